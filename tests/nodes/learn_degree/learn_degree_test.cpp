#include "learn_degree/learn_degree.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/value_type.h"
#include "nodes/learn_degree/examples.h"
#include "support/sanitizers.h"

namespace sherd {
namespace {

using namespace examples;
using reference::Cloud;
using reference::cloud;

const DegreeMethod kAll[] = {DegreeMethod::Process, DegreeMethod::Network, DegreeMethod::Exact};

Result<DegreeModel> learn(const Cloud& c, const std::vector<DegreeExample>& examples, double gamma,
                          const LearnDegreeParams& params = {}, const Exec& exec = {}) {
  DegreeValidity valid;
  valid.gamma = gamma;
  return learnDegree(examples, *c.embedding, c.weights.volume, valid, params, exec);
}

DegreeModel learned(const Cloud& c, const std::vector<DegreeExample>& examples, double gamma,
                    const LearnDegreeParams& params = {}) {
  auto model = learn(c, examples, gamma, params);
  EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().text());
  return std::move(model).value();
}

DegreeEstimate estimate(const Cloud& c, const DegreeModel& model, const std::vector<double>& weight) {
  return estimateDegree(model, {nullptr, {}, weight, c.weights.volume}, *c.embedding, Deviation::Known);
}

/// γ for which a hit of 1 J gives about `pieces`.
double gammaFor(const Cloud& c, double pieces) {
  return wholeEnergy(c, hitAt(c, 0, 1)) / std::pow(pieces, 2.0 / 3);
}

TEST(LearnDegree, OneExample) {
  const Cloud c = cloud(200, 4, 1);
  const double gamma = gammaFor(c, 20);
  const DegreeExample only = powerLaw(c, hitAt(c, 0, 1), gamma, 0);
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, {only}, gamma, {.method = method});
    const DegreeEstimate same = estimate(c, model, only.weight);
    EXPECT_NEAR(same.degree, only.degree[0], 1);
    EXPECT_FALSE(same.isOutside);
    EXPECT_TRUE(estimate(c, model, hitAt(c, 150, 3)).isOutside);
    EXPECT_EQ(model.errors.examples, 0);
  }
}

TEST(LearnDegree, EqualExamplesWithSeveralDegreesGiveTheMean) {
  const Cloud c = cloud(200, 4, 2);
  const double gamma = gammaFor(c, 20);
  std::vector<DegreeExample> examples(6);
  for (int i = 0; i < 6; ++i) examples[at(i)] = {hitAt(c, 0, 1), {18 + i, 20 + i}, {17.5 + i, 19.5 + i}, i};
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, examples, gamma, {.method = method});
    EXPECT_NEAR(estimate(c, model, examples[0].weight).degree, 21.5, 0.6);
    EXPECT_TRUE(estimate(c, model, hitAt(c, 150, 3)).isOutside);
  }
}

TEST(LearnDegree, NothingBreaks) {
  const Cloud c = cloud(200, 4, 3);
  const double gamma = 1e3 * gammaFor(c, 1);
  const auto examples = powerLaws(c, 6, 3, gamma);
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, examples, gamma, {.method = method});
    for (const DegreeExample& e : examples) EXPECT_EQ(estimate(c, model, e.weight).degree, 1);
    EXPECT_EQ(model.errors.meanAbsolute, 0);
  }
  const DegreeModel model = learned(c, examples, gamma);
  const DegreeEstimate broken = estimate(c, model, hitAt(c, 0, 1e6));
  EXPECT_TRUE(broken.isOutside);
  EXPECT_GE(broken.degree, 2);
}

TEST(LearnDegree, WeightsThatAreAllZero) {
  const Cloud c = cloud(100, 4, 3);
  const DegreeExample nothing{std::vector<double>(100, 0.0), {1}, {0.5}, 0};
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, {nothing}, 1, {.method = method});
    EXPECT_EQ(estimate(c, model, nothing.weight).degree, 1);
  }
}

