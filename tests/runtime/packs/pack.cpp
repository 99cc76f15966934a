// One node pack in variants: a good one, and ones that a program must refuse before it calls anything in
// them.
#include <array>
#include <cstdlib>

#include "plugin/plugin.h"

namespace {

struct NoParams {};

[[maybe_unused]] sherd::NodeType packedNode() {
  return sherd::NodeBuilder<NoParams>("Packed", 1, "Comes from a pack.")
      .output<std::int64_t>("value", "42")
      .run([](const NoParams&, sherd::NodeIo& io) -> sherd::Result<void> {
        io.out<std::int64_t>("value", 42);
        return {};
      });
}

}  // namespace

#if defined(PACK_SHAPE) || defined(PACK_OTHER_SHAPE)
namespace shapes {
/// A value type of one name and, as after an update of its header, two layouts.
struct Shape {
  static constexpr const char* typeName = "Shape";
#if defined(PACK_SHAPE)
  std::int64_t numbers[3];
#else
  std::int64_t numbers[2];
#endif
};
inline void hashValue(sherd::Hasher& hasher, const Shape& shape) {
  for (const std::int64_t number : shape.numbers) hasher.add(number);
}
inline std::size_t byteSize(const Shape&) { return sizeof(Shape); }
}  // namespace shapes

namespace {
sherd::NodeType shapeNode() {
#if defined(PACK_SHAPE)
  sherd::NodeBuilder<NoParams> node("MakeShape", 1, "Makes a shape.");
  node.output<shapes::Shape>("shape", "a shape");
#else
  sherd::NodeBuilder<NoParams> node("TakeShape", 1, "Takes a shape.");
  node.input<shapes::Shape>("shape", "a shape");
#endif
  return node.run([](const NoParams&, sherd::NodeIo&) -> sherd::Result<void> { return {}; });
}
}  // namespace
SHERD_NODE_PACK(shapeNode)
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
