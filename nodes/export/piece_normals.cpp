#include <algorithm>
#include <map>
#include <numeric>

#include "export/piece_files.h"

namespace sherd {
namespace {

Vec3 areaVector(const Fragments& f, const Triangle& t) {
  const Vec3& a = f.positions[at(t[0])];
  return (f.positions[at(t[1])] - a).cross(f.positions[at(t[2])] - a);
}

/// Unit vector along `v`, safe from underflow for the tiny faces that cutting makes; z where v is 0.
Vec3 unit(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((v / largest).normalized()) : Vec3::UnitZ();
}

/// Made normals need no more digits than a float has; files are smaller for it.
Vec3 rounded(const Vec3& v) { return v.cast<float>().cast<double>(); }

}  // namespace

std::vector<Vec3> surfaceNormals(const Fragments& f, const Piece& piece) {
  const TriMesh& source = *f.tets->surface;
  std::vector<Vec3> normals;
  if (source.normals.empty()) return normals;
  normals.reserve(3 * piece.surface.size());
  for (std::size_t t = 0; t < piece.surface.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 normal = cornerAttribute(f, piece, t, corner, source.normals);
      if (piece.surfaceCut[t] < 0)
        normals.push_back(normal);
      else
        normals.push_back(unit(normal.isZero(0) ? areaVector(f, piece.surface[t]) : normal));
    }
  return normals;
}

std::vector<Vec3> crackNormals(const Fragments& f, const Piece& piece,
                               ExportCrackSurfaceParams::CrackNormals kind) {
  std::vector<Vec3> normals(3 * piece.crack.size());
  if (kind == ExportCrackSurfaceParams::CrackNormals::Flat) {
    for (std::size_t t = 0; t < piece.crack.size(); ++t)
      std::fill_n(normals.begin() + static_cast<std::ptrdiff_t>(3 * t), 3,
                  rounded(unit(areaVector(f, piece.crack[t]))));
    return normals;
  }
  std::map<std::pair<Index, Index>, Vec3> sums;  // per neighbour and vertex
  for (std::size_t t = 0; t < piece.crack.size(); ++t)
    for (const Index v : piece.crack[t])
      sums.try_emplace({piece.crackNeighbour[t], v}, Vec3::Zero()).first->second +=
          areaVector(f, piece.crack[t]);
  for (std::size_t t = 0; t < piece.crack.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner)
      normals[3 * t + corner] = rounded(unit(sums.at({piece.crackNeighbour[t], piece.crack[t][corner]})));
  return normals;
}

std::vector<std::size_t> crackOrder(const Piece& piece) {
  std::vector<std::size_t> order(piece.crack.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return piece.crackNeighbour[a] < piece.crackNeighbour[b];
  });
  return order;
}

}  // namespace sherd