TEST(LearnDegree, TenExamplesAndDuplicates) {
  const Cloud c = cloud(300, 4, 4);
  const double gamma = gammaFor(c, 12);
  auto examples = powerLaws(c, 10, 1, gamma);
  for (int i = 0; i < 4; ++i) examples.push_back(examples[at(i)]);
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, examples, gamma, {.method = method});
    EXPECT_EQ(model.points.cols(), 10);
    EXPECT_EQ(model.errors.examples, 14);
    if (method == DegreeMethod::Network) continue;  // so few that it may find no centre worth having
    for (const DegreeExample& e : examples)
      EXPECT_NEAR(estimate(c, model, e.weight).degree, e.degree[0], 2 + 0.2 * e.degree[0]);
  }
}

TEST(LearnDegree, ExactGoesThroughTheMeanOfRepeats) {
  const Cloud c = cloud(300, 4, 4);
  const double gamma = gammaFor(c, 12);
  auto examples = powerLaws(c, 10, 3, gamma);
  const DegreeModel model = learned(c, examples, gamma, {.method = DegreeMethod::Exact, .tolerance = 0.0});
  for (const DegreeExample& e : examples) EXPECT_EQ(estimate(c, model, e.weight).degree, e.degree[0]);
}

TEST(LearnDegree, AProcessFindsThePowerLawOnHitsElsewhere) {
  const Cloud c = cloud(400, 5, 5);
  const double gamma = gammaFor(c, 15);
  const DegreeModel model = learned(c, powerLaws(c, 24, 4, gamma), gamma);
  EXPECT_GT(model.errors.rSquared, 0.99);
  EXPECT_LT(model.errors.meanAbsolute, 0.03 * model.errors.meanDegree);
  for (int hit = 200; hit < 220; ++hit) {
    const DegreeExample e = powerLaw(c, hitAt(c, hit, 2.5), gamma, 0);
    EXPECT_NEAR(estimate(c, model, e.weight).degree, e.degree[0], 1 + 0.06 * e.degree[0]);
  }
}

TEST(LearnDegree, AProcessForetellsSearchesOfHitsElsewhereAndHarder) {
  const Cloud c = cloud(400, 3, 5);
  const double gamma = gammaFor(c, 15);
  std::vector<DegreeExample> examples;
  for (int g = 0; g < 24; ++g)
    for (const double strength : {1.0, 2.0, 3.0})
      examples.push_back(searched(c, hitAt(c, 7 * g, strength), gamma, g));
  const DegreeModel model = learned(c, examples, gamma);
  EXPECT_GT(model.errors.rSquared, 0.97);
  for (const double strength : {0.5, 2.5, 20.0}) {
    double absolute = 0, sum = 0, within = 0;
    for (int hit = 200; hit < 220; ++hit) {
      const DegreeExample e = searched(c, hitAt(c, hit, strength), gamma, 0);
      const DegreeEstimate told = estimate(c, model, e.weight);
      absolute += std::abs(told.degree - e.degree[0]), sum += e.degree[0];
      within += std::abs(told.degree - e.degree[0]) <= 2 * told.deviation + 0.5;
      EXPECT_TRUE(told.isOutside || strength < 10);
    }
    EXPECT_LT(absolute, (strength > 10 ? 0.15 : 0.08) * sum) << strength;
    EXPECT_GE(within, 15) << strength;
  }
}

TEST(LearnDegree, ErrorBarsAreWhatCholeskySays) {
  // Far more of the covariance is the unknown mean than anything else: the bars must not drown in it.
  const Cloud c = cloud(300, 3, 15);
  const double gamma = gammaFor(c, 15);
  std::vector<DegreeExample> examples;
  for (int g = 0; g < 40; ++g) examples.push_back(searched(c, hitAt(c, 7 * g, 1 + g % 4), gamma, g));
  const DegreeModel model = learned(c, examples, gamma);
  ASSERT_EQ(model.whitening.rows(), 40);
  const double least = std::sqrt(model.variance * model.noise);
  for (const DegreeExample& e : examples) {
    const DegreeEstimate told = estimate(c, model, e.weight);
    EXPECT_GT(told.deviation, 0.9 * least * (told.degree - 1));
    EXPECT_LT(told.deviation, 1.5 * least * (told.degree + 1));  // it was seen: little but noise is left
  }
  const DegreeExample far = searched(c, hitAt(c, 3, 100), gamma, 0);
  const DegreeEstimate guess = estimate(c, model, far.weight);
  EXPECT_GT(guess.deviation, 2 * least * guess.degree);
}

