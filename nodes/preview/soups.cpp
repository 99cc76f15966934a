#include "preview/soups.h"

#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

Vec3 areaVector(const std::vector<Vec3>& positions, const Triangle& t) {
  const Vec3& a = positions[at(t[0])];
  return (positions[at(t[1])] - a).cross(positions[at(t[2])] - a);
}

/// Triangles around each vertex: of[begin[v]] … of[begin[v + 1] − 1].
struct Incidence {
  std::vector<std::size_t> begin, of;

  explicit Incidence(const TriMesh& mesh) : begin(mesh.positions.size() + 1, 0), of(mesh.cornerCount()) {
    for (const Triangle& t : mesh.triangles)
      for (const Index v : t) ++begin[at(v) + 1];
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const Index v : mesh.triangles[t]) of[next[at(v)]++] = t;
  }
};

void addTriangle(Soup& soup, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  soup.corners.insert(soup.corners.end(), {a, b, c});
}

Vec3 centreOfMass(const Fragments& f) {
  double volume = 0;
  Vec3 moment = Vec3::Zero();
  for (const Piece& piece : f.pieces) {
    volume += piece.volume;
    moment += piece.volume * piece.centreOfMass;
  }
  return volume > 0 ? Vec3(moment / volume) : f.pieces.front().centreOfMass;
}

}  // namespace

PictureSpace PictureSpace::of(const TriMesh& mesh) {
  const Box box = boxOf(mesh.positions);
  const double size = box.diagonal();
  return {box.centre(), size > 0 ? size : 1};
}

std::vector<Vec3> shadingNormals(const TriMesh& mesh) {
  if (!mesh.normals.empty()) return mesh.normals;
  constexpr double kSmooth = 0.766;  // cos 40°
  const Incidence around(mesh);
  std::vector<Vec3> area(mesh.triangles.size()), unit(area.size());
  for (std::size_t t = 0; t < area.size(); ++t) {
    area[t] = areaVector(mesh.positions, mesh.triangles[t]);
    unit[t] = area[t].normalized();
  }
  std::vector<Vec3> normals(mesh.cornerCount());
  for (std::size_t t = 0; t < area.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = at(mesh.triangles[t][c]);
      Vec3 sum = area[t];
      for (std::size_t i = around.begin[v]; i < around.begin[v + 1]; ++i)
        if (around.of[i] != t && unit[around.of[i]].dot(unit[t]) > kSmooth) sum += area[around.of[i]];
      normals[3 * t + c] = sum.normalized();
    }
  return normals;
}

Soup wholeSoup(const TriMesh& mesh, const std::vector<Vec3>& normals, const PictureSpace& space,
               const Colour& colour) {
  Soup soup;
  soup.palette = {colour};
  soup.paint.assign(mesh.triangles.size(), 0);
  for (const Triangle& t : mesh.triangles)
    addTriangle(soup, space.place(mesh.positions[at(t[0])]), space.place(mesh.positions[at(t[1])]),
                space.place(mesh.positions[at(t[2])]));
  for (const Vec3& n : normals) soup.normals.push_back(n.cast<float>());
  return soup;
}

Soup piecesSoup(const Fragments& f, const std::vector<Vec3>& normals,
                const std::vector<std::vector<Vec3>>& crackNormals, const PictureSpace& space,
                double explode) {
  Soup soup;
  const Vec3 centre = centreOfMass(f);
  for (std::size_t p = 0; p < f.pieces.size(); ++p) {
    const Piece& piece = f.pieces[p];
    const Vec3 offset = explode * (piece.centreOfMass - centre);
    const auto place = [&](Index v) { return space.place(f.positions[at(v)] + offset); };
    soup.palette.push_back(pieceColour(p));
    soup.palette.push_back(crackColour(p));
    for (std::size_t t = 0; t < piece.surface.size(); ++t) {
      const Triangle& corners = piece.surface[t];
      addTriangle(soup, place(corners[0]), place(corners[1]), place(corners[2]));
      soup.paint.push_back(static_cast<Index>(2 * p));
      for (std::size_t c = 0; c < 3; ++c)
        soup.normals.push_back(cornerAttribute(f, piece, t, c, normals).normalized().cast<float>());
    }
    for (const Triangle& corners : piece.crack) {
      addTriangle(soup, place(corners[0]), place(corners[1]), place(corners[2]));
      soup.paint.push_back(static_cast<Index>(2 * p + 1));
    }
    for (const Vec3& normal : crackNormals[p]) soup.normals.push_back(normal.cast<float>());
  }
  return soup;
}

std::vector<double> surfaceEnergyDensity(const EnergyField& energy) {
  const TetMesh& tets = *energy.tets;
  const TriMesh& surface = *tets.surface;
  const std::vector<double> volumes = lumpedVolumes(tets);
  std::vector<double> density(surface.positions.size(), 0);
  // Of the tetrahedra that touch a vertex' triangles, the one that it lies deepest in.
  std::vector<double> depth(surface.positions.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    const Tetra& nodes = tets.tets[t];
    const Vec3& origin = tets.nodes[at(nodes[0])];
    Mat3 edges;
    Eigen::Vector4d nodeDensity;
    for (int i = 0; i < 4; ++i) {
      const std::size_t n = at(nodes[static_cast<std::size_t>(i)]);
      if (i > 0) edges.col(i - 1) = tets.nodes[n] - origin;
      nodeDensity[i] = volumes[n] > 0 ? energy.nodeEnergy[n] / volumes[n] : 0;
    }
    const Mat3 inverse = edges.inverse();
    for (Index held = tets.heldBegin[t]; held < tets.heldBegin[t + 1]; ++held)
      for (const Index v : surface.triangles[at(tets.held[at(held)])]) {
        const Vec3 b = inverse * (surface.positions[at(v)] - origin);
        Eigen::Vector4d weights(1 - b.sum(), b.x(), b.y(), b.z());
        const double least = weights.minCoeff();
        if (!(least > depth[at(v)])) continue;
        depth[at(v)] = least;
        weights = weights.cwiseMax(0.0);
        density[at(v)] = weights.dot(nodeDensity) / weights.sum();
      }
  }
  return density;
}

EnergyScale energyScale(std::vector<double> densities) {
  if (densities.empty()) return {};
  std::sort(densities.begin(), densities.end());
  const auto percentile = [&](double share) {
    return densities[static_cast<std::size_t>(share * static_cast<double>(densities.size() - 1))];
  };
  EnergyScale scale;
  scale.high = percentile(0.995);
  if (!(scale.high > 0)) scale.high = densities.back();
  if (!(scale.high > 0)) return {};
  scale.low = std::clamp(percentile(0.02), 1e-4 * scale.high, 0.5 * scale.high);
  return scale;
}

float EnergyScale::place(double density) const {
  if (!(high > 0) || !(density > low)) return 0;
  return static_cast<float>(std::min(1.0, std::log(density / low) / std::log(high / low)));
}

}  // namespace sherd
