#include <algorithm>
#include <numeric>

#include "export/piece_files.h"
#include "export/row_table.h"
#include "export/text_buffer.h"

namespace sherd {
namespace {

/// Indexed corner values of one kind and the lines that list them.
template <int N>
class Lines {
 public:
  Lines(std::string_view key, std::size_t expected) : key_(key), table_(N, expected) {}
  /// The value's number in an OBJ file, from 1.
  std::int64_t add(const Eigen::Matrix<double, N, 1>& v) {
    const Eigen::Matrix<double, N, 1> positive = v.array() + 0.0;  // −0 is written as 0, so it is the same
    return table_.add(positive.data()) + std::int64_t{1};
  }
  void write(TextBuffer& out) const {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const Eigen::Matrix<double, N, 1> value(table_.row(i).data());
      out.row(key_, value);
    }
  }

 private:
  std::string_view key_;
  RowTable table_;
};

void head(TextBuffer& out, const Fragments& f, const std::string& object, const char* what) {
  out.reserve(256);
  out << "# sherd: " << what << ". Unit and axes are those of the source file; 1 unit is ";
  out << f.tets->surface->frame.metresPerUnit << " m.\no " << object << '\n';
}

/// A name as OBJ can hold it: on one line, and not empty.
std::string objName(const std::string& name) {
  std::string clean = name;
  for (char& c : clean)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  return clean.empty() ? "unnamed" : clean;
}

}  // namespace

std::vector<std::size_t> crackOrder(const Piece& piece) {
  std::vector<std::size_t> order(piece.crack.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return piece.crackNeighbour[a] < piece.crackNeighbour[b];
  });
  return order;
}

std::string surfaceObj(const Fragments& f, const Piece& piece) {
  const TriMesh& source = *f.tets->surface;
  const std::vector<Vec3> normals = surfaceNormals(f, piece);
  const std::size_t count = piece.surface.size();
  const bool hasUv = !source.uvSets.empty();
  Lines<3> positions("v", count / 2), directions("vn", normals.empty() ? 0 : count / 2);
  Lines<2> uvs("vt", hasUv ? count / 2 : 0);
  TextBuffer faces;
  faces.reserve(40 * count);
  Index material = -2;
  for (std::size_t t = 0; t < count; ++t) {
    const Index wanted = outerMaterial(source, piece, t);
    // The group comes last: whatever the material is called (`inside`, where an earlier fracture made it), in
    // this fracture these faces are skin.
    if (wanted != material)
      faces << "usemtl " << (wanted < 0 ? kOutside : objName(source.materials[at(wanted)])) << "\ng "
            << piece.name << '\n';
    material = wanted;
    faces << 'f';
    for (std::size_t c = 0; c < 3; ++c) {
      faces << ' ' << positions.add(source.frame.toFile(f.positions[at(piece.surface[t][c])]));
      if (hasUv) faces << '/' << uvs.add(cornerAttribute(f, piece, t, c, source.uvSets.front().uv));
      if (!normals.empty())
        faces << (hasUv ? "/" : "//") << directions.add(source.frame.directionToFile(normals[3 * t + c]));
    }
    faces << '\n';
  }
  TextBuffer out;
  head(out, f, piece.name + "_surface", "outer skin of a piece");
  out.reserve(120 * count);
  positions.write(out);
  uvs.write(out);
  directions.write(out);
  out << faces.take();
  return out.take();
}

std::string crackObj(const Fragments& f, const Piece& piece, const CrackCorners& cracks) {
  const FileFrame& frame = f.tets->surface->frame;
  const std::size_t count = piece.crack.size();
  Lines<3> positions("v", count / 2), directions("vn", count);
  Lines<2> uvs("vt", count);
  TextBuffer faces;
  faces.reserve(50 * count);
  Index neighbour = -1;
  for (const std::size_t t : crackOrder(piece)) {
    if (piece.crackNeighbour[t] != neighbour) {
      neighbour = piece.crackNeighbour[t];
      faces << "usemtl " << kInside << "\ng " << piece.name << "_crack_with_" << f.pieces[at(neighbour)].name
            << '\n';
    }
    faces << 'f';
    for (std::size_t c = 0; c < 3; ++c) {
      faces << ' ' << positions.add(frame.toFile(f.positions[at(piece.crack[t][c])]));
      faces << '/' << uvs.add(cracks.uvs[3 * t + c]);
      faces << '/' << directions.add(frame.directionToFile(cracks.normals[3 * t + c]));
    }
    faces << '\n';
  }
  TextBuffer out;
  head(out, f, piece.name + "_crack", "crack faces of a piece");
  out.reserve(150 * count);
  positions.write(out);
  uvs.write(out);
  directions.write(out);
  out << faces.take();
  return out.take();
}

}  // namespace sherd
