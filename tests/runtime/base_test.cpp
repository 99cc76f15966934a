// The base layer: results, random numbers, digests and threads.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/parallel_in_order.h"
#include "base/result.h"
#include "base/rng.h"

namespace sherd {
namespace {

Result<int> half(int n) {
  if (n % 2 != 0) return failure("odd", "an even number", "n");
  return n / 2;
}

Result<int> quarter(int n) {
  SHERD_ASSIGN(const int first, half(n));
  SHERD_CHECK(half(first));
  return half(first);
}

TEST(ResultType, CarriesValueOrError) {
  EXPECT_EQ(*quarter(8), 2);
  EXPECT_FALSE(quarter(6).ok());
  EXPECT_EQ(quarter(7).error().text(), "odd; an even number");
  EXPECT_EQ(quarter(7).error().port, "n");
  EXPECT_EQ(failure("odd").text(), "odd");
  EXPECT_EQ(cancelledError().kind, Error::Kind::Cancelled);
  EXPECT_THROW(static_cast<void>(quarter(7).value()), std::bad_variant_access);
}

TEST(RngTest, IsAFunctionOfSeedStreamAndIndex) {
  Rng a(7, 1), b(7, 1);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bitsAt(i));
  EXPECT_NE(Rng(7, 1).bits(), Rng(7, 2).bits());
  EXPECT_NE(Rng(7, 1).bits(), Rng(8, 1).bits());
}

/// Known answers of philox2x64-10 (Random123's kat_vectors), first of the two words.
TEST(RngTest, IsPhilox) {
  EXPECT_EQ(Rng(0, 0).bitsAt(0), 0xca00a0459843d731ULL);
  EXPECT_EQ(Rng(~0ULL, ~0ULL).bitsAt(~0ULL), 0x65b021d60cd8310fULL);
  EXPECT_EQ(Rng(0xa4093822299f31d0ULL, 0x13198a2e03707344ULL).bitsAt(0x243f6a8885a308d3ULL),
            0x0a5e742c2997341cULL);
}

TEST(RngTest, IsUniform) {
  Rng rng(3);
  constexpr int kDraws = 200000, kBins = 20;
  std::vector<int> bins(kBins, 0);
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = rng.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u;
    squares += u * u;
    ++bins[static_cast<std::size_t>(u * kBins)];
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.003);
  EXPECT_NEAR(squares / kDraws, 1.0 / 3, 0.003);
  double chi = 0;
  for (const int count : bins) chi += std::pow(count - kDraws / kBins, 2) / (kDraws / kBins);
  EXPECT_LT(chi, 50);  // 19 degrees of freedom: exceeded once in 7000 seeds
  for (int i = 0; i < 1000; ++i) EXPECT_LT(rng.below(7), 7u);
  EXPECT_EQ(rng.below(1), 0u);
}

TEST(HashTest, SeparatesWhatItIsFed) {
  auto of = [](auto... parts) {
    Hasher hasher;
    (hasher.add(parts), ...);
    return hasher.digest();
  };
  using Text = std::string_view;
  EXPECT_EQ(of(Text("ab"), Text("c")), of(Text("ab"), Text("c")));
  EXPECT_NE(of(Text("ab"), Text("c")), of(Text("a"), Text("bc")));
  EXPECT_NE(of(Text("")), of());
  EXPECT_EQ(of(0.0), of(-0.0));
  EXPECT_NE(of(1.0), of(2.0));
  EXPECT_EQ(of(1), of(std::int64_t{1}));
  EXPECT_EQ((Digest{0x0123456789abcdefULL, 1}.hex()), "0123456789abcdef0000000000000001");
}

class Parallel : public ::testing::TestWithParam<int> {
 protected:
  Parallel() { setThreadLimit(GetParam()); }
  ~Parallel() override { setThreadLimit(0); }
};
INSTANTIATE_TEST_SUITE_P(Threads, Parallel, ::testing::Values(1, 2, 4));

