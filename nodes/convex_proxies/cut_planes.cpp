#include "convex_proxies/cut_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/edge_table.h"

namespace sherd {
namespace {

constexpr std::size_t kDeepEdges = 6;  ///< whose planes are tried
constexpr int kSlices = 5;             ///< across each principal axis
constexpr double kApart = 0.08;        ///< in sizes of the hull: closer edges of one direction count as one
constexpr double kLeastBend = 1e-9;    ///< sine of the angle between triangles that counts as concave
constexpr double kLeastDepth = 1e-6;   ///< in sizes of the hull

Vec3 unitNormal(std::span<const Vec3> p, const Triangle& t) {
  const Vec3 n = (p[at(t[1])] - p[at(t[0])]).cross(p[at(t[2])] - p[at(t[0])]);
  const double largest = n.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((n / largest).normalized()) : Vec3::Zero();
}

std::vector<CutPlane> hullPlanes(const HullMesh& hull) {
  std::vector<CutPlane> planes;
  for (const Triangle& t : hull.triangles)
    if (const Vec3 n = unitNormal(hull.positions, t); !n.isZero(0))
      planes.push_back({hull.positions[at(t[0])], n});
  return planes;
}

double depthIn(const std::vector<CutPlane>& planes, const Vec3& x) {
  double depth = std::numeric_limits<double>::infinity();
  for (const CutPlane& plane : planes) depth = std::min(depth, -plane.height(x));
  return depth;
}

struct DeepEdge {
  double depth;
  const ConcaveEdge* edge;
};

std::vector<const ConcaveEdge*> deepest(std::span<const ConcaveEdge> edges, const HullMesh& hull,
                                        std::span<const CutPlane> bounds, const Exec& exec) {
  const double size = boxOf(hull.positions).diagonal();
  const std::vector<CutPlane> planes = hullPlanes(hull);
  std::vector<DeepEdge> found;
  for (const ConcaveEdge& e : edges) {
    if (exec.cancelled()) return {};
    const Vec3 middle = e.middle();
    if (std::any_of(bounds.begin(), bounds.end(), [&](const CutPlane& b) { return b.height(middle) > 0; }))
      continue;
    if (const double depth = depthIn(planes, middle); depth > kLeastDepth * size)
      found.push_back({depth, &e});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const DeepEdge& a, const DeepEdge& b) { return a.depth > b.depth; });
  std::vector<const ConcaveEdge*> chosen;
  for (const DeepEdge& candidate : found) {
    const Vec3 direction = (candidate.edge->b - candidate.edge->a).normalized();
    const bool isNew = std::none_of(chosen.begin(), chosen.end(), [&](const ConcaveEdge* c) {
      return (c->middle() - candidate.edge->middle()).norm() < kApart * size &&
             std::abs(direction.dot((c->b - c->a).normalized())) > 0.9;
    });
    if (isNew) chosen.push_back(candidate.edge);
    if (chosen.size() == kDeepEdges) break;
  }
  return chosen;
}

void addSlices(const HullMesh& hull, std::vector<CutPlane>& planes) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : hull.positions) mean += p / static_cast<double>(hull.positions.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : hull.positions) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
  for (int k = 2; k >= 0; --k) {  // the longest first
    const Vec3 axis = axes.eigenvectors().col(k);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : hull.positions) {
      low = std::min(low, axis.dot(p - mean));
      high = std::max(high, axis.dot(p - mean));
    }
    for (int i = 1; i <= kSlices; ++i)
      planes.push_back({mean + (low + (high - low) * i / (kSlices + 1)) * axis, axis});
  }
}

}  // namespace

std::vector<ConcaveEdge> concaveEdges(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const EdgeTable table = buildEdgeTable(triangles, positions.size());
  std::vector<ConcaveEdge> edges;
  for (std::size_t e = 0; e < table.ends.size(); ++e) {
    const auto users = table.trianglesOf(static_cast<Index>(e));
    if (users.size() != 2) continue;
    const Triangle &s = triangles[at(users[0])], &t = triangles[at(users[1])];
    ConcaveEdge edge{positions[at(table.ends[e][0])],
                     positions[at(table.ends[e][1])],
                     {unitNormal(positions, s), unitNormal(positions, t)}};
    const auto tip = std::find_if(t.begin(), t.end(),
                                  [&](Index v) { return v != table.ends[e][0] && v != table.ends[e][1]; });
    if (tip == t.end()) continue;
    const Vec3 reach = positions[at(*tip)] - edge.a;
    if (edge.normals[0].dot(reach) > kLeastBend * reach.norm() && !edge.normals[1].isZero(0))
      edges.push_back(edge);
  }
  return edges;
}

std::vector<CutPlane> candidatePlanes(std::span<const ConcaveEdge> edges, const HullMesh& hull,
                                      std::span<const CutPlane> bounds, const Exec& exec) {
  std::vector<CutPlane> planes;
  for (const ConcaveEdge* e : deepest(edges, hull, bounds, exec)) {
    const Vec3 origin = e->middle();
    planes.push_back({origin, e->normals[0]});
    planes.push_back({origin, e->normals[1]});
    // Across the surface: holds the edge, and the direction in between the normals.
    const Vec3 across = (e->b - e->a).normalized().cross(e->normals[0] + e->normals[1]);
    if (across.norm() > 1e-6) planes.push_back({origin, across.normalized()});
  }
  addSlices(hull, planes);
  return planes;
}

}  // namespace sherd
