#include "train_degree/growth_path.h"

#include <gtest/gtest.h>

#include "base/memo.h"
#include "base/rng.h"
#include "nodes/train_degree/block.h"

namespace sherd {
namespace {

TEST(GrowthPath, EndsWhereTheLineThroughTheLogarithmsFallsToGamma) {
  const std::vector<double> path{8, 4, 1, 0};
  EXPECT_EQ(endOf(path, {1, 9})->degree, 1);
  EXPECT_EQ(endOf(path, {1, 9})->crossing, 0.5);
  EXPECT_EQ(endOf(path, {1, 8})->degree, 2);  // below, not at
  EXPECT_EQ(endOf(path, {1, 8})->crossing, 1);
  EXPECT_NEAR(endOf(path, {1, 2})->crossing, std::sqrt(6.0), 1e-12);  // halfway from 2 to 3 in logarithms
  EXPECT_EQ(endOf(path, {10, 1})->degree, 4);
  EXPECT_EQ(endOf(path, {10, 1})->crossing, 3);
  EXPECT_FALSE(endOf(std::vector<double>{8, 4, 1}, {10, 1}));
  EXPECT_EQ(endOf(path, {1, 2, 3})->degree, 3);
  EXPECT_FALSE(endOf(path, {1, 2, 2}));  // not among the first two
}

/// A body with uneven weights.
struct Weighted {
  Body body = block();
  WeightField field;
  Weighted() {
    Rng rng(3);
    field.tets = body.tets;
    for (const Vec3& p : body.tets->nodes) {
      field.volume.push_back(1e-6);
      field.weight.push_back(p.z() > 0.17 ? 0 : 1e-3 * rng.uniform() * std::exp(-20 * p.x()));
    }
  }
  GrowthPath followed(GrowthPath path, const PathGoal& goal) const {
    const auto done = follow(path, goal, *body.embedding, field, 5, Exec{});
    EXPECT_TRUE(done.ok());
    return path;
  }
};

void expectSamePath(const GrowthPath& a, const GrowthPath& b) {
  EXPECT_EQ(a.energy, b.energy);
  EXPECT_EQ(a.sites, b.sites);
  EXPECT_EQ(a.isExhausted, b.isExhausted);
}

TEST(GrowthPath, GoesOnToTheBitFromWhereverItEnded) {
  const Weighted w;
  const double whole = w.followed({}, {1, 1e9}).energy.at(0);
  const GrowthPath direct = w.followed({}, {1, whole / 40});
  ASSERT_GT(direct.energy.size(), 40u);
  GrowthPath inSteps;
  for (const double share : {2.0, 3.0, 4.0, 9.0, 10.0, 35.0, 40.0})
    inSteps = w.followed(inSteps, {1, whole / share});
  expectSamePath(inSteps, direct);
  GrowthPath oneByOne;
  for (int n = 1; n <= static_cast<int>(direct.energy.size()); ++n)
    oneByOne = w.followed(oneByOne, {1, whole / 40, n});
  expectSamePath(oneByOne, direct);
  // What is long enough stays.
  expectSamePath(w.followed(direct, {1, whole / 10}), direct);
  expectSamePath(w.followed(direct, {0.5, whole / 40}), direct);
  EXPECT_GT(w.followed(direct, {2, whole / 40}).energy.size(), direct.energy.size());
}

TEST(GrowthPath, ThatIsExhaustedDoesNotGoOn) {
  Weighted w;
  std::fill(w.field.weight.begin(), w.field.weight.end(), 0.0);
  for (const std::size_t n : {3u, 50u, 200u}) w.field.weight[n] = 1;
  const GrowthPath path = w.followed({}, {1, 0});
  EXPECT_TRUE(path.isExhausted);
  EXPECT_TRUE(isComplete(path, {1e9, 1e-30}));
  expectSamePath(w.followed(path, {1, 0}), path);
  std::fill(w.field.weight.begin(), w.field.weight.end(), 0.0);
  EXPECT_EQ(w.followed({}, {1, 1e-9}).energy, std::vector<double>{0});
}

TEST(GrowthPath, ComesBackAsItWas) {
  const Weighted w;
  const GrowthPath path = w.followed({}, {1, 1e-30, 7});
  ArchiveWriter to;
  saveValue(to, path);
  ArchiveReader from(to.bytes(), {});
  const auto read = loadValue(from, std::type_identity<GrowthPath>());
  ASSERT_TRUE(read && from.atEnd());
  expectSamePath(*read, path);
  GrowthPath wrong = path;
  wrong.energy.pop_back();
  ArchiveWriter other;
  saveValue(other, wrong);
  ArchiveReader again(other.bytes(), {});
  EXPECT_FALSE(loadValue(again, std::type_identity<GrowthPath>()));
}

}  // namespace
}  // namespace sherd
