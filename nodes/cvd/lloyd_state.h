// What Lloyd's iteration knows between passes (class Lloyd of cvd.h). Distances called bounds are over the
// embedding's diameter, in single precision, and on the safe side of all rounding.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "cvd/cvd.h"
#include "cvd/node_lanes.h"
#include "geometry/tet_edges.h"

namespace sherd {

/// About how many operations are worth a task.
inline constexpr std::size_t kTaskWork = std::size_t{1} << 16;

/// From so many pairs of node and site on it pays to find out which cells are near one another.
inline constexpr std::size_t kManyPairs = std::size_t{1} << 18;
/// So many bounds of pairs are kept at most.
inline constexpr std::size_t kMaxBounds = std::size_t{1} << 26;
// Bounds are given up where twice the sites would be too many: cells are told apart long before, and where
// they aren't, bounds are there to be read.
static_assert(2 * kManyPairs < kMaxBounds / 8);

/// How many items of so many operations each are worth a task.
inline std::size_t blockOf(std::size_t operations) {
  return std::max<std::size_t>(1, kTaskWork / (operations + 1));
}

/// The same for that many items, in parts of one size, an even number of them where there are several.
inline std::size_t evenBlockOf(std::size_t items, std::size_t operations) {
  const std::size_t tasks = 1 + items * operations / kTaskWork, even = tasks == 1 ? 1 : (tasks + 1) / 2 * 2;
  return std::max<std::size_t>(1, (items + even - 1) / even);
}

/// A site that may take nodes from a cell; a lower bound of half its distance to the cell's site.
struct Contender {
  float half;
  Index site;
};

/// A node whose label has changed, and what that was.
struct Leaving {
  Index node, from;
};

/// Σ w x̄ and, behind it, Σ w over the nodes that a cell has in each block of sixteen: a pass sums anew only
/// where nodes came or went, and since the sums are always taken over the same nodes in the same order, they
/// don't depend on what was there before.
struct CellSums {
  std::vector<Index> block;  ///< ascending
  std::vector<char> isStale;
  std::vector<double> sum;  ///< dimensions + 1 for each of `block`
};

/// Plain data, which the functions below keep in step. Cost of each is that of what
/// moved or changed, and O(N).
struct LloydState {
  const Embedding& embedding;
  const WeightField& weights;
  const double* x;  ///< the embedding's coordinates, node by node
  std::size_t nodes, dimensions;
  NodeLanes lanes;

  std::size_t siteCount = 0;
  std::size_t pinned = 0;   ///< the first so many sites don't move
  std::vector<double> p;    ///< sites' coordinates, one after another
  std::vector<float> site;  ///< per site: LaneSite::minusTwice
  std::vector<float> squaredNorm;
  std::vector<LaneValues> siteLanes;   ///< sites in blocks, as `lanes` has nodes
  std::vector<float> drift;            ///< per site: at least the sum of all its moves
  std::vector<std::uint64_t> version;  ///< per site: another number for each place of any site
  std::uint64_t versions = 0;
  std::vector<char> moved;    ///< per site: since labels were last exact
  std::vector<char> dirty;    ///< per cell: it has changed since its centroid was taken
  std::vector<char> resized;  ///< per cell: it or its nodes' bounds have changed since `radius` was taken
  std::vector<std::vector<Contender>> contenders;  ///< per cell, while labels are made exact
  std::vector<float> radius;                ///< per cell: no less than the distance of any of its nodes
  std::vector<std::vector<Index>> members;  ///< per cell its nodes, ascending
  std::vector<CellSums> sums;

  std::vector<Index> label;
  std::vector<float> up, low;           ///< per lane: up ≥ distance from the node to its site ≥ low
  std::vector<char> isTight;            ///< per lane: these are as good as `lanes` can tell
  std::vector<double> distance2;        ///< per node, to its site, where `measured` says so
  std::vector<std::uint64_t> measured;  ///< per node: version of the site that distance2 is to
  bool allStale = false;                ///< labels come from elsewhere: every comparison has to be made

  // The distance of lane l of block b to site j is at least bound[b · capacity + j].lane[l] − drift[j].
  bool bounded = true;
  std::size_t capacity = 0;
  std::unique_ptr<LaneValues[]> bound;

  LloydState(const Embedding& e, const WeightField& w, const Exec& exec);

  const double* position(std::size_t j) const { return p.data() + j * dimensions; }
  LaneSite lanesOf(std::size_t j) const { return {site.data() + j * dimensions, squaredNorm[j]}; }
  double squaredDistanceTo(std::size_t n, std::size_t j) const;
  /// Exactly the documented number; kept until the site moves or the label changes.
  double ownSquaredDistance(std::size_t n);
  void measureAll();

  // lloyd.cpp
  void addSite(const Eigen::Ref<const Eigen::VectorXd>& at, const Exec& exec);
  void reserveBounds(const Exec& exec);
  void listMembers();
  std::size_t assignByFlooding(const NodeGraph& graph, const Exec& exec);

  // lloyd_assign.cpp
  std::size_t assign(const Exec& exec);

  // lloyd_centroids.cpp
  std::size_t moveNodes(std::span<const std::vector<Leaving>> leaving);
  double moveToCentroids(double relaxation, const Exec& exec);
  void place(std::size_t j, const double* at);
  void moveTo(std::size_t j, const double* at, double step);
};

}  // namespace sherd
