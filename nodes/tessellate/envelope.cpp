#include "tessellate/envelope.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "base/parallel_in_order.h"
#include "geometry/approx.h"
#include "tessellate/first_numbers.h"
#include "tessellate/symbolic_sign.h"
#include "tessellate/tet_envelope.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 64;  ///< tetrahedra a task
/// How much less extended precision is off than doubles are.
constexpr double kExtended = 0x1p-11;

std::uint64_t hashOf(const VertexName& name) {
  const auto [a, b, c, d] = name.words();
  const std::uint64_t nodes = (a * 0x9E3779B97F4A7C15ULL ^ b) * 0xC2B2AE3D27D4EB4FULL,
                      ranks = (c * 0x9FB21C651E98DF25ULL ^ d) * 0xD6E8FEB86659FD93ULL;
  const std::uint64_t both = nodes ^ std::rotl(ranks, 32);
  return both ^ both >> 29;
}

template <class Number>
Number determinant(const std::array<std::array<Number, 4>, 4>& m, std::size_t n) {
  if (n == 1) return m[0][0];
  if (n == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const auto minor3 = [&](std::size_t row, std::size_t a, std::size_t b, std::size_t c) {
    return m[row][a] * (m[row + 1][b] * m[row + 2][c] - m[row + 1][c] * m[row + 2][b]) -
           m[row][b] * (m[row + 1][a] * m[row + 2][c] - m[row + 1][c] * m[row + 2][a]) +
           m[row][c] * (m[row + 1][a] * m[row + 2][b] - m[row + 1][b] * m[row + 2][a]);
  };
  if (n == 3) return minor3(0, 0, 1, 2);
  return m[0][0] * minor3(1, 1, 2, 3) - m[0][1] * minor3(1, 0, 2, 3) + m[0][2] * minor3(1, 0, 1, 3) -
         m[0][3] * minor3(1, 0, 1, 2);
}

/// g_plus − g_minus as a double that knows how far it was rounded.
Approx difference(const double* g, Index plus, Index minus) {
  const double d = g[plus] - g[minus];
  return {d, 0x1p-53 * std::abs(d)};
}

/// The minors of the differences to the first site, which are the nodes' weights times their sum.
template <class Number, class Difference>
std::array<Number, 4> minorsOf(std::size_t n, Difference differenceAt) {
  std::array<std::array<Number, 4>, 4> full{};
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c + 1 < n; ++c) full[r][c] = differenceAt(r, c);
  std::array<Number, 4> minors{};
  for (std::size_t i = 0; i < n; ++i) {
    std::array<std::array<Number, 4>, 4> m{};
    for (std::size_t r = 0, out = 0; r < n; ++r)
      if (r != i) m[out++] = full[r];
    const Number d = determinant(m, n - 1);
    minors[i] = i % 2 == 0 ? d : -d;
  }
  return minors;
}

/// Off by no more than `tolerance`, as a share of one.
std::array<double, 4> weightsOf(const VertexName& name, const SiteValues& values, double tolerance) {
  const std::size_t n = name.dimension() + 1;
  const auto rough = minorsOf<Approx>(n, [&](std::size_t r, std::size_t c) {
    return difference(values.at(name.nodes[r]), name.ranks[c + 1], name.ranks[0]);
  });
  Approx sum = 0;
  double error = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum = sum + rough[i];
    error = std::max({error, rough[i].error, sum.error});
  }
  const double off = 4 * error, allowed = tolerance * std::abs(sum.value);
  if (off <= allowed) {
    std::array<double, 4> weights{};
    for (std::size_t i = 0; i < n; ++i) weights[i] = rough[i].value / sum.value;
    return weights;
  }
  if (off * kExtended <= allowed) {
    using Wide = long double;
    const auto fine = minorsOf<Wide>(n, [&](std::size_t r, std::size_t c) {
      const double* g = values.at(name.nodes[r]);
      return static_cast<Wide>(g[name.ranks[c + 1]]) - static_cast<Wide>(g[name.ranks[0]]);
    });
    Wide whole = 0;
    for (std::size_t i = 0; i < n; ++i) whole += fine[i];
    std::array<double, 4> weights{};
    for (std::size_t i = 0; i < n; ++i) weights[i] = static_cast<double>(fine[i] / whole);
    return weights;
  }
  std::array<AffineFunction, 3> functions;
  for (std::size_t c = 0; c + 1 < n; ++c) {
    functions[c].plus = name.ranks[c + 1];
    functions[c].minus = name.ranks[0];
    for (std::size_t r = 0; r < n; ++r) {
      functions[c].plusAt[r] = values.at(name.nodes[r]) + name.ranks[c + 1];
      functions[c].minusAt[r] = values.at(name.nodes[r]) + name.ranks[0];
    }
  }
  constexpr std::array<int, 4> rows{0, 1, 2, 3};
  return nodeWeights(std::span(rows).first(n), std::span(functions).first(n - 1));
}

