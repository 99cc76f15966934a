#include "embed/embed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "embed/convexity.h"
#include "embed/extension.h"
#include "embed/filter.h"
#include "embed/fine_source.h"
#include "embed/part.h"
#include "embed/spectrum.h"
#include "embed/unfold.h"
#include "geometry/paint_place.h"
#include "geometry/solid.h"
#include "geometry/tet_edges.h"

namespace sherd {
namespace {

constexpr double kConvex = 1e-6;  ///< of the hull's volume
constexpr double kLeastStretch = 1e-3;

Result<void> checkParams(const EmbedParams& params) {
  if (params.dimensions < 1) return failure("no dimension is allowed", "allow at least one", "dimensions");
  if (!(params.tolerance >= 0 && params.tolerance < 1))
    return failure("the tolerance is not in [0, 1)", {}, "tolerance");
  if (!(params.time > 0) || !std::isfinite(params.time))
    return failure("the diffusion time is not positive", {}, "time");
  return {};
}

Result<void> check(const TetMesh* tets, const RestShape* rest, const EmbedParams& params) {
  if (tets == nullptr || tets->tets.empty()) return failure("the tetrahedral mesh is empty", {}, "tets");
  for (const Vec3& p : tets->nodes)
    if (!p.allFinite()) return failure("a node of the tetrahedral mesh is not at a finite place", {}, "tets");
  if (rest != nullptr && !isOf(*rest, *tets))
    return failure("the rest shape is that of another body", "wire it to a WarpRest of the same tets",
                   "rest");
  if (rest != nullptr)
    for (const Vec3& p : rest->positions)
      if (!p.allFinite()) return failure("a node of the rest shape is not at a finite place", {}, "rest");
  return checkParams(params);
}

Result<bool> isConvex(const TetMesh& tets) {
  const TriMesh& surface = *tets.surface;
  SHERD_ASSIGN(const double hull, convexHullVolume(surface.positions));
  return hull - std::abs(solidVolume(surface.positions, surface.triangles)) <= kConvex * hull;
}

double boxDiagonal(const Eigen::MatrixXd& coordinates) {
  return (coordinates.rowwise().maxCoeff() - coordinates.rowwise().minCoeff()).norm();
}

/// About the nodes' mean by the volume that the tetrahedra have in the body.
Vec3 meanPlace(const TetMesh& tets, const std::vector<Vec3>& places) {
  Vec3 sum = Vec3::Zero();
  double total = 0;
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    const double quarter = 0.25 * tetVolume(tets, t);
    for (const Index n : tets.tets[t]) sum += quarter * places[at(n)];
    total += 4 * quarter;
  }
  return sum / total;
}

Embedding euclidean(const std::shared_ptr<const TetMesh>& tets, const std::vector<Vec3>& places) {
  Embedding out{tets, Embedding::Metric::Euclidean, {}, 0};
  const Vec3 centre = &places == &tets->nodes
                          ? integrateSolid(tets->surface->positions, tets->surface->triangles).centroid
                          : meanPlace(*tets, places);
  out.coordinates.resize(3, static_cast<Eigen::Index>(places.size()));
  for (std::size_t n = 0; n < places.size(); ++n)
    out.coordinates.col(static_cast<Eigen::Index>(n)) = places[n] - centre;
  out.diameter = boxDiagonal(out.coordinates);
  return out;
}

/// Mode functions of the part's border, carried inward (nodes × modes).
Result<Eigen::MatrixXd> extended(const BodyPart& part, const Eigen::MatrixXd& onBorder,
                                 EmbedParams::Extension extension, const Exec& exec) {
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.node.size()), onBorder.cols());
  std::vector<char> given(part.node.size(), 0);
  for (std::size_t v = 0; v < part.borderNode.size(); ++v) {
    values.row(part.borderNode[v]) = onBorder.row(static_cast<Eigen::Index>(v));
    given[at(part.borderNode[v])] = 1;
  }
  if (extension == EmbedParams::Extension::Harmonic) {
    SHERD_CHECK(extendHarmonically(part.positions, part.tets, given, values, part.stretch));
    return values;
  }
  parallelFor(exec, part.node.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (!given[n])
        values.row(static_cast<Eigen::Index>(n)) =
            meanValueCoordinates(part.positions[n], part.borderPositions, part.borderTriangles).transpose() *
            onBorder;
  });
  if (exec.cancelled()) return cancelledError();
  if (!values.allFinite())
    return failure("mean value coordinates are not defined at a node of the tetrahedral mesh",
                   "use extension: harmonic", "extension");
  return values;
}

/// Eigenvalues, and the modes at all nodes of the part. None where its surface does not hang together.
Result<std::optional<Modes>> surfaceModes(const TetMesh& tets, const BodyPart& part,
                                          const EmbedParams& params, const Exec& exec) {
  if (params.source == EmbedParams::Source::Fine) return fineModes(tets, part, params, exec);
  if (part.shells != 1) return std::optional<Modes>();
  SHERD_ASSIGN(Modes modes,
               lowestModes(surfaceLaplacian(part.borderPositions, part.borderTriangles, part.borderStretch),
                           params.dimensions, exec));
  SHERD_ASSIGN(modes.functions, extended(part, modes.functions, params.extension, exec));
  return std::optional(std::move(modes));
}

