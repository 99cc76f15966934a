// Seeded adversarial cases: every promise in each.
//
// One case alone: SHERD_SEEDS=1234 test_tessellate --gtest_filter='*Stability*'; a range: SHERD_SEEDS=1-300.
// SHERD_SEED_LOG=FILE appends every failure to a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/parallel.h"
#include "support/adversarial_cases.h"
#include "support/fracture_check.h"
#include "tessellate/tessellate.h"

namespace sherd::test {
namespace {

char currentCase[64] = "";  ///< for the handler below

/// A crash names its case.
extern "C" void tellCase(int signal) {
  std::fprintf(stderr, "\nsignal %d in case %s\n", signal, currentCase);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

struct Totals {
  std::size_t cases = 0, failed = 0, selfIntersecting = 0, flat = 0, pieces = 0, forced = 0,
              renamedDiffer = 0;
};

Digest digestOf(const Fragments& f) {
  Hasher hasher;
  hashValue(hasher, f);
  return hasher.digest();
}

/// What doesn't depend on names: each piece's triangles by their corners' places, in an order of their own.
std::vector<Digest> namelessPieces(const Fragments& f) {
  std::vector<Digest> digests;
  for (const Piece& piece : f.pieces) {
    std::vector<std::array<double, 9>> places;
    for (const auto* list : {&piece.surface, &piece.crack})
      for (const Triangle& t : *list) {
        std::array<std::array<double, 3>, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
          const Vec3 p = f.positions[at(t[c])] + Vec3::Zero();  // −0 is +0
          corners[c] = {p.x(), p.y(), p.z()};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        auto& place = places.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
          std::copy(corners[c].begin(), corners[c].end(), place.begin() + 3 * static_cast<std::ptrdiff_t>(c));
      }
    std::sort(places.begin(), places.end());
    Hasher hasher;
    digests.push_back(hasher.add(places).digest());
  }
  std::sort(digests.begin(), digests.end());
  return digests;
}

std::vector<double> sortedVolumes(const Fragments& f) {
  std::vector<double> volumes;
  for (const Piece& p : f.pieces) volumes.push_back(p.volume);
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

/// "" or what differs after the sites were renamed: nothing but names may. Places are compared to the bit for
/// `sameBits` and by number and volumes for the rest.
std::string afterRenaming(const AdversarialCase& made, const TessellateParams& params, const Fragments& whole,
                          bool& sameBits) {
  std::vector<Index> order(made.cells.siteCount());
  std::iota(order.rbegin(), order.rend(), 0);
  const auto renamed = tessellate(withSitesRenamed(made.cells, order), params, Exec{});
  if (!renamed.ok()) return "sites renamed: " + renamed.error().text();
  sameBits = namelessPieces(*renamed) == namelessPieces(whole);
  if (sameBits) return "";
  const std::vector<double> a = sortedVolumes(whole), b = sortedVolumes(*renamed);
  if (a.size() != b.size())
    return "sites renamed: " + std::to_string(b.size()) + " pieces, not " + std::to_string(a.size());
  const double sum = std::accumulate(a.begin(), a.end(), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > 1e-9 * sum) return "sites renamed: other volumes";
  return "";
}

/// Where the paper's vertices have to be drawn into their simplices, its sheets can cross each other, and the
/// parts of a surface triangle between them then overlap.
double areaLimitOf(const TessellateParams& params) {
  return params.cells == CellMode::Canonical ? 0.2 : 1e-9;
}

/// "" where every promise is kept.
std::string broken(const AdversarialCase& made, const TessellateParams& params, bool slow, Totals& totals) {
  setThreadLimit(1);
  const auto one = tessellate(made.cells, params, Exec{});
  setThreadLimit(2);
  if (!one.ok()) return one.error().text();
  const FractureCheck check = checkFracture(
      *one, {.points = slow ? 40u : 5u, .selfIntersections = slow, .areaLimit = areaLimitOf(params)});
  totals.selfIntersecting += check.selfIntersecting;
  totals.pieces += check.pieces;
  totals.flat += check.flat;
  totals.forced += one->counts.forcedTriangles;
  std::string what = check.good() ? "" : check.text();
  const auto two = tessellate(made.cells, params, Exec{});
  if (!two.ok() || digestOf(*one) != digestOf(*two)) what += " two threads give other bytes";
  // The paper's cells follow the nodes' labels, which go by the sites' numbers where two are equally near.
  if (params.cells == CellMode::Canonical) return what;
  bool sameBits = true;
  const std::string renaming = afterRenaming(made, params, *one, sameBits);
  totals.renamedDiffer += !sameBits;
  return what.empty() ? renaming : what;
}

void run(const std::string& family, AdversarialCase (*make)(std::uint64_t), TessellateParams params,
         std::uint64_t first, std::uint64_t last, bool slow) {
  if (const char* seeds = std::getenv("SHERD_SEEDS")) {
    char* rest = nullptr;
    first = last = std::strtoull(seeds, &rest, 10);
    if (*rest == '-') last = std::strtoull(rest + 1, nullptr, 10);
    slow = true;
  }
  for (const int signal : {SIGSEGV, SIGFPE, SIGABRT, SIGBUS}) std::signal(signal, tellCase);
  const char* log = std::getenv("SHERD_SEED_LOG");
  Totals totals;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    std::snprintf(currentCase, sizeof currentCase, "%s %llu", family.c_str(),
                  static_cast<unsigned long long>(seed));
    const AdversarialCase made = make(seed);
    params.minVolume = made.minVolume;
    const std::string what = broken(made, params, slow, totals);
    ++totals.cases;
    totals.failed += !what.empty();
    EXPECT_EQ(what, "") << currentCase << ": " << made.what;
    if (!what.empty() && log)
      std::ofstream(log, std::ios::app) << currentCase << " | " << made.what << " | " << what << "\n";
  }
  setThreadLimit(0);
  ::testing::Test::RecordProperty("cases", static_cast<int>(totals.cases));
  if (slow)
    std::printf(
        "%s: %zu cases, %zu failed, %zu pieces of which %zu intersect themselves, %zu flat triangles, %zu "
        "forced, "
        "%zu cases with other bits after renaming sites\n",
        family.c_str(), totals.cases, totals.failed, totals.pieces, totals.selfIntersecting, totals.flat,
        totals.forced, totals.renamedDiffer);
}

constexpr TessellateParams kExact{.cells = CellMode::Exact}, kCanonical{.cells = CellMode::Canonical};
constexpr TessellateParams kConforming{.cells = CellMode::Exact, .surface = SurfaceMode::Conforming};

TEST(Stability, ExactCells) { run("exact", adversarialCase, kExact, 1, 110, false); }
/// Uncut patches beside cut triangles; a pocket of skin that rounding laid flat; a void that touches the
/// shell around it.
TEST(Stability, SeedsOfFormerFaults) {
  for (const std::uint64_t seed : {27, 465, 3147}) run("exact", adversarialCase, kExact, seed, seed, false);
}
/// Sheets all but in the plane of the surface; a void with a sheet through its vertex.
TEST(Stability, CanonicalSeedsOfFormerFaults) {
  for (const std::uint64_t seed : {509, 4134, 4379, 5911, 6962, 8862})
    run("canonical", adversarialCase, kCanonical, seed, seed, false);
}
/// Two sheets on one flat triangle.
TEST(Stability, ConformingSeedsOfFormerFaults) {
  run("conforming", conformingCase, kConforming, 4868, 4868, false);
}
TEST(Stability, CanonicalCells) { run("canonical", adversarialCase, kCanonical, 1, 60, false); }
TEST(Stability, ConformingSurfaces) { run("conforming", conformingCase, kConforming, 1, 50, false); }
TEST(SlowStability, ExactCells) { run("exact", adversarialCase, kExact, 1, 1500, true); }
TEST(SlowStability, CanonicalCells) { run("canonical", adversarialCase, kCanonical, 1, 500, true); }
TEST(SlowStability, ConformingSurfaces) { run("conforming", conformingCase, kConforming, 1, 1000, true); }
TEST(CorpusStability, ExactCells) { run("exact", adversarialCase, kExact, 1, 10000, true); }
TEST(CorpusStability, CanonicalCells) { run("canonical", adversarialCase, kCanonical, 1, 10000, true); }
TEST(CorpusStability, ConformingSurfaces) { run("conforming", conformingCase, kConforming, 1, 10000, true); }

}  // namespace
}  // namespace sherd::test
