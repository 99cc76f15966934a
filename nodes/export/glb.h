// GLB 2.0: meshes of many parts as one binary file that every 3D application reads (core glTF, no
// extensions).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "types/surface_looks.h"
#include "types/vec.h"

namespace sherd {

using Floats2 = std::array<float, 2>;
using Floats3 = std::array<float, 3>;
using Floats4 = std::array<float, 4>;

/// Triangles of one material. Every array but `indices` has one entry per vertex; normals, and each set, may
/// be missing altogether.
struct GlbPrimitive {
  std::size_t material = 0;
  std::vector<Floats3> positions, normals;
  std::vector<std::vector<Floats2>> uvs;      ///< TEXCOORD_0, …; v points down, as glTF has it
  std::vector<std::vector<Floats4>> colours;  ///< COLOR_0, …
  std::vector<std::uint32_t> indices;         ///< three per triangle
};

/// A node with a mesh of the same name.
struct GlbNode {
  std::string name;
  Floats3 translation{};
  std::string extras;  ///< a JSON object, or empty
  std::vector<GlbPrimitive> primitives;
};

struct GlbMaterial {
  std::string name;
  Floats3 colour{};               ///< linear, of a rough surface that is no metal; where there is no look
  std::optional<Look> look = {};  ///< its images are PNG or JPEG, its UV sets are there
};

struct GlbScene {
  std::string name;
  std::vector<GlbMaterial> materials;
  std::vector<GlbNode> nodes;
  std::shared_ptr<const SurfaceLooks> looks;  ///< whose images the materials' textures are
};

/// The file's bytes. Accessors of one type of element share a buffer view; all are aligned to four bytes;
/// indices have 16 bits where these are enough. Images that materials use stand in the file once each, byte
/// for byte. Fails beyond 4 GiB, which the format's lengths can't tell.
Result<std::string> writeGlb(const GlbScene& scene);

}  // namespace sherd
