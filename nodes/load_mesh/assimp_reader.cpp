// glTF, GLB, FBX, Collada and the other formats of assimp. What is special about some of them:
// - glTF is in metres, y up, by its specification.
// - FBX states its unit (UnitScaleFactor, in centimetres) and its up axis; assimp passes both on and applies
// neither.
// - Collada states them too; assimp applies them, so that metres and y up arrive here.
// assimp turns texture coordinates so that v runs upwards in all formats, as in OBJ.
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <unordered_map>
#include <utility>

#include "load_mesh/file_looks.h"
#include "load_mesh/file_mesh.h"
#include "load_mesh/polygon_fan.h"

namespace sherd {
namespace {

constexpr std::size_t kMost = static_cast<std::size_t>(std::numeric_limits<Index>::max());

using Transform = Eigen::Matrix4d;

Transform toTransform(const aiMatrix4x4& m) {
  Transform t;
  for (unsigned i = 0; i < 4; ++i) {
    for (unsigned j = 0; j < 4; ++j)
      t(static_cast<int>(i), static_cast<int>(j)) = static_cast<double>(m[i][j]);
  }
  return t;
}

Vec3 toVec3(const aiVector3D& v) {
  return Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

// Normals map by the inverse transpose, here times |det| so that a transform without an inverse has one as
// well.
Mat3 normalTransform(const Mat3& m) {
  Mat3 cofactors;
  for (int i = 0; i < 3; ++i) cofactors.col(i) = m.col((i + 1) % 3).cross(m.col((i + 2) % 3));
  return m.determinant() < 0 ? Mat3(-cofactors) : cofactors;
}

// How many channels of each kind the meshes have, and what they are called where they have names.
struct Channels {
  std::vector<std::string> uvNames;
  std::size_t colors = 0;
  bool normals = false;

  explicit Channels(const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene.mMeshes[m];
      normals = normals || mesh.HasNormals();
      for (unsigned k = 0; k < AI_MAX_NUMBER_OF_COLOR_SETS; ++k) {
        if (mesh.HasVertexColors(k)) colors = std::max<std::size_t>(colors, k + 1);
      }
      for (unsigned k = 0; k < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++k) {
        if (mesh.HasTextureCoords(k)) nameUv(mesh, k);
      }
    }
  }

 private:
  void nameUv(const aiMesh& mesh, unsigned channel) {
    while (uvNames.size() <= channel) {
      uvNames.push_back(uvNames.empty() ? "uv" : "uv" + std::to_string(uvNames.size()));
    }
    if (!mesh.HasTextureCoordsName(channel)) return;
    const std::string name = mesh.GetTextureCoordsName(channel)->C_Str();
    if (!name.empty()) uvNames[channel] = name;
  }
};

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const std::string& path, const Exec& exec)
      : scene_(scene), channels_(scene), looks_(path, exec) {
    for (const std::string& name : channels_.uvNames) mesh().uvSets.push_back({name, {}});
    for (std::size_t k = 0; k < channels_.colors; ++k) {
      mesh().colorSets.push_back({k == 0 ? "color" : "color" + std::to_string(k), {}});
    }
  }

