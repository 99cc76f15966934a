// What of a training is kept: what is new is computed, and nothing else; the result is the same to the bit.
#include <functional>
#include <mutex>

#include "base/parallel.h"
#include "base/value_type.h"
#include "nodes/train_degree/block.h"
#include "simulate/simulate.h"

namespace sherd {
namespace {

class TestMemo : public Memo {
 public:
  std::optional<std::string> find(const Digest& key) override {
    const std::lock_guard lock(mutex_);
    const auto found = kept.find(key);
    return found == kept.end() ? std::nullopt : std::optional(found->second);
  }
  void keep(const Digest& key, std::string_view bytes, double ms) override {
    const std::lock_guard lock(mutex_);
    EXPECT_GE(ms, 0);
    kept[key] = bytes;
    size += bytes.size();
    if (onKeep) onKeep();
  }

  std::map<Digest, std::string> kept;
  std::size_t size = 0;
  std::function<void()> onKeep;

 private:
  std::mutex mutex_;
};

/// Heights differ in strength alone.
TrainDegreeParams sharing() {
  TrainDegreeParams params = small();
  params.drop.contactRadius = 0.01;  // Hertz's would grow with the height
  return params;
}

struct Computed {
  std::size_t impacts, solves, paths;
  friend bool operator==(const Computed&, const Computed&) = default;
};
std::ostream& operator<<(std::ostream& to, const Computed& c) {
  return to << c.impacts << " impacts, " << c.solves << " solves, " << c.paths << " paths";
}

/// Runs with what is kept and without, expects the same, and says what was computed with it.
Computed computed(const Body& body, const TrainDegreeParams& params, TestMemo& memo) {
  const DropExamples with = drops(body, params, &memo);
  expectSame(with, drops(body, params));
  return {with.impacts, with.solves, with.paths};
}

TEST(TrainDegreeKept, AnotherGammaTakesNoDropAndNoSolution) {
  const Body body = block();
  TrainDegreeParams params = sharing();
  TestMemo memo;
  EXPECT_EQ(computed(body, params, memo), (Computed{24, 8, 16}));
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 0}));
  params.gamma *= 3;
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 0}));  // the way to a smaller γ leads past it
  params.gamma /= 9;
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 16}));  // which go on from where they ended
  params.maxDegree = 5;
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 0}));
  EXPECT_LT(memo.size, 24 * 500 + 8 * body.tets->nodes.size() * 9 + 48 * 20'000);
}

TEST(TrainDegreeKept, MoreHeightsOrientationsAndSearchesTakeWhatIsNew) {
  const Body body = block();
  TrainDegreeParams params = sharing();
  TestMemo memo;
  computed(body, params, memo);
  params.heights = {0.25, 0.5, 1, 2};
  EXPECT_EQ(computed(body, params, memo), (Computed{8, 0, 0}));  // the way to the highest leads past it
  params.heights = {0.5, 4};
  EXPECT_EQ(computed(body, params, memo), (Computed{8, 0, 16}));
  params.orientations = 11;
  EXPECT_EQ(computed(body, params, memo), (Computed{6, 3, 6}));
  params.repeats = 3;
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 11}));
  params.learn.method = DegreeMethod::Network;
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 0}));
}

TEST(TrainDegreeKept, WhatAPartDependsOnIsItsKey) {
  const Body body = block();
  TrainDegreeParams params = sharing();
  params.orientations = 2;
  params.repeats = 1;
  TestMemo memo;
  EXPECT_EQ(computed(body, params, memo), (Computed{6, 2, 2}));
  const auto after = [&](const std::function<void(TrainDegreeParams&)>& change) {
    TrainDegreeParams changed = params;
    change(changed);
    return computed(body, changed, memo);
  };
  EXPECT_EQ(after([](auto& p) { p.alpha = 0.5; }), (Computed{0, 0, 2}));
  EXPECT_EQ(after([](auto& p) { p.drop.body.youngModulus *= 2; }).solves, 2u);
  EXPECT_EQ(after([](auto& p) { p.drop.body.poissonRatio = 0.3; }).solves, 2u);
  EXPECT_EQ(after([](auto& p) { p.drop.elements = ElementOrder::Quadratic; }), (Computed{0, 2, 2}));
  EXPECT_EQ(after([](auto& p) { p.drop.body.density *= 2; }).impacts, 6u);
  EXPECT_EQ(after([](auto& p) { p.drop.friction = 0.1; }).impacts, 6u);
  EXPECT_EQ(after([](auto& p) { p.drop.ballRadius = 0.1; }).impacts, 0u);  // no ball is thrown
  EXPECT_EQ(after([](auto& p) { p.seed = 7; }), (Computed{6, 2, 2}));

  Body other = body;
  auto stretched = std::make_shared<Embedding>(*body.embedding);
  stretched->coordinates.row(2) *= 2;
  other.embedding = stretched;
  EXPECT_EQ(computed(other, params, memo), (Computed{0, 0, 2}));
  EXPECT_EQ(computed(bodyOf(families::box(6, 4, 10, Vec3(0.12, 0.08, 0.21))), params, memo),
            (Computed{6, 2, 2}));
  EXPECT_EQ(computed(body, params, memo), (Computed{0, 0, 0}));
}