/// Where lengths are stretched, paths' coordinates stand for the modes, but under diffusion: low modes don't
/// show how far it is across a narrow band.
Result<Modes> modesOf(const TetMesh& tets, const BodyPart& part, const EmbedParams& params,
                      const Exec& exec) {
  if (params.filter != EmbedParams::Filter::Diffusion && !part.stretch.empty()) {
    SHERD_ASSIGN(const Eigen::MatrixXd coordinates, pathCoordinates(part, params.dimensions, exec));
    return Modes{{}, coordinates.transpose()};
  }
  if (params.source != EmbedParams::Source::Solid) {
    SHERD_ASSIGN(std::optional<Modes> modes, surfaceModes(tets, part, params, exec));
    if (modes) return std::move(*modes);
    exec.info(
        "a part of the body has a surface that does not hang together, as around a void: modes of the solid "
        "are taken for it");
  }
  return lowestModes(solidLaplacian(part.positions, part.tets, part.stretch), params.dimensions, exec);
}

/// The factor that brings embedded edges closest to true ones: argmin Σ (s |x̄_i − x̄_j| − |x_i − x_j|)².
double edgeScale(const BodyPart& part, const Eigen::MatrixXd& x) {
  double product = 0, square = 0;
  for (const auto& [i, j] : tetEdges(part.tets)) {
    const double embedded = (x.col(i) - x.col(j)).norm();
    product += embedded * part.lengthBetween(at(i), at(j));
    square += embedded * embedded;
  }
  return square > 0 ? product / square : 1;
}

/// Leaves out the rows that hold less than `tolerance` of the largest row's magnitude.
Eigen::MatrixXd significantRows(const Eigen::MatrixXd& x, double tolerance) {
  const Eigen::VectorXd size = x.rowwise().norm();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < x.rows(); ++k)
    if (size[k] > 0 && size[k] >= tolerance * size.maxCoeff()) kept.push_back(k);
  return x(kept, Eigen::all);
}

/// Modes times factors, after the positions times theirs where these count, d × nodes.
Result<Eigen::MatrixXd> filtered(const TetMesh& tets, const BodyPart& part, const EmbedParams& params,
                                 const Exec& exec) {
  SHERD_ASSIGN(const Modes modes, modesOf(tets, part, params, exec));
  if (params.filter == EmbedParams::Filter::Diffusion) {
    const Eigen::VectorXd factors = diffusionFilter(modes.eigenvalues, params.time);
    const Eigen::MatrixXd x =
        significantRows(factors.asDiagonal() * modes.functions.transpose(), params.tolerance);
    return Eigen::MatrixXd(edgeScale(part, x) * x);
  }
  if (params.filter == EmbedParams::Filter::Unfolded) {
    SHERD_ASSIGN(const Eigen::MatrixXd x, unfolded(part, modes.functions, exec));
    return significantRows(x, params.tolerance);
  }
  SHERD_ASSIGN(const FittedFilter factors, fittedFilter(part, modes.functions, exec));
  Eigen::MatrixXd x(modes.functions.cols() + 3, modes.functions.rows());
  for (std::size_t n = 0; n < part.positions.size(); ++n)
    x.col(static_cast<Eigen::Index>(n)).head<3>() =
        factors.positions * (part.positions[n] - part.positions[0]);
  x.bottomRows(modes.functions.cols()) = factors.modes.asDiagonal() * modes.functions.transpose();
  return significantRows(x, params.tolerance);
}

/// One part's coordinates about its mean by volume, d × nodes.
Result<Eigen::MatrixXd> embedPart(const TetMesh& tets, const BodyPart& part, const EmbedParams& params,
                                  const Exec& exec) {
  SHERD_ASSIGN(Eigen::MatrixXd x, filtered(tets, part, params, exec));
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(x.rows());
  double total = 0;
  for (Eigen::Index n = 0; n < x.cols(); ++n) {
    mean += part.volume[static_cast<std::size_t>(n)] * x.col(n);
    total += part.volume[static_cast<std::size_t>(n)];
  }
  x.colwise() -= mean / total;
  return x;
}

/// Parts on shared axes, apart along one more.
Eigen::MatrixXd joined(const std::vector<BodyPart>& parts, const std::vector<Eigen::MatrixXd>& x,
                       std::span<const Vec3> places) {
  Eigen::Index dimensions = 0;
  double apart = boxOf(places).diagonal();
  for (const Eigen::MatrixXd& part : x) {
    dimensions = std::max(dimensions, part.rows());
    apart = std::max(apart, boxDiagonal(part));
  }
  const Eigen::Index separate = parts.size() > 1 ? 1 : 0;
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Zero(dimensions + separate, static_cast<Eigen::Index>(places.size()));
  for (std::size_t c = 0; c < parts.size(); ++c)
    for (std::size_t n = 0; n < parts[c].node.size(); ++n) {
      auto column = all.col(parts[c].node[n]);
      column.head(x[c].rows()) = x[c].col(static_cast<Eigen::Index>(n));
      if (separate) column[dimensions] = 2 * apart * static_cast<double>(c);
    }
  return all;
}

