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
#include <iterator>
#include <string>

#include "graph/node_type.h"
#include "graph/registry.h"

namespace sherd {

/// Raised when a class that crosses the border changes its layout or meaning, or kLayouts its entries.
inline constexpr std::uint32_t kPluginAbi = 4;

#define SHERD_TEXT2(x) #x
#define SHERD_TEXT(x) SHERD_TEXT2(x)
#if !defined(SHERD_VERSION)
#error "SHERD_VERSION is not defined: link the CMake target sherd::graph, or use sherd_add_node_pack"
#endif

#ifdef __GLIBCXX__
#define SHERD_LIBRARY_IDENTITY "libstdc++ abi " SHERD_TEXT(_GLIBCXX_USE_CXX11_ABI)
#else
#define SHERD_LIBRARY_IDENTITY "libc++ " SHERD_TEXT(_LIBCPP_VERSION)
#endif
// Containers of another layout.
#ifdef _GLIBCXX_DEBUG
#define SHERD_DEBUG_IDENTITY ", _GLIBCXX_DEBUG"
#else
#define SHERD_DEBUG_IDENTITY ""
#endif
// Both sides or none: the sanitizers' runtimes see only what is instrumented.
#if defined(__SANITIZE_ADDRESS__)
#define SHERD_SANITIZER_IDENTITY ", address sanitizer"
#elif defined(__SANITIZE_THREAD__)
#define SHERD_SANITIZER_IDENTITY ", thread sanitizer"
#else
#define SHERD_SANITIZER_IDENTITY ""
#endif
// Eigen aligns, allocates and frees by the widest vectors that it may use.
#if defined(__AVX512F__)
#define SHERD_VECTOR_IDENTITY ", AVX-512"
#elif defined(__AVX__)
#define SHERD_VECTOR_IDENTITY ", AVX"
#else
#define SHERD_VECTOR_IDENTITY ""
#endif
/// Compiler, standard library, and the options that change layouts. Optimisation and assertions (NDEBUG) do
/// not: a pack may be built for debugging.
#define SHERD_BUILD_IDENTITY                                                                       \
  "C++ " SHERD_TEXT(__cplusplus) ", " __VERSION__ ", " SHERD_LIBRARY_IDENTITY SHERD_DEBUG_IDENTITY \
      SHERD_SANITIZER_IDENTITY SHERD_VECTOR_IDENTITY

/// A class that crosses the border and its size: catches a change of layout that forgot to raise kPluginAbi.
/// That values on wires agree is for the registry to see (PortInfo::valueBytes).
struct PluginLayout {
  const char* name;
  std::uint64_t bytes;
};
// Not inline: the loader makes one object of inline variables, and a pack would hand out the program's sizes.
constexpr PluginLayout kLayouts[] = {
    {"NodeType", sizeof(NodeType)},
    {"NodeIo", sizeof(NodeIo)},
    {"PortInfo", sizeof(PortInfo)},
    {"ParamInfo", sizeof(ParamInfo)},
    {"ParamValue", sizeof(ParamValue)},
    {"Migration", sizeof(Migration)},
    {"MigrationStep", sizeof(MigrationStep)},
    {"Uninterruptible", sizeof(Uninterruptible)},
    {"ValueType", sizeof(ValueType)},
    {"Value", sizeof(Value)},
    {"ArchiveWriter", sizeof(ArchiveWriter)},
    {"ArchiveReader", sizeof(ArchiveReader)},
    {"Hasher", sizeof(Hasher)},
    {"Exec", sizeof(Exec)},
    {"Error", sizeof(Error)},
    {"Registry", sizeof(Registry)},
};

/// What a pack exports as the C symbol `sherd_pack_handshake`. `magic` and `abi` stay the first fields; the
/// others may differ in another ABI, and are read only when it is the program's.
struct PluginHandshake {
  std::uint32_t magic;          ///< kPluginMagic
  std::uint32_t abi;            ///< kPluginAbi
  const char* build;            ///< SHERD_BUILD_IDENTITY
  const char* version;          ///< SHERD_VERSION, of the headers
  const PluginLayout* layouts;  ///< kLayouts
  std::uint64_t layoutCount;
};
inline constexpr std::uint32_t kPluginMagic = 0x73685244;  // "shRD"
constexpr PluginHandshake kHandshake{kPluginMagic,  kPluginAbi, SHERD_BUILD_IDENTITY,
                                     SHERD_VERSION, kLayouts,   std::size(kLayouts)};

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
