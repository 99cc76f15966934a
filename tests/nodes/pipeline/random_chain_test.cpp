// The whole chain, from surfaces to pieces, on random bodies, materials and hits: what comes out is sound, or
// an error that says what is wrong and what would be right.
//
// One body alone: SHERD_SEEDS=1234 test_pipeline --gtest_filter='RandomChain.*Seeds'; a range:
// SHERD_SEEDS=1-300. SHERD_SEED_LOG=FILE appends a line for every case.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "base/hash.h"
#include "base/parallel.h"
#include "cvd/cvd.h"
#include "embed/embed.h"
#include "nodes/pipeline/random_bodies.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "support/fracture_check.h"
#include "tessellate/tessellate.h"
#include "tetrahedralize/tetrahedralize.h"
#include "weights/weights.h"

namespace sherd::test {
namespace {

constexpr std::uint64_t kHitsABody = 4;

/// A material, what hits it, and how it is to break.
struct RandomHit {
  SimulateParams hit;
  WeightsParams weights;
  double beta = 1;
  double gammaShare = 1;  ///< of E_D with one site
  int degree = 0;
  std::int64_t seed = 1;
};

Material anyMaterial(Rng& rng) {
  constexpr double poisson[] = {-0.5, 0, 0.2, 0.33, 0.45, 0.49, 0.4999};
  Material material;
  material.density = logUniformIn(rng, 1, 2e4);
  material.youngModulus = logUniformIn(rng, 1e3, 1e12);
  material.poissonRatio = poisson[rng.below(std::size(poisson))];
  return material;
}

void addBall(Rng& rng, const RandomBody& body, SimulateParams& hit) {
  hit.scene = RigidScene::Ball;
  hit.ballRadius = body.size * logUniformIn(rng, 0.005, 1);
  hit.ballDensity = logUniformIn(rng, 100, 2e4);
  hit.ballSpeed = logUniformIn(rng, 0.1, 300);
  hit.ballDirection = anyDirection(rng);
  hit.ballTarget = Vec3::Constant(0.5) + 0.25 * anyDirection(rng);
  hit.standing = rng.below(3) == 0;
  if (hit.standing) hit.velocity = hit.angularVelocity = Vec3::Zero();
}

SimulateParams anyScene(Rng& rng, const RandomBody& body) {
  SimulateParams hit;
  hit.body = anyMaterial(rng);
  hit.orientation = uniformIn(rng, 0, 180) * anyDirection(rng);
  hit.dropHeight = rng.below(20) == 0 ? 0 : body.size * logUniformIn(rng, 0.1, 10);
  if (rng.below(3) == 0) hit.velocity = logUniformIn(rng, 0.1, 10) * std::sqrt(body.size) * anyDirection(rng);
  if (rng.below(3) == 0) hit.angularVelocity = logUniformIn(rng, 0.01, 30) * anyDirection(rng);
  hit.restitution = rng.below(3) == 0 ? 0 : rng.uniform();
  hit.friction = rng.below(3) == 0 ? 0 : rng.uniform();
  hit.obstacleYoung = logUniformIn(rng, 1e4, 1e12);
  if (rng.below(4) == 0) hit.contactRadius = body.size * logUniformIn(rng, 0.001, 2);
  if (rng.below(4) == 0) hit.contactDuration = logUniformIn(rng, 1e-6, 1e-1);
  if (rng.below(20) == 0) hit.threshold = 1e30;
  hit.maxTime = 1000;
  if (rng.below(2) == 0) addBall(rng, body, hit);
  return hit;
}

RandomHit anyHit(Rng& rng, const RandomBody& body) {
  RandomHit hit;
  hit.hit = anyScene(rng, body);
  hit.weights.alpha = rng.below(2) == 0 ? 1 : uniformIn(rng, 0, 4);
  if (rng.below(3) == 0) hit.beta = logUniformIn(rng, 1e-3, 1e3);
  hit.gammaShare = logUniformIn(rng, 0.02, 2);
  if (rng.below(4) == 0) hit.degree = 2 + static_cast<int>(rng.below(8));
  hit.seed = static_cast<std::int64_t>(rng.below(1000));
  return hit;
}

struct RandomCase {
  RandomBody body;
  TetrahedralizeParams cage;
  std::vector<RandomHit> hits;
};

RandomCase anyCase(std::uint64_t seed) {
  Rng rng(seed, 0x636861696e);
  RandomCase c;
  c.body = randomBody(rng);
  c.cage.tets = 50 + static_cast<int>(rng.below(150));
  for (std::uint64_t k = 0; k < kHitsABody; ++k) c.hits.push_back(anyHit(rng, c.body));
  return c;
}

/// What a case led to. `error`: of a step, which is right where it tells enough; `defect`: of a result.
struct Outcome {
  std::string step, error, defect;
  std::size_t pieceCount = 0;
  std::vector<Index> labels;
  double strainEnergy = 0, cellEnergy = 0;  ///< J, J·m²
  Digest digest{};                          ///< of the pieces

