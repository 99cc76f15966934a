#include <fmt/format.h>

#include <cmath>

#include "beta/layers.h"

namespace sherd {
namespace {

/// A number for each pixel in [0, 1], over texture coordinates: (0, 0) is the lower left corner of the
/// picture, (1, 1) its upper right one, and beyond it repeats. Between the pixels' middles it is linear.
class Texture {
 public:
  Texture(const Picture& picture, ColorChannel channel)
      : picture_(picture), channel_(static_cast<std::size_t>(channel)) {}

  double at(const Vec2& uv) const {
    const auto [x, right] = between(uv.x(), picture_.width);
    const auto [y, down] = between(-uv.y(), picture_.height);  // rows from the top
    const double above = (1 - right) * pixel(x, y) + right * pixel(x + 1, y);
    const double below = (1 - right) * pixel(x, y + 1) + right * pixel(x + 1, y + 1);
    return (1 - down) * above + down * below;
  }

 private:
  /// The pixel whose middle comes before the coordinate, and how far it is on to the next, in pixels.
  static std::pair<int, double> between(double coordinate, int pixels) {
    const double place = (coordinate - std::floor(coordinate)) * pixels - 0.5, before = std::floor(place);
    return {static_cast<int>(before), place - before};
  }
  double pixel(int x, int y) const {
    const int w = picture_.width, h = picture_.height;
    return picture_.rgb[picture_.offset((x + w) % w, (y + h) % h) + channel_] / 255.0;
  }

  const Picture& picture_;
  std::size_t channel_;
};

Result<const TriMesh::UvSet*> findUvs(const TriMesh& mesh, const std::string& wanted) {
  if (mesh.uvSets.empty())
    return failure(fmt::format("the mesh '{}' has no texture coordinates", mesh.source),
                   "unwrap it, and save it in a format that keeps them: OBJ, glTF or FBX", "mesh");
  std::string names;
  for (const TriMesh::UvSet& uvs : mesh.uvSets) {
    if (wanted.empty() || uvs.name == wanted) return &uvs;
    names += (names.empty() ? "'" : ", '") + uvs.name + "'";
  }
  return failure(fmt::format("the mesh has no texture coordinates named '{}'", wanted), "it has " + names,
                 "uv_set");
}

/// −1 for all of them.
Result<Index> findMaterial(const TriMesh& mesh, const std::string& wanted) {
  if (wanted.empty()) return Index{-1};
  std::string names;
  for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
    if (mesh.materials[m] == wanted) return static_cast<Index>(m);
    names += (names.empty() ? "'" : ", '") + mesh.materials[m] + "'";
  }
  return failure(fmt::format("the mesh has no material named '{}'", wanted),
                 names.empty() ? "it has none at all: leave it out" : "it has " + names, "material");
}

}  // namespace

Result<TextureParts> findTexture(const TriMesh* mesh, const Picture* picture, const PaintBetaParams& params) {
  if (mesh == nullptr)
    return failure("a texture lies on a mesh, and none is wired", "wire LoadMesh to `mesh`", "mesh");
  if (picture == nullptr)
    return failure("there is no texture", "wire LoadPicture to `texture`, with the picture's file",
                   "texture");
  if (!picture->complete()) return failure("the texture has no pixels", "wire another picture", "texture");
  if (params.channel == ColorChannel::Alpha)
    return failure("a texture's transparency is not kept", "choose red, green or blue, or save it as grey",
                   "channel");
  TextureParts parts;
  SHERD_ASSIGN(parts.uvs, findUvs(*mesh, params.uvSet));
  SHERD_ASSIGN(parts.material, findMaterial(*mesh, params.material));
  return parts;
}

Result<void> paintTexture(Canvas& canvas, const TriMesh& mesh, const Picture& picture,
                          const PaintBetaParams& params, double band, const Exec& exec) {
  SHERD_ASSIGN(const TextureParts parts, findTexture(&mesh, &picture, params));
  const Texture texture(picture, params.channel);
  const auto valueAt = [&](Index t, const Vec3& weights) -> std::optional<double> {
    if (parts.material >= 0 && mesh.materialOf[at(t)] != parts.material) return std::nullopt;
    const Vec2* uv = &parts.uvs->uv[3 * at(t)];
    return texture.at(weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2]);
  };
  return paintSurface(canvas, mesh, valueAt, params, band, exec);
}

}  // namespace sherd
