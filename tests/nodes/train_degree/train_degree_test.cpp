#include "train_degree/train_degree.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/value_type.h"
#include "nodes/train_degree/block.h"
#include "predict_degree/predict_degree.h"
#include "support/said.h"
#include "train_degree/rotations.h"

namespace sherd {
namespace {

WeightField fieldOf(const Body& body, const DropExamples& all, const DropExample& drop) {
  return {body.tets,  all.validFor.material, drop.example.weight,
          all.volume, all.validFor.alpha,    all.validFor.beta};
}

TEST(Rotations, AreSpreadEvenly) {
  for (const std::int64_t seed : {1, 2, 77}) {
    Mat3 sum = Mat3::Zero(), squares = Mat3::Zero();
    const auto all = uniformOrientations(256, seed);
    for (const Vec3& degrees : all) {
      const Vec3 a = degrees * (M_PI / 180);
      const Mat3 r = (Eigen::AngleAxisd(a.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(a.y(), Vec3::UnitY()) *
                      Eigen::AngleAxisd(a.x(), Vec3::UnitX()))
                         .toRotationMatrix();
      sum += r / 256;
      squares += r.cwiseAbs2() / 256;
    }
    EXPECT_LT(sum.cwiseAbs().maxCoeff(), 0.08);  // random ones: 0.1 or more
    EXPECT_LT((squares.array() - 1.0 / 3).abs().maxCoeff(), 0.05);
    const auto fewer = uniformOrientations(10, seed);
    EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), all.begin()));
  }
  EXPECT_NE(uniformOrientations(1, 1)[0], uniformOrientations(1, 2)[0]);
}

TEST(TrainDegree, SharedPathsFindWhatEachSearchFinds) {
  const Body body = block();
  TrainDegreeParams params = small();
  params.drop.contactRadius = 0.01;  // Hertz's would grow with the height
  const DropExamples all = drops(body, params);
  ASSERT_EQ(all.drops.size(), 24u);
  EXPECT_EQ(all.paths, 16u);  // one for all heights
  int least = 1000, most = 0;
  for (const DropExample& drop : all.drops) {
    ASSERT_EQ(drop.example.degree.size(), 2u);
    const WeightField field = fieldOf(body, all, drop);
    for (const int repeat : {0, 1}) {
      const Sites sites = valueOf(predictDegree(
          field, *body.embedding, {.gamma = params.gamma, .seed = params.seed + repeat}, Exec{}));
      const int degree = drop.example.degree[at(repeat)];
      EXPECT_EQ(degree, sites.positions.cols());
      EXPECT_LE(drop.example.crossing[at(repeat)], degree);
      EXPECT_GE(drop.example.crossing[at(repeat)], degree - 1);
      least = std::min(least, degree), most = std::max(most, degree);
    }
    const Sites whole = valueOf(predictDegree(field, *body.embedding, {.degree = 1}, Exec{}));
    EXPECT_NEAR(drop.wholeEnergy, whole.energy, 1e-8 * whole.energy);
  }
  EXPECT_LT(least, 10);
  EXPECT_GT(most, 2 * least);
}

TEST(TrainDegree, HeightsThatChangeTheContactAreSearchedEach) {
  const Body body = block();
  TrainDegreeParams params = small();
  params.orientations = 2;
  params.repeats = 1;
  // A soft floor: Hertz's patch is larger than the smallest one, and grows with the height.
  params.drop.obstacleYoung = 1e7;
  const DropExamples all = drops(body, params);
  EXPECT_EQ(all.paths, 6u);
}

TEST(TrainDegree, TellsAUserHowGoodItIsAndWritesATable) {
  const Body body = block();
  Said said;
  const auto out = valueOf(trainDegree(body.tets, body.embedding, nullptr, small(), said.exec));
  EXPECT_TRUE(said.info("learned from 24 drops that give "));
  EXPECT_TRUE(said.info("on orientations left out it is off by "));
  EXPECT_EQ(std::count(out.table.begin(), out.table.end(), '\n'), 25);
  EXPECT_TRUE(out.table.starts_with(
      "source,orientation_x,orientation_y,orientation_z,height,target_x,target_y,target_z,"
      "direction_x,direction_y,direction_z,speed,strain_energy,whole_energy,foretold,"
      "degree_1,degree_2\ndrop,"));
  EXPECT_EQ(out.model.errors.examples, 48);
  EXPECT_GT(out.model.errors.rSquared, 0.7);
}

TEST(TrainDegree, SameForAnyNumberOfThreads) {
  const Body body = block();
  TrainDegreeParams params = small();
  params.orientations = 6;
  std::vector<Digest> digests;
  std::string table;
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    const auto out = valueOf(trainDegree(body.tets, body.embedding, nullptr, params, Exec{}));
    digests.push_back(valueType<DegreeModel>().digest(&out.model));
    if (table.empty()) table = out.table;
    EXPECT_EQ(out.table, table);
  }
  setThreadLimit(0);
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(digests[0], digests[2]);
}

