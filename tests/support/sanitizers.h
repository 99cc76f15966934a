// What a build with sanitizers changes for tests.
#pragma once

namespace sherd::test {

#ifdef __SANITIZE_ADDRESS__
/// Its allocator ends the program where the usual one throws, and it needs terabytes of address space.
inline constexpr bool kAddressSanitizer = true;
#else
inline constexpr bool kAddressSanitizer = false;
#endif
#ifdef __SANITIZE_THREAD__
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

/// How much longer everything may take.
inline constexpr double kSlowdown = kThreadSanitizer ? 15 : kAddressSanitizer ? 4 : 1;

}  // namespace sherd::test
