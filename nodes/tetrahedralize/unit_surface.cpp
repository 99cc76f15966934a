#include "tetrahedralize/unit_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/solid.h"

namespace sherd {
namespace {

/// Position along a Morton curve through the unit box.
std::uint64_t mortonCode(const Vec3& p) {
  std::uint64_t code = 0;
  Eigen::Array<std::uint64_t, 3, 1> cell;
  for (Eigen::Index i = 0; i < 3; ++i)
    cell[i] = static_cast<std::uint64_t>(std::clamp((p[i] + 1.0) * 0.5, 0.0, 1.0) * ((1 << 20) - 1));
  for (unsigned bit = 20; bit-- > 0;)
    for (Eigen::Index i = 0; i < 3; ++i) code = code << 1 | (cell[i] >> bit & 1);
  return code;
}

template <class Code>
std::vector<Index> orderBy(std::size_t n, Code&& code) {
  std::vector<std::pair<std::uint64_t, Index>> keys(n);
  for (std::size_t i = 0; i < n; ++i) keys[i] = {code(i), static_cast<Index>(i)};
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = keys[i].second;
  return order;
}

UnitSurface toUnit(const TriMesh& mesh) {
  UnitSurface unit;
  const Box box = boxOf(mesh.positions);
  unit.centre = box.centre();
  unit.size = box.diagonal();
  constexpr double kGrid = 1 << 24;
  for (const Vec3& p : mesh.positions)
    unit.positions.push_back(((p - unit.centre) / unit.size * kGrid).array().round().matrix() / kGrid);
  unit.triangles = mesh.triangles;
  unit.volume = solidVolume(unit.positions, unit.triangles);
  unit.area = 0;
  for (const Triangle& t : unit.triangles) {
    const Vec3& a = unit.positions[at(t[0])];
    unit.area += 0.5 * (unit.positions[at(t[1])] - a).cross(unit.positions[at(t[2])] - a).norm();
  }
  return unit;
}

}  // namespace

Result<UnitSurface> checkedUnitSurface(const TriMesh& mesh) {
  if (mesh.triangles.empty()) return failure("the surface has no triangles", "give a closed surface", "mesh");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!mesh.positions[v].allFinite())
      return failure(fmt::format("vertex {} is not a finite number", v + 1), "repair the file", "mesh");
  SHERD_ASSIGN(std::vector<Shell> shells, splitShells(mesh.positions, mesh.triangles));
  const double volume = solidVolume(mesh.positions, mesh.triangles);
  const double size = boxOf(mesh.positions).diagonal();
  if (std::abs(volume) <= 1e-12 * size * size * size)
    return failure("the surface encloses no volume", "give a solid with some thickness", "mesh");
  if (volume < 0)
    return failure("the surface is inside out: its volume is negative", "turn its triangles around", "mesh");
  UnitSurface unit = toUnit(mesh);
  for (Shell& shell : shells) shell.volume /= size * size * size;
  unit.shells = std::move(shells);
  return unit;
}

TetMesh toMetres(const Tetrahedra& mesh, const UnitSurface& surface) {
  TetMesh out;
  const std::vector<Index> nodeOrder =
      orderBy(mesh.nodes.size(), [&](std::size_t n) { return mortonCode(mesh.nodes[n]); });
  std::vector<Index> newNumber(mesh.nodes.size());
  for (std::size_t n = 0; n < nodeOrder.size(); ++n) {
    newNumber[at(nodeOrder[n])] = static_cast<Index>(n);
    out.nodes.push_back(surface.toMetres(mesh.nodes[at(nodeOrder[n])]));
  }
  const std::vector<Index> tetOrder = orderBy(mesh.tets.size(), [&](std::size_t t) {
    Vec3 sum = Vec3::Zero();
    for (const Index n : mesh.tets[t]) sum += mesh.nodes[at(n)];
    return mortonCode(0.25 * sum);
  });
  for (const Index t : tetOrder) {
    Tetra tet = mesh.tets[at(t)];
    for (Index& n : tet) n = newNumber[at(n)];
    out.tets.push_back(tet);
  }
  connectTets(out);
  return out;
}

}  // namespace sherd