/// Off by no more than `tolerance` (m) and the rounding of coordinates. From the heaviest node, so that a
/// vertex close to a node keeps that node's digits.
Vec3 positionOf(const VertexName& name, const SiteValues& values, const TetMesh& tets, double tolerance) {
  const std::size_t n = name.dimension() + 1;
  double extent = 0;
  for (std::size_t i = 1; i < n; ++i)
    extent = std::max(extent,
                      (tets.nodes[at(name.nodes[i])] - tets.nodes[at(name.nodes[0])]).cwiseAbs().maxCoeff());
  const std::array<double, 4> weights = weightsOf(name, values, tolerance / extent);
  const auto base = static_cast<std::size_t>(
      std::max_element(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(n)) - weights.begin());
  const Vec3& origin = tets.nodes[at(name.nodes[base])];
  Vec3 offset = Vec3::Zero();
  Box box;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& node = tets.nodes[at(name.nodes[i])];
    box.add(node);
    if (i != base) offset += weights[i] * (node - origin);
  }
  return Vec3(origin + offset).cwiseMax(box.low).cwiseMin(box.high);
}

bool liesOutside(const TetMesh& tets, std::size_t t) {
  return tets.heldBegin[t] == tets.heldBegin[t + 1] && tets.insideFraction.size() == tets.tets.size() &&
         tets.insideFraction[t] < 0.5;
}

/// What a block's tetrahedra share is named once, so that little is left to be numbered for all blocks.
struct Block {
  BlockPolygons found;
  std::vector<VertexName> names;  ///< each once
  std::vector<std::uint64_t> hashes;
  std::vector<Index> nameOf;  ///< per corner

  void nameCorners() {
    FirstNumbers<VertexName> numbers(found.corners.size());
    nameOf.reserve(found.corners.size());
    for (const VertexName& name : found.corners) nameOf.push_back(numbers.numberOf(name, hashOf(name)));
    names = numbers.take();
    hashes = numbers.takeHashes();
  }
};

Block blockOf(const TetMesh& tets, const SiteValues& values, std::size_t begin, std::size_t end) {
  std::vector<Index> candidates;
  TetEnvelope envelope(tets, values);
  Block block;
  for (std::size_t t = begin; t < end; ++t) {
    if (liesOutside(tets, t)) continue;
    values.candidates(tets.tets[t], candidates);
    if (candidates.size() > 1) envelope.addPolygons(static_cast<Index>(t), candidates, block.found);
  }
  block.nameCorners();
  return block;
}

/// Puts the blocks together, one after the other.
class Gatherer {
 public:
  Gatherer(const SiteValues& values, std::size_t tets) : values_(values), numbers_(tets) {}

  void add(const Block& block) {
    const BlockPolygons& found = block.found;
    Sheets& sheets = result.sheets;
    Index first = static_cast<Index>(sheets.corners.size());
    for (const BlockPolygons::Polygon& p : found.polygons) {
      sheets.polygons.push_back({first, p.count, values_.site(p.front), values_.site(p.back), p.tet});
      result.ranks.push_back({p.back, p.front});
      first += p.count;
    }
    numberOf_.clear();
    for (std::size_t k = 0; k < block.names.size(); ++k)
      numberOf_.push_back(numbers_.numberOf(block.names[k], block.hashes[k]));
    sheets.onCage.resize(numbers_.size(), 0);
    for (std::size_t c = 0; c < block.nameOf.size(); ++c) {
      const Index vertex = numberOf_[at(block.nameOf[c])];
      sheets.corners.push_back(vertex);
      sheets.onCage[at(vertex)] |= found.onCage[c];
    }
    result.lines.insert(result.lines.end(), found.lines.begin(), found.lines.end());
    sheets.cutTets += found.cutTets;
  }
  std::vector<VertexName> takeNames() { return numbers_.take(); }

  ExactSheets result;  ///< without places

 private:
  const SiteValues& values_;
  FirstNumbers<VertexName> numbers_;
  std::vector<Index> numberOf_;  ///< per name of a block
};

}  // namespace

ExactSheets exactSheets(const TetMesh& tets, const SiteValues& values, const Exec& exec) {
  const std::size_t n = tets.tets.size();
  std::vector<Block> blocks((n + kBlock - 1) / kBlock);
  Gatherer gatherer(values, n);
  parallelInOrder(
      exec, blocks.size(),
      [&](std::size_t b) { blocks[b] = blockOf(tets, values, b * kBlock, std::min(n, (b + 1) * kBlock)); },
      [&](std::size_t b) {
        gatherer.add(blocks[b]);
        blocks[b] = {};
      });
  const std::vector<VertexName> names = gatherer.takeNames();
  Sheets& sheets = gatherer.result.sheets;
  sheets.vertices.resize(names.size());
  sheets.simplexOf.resize(names.size());
  const double tolerance = 0x1p-52 * boxOf(tets.nodes).diagonal();
  parallelFor(exec, names.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      sheets.simplexOf[v] = names[v].nodes;
      sheets.vertices[v] = positionOf(names[v], values, tets, tolerance);
    }
  });
  return std::move(gatherer.result);
}

}  // namespace sherd