  void note(const std::string& what) {
    if (defect.empty()) defect = what;
  }
};

/// Whether the chain goes on; an error has to say what is wrong and what would be right.
template <class T>
bool took(Outcome& out, const char* step, const Result<T>& result) {
  out.step = step;
  if (result.ok()) return true;
  out.error = result.error().text();
  if (result.error().what.empty() || result.error().remedy.empty() ||
      out.error.find("nan") != std::string::npos)
    out.note(fmt::format("{} doesn't say enough: {}", step, out.error));
  return false;
}

bool isAmount(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v >= 0; });
}
double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
bool isNear(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

std::string defectOf(const TetMesh& tets) {
  for (std::size_t t = 0; t < tets.tets.size(); ++t)
    if (!(tetVolume(tets, t) > 0)) return fmt::format("tetrahedron {} is not positive", t);
  if (!(tets.quality.volumeError < 1e-9))
    return fmt::format("the cage misses {:.2g} of the volume", tets.quality.volumeError);
  return isAmount(lumpedVolumes(tets)) ? "" : "a volume is not finite";
}

std::string defectOf(const SimulateOutput& hit, const RandomBody& body) {
  const EnergyField& e = hit.energy;
  if (!isAmount(e.tetEnergy) || !isAmount(e.nodeEnergy)) return "an energy is negative or not finite";
  const double stored = sumOf(e.tetEnergy), inside = sumOf(e.nodeEnergy);
  if (inside > stored * (1 + 1e-12)) return "nodes have more energy than tetrahedra";
  for (const Vec3& u : e.displacement)
    if (!u.allFinite()) return "a displacement is not finite";
  const Box box = boxOf(body.surface->positions);
  for (const Contact& c : hit.impact.contacts)
    if (!c.impulse.allFinite() || !(c.duration > 0 && c.radius > 0 && c.radius <= 2 * body.size) ||
        !((c.point - box.centre()).norm() <= 0.501 * box.diagonal()))
      return fmt::format("a contact of {:.3g} N·s, {:.3g} s and {:.3g} m is {:.3g} m from the body's middle",
                         c.impulse.norm(), c.duration, c.radius, (c.point - box.centre()).norm());
  const RigidMotion& after = hit.impact.after;
  return after.velocity.allFinite() && after.angularVelocity.allFinite() ? "" : "the motion is not finite";
}

std::string defectOf(const Partition& cells, const WeightField& weights) {
  if (!cells.sites.allFinite() || !std::isfinite(cells.energy)) return "a site is not finite";
  const double nothing = 1e-24 * std::pow(cells.embedding->diameter, 2);
  double energy = 0;
  for (std::size_t n = 0; n < cells.label.size(); ++n) {
    const auto x = cells.embedding->coordinates.col(static_cast<Eigen::Index>(n));
    const Eigen::VectorXd d2 = (cells.sites.colwise() - x).colwise().squaredNorm();
    if (d2[cells.label[n]] > d2.minCoeff() * (1 + 1e-9) + nothing)
      return fmt::format("node {} is not in the nearest cell", n);
    energy += weights.weight[n] * d2[cells.label[n]];
  }
  return isNear(energy, cells.energy, 1e-9) ? "" : "E_D is not the sum over the nodes";
}

std::string defectOf(const Fragments& pieces) {
  const FractureCheck check = checkFracture(pieces);
  if (!check.good()) return check.text();
  for (const Piece& piece : pieces.pieces)
    if (!piece.inertia.allFinite() || !piece.centreOfMass.allFinite()) return "a piece has no inertia";
  return "";
}

void log(const std::string& line) {
  if (const char* file = std::getenv("SHERD_SEED_LOG")) std::ofstream(file, std::ios::app) << line << "\n";
}

/// Share of the weights at nodes that have less than a thousandth of the mean volume.
double shareOfScraps(const WeightField& field) {
  const double scrap = 1e-3 * sumOf(field.volume) / static_cast<double>(field.volume.size());
  double sum = 0;
  for (std::size_t n = 0; n < field.volume.size(); ++n)
    if (field.volume[n] < scrap) sum += field.weight[n];
  return sum / std::max(sumOf(field.weight), std::numeric_limits<double>::min());
}

/// From the energy to the pieces.
void breakBody(const RandomHit& how, const EnergyField& energy,
               const std::shared_ptr<const Embedding>& metric, Outcome& out) {
  const ScalarGrid beta = ScalarGrid::constant(how.beta);
  const auto weighed = weights(energy, how.beta == 1 ? nullptr : &beta, how.weights, Exec{});
  if (!took(out, "Weights", weighed)) return;
  if (!isAmount(weighed->weight)) out.note("a weight is negative or not finite");
  double kept = 0;  // nodes without volume weigh nothing
  for (std::size_t n = 0; n < weighed->volume.size(); ++n)
    if (weighed->volume[n] > 0) kept += energy.nodeEnergy[n];
  if (!isNear(sumOf(weighed->weight), how.beta * kept, 1e-9)) out.note("weights don't add up to the energy");
  if (how.weights.alpha <= 2 && shareOfScraps(*weighed) > 0.5)
    out.note("weights are drawn to nodes of next to no volume");
  PredictDegreeParams search;
  search.degree = 1;
  search.seed = how.seed;
  const auto whole = predictDegree(*weighed, *metric, search, Exec{});
  if (!took(out, "PredictDegree of one", whole)) return;
  search.degree = how.degree;
  search.gamma = how.gammaShare * whole->energy;
  search.maxDegree = 12;
  const auto sites = predictDegree(*weighed, *metric, search, Exec{});
  if (!took(out, "PredictDegree", sites)) return;
  if (sites->energy > whole->energy * (1 + 1e-12)) out.note("E_D has grown with sites");
  const auto cells = cvd(metric, *weighed, &*sites, {}, Exec{});
  if (!took(out, "CVD", cells)) return;
  out.note(defectOf(*cells, *weighed));
  out.labels = cells->label;
  out.cellEnergy = cells->energy;
  const auto pieces = tessellate(*cells, {}, Exec{});
  if (!took(out, "Tessellate", pieces)) return;
  out.note(defectOf(*pieces));
  out.pieceCount = pieces->pieces.size();
  Hasher hasher;
  hashValue(hasher, *pieces);
  out.digest = hasher.digest();
}

/// One outcome per hit; where there is no cage or metric, all of them say so.
std::vector<Outcome> runChain(const RandomCase& c) {
  Outcome out;
  auto cage = tetrahedralize(c.body.surface, c.cage, Exec{});
  if (!took(out, "Tetrahedralize", cage)) return std::vector<Outcome>(c.hits.size(), out);
  out.note(defectOf(*cage));
  const auto tets = std::make_shared<const TetMesh>(std::move(*cage));
  auto made = embed(tets, {}, Exec{});
  if (!took(out, "Embed", made)) return std::vector<Outcome>(c.hits.size(), out);
  if (!made->coordinates.allFinite()) out.note("a coordinate is not finite");
  const auto metric = std::make_shared<const Embedding>(std::move(*made));
  std::vector<Outcome> outcomes;
  for (const RandomHit& how : c.hits) {
    outcomes.push_back(out);
    const auto hit = simulate(tets, how.hit, Exec{});
    if (!took(outcomes.back(), "Simulate", hit)) continue;
    outcomes.back().note(defectOf(*hit, c.body));
    outcomes.back().strainEnergy = totalEnergy(hit->energy);
    breakBody(how, hit->energy, metric, outcomes.back());
  }
  return outcomes;
}

std::string about(std::uint64_t seed, const RandomCase& c) {
  return fmt::format("seed {}: {}, {:.3g} m large, {:.2g} m thin, {:.2g} sizes away, {} tets", seed,
                     c.body.kind, c.body.size, c.body.thickness, c.body.distance, c.cage.tets);
}

std::string about(const RandomHit& h) {
  const Material& m = h.hit.body;
  return fmt::format("{}, {:.2g} kg/m³, {:.2g} Pa, ν {}", h.hit.scene == RigidScene::Floor ? "drop" : "ball",
                     m.density, m.youngModulus, m.poissonRatio);
}

struct Totals {
  int broken = 0, whole = 0, missed = 0, refused = 0;
  int all() const { return broken + whole + missed + refused; }
};

/// Several bodies at a time, which also shows that steps don't disturb each other.
Totals runBodies(std::uint64_t first, std::uint64_t last) {
  std::vector<std::vector<Outcome>> outcomes(last - first + 1);
  std::vector<double> seconds(outcomes.size());
  parallelFor(Exec{}, outcomes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto start = std::chrono::steady_clock::now();
      outcomes[i] = runChain(anyCase(first + i));
      seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  });
  Totals totals;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const RandomCase c = anyCase(first + i);
    for (std::size_t k = 0; k < c.hits.size(); ++k) {
      const Outcome& out = outcomes[i][k];
      const std::string line =
          fmt::format("{} | {} | {} | {} | {} pieces of {}, {:.2f} s", about(first + i, c), about(c.hits[k]),
                      out.step, out.error, out.pieceCount, out.labels.size(), seconds[i]);
      EXPECT_EQ(out.defect, "") << line;
      log(out.defect + " | " + line);
      const bool isMiss = out.step == "Simulate";
      ++(out.error.empty() ? (out.pieceCount > 1 ? totals.broken : totals.whole)
                           : (isMiss ? totals.missed : totals.refused));
    }
  }
  return totals;
}

