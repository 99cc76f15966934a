#include <fmt/format.h>

#include <functional>
#include <set>

#include "export/piece_files.h"
#include "export/row_table.h"
#include "export/text_buffer.h"

namespace sherd {
namespace {

/// One PLY file in the making: vertices are distinct rows of named doubles, faces carry one integer.
class PlyFile {
 public:
  PlyFile(std::vector<std::string> vertexProperties, std::string faceProperty, std::size_t triangles)
      : properties_(std::move(vertexProperties)),
        faceProperty_(std::move(faceProperty)),
        vertices_(properties_.size(), triangles) {
    faces_.reserve(17 * triangles);
  }

  void comment(const std::string& text) { comments_ << "comment " << text << '\n'; }
  /// `corner(c, row)` appends the values of corner c to `row`.
  void face(const std::function<void(std::size_t, std::vector<double>&)>& corner, Index value) {
    faces_.binary(static_cast<unsigned char>(3));
    for (std::size_t c = 0; c < 3; ++c) {
      row_.clear();
      corner(c, row_);
      for (double& number : row_) number += 0.0;  // −0 is 0
      faces_.binary(vertices_.add(row_.data()));
    }
    if (!faceProperty_.empty()) faces_.binary(value);
    ++count_;
  }
  std::string take() {
    TextBuffer out;
    out << "ply\nformat binary_little_endian 1.0\n" << comments_.take();
    out << "element vertex " << static_cast<std::int64_t>(vertices_.size()) << '\n';
    for (const std::string& name : properties_) out << "property double " << name << '\n';
    out << "element face " << count_ << "\nproperty list uchar int vertex_indices\n";
    if (!faceProperty_.empty()) out << "property int " << faceProperty_ << '\n';
    out << "end_header\n";
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      for (const double number : vertices_.row(v)) out.binary(number);
    out << faces_.take();
    return out.take();
  }

 private:
  std::vector<std::string> properties_;
  std::string faceProperty_;
  RowTable vertices_;
  std::vector<double> row_;
  TextBuffer comments_, faces_;
  std::int64_t count_ = 0;
};

template <class V>
void append(std::vector<double>& row, const V& v) {
  row.insert(row.end(), v.data(), v.data() + v.size());
}

std::string numbered(const char* name, std::size_t set) {
  return set == 0 ? name : name + std::to_string(set);
}

std::vector<std::string> surfaceProperties(const TriMesh& source) {
  std::vector<std::string> names = {"x", "y", "z"};
  if (!source.normals.empty()) names.insert(names.end(), {"nx", "ny", "nz"});
  for (std::size_t i = 0; i < source.uvSets.size(); ++i)
    for (const char* name : {"s", "t"}) names.push_back(numbered(name, i));
  for (std::size_t i = 0; i < source.colorSets.size(); ++i)
    for (const char* name : {"red", "green", "blue", "alpha"}) names.push_back(numbered(name, i));
  return names;
}

void head(PlyFile& file, const Fragments& f, const Piece& piece) {
  file.comment("piece " + piece.name);
  TextBuffer text;
  text << "sherd: unit and axes are those of the source file; 1 unit is "
       << f.tets->surface->frame.metresPerUnit << " m";
  file.comment(text.take());
}

std::string oneLine(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

}  // namespace

std::string surfacePly(const Fragments& f, const Piece& piece) {
  const TriMesh& source = *f.tets->surface;
  const std::vector<Vec3> normals = surfaceNormals(f, piece);
  PlyFile file(surfaceProperties(source), "material_index", piece.surface.size());
  head(file, f, piece);
  for (std::size_t m = 0; m < source.materials.size(); ++m)
    file.comment("material " + std::to_string(m) + " " + oneLine(source.materials[m]));
  const auto outside = static_cast<Index>(source.materials.size());
  bool usesOutside = false;
  for (std::size_t t = 0; t < piece.surface.size(); ++t) usesOutside |= outerMaterial(source, piece, t) < 0;
  if (usesOutside) file.comment("material " + std::to_string(outside) + " " + kOutside);
  for (std::size_t i = 0; i < source.uvSets.size(); ++i)
    file.comment("uv set " + std::to_string(i) + " " + oneLine(source.uvSets[i].name));
  for (std::size_t i = 0; i < source.colorSets.size(); ++i)
    file.comment("colour set " + std::to_string(i) + " " + oneLine(source.colorSets[i].name));
  for (std::size_t t = 0; t < piece.surface.size(); ++t) {
    const auto corner = [&](std::size_t c, std::vector<double>& row) {
      append(row, source.frame.toFile(f.positions[at(piece.surface[t][c])]));
      if (!normals.empty()) append(row, source.frame.directionToFile(normals[3 * t + c]));
      for (const auto& set : source.uvSets) append(row, cornerAttribute(f, piece, t, c, set.uv));
      for (const auto& set : source.colorSets) append(row, cornerAttribute(f, piece, t, c, set.rgba));
    };
    const Index material = outerMaterial(source, piece, t);
    file.face(corner, material < 0 ? outside : material);
  }
  return file.take();
}

std::string crackPly(const Fragments& f, const Piece& piece, const CrackCorners& cracks) {
  const FileFrame& frame = f.tets->surface->frame;
  PlyFile file({"x", "y", "z", "nx", "ny", "nz", "s", "t"}, "neighbour", piece.crack.size());
  head(file, f, piece);
  file.comment(fmt::format("crack faces, all of material {}", kInside));
  const std::set<Index> neighbours(piece.crackNeighbour.begin(), piece.crackNeighbour.end());
  for (const Index neighbour : neighbours)
    file.comment("neighbour " + std::to_string(neighbour) + " " + f.pieces[at(neighbour)].name);
  for (const std::size_t t : crackOrder(piece)) {
    const auto corner = [&](std::size_t c, std::vector<double>& row) {
      append(row, frame.toFile(f.positions[at(piece.crack[t][c])]));
      append(row, frame.directionToFile(cracks.normals[3 * t + c]));
      append(row, cracks.uvs[3 * t + c]);
    };
    file.face(corner, piece.crackNeighbour[t]);
  }
  return file.take();
}

}  // namespace sherd