TEST(TrainDegree, DropsThatDoNotReachGammaAreLeftOutAndSaidSo) {
  const Body body = block();
  TrainDegreeParams params = small();
  params.maxDegree = 6;
  Said said;
  const auto some = trainDegree(body.tets, body.embedding, nullptr, params, said.exec);
  ASSERT_TRUE(some.ok()) << some.error().text();
  EXPECT_TRUE(said.warning(" of 24 drops were left out"));
  params.gamma = 1e-12;
  const auto none = trainDegree(body.tets, body.embedding, nullptr, params, Exec{});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().port, "gamma");
  params.gamma = 1e9;
  EXPECT_TRUE(trainDegree(body.tets, body.embedding, nullptr, params, said.exec).ok());
  EXPECT_TRUE(said.warning("none of the drops breaks the body"));
}

TEST(TrainDegree, WrongParametersAreNamed) {
  const Body body = block();
  const auto port = [&](const std::function<void(TrainDegreeParams&)>& spoil) {
    TrainDegreeParams params = small();
    spoil(params);
    const auto out = trainDegree(body.tets, body.embedding, nullptr, params, Exec{});
    return out.ok() ? std::string("nothing") : out.error().port;
  };
  EXPECT_EQ(port([](auto& p) { p.heights = {1, 0}; }), "heights");
  EXPECT_EQ(port([](auto& p) { p.gamma = 0; }), "gamma");
  EXPECT_EQ(port([](auto& p) { p.orientations = -1; }), "orientations");
  EXPECT_EQ(port([](auto& p) { p.repeats = 0; }), "repeats");
  EXPECT_EQ(port([](auto& p) { p.alpha = -1; }), "alpha");
  EXPECT_EQ(port([](auto& p) { p.drop.body.poissonRatio = 0.7; }), "poisson");
}

/// A trained model and a drop of its body that it hasn't seen.
class ByModel : public testing::Test {
 protected:
  ByModel() : body(block()), params(small()) {
    params.orientations = 16;
    model = valueOf(trainDegree(body.tets, body.embedding, nullptr, params, Exec{})).model;
    TrainDegreeParams other = params;
    other.seed = 99;
    other.orientations = 3;
    other.repeats = 1;
    unseen = drops(body, other);
  }
  Result<Sites> predict(const WeightField& field, const std::shared_ptr<const Embedding>& embedding,
                        PredictDegreeParams predict, const Exec& exec = {}) const {
    return predictByModel(model, field, embedding, predict, exec);
  }
  std::string differing(const WeightField& field, const std::shared_ptr<const Embedding>& embedding,
                        double gamma) const {
    const auto sites = predict(field, embedding, {.gamma = gamma, .otherBody = OtherBody::Refuse});
    if (sites.ok()) return "nothing";
    EXPECT_EQ(sites.error().port, "model");
    return sites.error().what;
  }

  Body body;
  TrainDegreeParams params;
  DegreeModel model;
  DropExamples unseen;
};

TEST_F(ByModel, GrowsTheForetoldNumberOfSites) {
  for (const DropExample& drop : unseen.drops) {
    const WeightField field = fieldOf(body, unseen, drop);
    const DegreeEstimate estimate = estimateDegree(model, field, *body.embedding);
    const Sites sites = valueOf(
        predict(field, body.embedding, {.gamma = params.gamma, .seed = 4, .outside = OutsideModel::Predict}));
    EXPECT_EQ(sites.positions.cols(), estimate.degree);
    EXPECT_EQ(sites.gamma, params.gamma);
    EXPECT_FALSE(sites.degreeGiven);
    EXPECT_NEAR(estimate.degree, drop.example.degree[0], 2 + 0.35 * drop.example.degree[0]);
    const Sites asked = valueOf(
        predictDegree(field, *body.embedding, {.gamma = 1, .degree = estimate.degree, .seed = 4}, Exec{}));
    EXPECT_EQ(asked.positions, sites.positions);
    const Sites more = valueOf(predict(field, body.embedding, {.gamma = 1, .degree = 5}));
    EXPECT_EQ(more.positions.cols(), 5);  // a number asked for goes before the model
    EXPECT_TRUE(more.degreeGiven);
    const Sites searched =
        valueOf(predict(field, body.embedding, {.gamma = params.gamma, .by = DegreeBy::Search}));
    EXPECT_EQ(searched.positions,
              valueOf(predictDegree(field, *body.embedding, {.gamma = params.gamma}, Exec{})).positions);
  }
}

