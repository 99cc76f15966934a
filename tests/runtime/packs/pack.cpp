// One node pack in variants: a good one, and ones that a program must refuse before it calls anything in
// them.
#include <cstdlib>

#include "plugin/plugin.h"

namespace {

struct NoParams {};

sherd::NodeType packedNode() {
  return sherd::NodeBuilder<NoParams>("Packed", 1, "Comes from a pack.")
      .output<std::int64_t>("value", "42")
      .run([](const NoParams&, sherd::NodeIo& io) -> sherd::Result<void> {
        io.out<std::int64_t>("value", 42);
        return {};
      });
}

}  // namespace

#if defined(PACK_GOOD)
SHERD_NODE_PACK(packedNode)
#elif defined(PACK_TWICE)
SHERD_NODE_PACK(packedNode, packedNode)
#else
#if !defined(PACK_NO_HANDSHAKE)
namespace {
constexpr sherd::PluginHandshake handshake() {
  sherd::PluginHandshake made = sherd::kHandshake;
#if defined(PACK_OTHER_ABI)
  made.abi += 1;
#elif defined(PACK_OTHER_BUILD)
  made.build = "another compiler";
#elif defined(PACK_OTHER_LAYOUT)
  made.nodeTypeBytes += 8;
#endif
  return made;
}
}  // namespace
extern "C" const sherd::PluginHandshake sherd_pack_handshake;
const sherd::PluginHandshake sherd_pack_handshake = handshake();
#endif
extern "C" bool sherd_pack_register(sherd::Registry& registry, sherd::Error&) {
  static_cast<void>(registry.add(packedNode()));
  std::abort();  // nothing in a refused pack may be called
}
#endif
