#include "load_mesh/polygon_fan.h"

#include <utility>

namespace sherd {
namespace {

// Twice the polygon's area vector (Newell's formula), summed relative to the first corner to lose no digits
// to a polygon's distance from the origin.
Vec3 newellNormal(std::span<const Vec3> corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  return normal;
}

// Drops the coordinate along which the normal is longest. An affine map of the polygon's plane, so that turns
// and containment stay as they are, and the two coordinates stay as in the file.
std::vector<Vec2> project(std::span<const Vec3> corners, const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Vec2> flat(corners.size());
  for (std::size_t i = 0; i < flat.size(); ++i) flat[i] = Vec2(corners[i][u], corners[i][v]);
  return flat;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

// Left turns at all corners, and seen from the first one all others in turn: the fan folds nowhere.
bool strictlyConvex(const std::vector<Vec2>& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(turn(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0)) return false;
    if (i > 0 && i + 1 < n && !(turn(p[0], p[i], p[i + 1]) > 0)) return false;
  }
  return true;
}

class EarClipping {
 public:
  explicit EarClipping(const std::vector<Vec2>& points)
      : points_(points), next_(points.size()), previous_(points.size()), noEar_(points.size(), false) {
    const Index n = static_cast<Index>(points.size());
    for (Index i = 0; i < n; ++i) {
      next_[at(i)] = (i + 1) % n;
      previous_[at(i)] = (i + n - 1) % n;
    }
  }

  // Walks around, cutting ears as they are met. A full round without an ear ends the search: the rest is a
  // fan. Cutting an ear makes new ears of its two neighbours only, so no other corner is tested a second
  // time.
  void cut(std::vector<Triangle>& triangles) {
    Index left = static_cast<Index>(points_.size()), corner = 1, withoutEar = 0;
    while (left > 3 && withoutEar < left) {
      const Index before = previous_[at(corner)], after = next_[at(corner)];
      if (noEar_[at(corner)] || !isEar(before, corner, after)) {
        noEar_[at(corner)] = true;
        corner = after;
        ++withoutEar;
        continue;
      }
      triangles.push_back({before, corner, after});
      next_[at(before)] = after;
      previous_[at(after)] = before;
      noEar_[at(before)] = noEar_[at(after)] = false;
      corner = after;
      --left;
      withoutEar = 0;
    }
    for (Index b = next_[at(corner)]; next_[at(b)] != corner; b = next_[at(b)]) {
      triangles.push_back({corner, b, next_[at(b)]});
    }
  }

 private:
  bool isEar(Index a, Index b, Index c) const {
    const Vec2 &pa = points_[at(a)], &pb = points_[at(b)], &pc = points_[at(c)];
    if (!(turn(pa, pb, pc) > 0)) return false;
    for (Index i = next_[at(c)]; i != a; i = next_[at(i)]) {
      const Vec2& p = points_[at(i)];
      // A corner that is met twice (a bridge to a hole) blocks nothing.
      if (p == pa || p == pb || p == pc) continue;
      if (turn(pa, pb, p) >= 0 && turn(pb, pc, p) >= 0 && turn(pc, pa, p) >= 0) return false;
    }
    return true;
  }

  const std::vector<Vec2>& points_;
  std::vector<Index> next_, previous_;
  std::vector<bool> noEar_;
};

void fan(std::size_t n, std::vector<Triangle>& triangles) {
  for (Index i = 1; i + 1 < static_cast<Index>(n); ++i) triangles.push_back({0, i, i + 1});
}

}  // namespace

void splitPolygon(std::span<const Vec3> corners, std::vector<Triangle>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return;
  }
  const Vec3 normal = newellNormal(corners);
  if (!normal.allFinite() || normal.isZero(0)) {
    fan(corners.size(), triangles);
    return;
  }
  const std::vector<Vec2> flat = project(corners, normal);
  if (strictlyConvex(flat)) {
    fan(corners.size(), triangles);
  } else {
    EarClipping(flat).cut(triangles);
  }
}

PolygonTriangles triangulate(const Polygons& polygons, const std::vector<Vec3>& positions) {
  PolygonTriangles out;
  const std::size_t count = polygons.vertices.size() - 2 * polygons.size();
  out.triangles.reserve(count);
  out.cornerOf.reserve(3 * count);
  out.polygonOf.reserve(count);
  std::vector<Vec3> corners;
  std::vector<Triangle> local;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const Index first = polygons.start[p], last = polygons.start[p + 1];
    corners.clear();
    local.clear();
    for (Index c = first; c < last; ++c) corners.push_back(positions[at(polygons.vertices[at(c)])]);
    splitPolygon(corners, local);
    for (const Triangle& t : local) {
      out.triangles.emplace_back();
      out.polygonOf.push_back(static_cast<Index>(p));
      for (std::size_t k = 0; k < 3; ++k) {
        out.cornerOf.push_back(first + t[k]);
        out.triangles.back()[k] = polygons.vertices[at(first + t[k])];
      }
    }
  }
  return out;
}

void finishNormals(TriMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size() && !mesh.normals.empty(); ++t) {
    const Triangle& v = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& normal = mesh.normals[3 * t + k];
      if (normal.isZero(0)) {
        const Vec3& a = mesh.positions[at(v[0])];
        normal = (mesh.positions[at(v[1])] - a).cross(mesh.positions[at(v[2])] - a);
      }
      normal.stableNormalize();  // leaves a zero vector as it is
      if (normal.isZero(0)) normal = Vec3::UnitZ();
    }
  }
}

}  // namespace sherd