  Result<FileMesh> read() {
    std::vector<std::pair<const aiNode*, Transform>> open{{scene_.mRootNode, Transform::Identity()}};
    while (!open.empty()) {
      const auto [node, above] = open.back();
      open.pop_back();
      const Transform transform = above * toTransform(node->mTransformation);
      for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        if (node->mMeshes[i] >= scene_.mNumMeshes)
          return failure("a node names a mesh that does not exist",
                         "the file may be damaged; export it again");
        SHERD_CHECK(append(*scene_.mMeshes[node->mMeshes[i]], transform));
      }
      for (unsigned i = node->mNumChildren; i > 0; --i) open.emplace_back(node->mChildren[i - 1], transform);
    }
    if (mesh().triangles.empty()) {
      return failure("the file has no polygons", "export the model itself, as a polygon mesh");
    }
    readLooks();
    dropUnnamedMaterial();
    finishNormals(mesh());
    SHERD_CHECK(unitAndUp());
    return std::move(file_);
  }

 private:
  TriMesh& mesh() { return file_.mesh; }

  // Points and lines have no surface and are passed over.
  Result<Polygons> polygonsOf(const aiMesh& part) const {
    Polygons polygons;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) {
          return failure(
              "a face of mesh '" + std::string(part.mName.C_Str()) + "' names a vertex that does not exist",
              "the file may be damaged");
        }
        polygons.vertices.push_back(static_cast<Index>(face.mIndices[k]));
      }
      if (polygons.vertices.size() > kMost) return tooLarge();
      polygons.close();
    }
    return polygons;
  }

  static Error tooLarge() {
    return failure("more vertices or corners than can be numbered (2147483647)", "split the model");
  }

  Result<void> append(const aiMesh& part, const Transform& transform) {
    if (mesh().positions.size() + part.mNumVertices > kMost) return tooLarge();
    SHERD_ASSIGN(const Polygons polygons, polygonsOf(part));
    const Mat3 linear = transform.topLeftCorner<3, 3>();
    std::vector<Vec3> positions;
    positions.reserve(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      positions.emplace_back(linear * toVec3(part.mVertices[i]) + transform.topRightCorner<3, 1>());
    }
    PolygonTriangles split = triangulate(polygons, positions);
    if (3 * (mesh().triangles.size() + split.triangles.size()) > kMost) return tooLarge();
    if (linear.determinant() < 0) {  // a mirror turns the inside out: turn it back
      for (Triangle& t : split.triangles) std::swap(t[1], t[2]);
    }
    const Index first = static_cast<Index>(mesh().positions.size());
    mesh().positions.insert(mesh().positions.end(), positions.begin(), positions.end());
    appendAttributes(part, split.triangles, normalTransform(linear));
    for (const Triangle& t : split.triangles)
      mesh().triangles.push_back({first + t[0], first + t[1], first + t[2]});
    if (!split.triangles.empty()) {
      mesh().materialOf.resize(mesh().triangles.size(), materialNumber(part.mMaterialIndex));
    }
    return {};
  }

  // What this mesh lacks and others have: (0, 0) as texture coordinates, white, and its triangles' own
  // normals.
  void appendAttributes(const aiMesh& part, const std::vector<Triangle>& triangles, const Mat3& normals) {
    for (const Triangle& t : triangles) {
      for (Index v : t) {
        if (channels_.normals) {
          mesh().normals.push_back(part.HasNormals() ? Vec3(normals * toVec3(part.mNormals[v]))
                                                     : Vec3(0, 0, 0));
        }
        for (unsigned k = 0; k < mesh().uvSets.size(); ++k) {
          const Vec3 uv = part.HasTextureCoords(k) ? toVec3(part.mTextureCoords[k][v]) : Vec3(0, 0, 0);
          mesh().uvSets[k].uv.push_back(uv.head<2>());
        }
        for (unsigned k = 0; k < mesh().colorSets.size(); ++k) {
          const aiColor4D c = part.HasVertexColors(k) ? part.mColors[k][v] : aiColor4D(1, 1, 1, 1);
          mesh().colorSets[k].rgba.push_back(Eigen::Vector4f(c.r, c.g, c.b, c.a).cast<double>());
        }
      }
    }
  }

  Index materialNumber(unsigned index) {
    const auto [entry, isNew] =
        materialNumber_.try_emplace(index, static_cast<Index>(mesh().materials.size()));
    if (isNew) {
      aiString name;
      if (index < scene_.mNumMaterials) scene_.mMaterials[index]->Get(AI_MATKEY_NAME, name);
      mesh().materials.emplace_back(name.C_Str());
    }
    return entry->second;
  }

  void readLooks() {
    std::vector<unsigned> indices(mesh().materials.size());
    for (const auto& [index, number] : materialNumber_) indices[at(number)] = index;
    for (std::size_t m = 0; m < indices.size(); ++m) {
      if (mesh().materials[m] == AI_DEFAULT_MATERIAL_NAME) continue;
      if (auto look = lookOf(scene_, indices[m], looks_)) looks_.set(m, std::move(*look));
    }
    mesh().looks = looks_.take();
  }

  // assimp gives every mesh a material. Where it is the only one and assimp's own, or has neither name nor
  // colour, the file has none.
  void dropUnnamedMaterial() {
    if (mesh().materials.size() != 1) return;
    const std::string& name = mesh().materials[0];
    const Look* look = lookOf(mesh().looks.get(), 0);
    if (look != nullptr && (!name.empty() || saysMuch(*look))) return;
    mesh().materials.clear();
    mesh().materialOf.clear();
    mesh().looks = nullptr;
  }

  static bool saysMuch(const Look& look) {
    const auto& [r, g, b, a] = look.baseColour;
    bool much = r != g || g != b || a < 1;
    forEachTexture(look, [&](const Texture& texture) { much = much || texture.image >= 0; });
    return much;
  }

  Result<void> unitAndUp() {
    aiString format;
    if (scene_.mMetaData == nullptr || !scene_.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format)) return {};
    const std::string name = format.C_Str();
    if (name.find("FBX") != std::string::npos) return fbxUnitAndUp(*scene_.mMetaData);
    if (name.find("glTF") != std::string::npos || name.find("Collada") != std::string::npos) {
      file_.metresPerUnit = 1;
      file_.up = FileFrame::Up::Y;
    }
    return {};
  }

  Result<void> fbxUnitAndUp(const aiMetadata& settings) {
    float centimetres = 0;
    if (settings.Get("UnitScaleFactor", centimetres)) {
      const double metres = shortest(centimetres) / 100;
      if (!(metres > 0) || !std::isfinite(metres)) {
        return failure("the FBX file's UnitScaleFactor is " + std::to_string(centimetres),
                       "centimetres per unit, above 0");
      }
      file_.metresPerUnit = metres;
    }
    std::int32_t axis = 1, sign = 1;
    if (!settings.Get("UpAxis", axis)) return {};
    settings.Get("UpAxisSign", sign);
    if ((axis != 1 && axis != 2) || sign < 0) {
      return failure("the FBX file's up axis is neither y nor z", "export it with y or z up");
    }
    file_.up = axis == 1 ? FileFrame::Up::Y : FileFrame::Up::Z;
    return {};
  }

  // The number as it stands in the file: assimp has rounded 2.54 to a float, 2.5399999618530273.
  static double shortest(float value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.7g", static_cast<double>(value));
    return std::strtod(digits, nullptr);
  }

  const aiScene& scene_;
  Channels channels_;
  std::unordered_map<unsigned, Index> materialNumber_;
  LooksBuilder looks_;
  FileMesh file_;
};

}  // namespace

Result<FileMesh> readWithAssimp(const std::string& path, const Exec& exec) {
  try {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* scene = importer.ReadFile(path, 0);
    if (scene == nullptr) {
      const std::string why = importer.GetErrorString();
      return failure("the file can't be read" + (why.empty() ? why : ": " + why),
                     "OBJ, PLY, STL, OFF, glTF, GLB, FBX or Collada; is it damaged?");
    }
    if (scene->mRootNode == nullptr)
      return failure("the file has no scene", "export the model as a polygon mesh");
    return SceneReader(*scene, path, exec).read();
  } catch (const std::exception& e) {
    return failure(std::string("the file can't be read: ") + e.what(), "it may be damaged; export it again");
  } catch (...) {
    return failure("the file can't be read: assimp failed without saying why",
                   "it may be damaged; export it again");
  }
}

}  // namespace sherd
