#include "base/processor.h"

#include <sys/utsname.h>

namespace sherd {
namespace {

std::string findLevel() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return "x86-64-v4";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return "x86-64-v3";
  return __builtin_cpu_supports("sse4.2") ? "x86-64-v2" : "x86-64-v1";
#else
  utsname machine{};
  return uname(&machine) == 0 ? machine.machine : "unknown";
#endif
}

}  // namespace

const std::string& processorLevel() {
  static const std::string level = findLevel();
  return level;
}

}  // namespace sherd
