#include "cvd/pin_sites.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace sherd {
namespace {

constexpr double kOnFace = 1e-9;      // barycentric: what rounding makes of a point on a face
constexpr double kSamePlace = 1e-12;  // of the embedding's diameter

/// Where a point is: in a tetrahedron, or nearest to a node.
struct Place {
  Index tet = -1;
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();  ///< barycentric, not negative, sum 1
  Index node = -1;                                    ///< where it is outside
  double distance = 0;                                ///< m, to that node
};

Result<void> check(const Embedding& embedding, const PinSitesParams& params) {
  if (!embedding.tets || embedding.tets->tets.empty() ||
      static_cast<std::size_t>(embedding.coordinates.cols()) != embedding.tets->nodes.size())
    return failure("the embedding isn't one of a tetrahedral mesh", "wire Embed", "embedding");
  if (!embedding.coordinates.allFinite())
    return failure("the embedding holds a coordinate that is not a finite number", {}, "embedding");
  if (params.points.empty())
    return failure("there is no point to pin", "write \"points\": [[x, y, z], …] in metres", "points");
  for (std::size_t i = 0; i < params.points.size(); ++i)
    if (!params.points[i].allFinite())
      return failure(fmt::format("pin {} is not at a finite place", i + 1), {}, "points");
  return {};
}

/// Barycentric coordinates of x; NaN or infinite in a tetrahedron without volume.
Eigen::Vector4d barycentric(const TetMesh& mesh, const Tetra& tet, const Vec3& x) {
  const Vec3& origin = mesh.nodes[at(tet[0])];
  const Vec3 a = mesh.nodes[at(tet[1])] - origin, b = mesh.nodes[at(tet[2])] - origin,
             c = mesh.nodes[at(tet[3])] - origin, p = x - origin;
  const double volume = a.dot(b.cross(c));
  const double wa = p.dot(b.cross(c)) / volume, wb = a.dot(p.cross(c)) / volume,
               wc = a.dot(b.cross(p)) / volume;
  return {1 - wa - wb - wc, wa, wb, wc};
}

/// The tetrahedron that x lies deepest in, the first of several; else the nearest node.
Place locate(const TetMesh& mesh, const Vec3& x) {
  Place place;
  double deepest = -kOnFace;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Eigen::Vector4d weights = barycentric(mesh, mesh.tets[t], x);
    const double least = weights.minCoeff();
    if (!weights.allFinite() || !(least > deepest)) continue;
    deepest = least;
    place.tet = static_cast<Index>(t);
    place.weights = weights.cwiseMax(0.0);
  }
  if (place.tet >= 0) {
    place.weights /= place.weights.sum();
    return place;
  }
  place.distance = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const double distance = (mesh.nodes[n] - x).norm();
    if (distance < place.distance) place.distance = distance, place.node = static_cast<Index>(n);
  }
  return place;
}

Eigen::VectorXd coordinatesAt(const Embedding& embedding, const Place& place) {
  if (place.tet < 0) return embedding.coordinates.col(place.node);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(embedding.coordinates.rows());
  const Tetra& tet = embedding.tets->tets[at(place.tet)];
  for (int i = 0; i < 4; ++i)
    sum += place.weights[i] * embedding.coordinates.col(tet[static_cast<std::size_t>(i)]);
  return sum;
}

void warnOfCoincident(const Embedding& embedding, const Eigen::MatrixXd& sites, const Exec& exec) {
  for (Eigen::Index j = 0; j < sites.cols(); ++j)
    for (Eigen::Index i = 0; i < j; ++i) {
      if ((sites.col(i) - sites.col(j)).norm() > kSamePlace * embedding.diameter) continue;
      exec.warn(
          fmt::format("pins {} and {} are at the same place; only the first gets a piece", i + 1, j + 1));
      break;
    }
}

}  // namespace

Result<Sites> pinSites(const Embedding& embedding, const PinSitesParams& params, const Exec& exec) {
  SHERD_CHECK(check(embedding, params));
  std::vector<Place> places(params.points.size());
  parallelFor(exec, places.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) places[i] = locate(*embedding.tets, params.points[i]);
  });
  if (exec.cancelled()) return cancelledError();
  Sites sites;
  sites.positions.resize(embedding.coordinates.rows(), static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    sites.positions.col(static_cast<Eigen::Index>(i)) = coordinatesAt(embedding, places[i]);
    if (places[i].tet >= 0) continue;
    const Vec3& p = params.points[i];
    exec.warn(fmt::format(
        "pin {} at ({:.6g}, {:.6g}, {:.6g}) m lies outside the body; the nearest node, {:.3g} m away, "
        "is taken",
        i + 1, p.x(), p.y(), p.z(), places[i].distance));
  }
  warnOfCoincident(embedding, sites.positions, exec);
  sites.degreeGiven = true;
  sites.pinned = sites.positions.cols();
  return sites;
}

}  // namespace sherd
