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

/// Grows patches over the links between triangles.
class PatchGrower {
 public:
  explicit PatchGrower(TetMesh& mesh)
      : neighbours_(mesh.surfaceNeighbours), out_(mesh.patches), patchOf_(out_.patchOf) {}

  void run() {
    out_ = {};
    patchOf_.assign(neighbours_.size(), -1);
    out_.begin.push_back(0);
    for (std::size_t t = 0; t < neighbours_.size(); ++t) {
      seeds_.push_back(static_cast<Index>(t));
      for (; nextSeed_ < seeds_.size(); ++nextSeed_)
        if (patchOf_[at(seeds_[nextSeed_])] < 0) grow(seeds_[nextSeed_]);
    }
    connect();
  }

 private:
  static constexpr std::size_t kLargest = 32;

  /// Across every edge lies one other triangle, which leads back.
  bool isRegular(Index t) const {
    return std::all_of(neighbours_[at(t)].begin(), neighbours_[at(t)].end(), [&](Index n) {
      const Triangle& back = neighbours_[at(n)];
      return n != t && std::find(back.begin(), back.end(), t) != back.end();
    });
  }

  void grow(Index seed) {
    const auto patch = static_cast<Index>(out_.regular.size());
    const std::size_t first = out_.triangles.size();
    const bool regular = isRegular(seed);
    out_.regular.push_back(regular);
    take(seed, patch);
    for (std::size_t i = first; regular && i < out_.triangles.size(); ++i)
      for (const Index next : neighbours_[at(out_.triangles[i])]) {
        if (patchOf_[at(next)] >= 0) continue;
        if (out_.triangles.size() - first < kLargest && isRegular(next))
          take(next, patch);
        else
          seeds_.push_back(next);
      }
    std::sort(out_.triangles.begin() + static_cast<std::ptrdiff_t>(first), out_.triangles.end());
    out_.begin.push_back(static_cast<Index>(out_.triangles.size()));
  }

  void take(Index t, Index patch) {
    patchOf_[at(t)] = patch;
    out_.triangles.push_back(t);
  }

  void connect() {
    out_.neighbourBegin.push_back(0);
    std::vector<Index> around;
    for (std::size_t p = 0; p < out_.count(); ++p) {
      around.clear();
      for (const Index t : out_.trianglesOf(p))
        for (const Index next : neighbours_[at(t)])
          if (at(patchOf_[at(next)]) != p) around.push_back(patchOf_[at(next)]);
      std::sort(around.begin(), around.end());
      out_.neighbours.insert(out_.neighbours.end(), around.begin(),
                             std::unique(around.begin(), around.end()));
      out_.neighbourBegin.push_back(static_cast<Index>(out_.neighbours.size()));
    }
  }

  const std::vector<Triangle>& neighbours_;
  TrianglePatches& out_;
  std::vector<Index>& patchOf_;
  std::vector<Index> seeds_;
  std::size_t nextSeed_ = 0;
};

void integratePatches(TetMesh& mesh, const Exec& exec) {
  const TriMesh& surface = *mesh.surface;
  TrianglePatches& patches = mesh.patches;
  patches.origin = surface.positions.empty() ? Vec3::Zero() : boxOf(surface.positions).centre();
  patches.sums.assign(patches.count(), {});
  parallelFor(exec, patches.count(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (const Index t : patches.trianglesOf(p)) {
        const Triangle& corners = surface.triangles[at(t)];
        const auto corner = [&](std::size_t c) { return surface.positions[at(corners[c])] - patches.origin; };
        patches.sums[p].add(corner(0), corner(1), corner(2));
      }
  });
}

}  // namespace

void linkSurface(TetMesh& mesh, const Exec& exec) {
  locateVertices(mesh, exec);
  linkTriangles(mesh);
  PatchGrower(mesh).run();
  integratePatches(mesh, exec);
}

}  // namespace sherd
