// One node pack in variants: a good one, and ones that a program must refuse before it calls anything in
// them.
#include <array>
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

#if defined(PACK_OTHER_VALUE)
namespace {
/// A value type whose layout differs from pack to pack.
struct Shape {
  static constexpr const char* typeName = "Shape";
  std::int64_t numbers[3];
};
struct OlderShape {
  static constexpr const char* typeName = "Shape";
  std::int64_t numbers[2];
};
template <class S>
void hashValue(sherd::Hasher& hasher, const S& shape) {
  for (const std::int64_t number : shape.numbers) hasher.add(number);
}
template <class S>
std::size_t byteSize(const S&) {
  return sizeof(S);
}

sherd::NodeType makeShapeNode() {
  return sherd::NodeBuilder<NoParams>("MakeShape", 1, "Makes a shape.")
      .output<Shape>("shape", "a shape")
      .run([](const NoParams&, sherd::NodeIo&) -> sherd::Result<void> { return {}; });
}
sherd::NodeType takeShapeNode() {
  return sherd::NodeBuilder<NoParams>("TakeShape", 1, "Takes a shape of other headers.")
      .input<OlderShape>("shape", "a shape")
      .run([](const NoParams&, sherd::NodeIo&) -> sherd::Result<void> { return {}; });
}
}  // namespace
SHERD_NODE_PACK(packedNode, makeShapeNode, takeShapeNode)
#elif defined(PACK_GOOD)
SHERD_NODE_PACK(packedNode)
#elif defined(PACK_TWICE)
SHERD_NODE_PACK(packedNode, packedNode)
#else
#if !defined(PACK_NO_HANDSHAKE)
namespace {
#if defined(PACK_OTHER_LAYOUT)
constexpr auto kOtherLayouts = [] {
  auto layouts = std::to_array(sherd::kLayouts);
  layouts[8].bytes += 8;
  return layouts;
}();
#endif
constexpr sherd::PluginHandshake handshake() {
  sherd::PluginHandshake made = sherd::kHandshake;
#if defined(PACK_OTHER_ABI)
  made.abi += 1;
#elif defined(PACK_OTHER_BUILD)
  made.build = "another compiler";
#elif defined(PACK_OTHER_LAYOUT)
  made.layouts = kOtherLayouts.data();
#elif defined(PACK_FEWER_LAYOUTS)
  made.layoutCount -= 1;
#elif defined(PACK_OTHER_VERSION)
  made.version = "0.0.1";
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
