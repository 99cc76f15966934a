// One function for several processors, chosen at run time; all with the same bits, since nothing is
// contracted (-ffp-contract=off).
#pragma once

// The choice is made by the dynamic linker, before sanitizers are set up: they go without.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define SHERD_VERSIONS
/// The same text for all.
#define SHERD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
/// Texts of their own, of one name.
#define SHERD_AVX512 __attribute__((target("arch=x86-64-v4")))
#define SHERD_AVX2 __attribute__((target("avx2")))
#define SHERD_BASELINE __attribute__((target("default")))
#else
#define SHERD_CLONES
#define SHERD_BASELINE
#endif