TEST(LearnDegree, AHitLikeTheOthersIsInside) {
  const Cloud c = cloud(400, 5, 5);
  const double gamma = gammaFor(c, 15);
  for (const DegreeMethod method : kAll) {
    const DegreeModel model = learned(c, powerLaws(c, 24, 4, gamma), gamma, {.method = method});
    int outside = 0;
    for (int hit = 200; hit < 220; ++hit) outside += estimate(c, model, hitAt(c, hit, 2.5)).isOutside;
    EXPECT_LE(outside, 4);
  }
}

TEST(LearnDegree, UnitsDoNotMatter) {
  const Cloud c = cloud(300, 4, 6);
  const double gamma = gammaFor(c, 15);
  const auto examples = powerLaws(c, 12, 3, gamma);
  // Lengths in thousandths, energies in other units, both by powers of two so that rounding is the same.
  Cloud other = cloud(300, 4, 6);
  other.embedding->coordinates *= 1024;
  other.embedding->diameter *= 1024;
  for (double& v : other.weights.volume) v *= 0x1p30;
  auto scaled = examples;
  for (DegreeExample& e : scaled)
    for (double& w : e.weight) w *= 0x1p-7;
  for (const DegreeMethod method : kAll) {
    const DegreeModel one = learned(c, examples, gamma, {.method = method});
    const DegreeModel two = learned(other, scaled, gamma * 0x1p13, {.method = method});
    EXPECT_EQ(one.errors.meanAbsolute, two.errors.meanAbsolute);
    for (int hit = 200; hit < 210; ++hit) {
      auto weight = hitAt(c, hit, 1.7);
      const DegreeEstimate a = estimate(c, one, weight);
      for (double& w : weight) w *= 0x1p-7;
      EXPECT_EQ(a.degree, estimate(other, two, weight).degree);
    }
  }
}

TEST(LearnDegree, SameModelForAnyNumberOfThreads) {
  const Cloud c = cloud(300, 4, 7);
  const double gamma = gammaFor(c, 15);
  const auto examples = powerLaws(c, 12, 3, gamma);
  for (const DegreeMethod method : kAll) {
    std::vector<Digest> digests;
    for (const int threads : {1, 2, 4}) {
      setThreadLimit(threads);
      const DegreeModel model = learned(c, examples, gamma, {.method = method});
      digests.push_back(valueType<DegreeModel>().digest(&model));
    }
    setThreadLimit(0);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digests[2]);
  }
}

TEST(LearnDegree, ExamplesOfFewDimensions) {
  // Two hits and what lies between them: all weights are in a plane, and fewer components than examples
  // serve.
  const Cloud c = cloud(200, 4, 11);
  const double gamma = gammaFor(c, 15);
  const auto one = hitAt(c, 3, 1), two = hitAt(c, 120, 1);
  std::vector<DegreeExample> examples;
  for (int i = 0; i <= 20; ++i) {
    auto weight = one;
    for (std::size_t n = 0; n < weight.size(); ++n) weight[n] += 0.05 * i * (two[n] - weight[n]);
    examples.push_back(powerLaw(c, weight, gamma, i));
  }
  for (const DegreeMethod method : kAll)
    for (const double tolerance : {0.0, 0.02}) {
      const DegreeModel model = learned(c, examples, gamma, {.method = method, .tolerance = tolerance});
      EXPECT_LE(model.basis.rows(), 2);
      EXPECT_TRUE(model.basis.allFinite() && model.points.allFinite());
      for (const DegreeExample& e : examples)
        EXPECT_NEAR(estimate(c, model, e.weight).degree, e.degree[0], 1 + 0.1 * e.degree[0]);
    }
}

