#include "protect/protected_tets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "base/parallel.h"
#include "geometry/tet_edges.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 512;          ///< tetrahedra a task
constexpr std::size_t kTriangles = 1 << 14;  ///< surface triangles sampled at once
constexpr double kSamplesPerEdge = 4;        ///< on the surface, per mean edge of the tetrahedra
constexpr int kMaxParts = 1024;              ///< of a triangle's side

/// Samples with the highest value seen; remembers the first that isn't finite.
class Sampler {
 public:
  explicit Sampler(const ScalarGrid& field) : field_(field) {}

  const std::vector<double>& at(std::span<const Vec3> points) {
    values_.resize(points.size());
    field_.sample(points, values_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!std::isfinite(values_[i]) && error_.ok())
        error_ = failure(fmt::format("the field is {} at ({:.6g}, {:.6g}, {:.6g}) m", values_[i],
                                     points[i].x(), points[i].y(), points[i].z()),
                         "paint it with finite values", "field");
      highest_ = std::max(highest_, values_[i]);
    }
    return values_;
  }
  double highest() const { return highest_; }
  const Result<void>& error() const { return error_; }

 private:
  const ScalarGrid& field_;
  std::vector<double> values_;
  double highest_ = -std::numeric_limits<double>::infinity();
  Result<void> error_;
};

/// Places on the surface where the field protects, by triangle, and how far around each it may protect, too.
struct SurfaceMarks {
  std::vector<std::size_t> begin;  ///< per triangle, and one more
  std::vector<Vec3> points;
  std::vector<double> reach;  ///< m, per triangle
};

/// How many parts a side is cut into so that samples are `spacing` apart.
int partsOf(const Vec3 (&p)[3], double spacing, double& longest) {
  longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  return static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, static_cast<double>(kMaxParts)));
}

Result<SurfaceMarks> marksOnSurface(const TriMesh& surface, double spacing, double threshold,
                                    Sampler& sampler, const Exec& exec) {
  SurfaceMarks marks;
  marks.begin.push_back(0);
  std::vector<Vec3> points;
  std::vector<std::size_t> end;
  for (std::size_t first = 0; first < surface.triangles.size(); first += kTriangles) {
    points.clear(), end.clear();
    const std::size_t last = std::min(first + kTriangles, surface.triangles.size());
    for (std::size_t t = first; t < last; ++t) {
      if (exec.cancelled()) return cancelledError();
      Vec3 p[3];
      for (std::size_t c = 0; c < 3; ++c) p[c] = surface.positions[at(surface.triangles[t][c])];
      double longest = 0;
      const int parts = partsOf(p, spacing, longest);
      marks.reach.push_back(longest / parts / std::numbers::sqrt3);
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
          points.push_back(p[0] + (i * (p[1] - p[0]) + j * (p[2] - p[0])) / parts);
      end.push_back(points.size());
    }
    const std::vector<double>& values = sampler.at(points);
    for (std::size_t i = 0, t = 0; t < end.size(); ++t) {
      for (; i < end[t]; ++i)
        if (values[i] >= threshold) marks.points.push_back(points[i]);
      marks.begin.push_back(marks.points.size());
    }
  }
  return marks;
}

/// Is a point within `reach` (m) of the planes that bound a tetrahedron, or inside?
bool touches(const Vec3 (&corner)[4], const Vec3& point, double reach) {
  for (const auto& face : kTetraFace) {
    const Vec3& a = corner[face[0]];
    const Vec3 normal = (corner[face[1]] - a).cross(corner[face[2]] - a);
    if ((point - a).dot(normal) > reach * normal.norm()) return false;
  }
  return true;
}

bool holdsAMark(const TetMesh& tets, const SurfaceMarks& marks, std::size_t t) {
  Vec3 corner[4];
  for (std::size_t c = 0; c < 4; ++c) corner[c] = tets.nodes[at(tets.tets[t][c])];
  for (Index h = tets.heldBegin[t]; h < tets.heldBegin[t + 1]; ++h) {
    const std::size_t triangle = at(tets.held[at(h)]);
    for (std::size_t i = marks.begin[triangle]; i < marks.begin[triangle + 1]; ++i)
      if (touches(corner, marks.points[i], marks.reach[triangle])) return true;
  }
  return false;
}

double meanEdge(const TetMesh& tets, std::span<const Edge> edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (tets.nodes[at(a)] - tets.nodes[at(b)]).norm();
  return sum / static_cast<double>(edges.size());
}

/// By the samples inside: nodes, middles of edges and of tetrahedra.
std::vector<char> protectedInside(const TetMesh& tets, double threshold, Sampler& sampler) {
  std::vector<char> result(tets.tets.size(), 0);
  std::vector<Vec3> middles;
  for (const Tetra& tet : tets.tets) {
    Vec3 sum = Vec3::Zero();
    for (const Index n : tet) sum += tets.nodes[at(n)];
    middles.push_back(sum / 4);
    for (const auto& [a, b] : kTetraEdge)
      middles.push_back(0.5 * (tets.nodes[at(tet[at(a)])] + tets.nodes[at(tet[at(b)])]));
  }
  const std::size_t each = middles.size() / tets.tets.size();
  const std::vector<double>& values = sampler.at(middles);
  for (std::size_t i = 0; i < values.size(); ++i) result[i / each] |= values[i] >= threshold;
  const std::vector<double>& atNodes = sampler.at(tets.nodes);
  for (std::size_t t = 0; t < tets.tets.size(); ++t)
    for (const Index n : tets.tets[t]) result[t] |= atNodes[at(n)] >= threshold;
  return result;
}

}  // namespace

Result<ProtectedTets> protectedTets(const TetMesh& tets, const ScalarGrid& field, double threshold,
                                    const Exec& exec) {
  Sampler sampler(field);
  ProtectedTets result;
  if (field.isConstant()) {
    const bool all = sampler.at(std::span(tets.nodes).first(1))[0] >= threshold;
    result.isProtected.assign(tets.tets.size(), all);
  } else {
    result.isProtected = protectedInside(tets, threshold, sampler);
    const double spacing = meanEdge(tets, tetEdges(tets.tets)) / kSamplesPerEdge;
    SHERD_ASSIGN(const SurfaceMarks marks, marksOnSurface(*tets.surface, spacing, threshold, sampler, exec));
    parallelFor(exec, tets.tets.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (!result.isProtected[t]) result.isProtected[t] = holdsAMark(tets, marks, t);
    });
  }
  SHERD_CHECK(sampler.error());
  if (exec.cancelled()) return cancelledError();
  result.highest = sampler.highest();
  return result;
}

}  // namespace sherd