TEST(RandomChain, SoundPiecesOrAClearError) {
  const Totals totals = runBodies(1, 8);
  EXPECT_GE(totals.broken, 8);
  EXPECT_EQ(totals.refused, 0);
}

TEST(RandomChain, TheSameBitsForAnyNumberOfThreads) {
  for (const std::uint64_t seed : {3, 5}) {
    const RandomCase c = anyCase(seed);
    setThreadLimit(1);
    const std::vector<Outcome> one = runChain(c);
    for (const int threads : {2, 0}) {
      setThreadLimit(threads);
      const std::vector<Outcome> several = runChain(c);
      for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_EQ(several[k].error, one[k].error) << about(seed, c);
        EXPECT_EQ(several[k].strainEnergy, one[k].strainEnergy) << about(seed, c);
        EXPECT_EQ(several[k].digest, one[k].digest) << about(seed, c);
      }
    }
  }
}

/// Lengths and speeds times 2^exponent; times, densities and moduli as they are. Masses then go with the
/// third power of lengths, forces with the fourth, displacements with the third, energies with the seventh.
RandomHit scaledByTwo(RandomHit how, int exponent) {
  const double factor = std::ldexp(1.0, exponent);
  SimulateParams& hit = how.hit;
  for (double* length : {&hit.dropHeight, &hit.gravity, &hit.ballRadius, &hit.ballSpeed, &hit.contactRadius})
    *length *= factor;
  hit.velocity *= factor;
  return how;
}

