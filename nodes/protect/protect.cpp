#include "protect/protect.h"

#include <fmt/format.h>

#include <cmath>

#include "geometry/disjoint_sets.h"
#include "geometry/paint_place.h"
#include "protect/protected_tets.h"

namespace sherd {
namespace {

Result<void> check(const Embedding& embedding, const ProtectParams& params) {
  if (!embedding.tets || embedding.tets->tets.empty() || !embedding.tets->surface)
    return failure("the embedding comes without its tetrahedra", "wire it to Embed", "embedding");
  if (embedding.coordinates.cols() != static_cast<Eigen::Index>(embedding.tets->nodes.size()))
    return failure("the embedding has other nodes than its tetrahedra", "wire it to Embed", "embedding");
  if (!std::isfinite(params.threshold))
    return failure(fmt::format("the threshold is {}", params.threshold), "such as 0.5", "threshold");
  return {};
}

/// Per node the least node of its region; −1 outside of all.
std::vector<Index> regions(const TetMesh& tets, const std::vector<char>& isProtected) {
  DisjointSets sets(tets.nodes.size());
  std::vector<Index> region(tets.nodes.size(), -1);
  for (std::size_t t = 0; t < tets.tets.size(); ++t)
    if (isProtected[t])
      for (const Index n : tets.tets[t]) {
        sets.join(at(tets.tets[t][0]), at(n));
        region[at(n)] = 0;
      }
  for (std::size_t n = 0; n < region.size(); ++n)
    if (region[n] == 0) region[n] = static_cast<Index>(sets.find(n));
  return region;
}

/// Moves the nodes of every region to their mean by volume. Returns the number of regions.
std::size_t gather(const std::vector<Index>& region, const TetMesh& tets, Eigen::MatrixXd& x) {
  std::vector<double> volume(tets.nodes.size(), 0), total(tets.nodes.size(), 0);
  for (std::size_t t = 0; t < tets.tets.size(); ++t)
    for (const Index n : tets.tets[t]) volume[at(n)] += 0.25 * tetVolume(tets, t);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (std::size_t n = 0; n < region.size(); ++n) {
    if (region[n] < 0) continue;
    sums.col(region[n]) += volume[n] * x.col(static_cast<Eigen::Index>(n));
    total[at(region[n])] += volume[n];
  }
  std::size_t count = 0;
  for (std::size_t n = 0; n < region.size(); ++n) {
    if (region[n] < 0) continue;
    const auto first = static_cast<Eigen::Index>(region[n]);
    if (first == static_cast<Eigen::Index>(n)) {
      sums.col(first) /= total[n];
      ++count;
    }
    x.col(static_cast<Eigen::Index>(n)) = sums.col(first);  // the first of a region comes before all others
  }
  return count;
}

/// Of the body's volume.
double share(const TetMesh& tets, const std::vector<char>& isProtected) {
  double inside = 0, whole = 0;
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    const double volume = tets.insideFraction[t] * tetVolume(tets, t);
    whole += volume;
    if (isProtected[t]) inside += volume;
  }
  return inside / whole;
}

void tell(double share, std::size_t count, const ProtectedTets& found, double threshold,
          const ScalarGrid& field, const TetMesh& tets, const Exec& exec) {
  const bool isMissed = !field.isConstant() && found.highest <= field.background();
  if (count == 0)
    exec.warn(
        fmt::format("nothing is protected: the field stays below {:.4g} on the whole body ({:.4g} at most){}",
                    threshold, found.highest, isMissed ? "; " + placeOfPaint(field, tets) : ""));
  else if (share >= 1)
    exec.warn("all of the body is protected: nothing of it can break");
  else
    exec.info(fmt::format("{} region{} protected, {:.1f} % of the body", count, count == 1 ? "" : "s",
                          100 * share));
}

}  // namespace

Result<Embedding> protect(const Embedding& embedding, const ScalarGrid& field, const ProtectParams& params,
                          const Exec& exec) {
  SHERD_CHECK(check(embedding, params));
  const TetMesh& tets = *embedding.tets;
  SHERD_ASSIGN(const ProtectedTets found, protectedTets(tets, field, params.threshold, exec));
  Embedding out = embedding;
  const std::size_t count = gather(regions(tets, found.isProtected), tets, out.coordinates);
  if (exec.cancelled()) return cancelledError();
  tell(share(tets, found.isProtected), count, found, params.threshold, field, tets, exec);
  if (count > 0)
    out.diameter = (out.coordinates.rowwise().maxCoeff() - out.coordinates.rowwise().minCoeff()).norm();
  return out;
}

}  // namespace sherd