/// Root mean square of embedded over true edge length, less 1.
double edgeError(const TetMesh& tets, const MetricNodes& metric, const Eigen::MatrixXd& x) {
  double sum = 0;
  const std::vector<Edge> edges = tetEdges(tets.tets);
  for (const auto& [i, j] : edges) {
    double length = (metric.places[at(i)] - metric.places[at(j)]).norm();
    if (!metric.stretch.empty()) length *= 0.5 * (metric.stretch[at(i)] + metric.stretch[at(j)]);
    const double error = (x.col(i) - x.col(j)).norm() / length - 1;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(edges.size()));
}

/// Their elements count as their mirror images, so that the modes stay those of positive lengths and volumes.
void warnOfInsideOut(const TetMesh& tets, std::span<const Vec3> places, const Exec& exec) {
  if (places.data() == tets.nodes.data()) return;
  std::size_t count = 0;
  for (const Tetra& t : tets.tets) {
    const Vec3& a = places[at(t[0])];
    count += !((places[at(t[1])] - a).cross(places[at(t[2])] - a).dot(places[at(t[3])] - a) > 0);
  }
  if (count > 0)
    exec.warn(
        fmt::format("the rest shape turns {} of {} tetrahedra inside out: distances there are those of their "
                    "mirror images; weaker waves or less roughness avoid it",
                    count, tets.tets.size()));
}

/// The stretch at every node; empty where it is 1 all over.
Result<std::vector<double>> stretchAt(const TetMesh& tets, const ScalarGrid* field, const Exec& exec) {
  std::vector<double> stretch;
  if (field == nullptr) return stretch;
  stretch.resize(tets.nodes.size());
  field->sample(tets.nodes, stretch);
  bool isOne = true;
  for (std::size_t n = 0; n < stretch.size(); ++n) {
    const Vec3& p = tets.nodes[n];
    if (!(stretch[n] >= kLeastStretch && stretch[n] <= 1 / kLeastStretch))
      return failure(
          fmt::format("the stretch is {} at ({:.6g}, {:.6g}, {:.6g}) m", stretch[n], p.x(), p.y(), p.z()),
          "paint it with values from 0.001 to 1000 (1: as it is, more: cracks are drawn there)", "stretch");
    isOne = isOne && stretch[n] == 1;
  }
  if (!isOne) return stretch;
  if (!field->isConstant())
    exec.warn("the stretch is 1 all over the body: its strokes miss it; " + placeOfPaint(*field, tets));
  return std::vector<double>{};
}

Result<Embedding> interior(const std::shared_ptr<const TetMesh>& tets, const MetricNodes& metric,
                           const EmbedParams& params, const Exec& exec) {
  warnOfInsideOut(*tets, metric.places, exec);
  const std::vector<BodyPart> parts = bodyParts(*tets, metric);
  std::vector<Eigen::MatrixXd> x;
  for (const BodyPart& part : parts) {
    SHERD_ASSIGN(Eigen::MatrixXd coordinates, embedPart(*tets, part, params, exec));
    x.push_back(std::move(coordinates));
    exec.progress(static_cast<double>(x.size()) / static_cast<double>(parts.size()));
  }
  Embedding out{tets, Embedding::Metric::Interior, joined(parts, x, metric.places), 0};
  out.diameter = boxDiagonal(out.coordinates);
  exec.info(fmt::format("interior distances in {} dimensions; edge lengths met within {:.0f} %",
                        out.coordinates.rows(), 100 * edgeError(*tets, metric, out.coordinates)));
  return out;
}

}  // namespace

Result<Embedding> embed(const std::shared_ptr<const TetMesh>& tets, const EmbedParams& params,
                        const Exec& exec, const MetricControls& controls) {
  SHERD_CHECK(check(tets.get(), controls.rest, params));
  const bool isWarped = controls.rest != nullptr && controls.rest->positions != tets->nodes;
  const std::vector<Vec3>& places = isWarped ? controls.rest->positions : tets->nodes;
  SHERD_ASSIGN(const std::vector<double> stretch, stretchAt(*tets, controls.stretch, exec));
  if (params.metric == EmbedParams::Metric::Euclidean && !stretch.empty())
    return failure("straight distances know no stretch", "choose auto or interior, or leave `stretch` open",
                   "metric");
  if (params.metric == EmbedParams::Metric::Euclidean) return euclidean(tets, places);
  if (params.metric == EmbedParams::Metric::Auto && stretch.empty()) {
    SHERD_ASSIGN(const bool convex, isConvex(*tets));
    if (convex) {
      exec.info("convex: straight distances, no embedding is computed");
      return euclidean(tets, places);
    }
  }
  if ((isWarped || !stretch.empty()) && params.source == EmbedParams::Source::Fine)
    return failure(
        "rest shapes and stretches bend the tetrahedra, not the surface that source: fine takes its "
        "modes of",
        "choose source: solid or surface", "source");
  return interior(tets, {places, stretch}, params, exec);
}

}  // namespace sherd
