#include "embed/fine_source.h"

#include <algorithm>

#include "base/parallel.h"
#include "embed/extension.h"
#include "geometry/disjoint_sets.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

struct Surface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

/// What of the surface touches the part's tetrahedra, with vertices numbered on their own.
Surface surfaceWithin(const TetMesh& tets, const BodyPart& part) {
  std::vector<char> inPart(tets.nodes.size(), 0);
  for (const Index n : part.node) inPart[at(n)] = 1;
  std::vector<char> touched(tets.surface->triangles.size(), 0);
  for (std::size_t t = 0; t < tets.tets.size(); ++t)
    if (inPart[at(tets.tets[t][0])])
      for (Index i = tets.heldBegin[t]; i < tets.heldBegin[t + 1]; ++i) touched[at(tets.held[at(i)])] = 1;
  Surface out;
  std::vector<Index> number(tets.surface->positions.size(), -1);
  for (std::size_t t = 0; t < touched.size(); ++t) {
    if (!touched[t]) continue;
    Triangle triangle = tets.surface->triangles[t];
    for (Index& v : triangle) {
      if (number[at(v)] < 0) {
        number[at(v)] = static_cast<Index>(out.positions.size());
        out.positions.push_back(tets.surface->positions[at(v)]);
      }
      v = number[at(v)];
    }
    out.triangles.push_back(triangle);
  }
  return out;
}

bool hangsTogether(const Surface& surface) {
  DisjointSets groups(std::max<std::size_t>(surface.positions.size(), 1));
  for (const Triangle& t : surface.triangles)
    for (const Index v : {t[1], t[2]}) groups.join(at(t[0]), at(v));
  for (std::size_t v = 1; v < surface.positions.size(); ++v)
    if (groups.find(v) != groups.find(0)) return false;
  return !surface.triangles.empty();
}

/// Rows of nodes that are not inside, from the closest point. Returns which these are.
std::vector<char> takeFromClosest(const Surface& surface, const BodyPart& part,
                                  const Eigen::MatrixXd& onSurface, Eigen::MatrixXd& values,
                                  const Exec& exec) {
  const SurfaceTree tree(surface.positions, surface.triangles);
  std::vector<char> given(part.node.size(), 0);
  parallelFor(exec, part.node.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (tree.contains(part.positions[n])) continue;
      const SurfacePoint nearest = tree.closest(part.positions[n]);
      const Triangle& t = surface.triangles[at(nearest.triangle)];
      for (Eigen::Index c = 0; c < 3; ++c)
        values.row(static_cast<Eigen::Index>(n)) +=
            nearest.barycentric[c] * onSurface.row(t[static_cast<std::size_t>(c)]);
      given[n] = 1;
    }
  });
  return given;
}

void extendByMeanValues(const Surface& surface, const BodyPart& part, const Eigen::MatrixXd& onSurface,
                        const std::vector<char>& given, Eigen::MatrixXd& values, const Exec& exec) {
  parallelFor(exec, part.node.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (!given[n])
        values.row(static_cast<Eigen::Index>(n)) =
            meanValueCoordinates(part.positions[n], surface.positions, surface.triangles).transpose() *
            onSurface;
  });
}

}  // namespace

Result<std::optional<Modes>> fineModes(const TetMesh& tets, const BodyPart& part, const EmbedParams& params,
                                       const Exec& exec) {
  const Surface surface = surfaceWithin(tets, part);
  if (!hangsTogether(surface)) return std::optional<Modes>();
  SHERD_ASSIGN(Modes modes,
               lowestModes(surfaceLaplacian(surface.positions, surface.triangles), params.dimensions, exec));
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.node.size()), modes.functions.cols());
  const std::vector<char> given = takeFromClosest(surface, part, modes.functions, values, exec);
  if (exec.cancelled()) return cancelledError();
  if (params.extension == EmbedParams::Extension::Harmonic)
    SHERD_CHECK(extendHarmonically(part.positions, part.tets, given, values));
  else
    extendByMeanValues(surface, part, modes.functions, given, values, exec);
  if (exec.cancelled()) return cancelledError();
  if (!values.allFinite())
    return failure("mean value coordinates are not defined at a node of the tetrahedral mesh",
                   "use extension: harmonic", "extension");
  modes.functions = std::move(values);
  return std::optional(std::move(modes));
}

}  // namespace sherd