TEST(LearnDegree, OneDegreeForAll) {
  const Cloud c = cloud(200, 4, 12);
  const double gamma = gammaFor(c, 15);
  for (const int degree : {1, 2, 37}) {
    auto examples = powerLaws(c, 12, 2, gamma);
    for (DegreeExample& e : examples) e.degree = {degree, degree}, e.crossing = {degree - 0.5, degree - 0.5};
    for (const DegreeMethod method : kAll) {
      const DegreeModel model = learned(c, examples, gamma, {.method = method});
      for (const DegreeExample& e : examples)
        // A process takes 1 for whatever is below γ as it is, and these aren't.
        EXPECT_NEAR(estimate(c, model, e.weight).degree,
                    method == DegreeMethod::Process ? std::max(degree, 2) : degree,
                    method == DegreeMethod::Process && degree > 2 ? 1 : 0);
      EXPECT_EQ(model.errors.noise, 0);
    }
  }
}

TEST(LearnDegree, WrongExamplesAreNamed) {
  const Cloud c = cloud(100, 4, 8);
  const auto says = [&](const std::function<void(std::vector<DegreeExample>&)>& spoil) {
    auto examples = powerLaws(c, 5, 1, gammaFor(c, 15));
    spoil(examples);
    const auto model = learn(c, examples, gammaFor(c, 15));
    return model.ok() ? std::string("nothing") : model.error().what;
  };
  EXPECT_EQ(says([](auto& e) { e[2].weight[7] = std::nan(""); }), "example 3 has a weight of nan");
  EXPECT_EQ(says([](auto& e) { e[4].weight[0] = -1; }), "example 5 has a weight of -1");
  EXPECT_EQ(says([](auto& e) { e[0].weight.pop_back(); }), "example 1 has 99 weights for 100 nodes");
  EXPECT_EQ(says([](auto& e) { e[1].degree = {0}; }), "example 2 has a degree of 0");
  EXPECT_EQ(says([](auto& e) { e[3].crossing = {std::nan("")}; }), "example 4 crosses γ at nan pieces");
  EXPECT_EQ(says([](auto& e) { e[3].weight[1] = HUGE_VAL; }), "example 4 has a weight of inf");
  EXPECT_EQ(says([](auto& e) { e[1].degree.clear(); }),
            "example 2 has no search, or not one crossing for each");
  EXPECT_EQ(says([](auto& e) { e.clear(); }), "there are no examples to learn from");
  EXPECT_FALSE(learn(c, powerLaws(c, 2, 1, 1), 0).ok());
  EXPECT_FALSE(learn(c, powerLaws(c, 2, 1, 1), 1, {.tolerance = -0.1}).ok());
}

TEST(LearnDegree, MoreExamplesThanMayBeCentres) {
  // A body of few nodes, hit between them: weights that change smoothly from hit to hit.
  const Cloud c = cloud(40, 2, 9);
  const double gamma = gammaFor(c, 15);
  std::vector<DegreeExample> examples;
  for (int g = 0; g < 90; ++g) {
    auto weight = hitAt(c, g % 40, 1);
    const auto other = hitAt(c, (7 * g + 3) % 40, 1);
    const double share = 0.1 * (g % 7);
    for (std::size_t n = 0; n < weight.size(); ++n) weight[n] += share * (other[n] - weight[n]);
    for (int s = 0; s < 7; ++s) {
      auto scaled = weight;
      for (double& w : scaled) w *= 1.0 + 0.5 * s;
      examples.push_back(powerLaw(c, scaled, gamma, g));
    }
  }
  const DegreeModel network = learned(c, examples, gamma, {.method = DegreeMethod::Network});
  EXPECT_EQ(network.points.cols(), 512);
  EXPECT_GT(network.errors.rSquared, 0.5);  // the mean alone: 0
  const DegreeModel process = learned(c, examples, gamma);
  EXPECT_LE(process.centres.size(), 512u);
  EXPECT_GT(process.errors.rSquared, 0.99);
}

/// Bytes that the process has held at most.
double mostMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

