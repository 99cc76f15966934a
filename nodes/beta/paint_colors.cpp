#include <fmt/format.h>

#include "beta/layers.h"

namespace sherd {

Result<const TriMesh::ColorSet*> findColors(const TriMesh* mesh, const PaintBetaParams& params) {
  if (mesh == nullptr)
    return failure("colours come from a mesh, and none is wired", "wire LoadMesh to `mesh`", "mesh");
  if (mesh->colorSets.empty())
    return failure(fmt::format("the mesh '{}' has no vertex colours", mesh->source),
                   "paint some and save it in a format that keeps them: PLY, glTF, or OBJ with colours",
                   "mesh");
  std::string names;
  for (const TriMesh::ColorSet& colors : mesh->colorSets) {
    if (params.colorSet.empty() || colors.name == params.colorSet) return &colors;
    names += (names.empty() ? "'" : ", '") + colors.name + "'";
  }
  return failure(fmt::format("the mesh has no colours named '{}'", params.colorSet), "it has " + names,
                 "color_set");
}

Result<void> paintColors(Canvas& canvas, const TriMesh& mesh, const PaintBetaParams& params, double band,
                         const Exec& exec) {
  SHERD_ASSIGN(const TriMesh::ColorSet* colors, findColors(&mesh, params));
  const auto channel = static_cast<Eigen::Index>(params.channel);
  const auto colorAt = [&](Index t, const Vec3& weights) -> std::optional<double> {
    double value = 0;
    for (std::size_t c = 0; c < 3; ++c)
      value += weights[static_cast<Eigen::Index>(c)] * colors->rgba[3 * at(t) + c][channel];
    return value;
  };
  return paintSurface(canvas, mesh, colorAt, params, band, exec);
}

}  // namespace sherd
