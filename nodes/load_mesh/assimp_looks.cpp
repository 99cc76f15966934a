// Materials of glTF, GLB, FBX and what else assimp reads.
#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

#include "load_mesh/file_looks.h"

namespace sherd {
namespace {

double inUnit(double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0; }

Texture::Wrap wrapOf(int mode) {
  return mode == aiTextureMapMode_Clamp    ? Texture::Wrap::Clamp
         : mode == aiTextureMapMode_Mirror ? Texture::Wrap::Mirror
                                           : Texture::Wrap::Repeat;
}

class LookReader {
 public:
  LookReader(const aiScene& scene, const aiMaterial& material, LooksBuilder& looks)
      : scene_(scene), material_(material), looks_(looks), name_(text(AI_MATKEY_NAME)) {}

  std::optional<Look> read() {
    float metallic = 0;
    isMetallicRoughness_ = material_.Get(AI_MATKEY_METALLIC_FACTOR, metallic) == AI_SUCCESS;
    Look look;
    if (isMetallicRoughness_)
      metallicRoughness(look);
    else
      classic(look);
    aiColor3D glow(0, 0, 0);
    material_.Get(AI_MATKEY_COLOR_EMISSIVE, glow);
    const double emissive[3] = {number(glow.r), number(glow.g), number(glow.b)};
    std::copy(emissive, emissive + 3, look.emissive.begin());
    look.emissiveTexture = texture(aiTextureType_EMISSIVE);
    look.normalTexture = texture(aiTextureType_NORMALS, _AI_MATKEY_GLTF_SCALE_BASE);
    int twoSided = 0;
    if (material_.Get(AI_MATKEY_TWOSIDED, twoSided) == AI_SUCCESS) look.doubleSided = twoSided != 0;
    return look;
  }

 private:
  static double number(float value) {
    return std::isfinite(value) ? std::max(0.0, static_cast<double>(value)) : 0.0;
  }
  std::string text(const char* key, unsigned type, unsigned index) const {
    aiString value;
    material_.Get(key, type, index, value);
    return value.C_Str();
  }
  double factor(const char* key, unsigned type, unsigned index, double fallback) const {
    float value = 0;
    return material_.Get(key, type, index, value) == AI_SUCCESS ? static_cast<double>(value) : fallback;
  }

  void metallicRoughness(Look& look) {
    aiColor4D base(1, 1, 1, 1);
    material_.Get(AI_MATKEY_BASE_COLOR, base);
    colour(base, look);
    look.metallic = inUnit(factor(AI_MATKEY_METALLIC_FACTOR, 1));
    look.roughness = inUnit(factor(AI_MATKEY_ROUGHNESS_FACTOR, 1));
    look.colourTexture = texture(aiTextureType_BASE_COLOR);
    if (look.colourTexture.image < 0) look.colourTexture = texture(aiTextureType_DIFFUSE);
    look.metallicRoughnessTexture = texture(aiTextureType_UNKNOWN);
    look.occlusionTexture = texture(aiTextureType_LIGHTMAP, _AI_MATKEY_GLTF_STRENGTH_BASE);
    const std::string mode = text(AI_MATKEY_GLTF_ALPHAMODE);
    if (mode == "MASK") look.alpha = Look::Alpha::Mask;
    if (mode == "BLEND") look.alpha = Look::Alpha::Blend;
    if (look.alpha == Look::Alpha::Mask) look.alphaCutoff = inUnit(factor(AI_MATKEY_GLTF_ALPHACUTOFF, 0.5));
  }

  /// Diffuse colour and opacity; a rough surface that is no metal.
  void classic(Look& look) {
    aiColor4D diffuse(0.8f, 0.8f, 0.8f, 1);
    material_.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    colour(diffuse, look);
    look.baseColour[3] = inUnit(factor(AI_MATKEY_OPACITY, 1));
    if (look.baseColour[3] < 1) look.alpha = Look::Alpha::Blend;
    look.roughness = 0.9;
    look.colourTexture = texture(aiTextureType_DIFFUSE);
    if (look.colourTexture.image >= 0)
      for (std::size_t c = 0; c < 3; ++c) look.baseColour[c] = 1;
  }

  static void colour(const aiColor4D& from, Look& look) {
    look.baseColour = {inUnit(from.r), inUnit(from.g), inUnit(from.b), inUnit(from.a)};
  }

  /// `strengthKey`: of a factor of the texture's own.
  Texture texture(aiTextureType type, const char* strengthKey = nullptr) {
    Texture texture;
    aiString path;
    if (material_.GetTexture(type, 0, &path) != AI_SUCCESS || path.length == 0) return texture;
    texture.image = image(path.C_Str());
    if (texture.image < 0) return texture;
    int value = 0;
    if (material_.Get(AI_MATKEY_UVWSRC(type, 0), value) == AI_SUCCESS) texture.uvSet = std::max(0, value);
    if (material_.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), value) == AI_SUCCESS) texture.wrapU = wrapOf(value);
    if (material_.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), value) == AI_SUCCESS) texture.wrapV = wrapOf(value);
    if (strengthKey != nullptr) texture.strength = factor(strengthKey, type, 0, 1);
    aiUVTransform transform;
    if (material_.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == AI_SUCCESS && moves(transform))
      looks_.warn("texture '" + std::string(path.C_Str()) + "' of material '" + name_ +
                  "' is moved, turned or scaled; the pieces' files hold it as it is");
    return texture;
  }

  static bool moves(const aiUVTransform& t) {
    const aiUVTransform none;
    return t.mTranslation != none.mTranslation || t.mScaling != none.mScaling || t.mRotation > 0 ||
           t.mRotation < 0;
  }

  Index image(const std::string& path) {
    const aiTexture* inside = scene_.GetEmbeddedTexture(path.c_str());
    if (inside == nullptr) return looks_.imageFile(path, name_);
    if (inside->mHeight != 0) {
      looks_.warn("texture '" + path + "' of material '" + name_ +
                  "' is not encoded (PNG, JPEG); the pieces are written without it");
      return -1;
    }
    return looks_.embedded(path, inside->mFilename.C_Str(),
                           std::string(reinterpret_cast<const char*>(inside->pcData), inside->mWidth), name_);
  }

  const aiScene& scene_;
  const aiMaterial& material_;
  LooksBuilder& looks_;
  std::string name_;
  bool isMetallicRoughness_ = false;
};

}  // namespace

std::optional<Look> lookOf(const aiScene& scene, unsigned material, LooksBuilder& looks) {
  if (material >= scene.mNumMaterials) return std::nullopt;
  return LookReader(scene, *scene.mMaterials[material], looks).read();
}

}  // namespace sherd