TEST_F(ByModel, FarOutsideItSearchesOrGuesses) {
  WeightField field = fieldOf(body, unseen, unseen.drops[0]);
  for (double& w : field.weight) w *= 50;
  Said said;
  const Sites searched = valueOf(predict(field, body.embedding, {.gamma = params.gamma}, said.exec));
  EXPECT_TRUE(said.warning("lies far outside of what the model was made of: its degree is searched for"));
  const Sites plain = valueOf(predictDegree(field, *body.embedding, {.gamma = params.gamma}, Exec{}));
  EXPECT_EQ(searched.positions, plain.positions);
  EXPECT_LT(searched.energy, params.gamma);
  const Sites guessed = valueOf(
      predict(field, body.embedding, {.gamma = params.gamma, .outside = OutsideModel::Predict}, said.exec));
  EXPECT_TRUE(said.warning("is a guess"));
  EXPECT_EQ(guessed.positions.cols(), estimateDegree(model, field, *body.embedding).degree);
}

TEST_F(ByModel, NoMoreThanMaxDegree) {
  const WeightField field = fieldOf(body, unseen, unseen.drops[2]);
  Said said;
  const Sites sites =
      valueOf(predict(field, body.embedding,
                      {.gamma = params.gamma, .maxDegree = 2, .outside = OutsideModel::Predict}, said.exec));
  EXPECT_EQ(sites.positions.cols(), 2);
  EXPECT_TRUE(said.warning("more than max_degree = 2"));
}

TEST_F(ByModel, WhatItWasNotMadeForIsRefusedByName) {
  const WeightField field = fieldOf(body, unseen, unseen.drops[0]);
  EXPECT_EQ(differing(field, body.embedding, params.gamma), "nothing");
  EXPECT_NE(differing(field, body.embedding, 2 * params.gamma).find("γ ("), std::string::npos);
  WeightField other = field;
  other.alpha = 0.5;
  EXPECT_NE(differing(other, body.embedding, params.gamma).find("α (1 there, 0.5 here)"), std::string::npos);
  other = field;
  other.beta = {1, 1};
  EXPECT_NE(differing(other, body.embedding, params.gamma).find("β"), std::string::npos);
  other = field;
  other.material.density = 1000;
  EXPECT_NE(differing(other, body.embedding, params.gamma).find("density ("), std::string::npos);

  auto embedding = std::make_shared<Embedding>(*body.embedding);
  embedding->coordinates(0, 0) += 1e-9;
  EXPECT_NE(differing(field, embedding, params.gamma).find("the embedding"), std::string::npos);

  // The same body with two of its nodes renumbered.
  auto mesh = std::make_shared<TetMesh>(*body.tets);
  std::swap(mesh->nodes[0], mesh->nodes[1]);
  for (auto* tuples : {&mesh->tets})
    for (Tetra& t : *tuples)
      for (Index& n : t) n = n == 0 ? 1 : n == 1 ? 0 : n;
  other = field;
  other.tets = mesh;
  auto renumbered = std::make_shared<Embedding>(*body.embedding);
  renumbered->tets = mesh;
  renumbered->coordinates.col(0).swap(renumbered->coordinates.col(1));
  EXPECT_NE(differing(other, renumbered, params.gamma).find("the tetrahedral mesh"), std::string::npos);
}

TEST_F(ByModel, OtherBodiesAreSearchedButNotTheSameWithOtherNumbers) {
  const Body fragment = bodyOf(families::box(4, 4, 5, Vec3(0.08, 0.08, 0.1)));
  TrainDegreeParams few = params;
  few.orientations = few.repeats = 1;
  const DropExamples hits = drops(fragment, few);
  const WeightField field = fieldOf(fragment, hits, hits.drops.back());
  const double gamma = 0.3 * params.gamma;  // of the fragment's own
  Said said;
  const Sites sites = valueOf(predict(field, fragment.embedding, {.gamma = gamma}, said.exec));
  EXPECT_TRUE(said.info("the model was made for another body: the degree of this one is searched for"));
  const Sites searched = valueOf(predictDegree(field, *fragment.embedding, {.gamma = gamma}, Exec{}));
  EXPECT_GT(searched.positions.cols(), 1);
  EXPECT_EQ(sites.positions, searched.positions);
  EXPECT_EQ(sites.energy, searched.energy);
  EXPECT_NE(differing(field, fragment.embedding, gamma).find("the tetrahedral mesh"), std::string::npos);
  // Of the body that it was made for, anything else that differs is refused.
  const auto refused =
      predict(fieldOf(body, unseen, unseen.drops[0]), body.embedding, {.gamma = 2 * params.gamma});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().what.find("γ ("), std::string::npos);
}

}  // namespace
}  // namespace sherd
