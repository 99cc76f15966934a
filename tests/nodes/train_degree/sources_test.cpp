// Examples from thrown balls, and from impacts of an earlier shot.
#include "base/value_type.h"
#include "nodes/train_degree/block.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "support/said.h"

namespace sherd {
namespace {

TrainDegreeParams thrown() {
  TrainDegreeParams params = small();
  params.orientations = 0;
  params.ballSpeeds = {4, 8, 16};
  params.drop.contactRadius = 0.01;
  params.gamma = 5e-3;
  return params;
}

SimulateOutput hit(const Body& body, const TrainDegreeParams& params, const DropExample& example) {
  SimulateParams scene = params.drop;
  scene.scene = RigidScene::Ball;
  scene.ballTarget = example.hit.target;
  scene.ballDirection = example.hit.direction;
  scene.ballSpeed = example.speed;
  return valueOf(simulate(body.tets, scene, Exec{}));
}

TEST(BallHits, AreSpreadEvenlyByAreaAndComeFromOutside) {
  const Body body = block();
  const Vec3 extent(0.12, 0.08, 0.2);
  for (const std::int64_t seed : {1, 9}) {
    const auto hits = spreadBallHits(*body.tets->surface, 400, false, seed);
    ASSERT_EQ(hits.size(), 400u);
    std::map<std::pair<int, bool>, double> share;
    for (const BallHit& hit : hits) {
      EXPECT_NEAR(hit.direction.norm(), 1, 1e-12);
      int onFaces = 0;
      for (int axis = 0; axis < 3; ++axis)
        for (const bool isHigh : {false, true}) {
          if (std::abs(hit.target[axis] - (isHigh ? 1 : 0)) > 1e-9) continue;
          ++onFaces;
          share[{axis, isHigh}] += 1.0 / 400;
          EXPECT_LT((isHigh ? 1 : -1) * hit.direction[axis], 0);
        }
      EXPECT_EQ(onFaces, 1);
    }
    const double whole = 2 * (extent.x() * extent.y() + extent.y() * extent.z() + extent.x() * extent.z());
    for (const auto& [face, part] : share)
      EXPECT_NEAR(part, extent.prod() / extent[face.first] / whole, 0.02);
    const auto fewer = spreadBallHits(*body.tets->surface, 7, false, seed);
    for (std::size_t i = 0; i < fewer.size(); ++i) EXPECT_EQ(fewer[i].target, hits[i].target);
    for (const BallHit& hit : spreadBallHits(*body.tets->surface, 50, true, seed))
      EXPECT_LE(hit.direction.y(), 0);
  }
  EXPECT_NE(spreadBallHits(*body.tets->surface, 1, false, 1)[0].target,
            spreadBallHits(*body.tets->surface, 1, false, 2)[0].target);
}

TEST(TrainDegreeSources, BallsGiveWhatSimulateAndTheSearchGive) {
  const Body body = block();
  TrainDegreeParams params = thrown();
  params.balls = 4;
  params.ballHits = {{Vec3(0.5, 0.75, 0.25), Vec3(2, 0, 0)}, {Vec3(0.9, 1, 0.1), Vec3(0, -1, 0.1)}};
  for (const bool standing : {false, true}) {
    params.drop.standing = standing;
    const DropExamples all = drops(body, params);
    ASSERT_EQ(all.drops.size(), 18u);
    EXPECT_EQ(all.drops[0].hit.target, params.ballHits[0].target);
    EXPECT_EQ(all.drops.back().example.group, 5);
    EXPECT_LE(all.solves, standing ? 18u : 6u);  // one for all speeds of a ball that hits it floating
    int least = 1000, most = 0;
    for (const DropExample& example : all.drops) {
      EXPECT_EQ(example.source, ExampleSource::Ball);
      const SimulateOutput exact = hit(body, params, example);
      EXPECT_NEAR(example.strainEnergy / totalEnergy(exact.energy), 1, 1e-6);
      const WeightField field{body.tets, all.validFor.material, example.example.weight, all.volume};
      const Sites sites = valueOf(
          predictDegree(field, *body.embedding, {.gamma = params.gamma, .seed = params.seed}, Exec{}));
      ASSERT_FALSE(example.example.degree.empty());
      EXPECT_EQ(example.example.degree[0], sites.positions.cols());
      least = std::min(least, example.example.degree[0]), most = std::max(most, example.example.degree[0]);
    }
    EXPECT_LT(least, most);
  }
}

TEST(TrainDegreeSources, ImpactsOfAnEarlierShotAreExamples) {
  const Body body = block();
  TrainDegreeParams params = thrown();
  params.balls = 3;
  const DropExamples balls = drops(body, params);
  TrainDegreeParams given = params;
  given.balls = 0;
  for (const DropExample& example : balls.drops) given.impacts.push_back(hit(body, params, example).impact);
  given.impacts.insert(given.impacts.begin(), Impact{});  // of a frame in which nothing was hit
  const DropExamples again = drops(body, given);
  ASSERT_EQ(again.drops.size(), balls.drops.size());
  EXPECT_EQ(again.impacts, 0u);
  for (std::size_t i = 0; i < again.drops.size(); ++i) {
    EXPECT_EQ(again.drops[i].source, ExampleSource::Impact);
    EXPECT_EQ(again.drops[i].impact, i + 1);
    EXPECT_EQ(again.drops[i].example.group, static_cast<int>(i));
    EXPECT_EQ(again.drops[i].example.degree, balls.drops[i].example.degree);
    EXPECT_EQ(again.drops[i].example.weight, balls.drops[i].example.weight);
  }
}

TEST(TrainDegreeSources, AllOfThemMakeOneModel) {
  const Body body = block();
  TrainDegreeParams params = thrown();
  params.orientations = 6;
  params.balls = 5;
  SimulateParams drop = params.drop;
  drop.orientation = Vec3(20, 30, 40);
  params.impacts = {valueOf(simulate(body.tets, drop, Exec{})).impact};
  Said said;
  const auto out = valueOf(trainDegree(body.tets, body.embedding, nullptr, params, said.exec));
  EXPECT_TRUE(said.info("learned from 34 drops and balls and impacts that give "));
  std::istringstream lines(out.table);
  std::string line;
  std::map<std::string, int> count;
  std::set<std::ptrdiff_t> commas;
  while (std::getline(lines, line)) {
    ++count[line.substr(0, line.find(','))];
    commas.insert(std::count(line.begin(), line.end(), ','));
  }
  EXPECT_EQ(count, (std::map<std::string, int>{{"source", 1}, {"drop", 18}, {"ball", 15}, {"impact", 1}}));
  EXPECT_EQ(commas.size(), 1u);
  // A model is for a body, not for how its examples came about: it serves a drop and a ball alike.
  TrainDegreeParams dropsOnly = small();
  dropsOnly.gamma = params.gamma;
  EXPECT_EQ(differences(out.model.validFor, drops(body, dropsOnly).validFor), "");
}

TEST(TrainDegreeSources, WhatIsNoExampleIsNamed) {
  const Body body = block(), other = bodyOf(families::box(6, 4, 10, Vec3(0.12, 0.08, 0.21)));
  const auto error = [&](const std::function<void(TrainDegreeParams&)>& spoil) {
    TrainDegreeParams params = thrown();
    params.balls = 1;
    spoil(params);
    const auto out = dropExamples(body.tets, body.embedding, nullptr, params, Exec{});
    return out.ok() ? failure("nothing") : out.error();
  };
  SimulateParams drop;
  const Impact good = valueOf(simulate(body.tets, drop, Exec{})).impact;
  const Impact wrong = valueOf(simulate(other.tets, drop, Exec{})).impact;
  EXPECT_EQ(error([&](auto& p) { p.impacts = {good}; }).what, "nothing");
  const Error stranger = error([&](auto& p) { p.impacts = {good, wrong}; });
  EXPECT_EQ(stranger.port, "impacts");
  EXPECT_NE(stranger.what.find("impact 2 is of another body"), std::string::npos);
  Impact broken = good;
  broken.contacts[0].impulse.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error([&](auto& p) { p.impacts = {broken}; }).what.find("impact 1 has a contact"),
            std::string::npos);
  EXPECT_EQ(error([](auto& p) { p.balls = -1; }).port, "balls");
  EXPECT_EQ(error([](auto& p) { p.ballSpeeds = {4, -1}; }).port, "ball_speeds");
  EXPECT_EQ(error([](auto& p) { p.ballHits = {{Vec3(2, 2, 2), Vec3(1, 0, 0)}}; }).port, "ball_target");
  EXPECT_EQ(error([](auto& p) { p.drop.ballRadius = 0; }).port, "ball_radius");
  const Error none = error([](auto& p) { p.balls = 0, p.impacts = {Impact{}}; });
  EXPECT_EQ(none.port, "orientations");
  EXPECT_NE(none.what.find("nothing to learn from"), std::string::npos);
}

}  // namespace
}  // namespace sherd
