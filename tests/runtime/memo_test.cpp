// Parts of a node's work: what is kept is found again, and what isn't is computed.
#include "base/memo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "eval/node_memo.h"
#include "runtime/disk_values.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

struct SquaresParams {
  std::int64_t count = 10;
  double factor = 1;
};

/// factor · Σ i², whose squares are parts.
NodeType squaresNode(const std::function<bool(std::int64_t)>& compute, int implementation = 1) {
  return NodeBuilder<SquaresParams>("Squares", 1, "Adds squares.")
      .integer("count", &SquaresParams::count, {.help = "how many"})
      .number("factor", &SquaresParams::factor, {.help = "of the sum"})
      .output<double>("sum", "")
      .implementation(implementation)
      .run([compute](const SquaresParams& params, NodeIo& io) -> Result<void> {
        double sum = 0;
        for (std::int64_t i = 0; i < params.count; ++i) {
          const Digest key = Hasher().add(i).digest();
          auto square = recall<Leaf>(io.memo(), key);
          if (!square) {
            if (!compute(i)) return failure("stopped");
            square = Leaf{{static_cast<double>(i * i)}};
            remember(io.memo(), key, *square, 5);
          }
          sum += square->numbers.at(0);
        }
        io.out("sum", params.factor * sum);
        return {};
      });
}

class MemoTest : public ::testing::Test {
 protected:
  /// A run in a process of its own, as far as anything kept is concerned. The sum; NaN where it failed.
  double run(std::int64_t count, double factor, int implementation = 1, bool withStore = true) {
    Registry registry;
    const auto added = registry.add(squaresNode(
        [this](std::int64_t i) {
          if (i == stopAt) return false;
          computed.push_back(i);
          return true;
        },
        implementation));
    EXPECT_TRUE(added.ok());
    const Graph graph = graphOf(R"("s": {"type": "Squares@1", "params": {"count": )" + std::to_string(count) +
                                    R"(, "factor": )" + std::to_string(factor) + "}}",
                                registry);
    const auto store = withStore ? openStore(root) : nullptr;
    Cache cache;
    CancelToken token;
    EvalOptions options;
    options.disk = store.get();
    computed.clear();
    const EvalReport report = evaluate(graph, nodesOf(graph, {"s"}), cache, token, options);
    return report.ok() ? numberAt(graph, report, "s", "sum") : std::nan("");
  }

  TemporaryDirectory directory;
  fs::path root = directory.path() / "cache";
  std::vector<std::int64_t> computed;
  std::int64_t stopAt = -1;
};

TEST_F(MemoTest, AnotherRunComputesOnlyWhatIsNew) {
  EXPECT_EQ(run(4, 1), 14);
  EXPECT_EQ(computed.size(), 4u);
  EXPECT_EQ(run(4, 2), 28);
  EXPECT_TRUE(computed.empty());
  EXPECT_EQ(run(6, 1), 55);
  EXPECT_EQ(computed, (std::vector<std::int64_t>{4, 5}));
  EXPECT_EQ(run(4, 3, 2), 42);  // another implementation trusts nothing of the first
  EXPECT_EQ(computed.size(), 4u);
}

TEST_F(MemoTest, ARunThatEndedInTheMiddleGoesOn) {
  stopAt = 3;
  EXPECT_TRUE(std::isnan(run(5, 1)));
  stopAt = -1;
  EXPECT_EQ(run(5, 1), 30);
  EXPECT_EQ(computed, (std::vector<std::int64_t>{3, 4}));
}

TEST_F(MemoTest, WithoutAStoreAllIsComputed) {
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(run(4, 1 + k, 1, false), 14 * (1 + k));
    EXPECT_EQ(computed.size(), 4u);
  }
}