TEST_P(Parallel, CoversEachIndexOnce) {
  for (const std::size_t n : {0u, 1u, 7u, 1000u, 100003u})
    for (const std::size_t grain : {0u, 1u, 64u, 1000000u}) {
      if (n > 1000 && grain < 2) continue;
      std::vector<int> seen(n, 0);
      inArena([&] {
        parallelFor(Exec{}, n, grain, [&](std::size_t begin, std::size_t end) {
          EXPECT_EQ(begin % std::max<std::size_t>(grain, 1), 0u);
          for (std::size_t i = begin; i < end; ++i) ++seen[i];
        });
      });
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(n));
    }
}

TEST_P(Parallel, SumsAreTheSameToTheLastBit) {
  constexpr std::size_t kCount = 100000, kGrain = 777;
  auto part = [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i)) * 1e3;
    return sum;
  };
  double expected = 0;
  for (std::size_t begin = 0; begin < kCount; begin += kGrain)
    expected += part(begin, std::min(kCount, begin + kGrain));
  for (int round = 0; round < 5; ++round) EXPECT_EQ(parallelSum(Exec{}, kCount, kGrain, 0.0, part), expected);
}

TEST_P(Parallel, RethrowsAndCanBeCancelled) {
  EXPECT_THROW(parallelFor(Exec{}, 1000, 1,
                           [](std::size_t begin, std::size_t) {
                             if (begin == 10) throw std::runtime_error("x");
                           }),
               std::runtime_error);
  CancelToken token;
  Exec exec;
  exec.cancel = &token;
  std::atomic<int> ran{0};
  parallelFor(exec, 100000, 1, [&](std::size_t, std::size_t) {
    if (++ran == 10) token.cancel();
  });
  EXPECT_LT(ran, 100000);
  EXPECT_TRUE(exec.cancelled());
}

TEST_P(Parallel, InOrderTakesEachBlockOnceAndOneByOne) {
  for (const std::size_t blocks : {0u, 1u, 2u, 3000u}) {
    std::vector<std::size_t> made(blocks, 0), taken;  // without a lock: sanitizers would see two at once
    inArena([&] {
      parallelInOrder(
          Exec{}, blocks, [&](std::size_t block) { made[block] += block + 1; },
          [&](std::size_t block) { taken.push_back(made[block]); });
    });
    ASSERT_EQ(taken.size(), blocks);
    for (std::size_t block = 0; block < blocks; ++block) EXPECT_EQ(taken[block], block + 1);
  }
}

TEST_P(Parallel, InOrderRethrowsAndCanBeCancelled) {
  const auto nothing = [](std::size_t) {};
  const auto fails = [](std::size_t block) {
    if (block == 10) throw std::runtime_error("x");
  };
  EXPECT_THROW(parallelInOrder(Exec{}, 1000, fails, nothing), std::runtime_error);
  EXPECT_THROW(parallelInOrder(Exec{}, 1000, nothing, fails), std::runtime_error);
  CancelToken token;
  Exec exec;
  exec.cancel = &token;
  std::size_t taken = 0;
  parallelInOrder(exec, 100000, nothing, [&](std::size_t block) {
    EXPECT_EQ(block, taken++);
    if (block == 10) token.cancel();
  });
  EXPECT_LT(taken, 100000u);
}

TEST_P(Parallel, TasksMayStartTasks) {
  std::atomic<int> count{0};
  inArena([&] {
    TaskGroup group;
    std::function<void(int)> grow = [&](int depth) {
      ++count;
      if (depth == 0) return;
      for (int i = 0; i < 2; ++i) group.run([&grow, depth] { grow(depth - 1); });
      parallelFor(Exec{}, 16, 1, [](std::size_t, std::size_t) {});
    };
    group.run([&] { grow(9); });
    group.wait();
  });
  EXPECT_EQ(count, 1023);
}

TEST_P(Parallel, GroupsRethrow) {
  TaskGroup group;
  group.run([] { throw std::runtime_error("x"); });
  EXPECT_THROW(group.wait(), std::runtime_error);
}

}  // namespace
}  // namespace sherd
