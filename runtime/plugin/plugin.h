// The binary interface between the program and a node pack, a shared library. A pack is one source file:
//
//   #include "plugin/plugin.h"
//   NodeType myNode();                    // a table made with NodeBuilder
//   SHERD_NODE_PACK(myNode, myOtherNode)
//
// Node types cross the border as C++ objects, so both sides must be built by the same compiler against the
// same library and headers. The handshake says whether they were; it is plain data, read before anything is
// called.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <string>

#include "graph/node_type.h"
#include "graph/registry.h"

namespace sherd {

/// Raised when a class that crosses the border changes its layout or meaning.
inline constexpr std::uint32_t kPluginAbi = 1;

#define SHERD_TEXT2(x) #x
#define SHERD_TEXT(x) SHERD_TEXT2(x)
#ifdef __GLIBCXX__
#define SHERD_LIBRARY_IDENTITY "libstdc++ abi " SHERD_TEXT(_GLIBCXX_USE_CXX11_ABI)
#else
#define SHERD_LIBRARY_IDENTITY "libc++ " SHERD_TEXT(_LIBCPP_VERSION)
#endif
/// Compiler and standard library.
#define SHERD_BUILD_IDENTITY "C++ " SHERD_TEXT(__cplusplus) ", " __VERSION__ ", " SHERD_LIBRARY_IDENTITY

/// What a pack exports as the C symbol `sherd_pack_handshake`. The order of the fields never changes.
struct PluginHandshake {
  std::uint32_t magic;  ///< kPluginMagic
  std::uint32_t abi;    ///< kPluginAbi
  const char* build;    ///< SHERD_BUILD_IDENTITY
  std::uint64_t
      nodeTypeBytes;  ///< sizeof(NodeType): catches a change of layout that forgot to raise kPluginAbi
  std::uint64_t nodeIoBytes;  ///< sizeof(NodeIo)
};
inline constexpr std::uint32_t kPluginMagic = 0x73685244;  // "shRD"
inline constexpr PluginHandshake kHandshake{kPluginMagic, kPluginAbi, SHERD_BUILD_IDENTITY, sizeof(NodeType),
                                            sizeof(NodeIo)};

/// What a pack exports as the C symbol `sherd_pack_register`: adds its types, or says why not and returns
/// false.
using RegisterPack = bool(Registry& registry, Error& error);

inline bool registerTypes(Registry& registry, Error& error, std::initializer_list<NodeType (*)()> makers) {
  try {
    for (const auto maker : makers)
      if (auto added = registry.add(maker()); !added.ok()) {
        error = added.error();
        return false;
      }
    return true;
  } catch (const std::exception& e) {
    error = failure(e.what());
    return false;
  }
}

}  // namespace sherd

/// Makes the shared library a node pack of the types that the given functions, NodeType f(), describe.
#define SHERD_NODE_PACK(...)                                                                            \
  extern "C" __attribute__((visibility("default"))) const sherd::PluginHandshake sherd_pack_handshake;  \
  const sherd::PluginHandshake sherd_pack_handshake = sherd::kHandshake;                                \
  extern "C" __attribute__((visibility("default"))) bool sherd_pack_register(sherd::Registry& registry, \
                                                                             sherd::Error& error) {     \
    return sherd::registerTypes(registry, error, {__VA_ARGS__});                                        \
  }
