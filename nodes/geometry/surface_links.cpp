#include "geometry/surface_links.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "base/parallel.h"
#include "geometry/edge_table.h"

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 toPoint(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Sign of coordinate `axis` of (b − a) × (c − a).
int normalSign(const Vec3& a, const Vec3& b, const Vec3& c, Eigen::Index axis) {
  const Eigen::Index i = (axis + 1) % 3, j = (axis + 2) % 3;
  return static_cast<int>(CGAL::orientation(Kernel::Point_2(a[i], a[j]), Kernel::Point_2(b[i], b[j]),
                                            Kernel::Point_2(c[i], c[j])));
}

/// Is the displaced point on the inner side of the outward face abc?
bool isInward(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const auto side = CGAL::orientation(toPoint(a), toPoint(b), toPoint(c), toPoint(point));
  if (side != CGAL::COPLANAR) return side == CGAL::NEGATIVE;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (const int s = normalSign(a, b, c, axis); s != 0) return s < 0;
  return false;
}

bool holdsPoint(const TetMesh& mesh, std::size_t t, const Vec3& point) {
  for (const auto& face : kTetraFace) {
    const auto corner = [&](int k) -> const Vec3& {
      return mesh.nodes[at(mesh.tets[t][static_cast<std::size_t>(face[k])])];
    };
    if (!isInward(corner(0), corner(1), corner(2), point)) return false;
  }
  return true;
}

void locateVertices(TetMesh& mesh, const Exec& exec) {
  const TriMesh& surface = *mesh.surface;
  mesh.vertexTet.assign(surface.positions.size(), -1);
  // No two tetrahedra hold one displaced point, so that no two tasks write to one vertex.
  parallelFor(exec, mesh.tets.size(), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> vertices;
    for (std::size_t t = begin; t < end; ++t) {
      Box box;
      for (const Index n : mesh.tets[t]) box.add(mesh.nodes[at(n)]);
      vertices.clear();
      for (Index h = mesh.heldBegin[t]; h < mesh.heldBegin[t + 1]; ++h)
        for (const Index v : surface.triangles[at(mesh.held[at(h)])]) {
          const Vec3& p = surface.positions[at(v)];
          if ((p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all())
            vertices.push_back(v);
        }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      for (const Index v : vertices)
        if (holdsPoint(mesh, t, surface.positions[at(v)])) mesh.vertexTet[at(v)] = static_cast<Index>(t);
    }
  });
}

/// Across each side the next triangle around its edge, in a ring: the other one where two share it.
void linkTriangles(TetMesh& mesh) {
  const TriMesh& surface = *mesh.surface;
  const EdgeTable edges = buildEdgeTable(surface.triangles, surface.positions.size());
  mesh.surfaceNeighbours.resize(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t side = 0; side < 3; ++side) {
      const auto ring = edges.trianglesOf(edges.ofTriangle[t][side]);
      const auto own = std::find(ring.begin(), ring.end(), static_cast<Index>(t)) - ring.begin();
      mesh.surfaceNeighbours[t][side] = ring[(static_cast<std::size_t>(own) + 1) % ring.size()];
    }
}

}  // namespace

void linkSurface(TetMesh& mesh, const Exec& exec) {
  locateVertices(mesh, exec);
  linkTriangles(mesh);
}

}  // namespace sherd
