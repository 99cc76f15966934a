#include "repair/patchwork.h"

#include "geometry/weld.h"

namespace sherd {
namespace {

/// The number of the one weight that is 1, or -1.
int wholeWeight(const Vec3& weights) {
  for (int k = 0; k < 3; ++k)
    if (weights[k] == 1) return k;
  return -1;
}

template <class T>
T valueAt(const std::vector<T>& perCorner, const CornerOrigin& origin) {
  const std::size_t first = 3 * at(origin.triangle);
  if (const int c = wholeWeight(origin.weights); c >= 0)
    return perCorner[first + static_cast<std::size_t>(c)];
  return origin.weights[0] * perCorner[first] + origin.weights[1] * perCorner[first + 1] +
         origin.weights[2] * perCorner[first + 2];
}

template <class T>
T valueAt(const std::vector<T>& perCorner, const Facet& facet, std::size_t c) {
  const Vec3& w = facet.corners[c];
  if (const int k = wholeWeight(w); k >= 0)
    return valueAt(perCorner, facet.base[static_cast<std::size_t>(k)]);
  return w[0] * valueAt(perCorner, facet.base[0]) + w[1] * valueAt(perCorner, facet.base[1]) +
         w[2] * valueAt(perCorner, facet.base[2]);
}

Vec3 normalOf(const Patchwork& surface, std::size_t t) {
  const Triangle& v = surface.triangles[t];
  const Vec3& a = surface.positions[at(v[0])];
  const Vec3 normal = (surface.positions[at(v[1])] - a).cross(surface.positions[at(v[2])] - a);
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3(0, 1, 0);
}

void addNormals(TriMesh& mesh, const Patchwork& surface, const TriMesh& given) {
  mesh.normals.reserve(mesh.cornerCount());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Facet& facet = surface.facets[t];
    const Vec3 own = normalOf(surface, t);
    std::array<Vec3, 3> normals{own, own, own};
    double agreement = 0;
    for (std::size_t c = 0; c < 3 && !facet.isNew; ++c) {
      normals[c] = valueAt(given.normals, facet, c);
      const int k = wholeWeight(facet.corners[c]);
      const bool isCopy = k >= 0 && wholeWeight(facet.base[static_cast<std::size_t>(k)].weights) >= 0;
      if (const double length = normals[c].norm(); !isCopy)
        normals[c] = length > 1e-9 ? Vec3(normals[c] / length) : own;
      agreement += own.dot(normals[c]);
    }
    // Normals made for the other side; those that had pointed to the front all along stay.
    const bool negate = facet.turned && agreement < 0;
    for (const Vec3& normal : normals) mesh.normals.push_back(negate ? Vec3(-normal) : normal);
  }
}

template <class T>
std::vector<T> carried(const std::vector<T>& perCorner, const Patchwork& surface) {
  std::vector<T> values;
  values.reserve(3 * surface.triangles.size());
  for (const Facet& facet : surface.facets)
    for (std::size_t c = 0; c < 3; ++c) values.push_back(valueAt(perCorner, facet, c));
  return values;
}

}  // namespace

CornerOrigin cornerOrigin(Index t, int c) { return {t, Vec3::Unit(c)}; }

Patchwork patchworkOf(const TriMesh& mesh) {
  Patchwork surface{mesh.positions, mesh.triangles, {}};
  surface.facets.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = static_cast<Index>(i);
    Facet facet{.base = {cornerOrigin(t, 0), cornerOrigin(t, 1), cornerOrigin(t, 2)}};
    facet.from = t;
    surface.facets.push_back(facet);
  }
  return surface;
}

CornerOrigin originOf(const Facet& facet, std::size_t c) {
  const Vec3& weights = facet.corners[c];
  Eigen::Index nearest = 0;
  weights.maxCoeff(&nearest);
  const Index t = facet.base[0].triangle;
  const bool isOne = facet.base[1].triangle == t && facet.base[2].triangle == t;
  if (weights[nearest] == 1 || !isOne) return facet.base[static_cast<std::size_t>(nearest)];
  return {t, weights[0] * facet.base[0].weights + weights[1] * facet.base[1].weights +
                 weights[2] * facet.base[2].weights};
}

CornerOrigin originAt(const Facet& facet, const Vec3& weights) {
  Facet point = facet;
  point.corners[0] =
      weights[0] * facet.corners[0] + weights[1] * facet.corners[1] + weights[2] * facet.corners[2];
  return originOf(point, 0);
}

void turn(Patchwork& surface, std::size_t t) {
  std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  std::swap(surface.facets[t].corners[1], surface.facets[t].corners[2]);
  surface.facets[t].turned = !surface.facets[t].turned;
}

void keepOnly(Patchwork& surface, const std::vector<bool>& keep) {
  std::size_t to = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    surface.triangles[to] = surface.triangles[t];
    surface.facets[to++] = surface.facets[t];
  }
  surface.triangles.resize(to);
  surface.facets.resize(to);
}

void joinEqual(Patchwork& surface) {
  // Weld a mesh whose materials number its triangles, so that the facets can follow.
  TriMesh mesh = bare(surface);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.materialOf.push_back(static_cast<Index>(t));
  weld(mesh);
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (const Index t : mesh.materialOf) facets.push_back(surface.facets[at(t)]);
  surface = {std::move(mesh.positions), std::move(mesh.triangles), std::move(facets)};
}

TriMesh bare(const Patchwork& surface) {
  TriMesh mesh;
  mesh.positions = surface.positions;
  mesh.triangles = surface.triangles;
  return mesh;
}

TriMesh finished(const Patchwork& surface, const TriMesh& given) {
  TriMesh mesh = bare(surface);
  mesh.materials = given.materials;
  mesh.looks = given.looks;
  mesh.frame = given.frame;
  mesh.source = given.source;
  if (!given.normals.empty()) addNormals(mesh, surface, given);
  for (const auto& set : given.uvSets) mesh.uvSets.push_back({set.name, carried(set.uv, surface)});
  for (const auto& set : given.colorSets) mesh.colorSets.push_back({set.name, carried(set.rgba, surface)});
  if (!given.materialOf.empty())
    for (const Facet& facet : surface.facets) mesh.materialOf.push_back(given.materialOf[at(facet.from)]);
  return mesh;
}

}  // namespace sherd
