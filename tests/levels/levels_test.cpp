// Functions that exist for several levels of processors, of which a processor runs one: all levels that this
// one has, built anew, against each other, what the program itself runs, and sums written plainly. To the
// last bit.
#include <gtest/gtest.h>

#include "cvd/distance.h"
#include "learn_degree/sums.h"
#include "levels/built_levels.h"

namespace sherd {
namespace {

using test::Built, test::isHere, test::Numbers, test::Record;

test::Level opened(const char* file) {
  const auto level = test::functionOf<decltype(&sherdLevel)>(file, "sherdLevel");
  return level == nullptr ? test::Level{} : level();
}

test::Level theProgramsOwn() {
  test::Level own;
  own.squaredDistance = &squaredDistance;
  own.addScaled = &addScaled;
  own.sumScaled = &sumScaled;
  own.compareLanes = &compareLanes;
  own.keepBounds = &keepBounds;
  own.findOpenLanes = &findOpenLanes;
  own.lanesWithLabel = &lanesWithLabel;
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

void addLanes(const test::Level& level, Numbers& numbers, std::size_t dimensions, Record& record) {
  const auto nextLanes = [&] {
    LaneValues values;
    for (float& value : values.lane) value = static_cast<float>(numbers.next());
    return values;
  };
  std::vector<LaneValues> block(dimensions + 1), bounds(5);
  for (auto* list : {&block, &bounds})
    for (LaneValues& values : *list) values = nextLanes();
  std::vector<float> site(dimensions), drift(bounds.size());
  for (auto* list : {&site, &drift})
    for (float& value : *list) value = static_cast<float>(numbers.next());
  const LaneValues up = nextLanes();
  LaneValues low, high, kept;
  record.add(level.compareLanes(block.data(), {site.data(), drift[0]}, dimensions, up.lane, low, high));
  level.keepBounds(low, drift[1], kept);
  std::vector<std::uint16_t> open(bounds.size());
  level.findOpenLanes(bounds.data(), drift.data(), bounds.size(), up.lane, open.data());
  for (const std::uint16_t bits : open) record.add(bits);
  int labels[kNodeLanes];
  for (std::size_t k = 0; k < kNodeLanes; ++k) {
    for (const LaneValues* values : {&low, &high, &kept}) record.add(static_cast<double>(values->lane[k]));
    labels[k] = low.lane[k] > 0.5f ? 7 : -1;
  }
  record.add(level.lanesWithLabel(labels, 7));
}

void addWeightedSums(const test::Level& level, Numbers& numbers, std::size_t dimensions, Record& record) {
  const std::vector<double> points = numbers.next(20 * dimensions), weight = numbers.next(20);
  const int list[] = {3, 0, 19, 7, 8};
  std::vector<double> out(dimensions);
  for (const std::size_t count : {0u, 1u, 5u}) {
    level.sumScaled(out.data(), points.data(), weight.data(), {list, count}, dimensions);
    record.add(out);
  }
}

Record recordOf(const test::Level& level) {
  Record record;
  for (const auto kind : {Numbers::Kind::Ordinary, Numbers::Kind::AllSizes, Numbers::Kind::Nasty}) {
    Numbers numbers(kind, 5);
    for (int round = 0; round < 40; ++round) {
      for (std::size_t size = 8; size <= 256; size += 8) addDistances(level, numbers, size, record);
      for (const std::size_t size : {1u, 3u, 4u, 8u, 13u, 33u, 74u, 250u}) {
        addDistances(level, numbers, size, record);
        addLanes(level, numbers, size, record);
        addWeightedSums(level, numbers, size, record);
      }
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
    const std::size_t size = 1 + static_cast<std::size_t>(round) % 250;
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

INSTANTIATE_TEST_SUITE_P(All, Levels, test::allLevels(), test::levelName);

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