TEST_F(MemoTest, DamagedPartsAreComputedAgain) {
  EXPECT_EQ(run(4, 1), 14);
  for (const char* damage : {"cut", "flipped", "emptied"}) {
    std::size_t damaged = 0;
    for (const fs::path& file : filesIn(root / "objects")) {
      std::string bytes = readFile(file);
      if (bytes.find("(part of a result)") == std::string::npos) continue;
      ++damaged;
      if (damage[0] == 'c') bytes.resize(bytes.size() - 1);
      if (damage[0] == 'f') bytes.back() = static_cast<char>(bytes.back() ^ 1);
      if (damage[0] == 'e') bytes.clear();
      writeFile(file, bytes);
    }
    EXPECT_EQ(damaged, 4u);
    EXPECT_EQ(run(4, 2 + damage[0]), 14 * (2 + damage[0]));
    EXPECT_EQ(computed.size(), 4u) << damage;
  }
}

TEST_F(MemoTest, PartsAreCheckedBoundedAndCleared) {
  const auto store = openStore(root, {.mostBytes = 200'000, .onWarning = {}});
  const std::string large(10'000, 'x');
  EXPECT_FALSE(store->part(digestOf(1)));
  EXPECT_TRUE(store->savePart(digestOf(1), "part", 5));
  EXPECT_EQ(store->part(digestOf(1)), "part");
  EXPECT_TRUE(store->savePart(digestOf(1), "newer", 5));
  EXPECT_EQ(store->part(digestOf(1)), "newer");
  EXPECT_FALSE(store->savePart(digestOf(2), std::string(300'000, 'x'), 5));
  EXPECT_TRUE(store->verify().empty());
  EXPECT_TRUE(store->load(valueType<Leaf>(), digestOf(1)).empty());  // it is no Leaf
  for (std::uint64_t i = 10; i < 60; ++i) EXPECT_TRUE(store->savePart(digestOf(i), large, 1));
  store->collect(200'000);
  EXPECT_LE(store->stats().bytes(), 200'000u);
  EXPECT_GT(store->stats().objects, 10u);
  EXPECT_TRUE(store->clear().ok());
  EXPECT_EQ(store->stats().objects, 0u);
}

TEST_F(MemoTest, BytesOfAnotherShapeAreNoValue) {
  const auto store = openStore(root);
  NodeMemo memo(*store, squaresNode([](std::int64_t) { return true; }));
  remember(&memo, digestOf(1), leaf(1), 5);
  EXPECT_EQ(recall<Leaf>(&memo, digestOf(1)), leaf(1));
  EXPECT_FALSE(recall<NewLeaf>(&memo, digestOf(1)));
  EXPECT_FALSE(recall<Blob>(&memo, digestOf(1)));
  const Digest key = detail::memoKey<Leaf>(digestOf(2));
  ArchiveWriter to;
  saveValue(to, leaf(2));
  for (const std::string& bytes : {to.bytes() + "x", to.bytes().substr(1), std::string()}) {
    memo.keep(key, bytes, 5);
    EXPECT_FALSE(recall<Leaf>(&memo, digestOf(2)));
  }
  memo.keep(key, to.bytes(), 5);
  EXPECT_EQ(recall<Leaf>(&memo, digestOf(2)), leaf(2));
  EXPECT_FALSE(recall<Leaf>(nullptr, digestOf(1)));
}

TEST(OptionalGatheredInput, MayBeLeftOpen) {
  Registry registry = madeUpNodes();
  const auto added = registry.add(NodeBuilder<SquaresParams>("Total", 1, "Adds all.")
                                      .optionalGatheredInput<double>("all", "numbers")
                                      .output<double>("sum", "")
                                      .run([](const SquaresParams&, NodeIo& io) -> Result<void> {
                                        double sum = 0;
                                        for (const auto& number : io.all<double>("all")) sum += *number.value;
                                        io.out("sum", sum);
                                        return {};
                                      }));
  ASSERT_TRUE(added.ok());
  const auto total = [&](const std::string& in) {
    const Graph graph = graphOf(R"("c": {"type": "Constant@1", "params": {"value": "${frame}"}},
        "t": {"type": "Total@1")" + in +
                                    "}",
                                registry, "/graphs", R"("frames": "1-4", )");
    Cache cache;
    CancelToken token;
    return numberAt(graph, evaluate(graph, nodesOf(graph, {"t"}), cache, token), "t", "sum");
  };
  EXPECT_EQ(total(""), 0);
  EXPECT_EQ(total(R"(, "in": {"all": "c"})"), 10);
}

}  // namespace
}  // namespace sherd::test
