// A small model with all that materials can have: a crate as a GLB file, with two pictures in it, and as OBJ
// with a material library and pictures beside it.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace sherd::test {

inline std::string bytesOfHex(const char* hex) {
  std::string bytes;
  for (; hex[0] != 0; hex += 2) bytes += static_cast<char>(std::stoi(std::string(hex, 2), nullptr, 16));
  return bytes;
}

/// PNG pictures: 2 × 2 pixels in four colours, and 2 × 1 in that of a flat normal map.
inline std::string planksPng() {
  return bytesOfHex(
      "89504e470d0a1a0a0000000d4948445200000002000000020802000000fdd49a73000000144944415478da63f8cfc0c0"
      "00c20cffffff6700001eef04fc731c53cc0000000049454e44ae426082");
}
inline std::string dentsPng() {
  return bytesOfHex(
      "89504e470d0a1a0a0000000d49484452000000020000000108020000007b40e8dd0000000d4944415478da636868f80f"
      "44000d0203ff41f82c0e0000000049454e44ae426082");
}

/// The crate's 24 vertices, four to a side; its size is 0.6 × 0.3 × 0.4 m. UVs as glTF has them, v down.
struct Crate {
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<float, 2>> uvs, dentUvs;
  std::vector<std::array<float, 4>> colours;  ///< by the place, from 0 to 1

  Crate() {
    const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const std::array<float, 2> corners[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (int side = 0; side < 6; ++side)
      for (int k = 0; k < 4; ++k) {
        const int i = sides[side][k];
        const float x = i & 1 ? 1.f : 0.f, y = i & 2 ? 1.f : 0.f, z = i & 4 ? 1.f : 0.f;
        std::array<float, 3> normal{};
        normal[static_cast<std::size_t>(side / 2)] = side % 2 ? 1.f : -1.f;
        positions.push_back({0.6f * x, 0.3f * y, 0.4f * z});
        normals.push_back(normal);
        uvs.push_back(corners[k]);
        dentUvs.push_back({0.5f * corners[k][0], 0.25f + 0.5f * corners[k][1]});
        colours.push_back({x, y, z, 1});
      }
  }
  /// Triangles of the sides [first, last).
  static std::vector<std::uint16_t> indices(int first, int last) {
    std::vector<std::uint16_t> list;
    for (int side = first; side < last; ++side)
      for (const int k : {0, 1, 2, 0, 2, 3}) list.push_back(static_cast<std::uint16_t>(4 * side + k));
    return list;
  }
};

/// The crate as GLB: five sides of material `planks`, one of `lid`.
inline void writeCrateGlb(const std::string& path) {
  const Crate crate;
  std::string binary, views;
  const auto view = [&](const void* data, std::size_t size) {
    views += std::string(views.empty() ? "" : ",") +
             "{\"buffer\":0,\"byteOffset\":" + std::to_string(binary.size()) +
             ",\"byteLength\":" + std::to_string(size) + "}";
    binary.append(static_cast<const char*>(data), size);
    binary.resize((binary.size() + 3) / 4 * 4);
  };
  const auto list = [&](const auto& values) { view(values.data(), values.size() * sizeof values[0]); };
  list(crate.positions), list(crate.normals), list(crate.uvs), list(crate.dentUvs), list(crate.colours);
  list(Crate::indices(0, 5)), list(Crate::indices(5, 6));
  const std::string planks = planksPng(), dents = dentsPng();
  view(planks.data(), planks.size()), view(dents.data(), dents.size());
  const std::string attributes =
      R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"TEXCOORD_1":3,"COLOR_0":4})";
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[)" +
                     attributes + R"(,"indices":5,"material":0},)" + attributes +
                     R"(,"indices":6,"material":1}]}],
"accessors":[
{"bufferView":0,"componentType":5126,"count":24,"type":"VEC3","min":[0,0,0],"max":[0.6,0.3,0.4]},
{"bufferView":1,"componentType":5126,"count":24,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":24,"type":"VEC2"},
{"bufferView":3,"componentType":5126,"count":24,"type":"VEC2"},
{"bufferView":4,"componentType":5126,"count":24,"type":"VEC4"},
{"bufferView":5,"componentType":5123,"count":30,"type":"SCALAR"},
{"bufferView":6,"componentType":5123,"count":6,"type":"SCALAR"}],
"images":[{"name":"planks","mimeType":"image/png","bufferView":7},{"name":"dents","mimeType":"image/png","bufferView":8}],
"samplers":[{"wrapS":33071,"wrapT":33648}],
"textures":[{"source":0},{"source":1,"sampler":0}],
"materials":[
{"name":"planks","doubleSided":true,"emissiveFactor":[0.25,0,0.5],
"normalTexture":{"index":1,"texCoord":1,"scale":0.5},
"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0.25,"roughnessFactor":0.75,
"baseColorTexture":{"index":0}}},
{"name":"lid","alphaMode":"MASK","alphaCutoff":0.25,
"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5],"metallicFactor":1,"roughnessFactor":0.125}}],
"buffers":[{"byteLength":)" +
                     std::to_string(binary.size()) + R"(}],"bufferViews":[)" + views + "]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  const auto word = [&](std::size_t number) {
    const auto narrow = static_cast<std::uint32_t>(number);
    file.append(reinterpret_cast<const char*>(&narrow), sizeof narrow);
  };
  word(2), word(28 + json.size() + binary.size()), word(json.size());
  file += "JSON" + json;
  word(binary.size());
  file.append("BIN\0", 4);
  std::ofstream(path, std::ios::binary) << file << binary;
}

/// The library of crate.obj. `moreWood`: statements that follow the first material's.
inline std::string crateMtl(const std::string& moreWood = "") {
  return "# by hand\nnewmtl wood\nKa 0 0 0\nKd 0.5 0.25 1\nNs 250\nillum 2\nmap_Kd -clamp on planks of "
         "oak.png\n"
         "map_Bump -bm 0.3 dents.png\n" +
         moreWood + "\nnewmtl glass\nKd 0.1 0.2 0.3\nTr 0.75\nPr 0.125\nPm 1\nKe 0 0.5 0\n";
}

/// The crate in `directory` as crate.obj, crate.mtl, "planks of oak.png" and dents.png.
inline void writeCrateObj(const std::string& directory, const std::string& moreWood = "") {
  const Crate crate;
  std::ofstream obj(directory + "/crate.obj");
  obj << "mtllib crate.mtl\n";
  for (const auto& p : crate.positions) obj << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& uv : crate.uvs) obj << "vt " << uv[0] << ' ' << 1 - uv[1] << '\n';
  for (const auto& n : crate.normals) obj << "vn " << n[0] << ' ' << n[1] << ' ' << n[2] << '\n';
  for (int side = 0; side < 6; ++side) {
    if (side == 0) obj << "usemtl wood\n";
    if (side == 5) obj << "usemtl glass\n";
    obj << 'f';
    for (int k = 1; k <= 4; ++k) obj << ' ' << 4 * side + k << '/' << 4 * side + k << '/' << 4 * side + k;
    obj << '\n';
  }
  std::ofstream(directory + "/crate.mtl") << crateMtl(moreWood);
  std::ofstream(directory + "/planks of oak.png", std::ios::binary) << planksPng();
  std::ofstream(directory + "/dents.png", std::ios::binary) << dentsPng();
}

}  // namespace sherd::test
