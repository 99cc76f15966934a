#include "eval/node_memo.h"

#include "base/processor.h"

namespace sherd {

NodeMemo::NodeMemo(DiskStore& store, const NodeType& type) : store_(store) {
  static constexpr std::string_view kPurpose = "part of a node's work";
  type_ = Hasher()
              .add(kPurpose)
              .add(std::string_view(type.name))
              .add(type.version)
              .add(type.implementation)
              .add(std::string_view(processorLevel()))
              .digest();
}

Digest NodeMemo::keyOf(const Digest& key) const { return Hasher().add(type_).add(key).digest(); }

std::optional<std::string> NodeMemo::find(const Digest& key) { return store_.part(keyOf(key)); }

void NodeMemo::keep(const Digest& key, std::string_view bytes, double ms) {
  store_.savePart(keyOf(key), bytes, ms);
}

}  // namespace sherd