TEST(LearnDegreeSlow, AHundredThousandExamplesInFourGibibytes) {
  if (test::kSlowdown > 1) GTEST_SKIP() << "sanitizers take several times the memory";
  const Cloud c = cloud(1600, 3, 13);
  const double gamma = gammaFor(c, 15);
  std::vector<std::vector<double>> hits;
  std::vector<double> whole;
  for (int h = 0; h < 40; ++h)
    hits.push_back(hitAt(c, 40 * h, 1)), whole.push_back(wholeEnergy(c, hits.back()));
  std::vector<DegreeExample> examples(100'000);
  Rng rng(5);
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const std::size_t a = i % 40, b = (i / 40) % 40;
    const double share = rng.uniform(), strength = 1 + 4 * rng.uniform();
    DegreeExample& e = examples[i];
    e.weight.resize(1600);
    for (std::size_t n = 0; n < 1600; ++n)
      e.weight[n] = strength * ((1 - share) * hits[a][n] + share * hits[b][n]);
    const double crossing = std::pow(strength * ((1 - share) * whole[a] + share * whole[b]) / gamma, 1.5);
    e.degree = {std::max(1, static_cast<int>(std::ceil(crossing)))};
    e.crossing = {std::max(0.5, crossing)};
    e.group = static_cast<int>(i / 10);
  }
  const double before = mostMemory();
  for (const DegreeMethod method : {DegreeMethod::Process, DegreeMethod::Network}) {
    const auto start = std::chrono::steady_clock::now();
    const DegreeModel model = learned(c, examples, gamma, {.method = method});
    EXPECT_EQ(model.errors.examples, 100'000);
    EXPECT_GT(model.errors.rSquared, 0.97);
    std::printf("%s: %.1f s, %.2f GiB, of which the examples %.2f; R² %.4f\n",
                method == DegreeMethod::Process ? "process" : "network",
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                mostMemory() / 0x1p30, before / 0x1p30, model.errors.rSquared);
    EXPECT_LT(mostMemory(), 0x1p32);
  }
}

TEST(LearnDegree, CancelledEndsAsThat) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const Cloud c = cloud(100, 4, 8);
  for (const DegreeMethod method : kAll) {
    const auto model =
        learn(c, powerLaws(c, 5, 2, gammaFor(c, 15)), gammaFor(c, 15), {.method = method}, exec);
    ASSERT_FALSE(model.ok());
    EXPECT_EQ(model.error().kind, Error::Kind::Cancelled);
  }
}

TEST(LearnDegree, ValidityNamesAllThatDiffers) {
  DegreeModel model;
  model.validFor = {{1, 1}, {2, 2}, {2400, 5e10, 0.2}, 1e-4, 1, {}};
  EXPECT_TRUE(checkValidity(model, model.validFor).ok());
  const auto says = [&](const std::function<void(DegreeValidity&)>& change) {
    DegreeValidity wanted = model.validFor;
    change(wanted);
    const auto checked = checkValidity(model, wanted);
    return checked.ok() ? std::string() : checked.error().what.substr(checked.error().what.find(": ") + 2);
  };
  EXPECT_EQ(says([](auto& v) { v.gamma = 2e-4; }), "γ (0.0001 J·m² there, 0.0002 J·m² here)");
  EXPECT_EQ(says([](auto& v) { v.alpha = 0.5; }), "α (1 there, 0.5 here)");
  EXPECT_EQ(says([](auto& v) { v.beta = {3, 3}; }), "β");
  EXPECT_EQ(says([](auto& v) { v.tets = {3, 3}, v.embedding = {4, 4}; }), "the tetrahedral mesh");
  EXPECT_EQ(says([](auto& v) { v.embedding = {4, 4}; }), "the embedding");
  EXPECT_EQ(says([](auto& v) { v.material.density = 7800, v.gamma = 1; }),
            "density (2400 kg/m³ there, 7800 kg/m³ here), γ (0.0001 J·m² there, 1 J·m² here)");
}

}  // namespace
}  // namespace sherd