TEST(TrainDegreeKept, ATrainingThatEndedAnywhereGoesOn) {
  const Body body = block();
  const TrainDegreeParams params = sharing();
  TestMemo whole;
  const DropExamples expected = drops(body, params, &whole);
  ASSERT_EQ(whole.kept.size(), 48u);
  for (const int threads : {1, 2}) {
    setThreadLimit(threads);
    for (const std::size_t keeps : {1u, 23u, 24u, 28u, 33u, 40u, 47u}) {
      TestMemo memo;
      CancelToken token;
      memo.onKeep = [&] {
        if (memo.kept.size() >= keeps) token.cancel();
      };
      const Exec exec{&token, {}, {}};
      EXPECT_FALSE(dropExamples(body.tets, body.embedding, nullptr, params, exec, &memo).ok());
      memo.onKeep = {};
      const std::size_t done = memo.kept.size();
      EXPECT_GE(done, keeps);
      EXPECT_LT(done, 48u);
      const DropExamples resumed = drops(body, params, &memo);
      EXPECT_EQ(resumed.impacts + resumed.solves + resumed.paths, 48 - done);
      expectSame(resumed, expected);
      EXPECT_EQ(memo.kept, whole.kept);
    }
  }
  setThreadLimit(0);
}

TEST(TrainDegreeKept, DamagedPartsAreComputedAgain) {
  const Body body = block();
  TrainDegreeParams params = sharing();
  params.orientations = 2;
  TestMemo memo;
  computed(body, params, memo);
  const auto sound = memo.kept;
  for (auto& [key, bytes] : memo.kept) bytes.pop_back();
  EXPECT_EQ(computed(body, params, memo), (Computed{6, 2, 4}));
  EXPECT_EQ(memo.kept, sound);
  for (auto& [key, bytes] : memo.kept) bytes.clear();
  EXPECT_EQ(computed(body, params, memo), (Computed{6, 2, 4}));
}

TEST(TrainDegreeKept, ModelsAreTheSameWhateverWasKept) {
  const Body body = block();
  TrainDegreeParams params = sharing();
  TestMemo memo;
  const auto train = [&](Memo* kept) {
    return valueOf(trainDegree(body.tets, body.embedding, nullptr, params, Exec{}, kept));
  };
  params.gamma *= 2;
  params.orientations = 5;
  train(&memo);
  params = sharing();
  const TrainDegreeOutput with = train(&memo), without = train(nullptr);
  EXPECT_EQ(valueType<DegreeModel>().digest(&with.model), valueType<DegreeModel>().digest(&without.model));
  EXPECT_EQ(with.table, without.table);
}

TEST(TrainDegreeKept, ExamplesHaveTheEnergiesOfSimulate) {
  const Body body = block();
  TrainDegreeParams params = small();
  params.orientations = 3;
  for (const double floor : {3e10, 1e7}) {
    params.drop.obstacleYoung = floor;
    for (const DropExample& example : drops(body, params).drops) {
      SimulateParams drop = params.drop;
      drop.orientation = example.orientation;
      drop.dropHeight = example.height;
      const SimulateOutput exact = valueOf(simulate(body.tets, drop, Exec{}));
      EXPECT_NEAR(example.strainEnergy / totalEnergy(exact.energy), 1, 1e-6);
      double worst = 0;
      for (std::size_t n = 0; n < exact.energy.nodeEnergy.size(); ++n)
        worst = std::max(worst, std::abs(example.example.weight[n] - exact.energy.nodeEnergy[n]));
      EXPECT_LT(worst, 1e-6 * example.strainEnergy);
    }
  }
}

TEST(TrainDegreeKept, ProgressOnlyRises) {
  const Body body = block();
  TestMemo memo;
  for (int run = 0; run < 2; ++run) {
    std::mutex mutex;
    std::vector<double> shares;
    Exec exec;
    exec.onProgress = [&](double share) {
      const std::lock_guard lock(mutex);
      shares.push_back(share);
    };
    setThreadLimit(1);
    EXPECT_TRUE(trainDegree(body.tets, body.embedding, nullptr, sharing(), exec, &memo).ok());
    setThreadLimit(0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GE(shares.front(), 0);
    EXPECT_LE(shares.back(), 1);
    EXPECT_GT(shares.back(), 0.7);
    EXPECT_GT(shares.size(), run == 0 ? 40u : 2u);
  }
}

}  // namespace
}  // namespace sherd
