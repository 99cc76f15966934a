// Levels of processors that functions were built for anew, and what they are compared by: numbers to give
// them, and bits to get.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/rng.h"
#include "levels/level.h"

namespace sherd::test {

struct Built {
  const char* name;
  const char* file;
};

inline bool isHere(const std::string& level) {
#ifdef __x86_64__
  if (level == "x86_64_v3") return __builtin_cpu_supports("x86-64-v3") != 0;
  if (level == "x86_64_v4") return __builtin_cpu_supports("x86-64-v4") != 0;
#endif
  return true;
}

/// A function of a shared object; null, with a failure, where there is none.
template <class Function>
Function functionOf(const char* file, const char* name) {
  void* object = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(object, nullptr) << dlerror();
  if (object == nullptr) return nullptr;
  void* function = dlsym(object, name);
  EXPECT_NE(function, nullptr) << dlerror();
  return reinterpret_cast<Function>(function);
}

/// All levels that are built: INSTANTIATE_TEST_SUITE_P(All, Suite, allLevels(), levelName).
inline auto allLevels() {
  return testing::Values(Built{"x86_64", LEVEL_X86_64}, Built{"x86_64_v3", LEVEL_X86_64_V3},
                         Built{"x86_64_v4", LEVEL_X86_64_V4});
}
inline std::string levelName(const testing::TestParamInfo<Built>& info) { return info.param.name; }

/// Ordinary numbers, numbers of all sizes, and those that rounding, cancelling and overflow are hard on.
class Numbers {
 public:
  enum class Kind { Ordinary, AllSizes, Nasty };
  Numbers(Kind kind, std::uint64_t seed) : kind_(kind), rng_(seed) {}

  double next() {
    const double u = 2 * rng_.uniform() - 1;
    if (kind_ == Kind::Ordinary) return u;
    if (kind_ == Kind::AllSizes) return std::ldexp(u, static_cast<int>(600 * rng_.uniform()) - 300);
    static constexpr double kNasty[] = {0,
                                        -0.0,
                                        4.9406564584124654e-324,
                                        -2.2250738585072009e-308,
                                        1,
                                        1 + 0x1p-52,
                                        1 - 0x1p-53,
                                        0x1p53,
                                        -1e8,
                                        1e-162,
                                        1.0 / 3,
                                        -0x1.fffffffffffffp+511,
                                        1e154,
                                        1.7e308,
                                        -1.7e308,
                                        0.1};
    return kNasty[static_cast<std::size_t>(16 * rng_.uniform())];
  }
  std::vector<double> next(std::size_t size) {
    std::vector<double> all(size);
    for (double& x : all) x = next();
    return all;
  }

 private:
  Kind kind_;
  Rng rng_;
};

/// Bits of all results over many inputs. Where infinities cancel, any NaN is as good as another.
class Record {
 public:
  void add(double value) { bits_.push_back(std::isnan(value) ? ~0ull : std::bit_cast<std::uint64_t>(value)); }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
  std::size_t size() const { return bits_.size(); }
  std::size_t differing(const Record& other) const {
    if (bits_.size() != other.bits_.size()) return bits_.size() + 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) count += bits_[i] != other.bits_[i];
    return count;
  }

 private:
  std::vector<std::uint64_t> bits_;
};

}  // namespace sherd::test
