#include "preview/cage_soups.h"

#include <algorithm>

namespace sherd {
namespace {

/// A point of a tetrahedron, by the weights of its corners.
using Barycentric = Eigen::Vector4d;

/// Flat and convex, within a tetrahedron.
struct Polygon {
  std::vector<Barycentric> corners;
  Vec3 normal = Vec3::Zero();
};

/// What is left of it where a function, linear in the tetrahedron and given at its corners, is not above 0.
Polygon clipped(const Polygon& polygon, const Eigen::Vector4d& values) {
  Polygon kept{{}, polygon.normal};
  const std::size_t count = polygon.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Barycentric &a = polygon.corners[i], &b = polygon.corners[(i + 1) % count];
    const double va = values.dot(a), vb = values.dot(b);
    if (va <= 0) kept.corners.push_back(a);
    if ((va <= 0) != (vb <= 0)) kept.corners.push_back(a + va / (va - vb) * (b - a));
  }
  if (kept.corners.size() < 3) kept.corners.clear();
  return kept;
}

/// The section of a tetrahedron where a linear function that is given at its corners is 0.
Polygon section(const Eigen::Vector4d& values, const Vec3& normal) {
  std::vector<int> in, out;
  for (int k = 0; k < 4; ++k) (values[k] <= 0 ? in : out).push_back(k);
  Polygon polygon{{}, normal};
  const auto cross = [&](int a, int b) {
    const double share = values[a] / (values[a] - values[b]);
    polygon.corners.push_back((1 - share) * Barycentric::Unit(a) + share * Barycentric::Unit(b));
  };
  for (std::size_t i = 0; i < in.size(); ++i)  // around the section: every other edge backwards
    for (std::size_t o = 0; o < out.size(); ++o) cross(in[i], out[i % 2 == 0 ? o : out.size() - 1 - o]);
  if (polygon.corners.size() < 3) polygon.corners.clear();
  return polygon;
}

/// Calls show(tetrahedron, polygon) for all that can be seen of the tetrahedra.
template <class Show>
void forVisible(const TetMesh& mesh, const std::optional<SlicePlane>& cut, const Show& show) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tetra& tet = mesh.tets[t];
    Eigen::Vector4d height = Eigen::Vector4d::Constant(-1);  // above the plane
    for (int k = 0; cut && k < 4; ++k)
      height[k] = mesh.nodes[at(tet[static_cast<std::size_t>(k)])][cut->axis] - cut->offset;
    if (height.minCoeff() > 0) continue;
    const bool isCut = height.maxCoeff() > 0;
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbours[t][f] >= 0) continue;
      const auto& face = kTetraFace[f];
      const auto node = [&](int c) -> const Vec3& {
        return mesh.nodes[at(tet[static_cast<std::size_t>(face[c])])];
      };
      Polygon polygon{{}, (node(1) - node(0)).cross(node(2) - node(0)).normalized()};
      for (const int c : face) polygon.corners.push_back(Barycentric::Unit(c));
      show(t, isCut ? clipped(polygon, height) : polygon);
    }
    if (isCut) show(t, section(height, Vec3::Unit(cut->axis)));
  }
}

class SoupBuilder {
 public:
  SoupBuilder(const TetMesh& mesh, const PictureSpace& space) : mesh_(mesh), space_(space) {}

  /// Adds the polygon as a fan; each(corner) is called for every corner of every triangle, in the soup's
  /// order.
  template <class Each>
  std::size_t add(std::size_t t, const Polygon& polygon, const Each& each) {
    std::size_t triangles = 0;
    for (std::size_t i = 2; i < polygon.corners.size(); ++i, ++triangles)
      for (const std::size_t corner : {std::size_t{0}, i - 1, i}) {
        const Barycentric& b = polygon.corners[corner];
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < 4; ++k) x += b[k] * mesh_.nodes[at(mesh_.tets[t][static_cast<std::size_t>(k)])];
        soup.corners.push_back(space_.place(x));
        soup.normals.push_back(polygon.normal.cast<float>());
        each(b);
      }
    return triangles;
  }
  Soup soup;

 private:
  const TetMesh& mesh_;
  const PictureSpace& space_;
};

}  // namespace

Soup cellsSoup(const Partition& cells, const std::optional<SlicePlane>& cut, const PictureSpace& space) {
  const TetMesh& mesh = *cells.embedding->tets;
  const Eigen::MatrixXd& x = cells.embedding->coordinates;
  SoupBuilder builder(mesh, space);
  for (std::size_t j = 0; j < cells.siteCount(); ++j) builder.soup.palette.push_back(pieceColour(j));
  const auto paint = [&](std::size_t t, const Polygon& polygon, Index label) {
    const std::size_t triangles = builder.add(t, polygon, [](const Barycentric&) {});
    builder.soup.paint.insert(builder.soup.paint.end(), triangles, label);
  };
  forVisible(mesh, cut, [&](std::size_t t, const Polygon& polygon) {
    std::vector<Index> labels;
    for (const Index n : mesh.tets[t]) labels.push_back(cells.label[at(n)]);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    if (labels.size() == 1) return paint(t, polygon, labels.front());
    // Differences of squared distances are linear in the tetrahedron.
    std::vector<Eigen::Vector4d> distance2(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i)
      for (int k = 0; k < 4; ++k)
        distance2[i][k] =
            (x.col(mesh.tets[t][static_cast<std::size_t>(k)]) - cells.sites.col(labels[i])).squaredNorm();
    for (std::size_t i = 0; i < labels.size(); ++i) {
      Polygon part = polygon;
      for (std::size_t j = 0; j < labels.size() && !part.corners.empty(); ++j)
        if (j != i) part = clipped(part, distance2[i] - distance2[j]);
      paint(t, part, labels[i]);
    }
  });
  return std::move(builder.soup);
}

std::vector<double> nodeEnergyDensity(const EnergyField& energy) {
  std::vector<double> density = lumpedVolumes(*energy.tets);
  for (std::size_t n = 0; n < density.size(); ++n)
    density[n] = density[n] > 0 ? energy.nodeEnergy[n] / density[n] : 0;
  return density;
}

Soup energySoup(const EnergyField& energy, const EnergyScale& scale, const std::optional<SlicePlane>& cut,
                const PictureSpace& space) {
  const TetMesh& mesh = *energy.tets;
  const std::vector<double> density = nodeEnergyDensity(energy);
  SoupBuilder builder(mesh, space);
  forVisible(mesh, cut, [&](std::size_t t, const Polygon& polygon) {
    Eigen::Vector4d values;
    for (int k = 0; k < 4; ++k) values[k] = density[at(mesh.tets[t][static_cast<std::size_t>(k)])];
    builder.add(t, polygon,
                [&](const Barycentric& b) { builder.soup.values.push_back(scale.place(values.dot(b))); });
  });
  return std::move(builder.soup);
}

}  // namespace sherd