void expectCovariant(std::uint64_t seed, int exponent) {
  RandomCase c = anyCase(seed);
  for (RandomHit& how : c.hits) {  // Hertz's contact depends on speeds in another way
    how.hit.contactDuration = 1e-3;
    how.hit.contactRadius = 0.1 * c.body.size;
  }
  RandomCase other = c;
  other.body = scaledByTwo(c.body, exponent);
  for (RandomHit& how : other.hits) how = scaledByTwo(how, exponent);
  const std::vector<Outcome> a = runChain(c), b = runChain(other);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::string what = about(seed, c) + fmt::format(", times 2^{}", exponent);
    EXPECT_EQ(a[k].labels, b[k].labels) << what << a[k].error << b[k].error;
    EXPECT_EQ(a[k].pieceCount, b[k].pieceCount) << what;
    EXPECT_TRUE(isNear(std::ldexp(a[k].strainEnergy, 7 * exponent), b[k].strainEnergy, 1e-9)) << what;
    EXPECT_TRUE(isNear(std::ldexp(a[k].cellEnergy, 9 * exponent), b[k].cellEnergy, 1e-9)) << what;
  }
}

TEST(RandomChain, SizeIsAMatterOfUnits) {
  expectCovariant(3, 10);
  expectCovariant(5, -7);
}

class RandomChainSlow : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomChainSlow, AThousandHits) {
  const std::uint64_t first = 1000 + 250 * GetParam();
  const Totals totals = runBodies(first, first + 249);
  EXPECT_EQ(totals.all(), 1000);
  EXPECT_GE(totals.broken, 600);
  EXPECT_LE(totals.missed, 200);
  EXPECT_LE(totals.refused, 10);
}

INSTANTIATE_TEST_SUITE_P(First, RandomChainSlow, testing::Range<std::uint64_t>(0, 1));
INSTANTIATE_TEST_SUITE_P(CorpusOfFourThousandMore, RandomChainSlow, testing::Range<std::uint64_t>(1, 5));

TEST(RandomChainSlow, SizeIsAMatterOfUnits) {
  for (std::uint64_t seed = 100; seed < 140; ++seed) expectCovariant(seed, seed % 2 == 0 ? 10 : -9);
}

TEST(RandomChain, Seeds) {
  const char* seeds = std::getenv("SHERD_SEEDS");
  if (seeds == nullptr) GTEST_SKIP() << "SHERD_SEEDS names none";
  char* end = nullptr;
  const std::uint64_t first = std::strtoull(seeds, &end, 10);
  const std::uint64_t last = *end == '-' ? std::strtoull(end + 1, nullptr, 10) : first;
  const Totals totals = runBodies(first, last);
  std::printf("%d hits: %d broken, %d whole, %d missed, %d refused\n", totals.all(), totals.broken,
              totals.whole, totals.missed, totals.refused);
}

}  // namespace
}  // namespace sherd::test
