// Functions that exist for several levels of processors, of which a processor runs one: all levels that this
// one has, built anew, against each other, what the program itself runs, and sums written plainly. To the
// last bit.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "base/rng.h"
#include "cvd/distance.h"
#include "learn_degree/sums.h"
#include "levels/level.h"

namespace sherd {
namespace {

struct Built {
  const char* name;
  const char* file;
};

bool isHere(const std::string& level) {
#ifdef __x86_64__
  if (level == "x86_64_v3") return __builtin_cpu_supports("x86-64-v3") != 0;
  if (level == "x86_64_v4") return __builtin_cpu_supports("x86-64-v4") != 0;
#endif
  return true;
}

test::Level opened(const char* file) {
  void* object = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(object, nullptr) << dlerror();
  if (object == nullptr) return {};
  const auto level = reinterpret_cast<decltype(&sherdLevel)>(dlsym(object, "sherdLevel"));
  EXPECT_NE(level, nullptr) << dlerror();
  return level == nullptr ? test::Level{} : level();
}

test::Level theProgramsOwn() {
  test::Level own;
  own.squaredDistance = &squaredDistance;
  own.addScaled = &addScaled;
  own.addProduct = [](const double* m, std::size_t rows, std::size_t columns, const double* a, double* y) {
    addProduct({m, rows, columns}, a, y);
  };
  own.squaredDistances = [](const double* m, std::size_t rows, std::size_t columns, const double* z,
                            double* out) {
    squaredDistances({m, rows, columns}, z, out);
  };
  own.squaredNormOfProduct = [](const double* m, std::size_t rows, const double* a) {
    return squaredNormOfProduct({m, rows, rows}, a);
  };
  own.rootSums = [](const double* v, const double* w, std::size_t size, double* out) {
    const RootSums sums = rootSums({v, size}, {w, size});
    out[0] = sums.half, out[1] = sums.threeQuarters;
  };
  own.runningSums = [](const double* m, std::size_t rows, const double* centre, const double* weight,
                       const int* order, std::size_t count, double* out) {
    runningSums({m, rows, count}, centre, weight, {order, count}, out);
  };
  return own;
}

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

void addDistances(const test::Level& level, Numbers& numbers, std::size_t size, Record& record) {
  const std::vector<double> a = numbers.next(size), b = numbers.next(size);
  record.add(level.squaredDistance(a.data(), b.data(), size));
  std::vector<double> sum = numbers.next(size);
  level.addScaled(sum.data(), a.data(), numbers.next(), size);
  record.add(sum);
}

void addSums(const test::Level& level, Numbers& numbers, std::size_t rows, std::size_t columns,
             Record& record) {
  const std::vector<double> m = numbers.next(rows * columns), z = numbers.next(rows);
  std::vector<double> a = numbers.next(columns), y = numbers.next(rows), out(columns);
  level.addProduct(m.data(), rows, columns, a.data(), y.data());
  record.add(y);
  level.squaredDistances(m.data(), rows, columns, z.data(), out.data());
  record.add(out);
  const std::vector<double> square = numbers.next(rows * rows);
  record.add(level.squaredNormOfProduct(square.data(), rows, z.data()));
  std::vector<double> v = numbers.next(columns), w = numbers.next(columns);
  for (std::size_t i = 0; i < columns; ++i) v[i] = std::abs(v[i]), w[i] = std::abs(w[i]);
  double roots[2];
  level.rootSums(v.data(), w.data(), columns, roots);
  record.add(roots[0]), record.add(roots[1]);
  std::vector<int> order(columns);
  for (std::size_t i = 0; i < columns; ++i) order[i] = static_cast<int>((7 * i) % columns);
  std::vector<double> running((columns + 1) * (rows + 2));
  level.runningSums(m.data(), rows, z.data(), w.data(), order.data(), columns, running.data());
  record.add(running);
}

Record recordOf(const test::Level& level) {
  Record record;
  for (const auto kind : {Numbers::Kind::Ordinary, Numbers::Kind::AllSizes, Numbers::Kind::Nasty}) {
    Numbers numbers(kind, 5);
    for (int round = 0; round < 40; ++round) {
      for (std::size_t size = 8; size <= 256; size += 8) addDistances(level, numbers, size, record);
      for (const std::size_t rows : {1u, 3u, 4u, 8u, 13u, 74u})
        for (const std::size_t columns : {1u, 5u, 8u, 21u}) addSums(level, numbers, rows, columns, record);
    }
  }
  return record;
}

class Levels : public testing::TestWithParam<Built> {};

TEST_P(Levels, HaveTheBitsThatTheProgramHas) {
  if (!isHere(GetParam().name)) GTEST_SKIP() << "this processor has no " << GetParam().name;
  const test::Level level = opened(GetParam().file);
  ASSERT_NE(level.runningSums, nullptr);
  const Record own = recordOf(theProgramsOwn()), built = recordOf(level);
  EXPECT_GT(own.size(), 100000u);
  EXPECT_EQ(built.differing(own), 0u);
}

TEST_P(Levels, SumInTheOrderThatIsDocumented) {
  if (!isHere(GetParam().name)) GTEST_SKIP() << "this processor has no " << GetParam().name;
  const test::Level level = opened(GetParam().file);
  ASSERT_NE(level.squaredDistance, nullptr);
  Record plain, built;
  Numbers numbers(Numbers::Kind::AllSizes, 11);
  for (int round = 0; round < 500; ++round) {
    const std::size_t size = 8 * (1 + static_cast<std::size_t>(round) % 32);
    const std::vector<double> a = numbers.next(size), b = numbers.next(size);
    volatile double s[8] = {};  // nothing is fused or put into another order
    for (std::size_t i = 0; i < size; ++i) {
      const volatile double difference = a[i] - b[i], square = difference * difference;
      s[i % 8] = s[i % 8] + square;
    }
    plain.add(((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7])));
    built.add(level.squaredDistance(a.data(), b.data(), size));
  }
  EXPECT_EQ(built.differing(plain), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, Levels,
                         testing::Values(Built{"x86_64", LEVEL_X86_64}, Built{"x86_64_v3", LEVEL_X86_64_V3},
                                         Built{"x86_64_v4", LEVEL_X86_64_V4}),
                         [](const auto& info) { return std::string(info.param.name); });

/// That the comparison would see it: fused multiply-adds, which the flags forbid, give other bits.
TEST(LevelsControl, FusedSumsAreSeen) {
  if (!isHere("x86_64_v3")) GTEST_SKIP() << "this processor has no x86_64_v3";
  const test::Level fused = opened(LEVEL_FUSED);
  ASSERT_NE(fused.runningSums, nullptr);
  const Record own = recordOf(theProgramsOwn());
  EXPECT_GT(recordOf(fused).differing(own), own.size() / 100);
}

}  // namespace
}  // namespace sherd
