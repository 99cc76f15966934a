// The store on disk as a place for parts of the work of one type of node.
#pragma once

#include "base/memo.h"
#include "eval/disk_store.h"
#include "graph/node_type.h"

namespace sherd {

/// Keys of other types, of other implementations of this one, and of other kinds of processors are apart.
class NodeMemo : public Memo {
 public:
  NodeMemo(DiskStore& store, const NodeType& type);
  std::optional<std::string> find(const Digest& key) override;
  void keep(const Digest& key, std::string_view bytes, double ms) override;

 private:
  Digest keyOf(const Digest& key) const;

  DiskStore& store_;
  Digest type_;
};

}  // namespace sherd
