#include "export/crack_faces.h"

#include <cmath>

#include "base/parallel.h"
#include "export/float_rounding.h"

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

void flatten(const Fragments& f, const Piece& piece, CrackCorners& corners) {
  for (std::size_t t = 0; t < piece.crack.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) corners.normals[3 * t + c] = unit(areaVector(f, piece.crack[t]));
}

}  // namespace

Result<CrackAttributes> styledCracks(const Fragments& f, const CrackStyle& style, const Exec& exec) {
  if (!(style.textureDensity > 0) || !std::isfinite(style.textureDensity))
    return failure("the texture density is out of range", "UV units per metre, above 0", "texture_density");
  SHERD_ASSIGN(CrackAttributes cracks, crackAttributes(f, exec));
  cracks.extent *= style.textureDensity;
  if (!std::isfinite(roundedToFloat(cracks.extent.maxCoeff())))
    return failure("the texture density makes UVs larger than a float can be", "a smaller one",
                   "texture_density");
  parallelFor(exec, f.pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      CrackCorners& corners = cracks.pieces[p];
      if (style.normals == CrackNormals::Flat) flatten(f, f.pieces[p], corners);
      for (Vec3& normal : corners.normals) normal = roundedToFloat(normal);
      for (Vec2& uv : corners.uvs) uv = roundedToFloat(Vec2(style.textureDensity * uv));
    }
  });
  if (exec.cancelled()) return cancelledError();
  return cracks;
}

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

void warnOfNames(const TriMesh& source, const Exec& exec) {
  if (!source.piece.empty()) return;  // what is `inside` of a piece is so from an earlier fracture
  for (const std::string& name : source.materials)
    if (name == kInside)
      exec.warn(
          "the mesh has a material 'inside' of its own, the name that crack faces get; rename it to tell "
          "them apart");
}

}  // namespace sherd
