// Wavefront OBJ, polygons only.
#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>

#include "load_mesh/file_mesh.h"
#include "load_mesh/polygon_fan.h"
#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

constexpr std::size_t kMostEntries = static_cast<std::size_t>(std::numeric_limits<Index>::max());

// Statements that say nothing about the surface's shape or attributes.
constexpr std::string_view kIgnored[] = {
    "g",    "o",        "s",        "l",      "p",          "vp",        "mg",    "usemap", "maplib", "bevel",
    "lod",  "c_interp", "d_interp", "cstype", "deg",        "bmat",      "step",  "parm",   "trim",   "hole",
    "scrv", "sp",       "end",      "con",    "shadow_obj", "trace_obj", "ctech", "stech",  "call",   "csh"};

class ObjReader {
 public:
  ObjReader(std::string_view content, const Exec& exec)
      : scan_(withoutByteOrderMark(content), TextScanner::Comments | TextScanner::Joins), exec_(exec) {}

  Result<FileMesh> read() {
    for (; !scan_.atEnd(); scan_.nextLine()) {
      if (exec_.cancelled()) return cancelledError();
      const std::string_view keyword = scan_.word();
      if (!keyword.empty()) SHERD_CHECK(statement(keyword));
    }
    if (polygons_.size() == 0) {
      return failure("the OBJ file has no faces (" + std::to_string(positions_.size()) + " vertices)",
                     "export the model as a polygon mesh, with lines such as 'f 1 2 3'");
    }
    SHERD_CHECK(checkForwardReferences());
    return assemble();
  }

 private:
  struct Corner {
    Index uv = -1, normal = -1;
  };
  enum Kind { Vertex, Uv, Normal };
  static constexpr const char* kKindName[] = {"vertex", "texture vertex", "vertex normal"};
  /// The largest number of a kind that a face named before its entry was there.
  struct Forward {
    Index largest = -1;
    TextScanner where{{}};
  };

  Result<void> statement(std::string_view keyword) {
    if (keyword == "v") return vertex();
    if (keyword == "vt") return textureVertex();
    if (keyword == "vn") return vertexNormal();
    if (keyword == "f" || keyword == "fo") return face();
    if (keyword == "usemtl") return useMaterial();
    if (keyword == "mtllib") {
      libraries_.emplace_back(scan_.rest());
      return {};
    }
    if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
      return scan_.error("free-form geometry (" + quoted(keyword) + ") is not read", "export polygons");
    }
    if (std::find(std::begin(kIgnored), std::end(kIgnored), keyword) != std::end(kIgnored)) return {};
    return scan_.error(quoted(keyword) + " is no OBJ statement",
                       "expected v, vt, vn, f, usemtl, g, o, s or a comment; is the file damaged?");
  }

  // Reads up to `most` numbers, which must be all that the line holds.
  Result<int> numbers(const char* statement, int least, int most, double* values) {
    int count = 0;
    for (std::string_view w = scan_.word(); !w.empty(); w = scan_.word(), ++count) {
      if (count == most) {
        return scan_.error(
            std::string("more than ") + std::to_string(most) + " numbers behind '" + statement + "'",
            "from " + std::to_string(least) + " to " + std::to_string(most) +
                " are expected; the file may be damaged, export it again");
      }
      if (!parseNumber(w, values[count])) return scan_.error(quoted(w) + " is not a number", kNumberRemedy);
    }
    if (count >= least) return count;
    return scan_.error(std::string("'") + statement + "' has " + std::to_string(count) + " numbers where " +
                           std::to_string(least) + " are needed",
                       "the file may be cut off or damaged");
  }

  Result<void> full(std::size_t size) const {
    if (size < kMostEntries) return {};
    return scan_.error("more entries than can be numbered (2147483647)", "split the model");
  }

  Result<void> vertex() {
    double n[7];
    SHERD_ASSIGN(const int count, numbers("v", 3, 7, n));
    if (count == 5)
      return scan_.error("'v' has 5 numbers", "3 (position), 4 (and a weight), 6 or 7 (and a colour)");
    SHERD_CHECK(full(positions_.size()));
    positions_.emplace_back(n[0], n[1], n[2]);
    if (count >= 6) {
      colors_.resize(positions_.size() - 1, Vec4::Ones());
      colors_.emplace_back(n[3], n[4], n[5], count == 7 ? n[6] : 1);
    }
    return {};
  }

  Result<void> textureVertex() {
    double n[3] = {0, 0, 0};
    SHERD_CHECK(numbers("vt", 1, 3, n));
    SHERD_CHECK(full(uvs_.size()));
    uvs_.emplace_back(n[0], n[1]);
    return {};
  }

  Result<void> vertexNormal() {
    double n[3];
    SHERD_CHECK(numbers("vn", 3, 3, n));
    SHERD_CHECK(full(normals_.size()));
    normals_.emplace_back(n[0], n[1], n[2]);
    return {};
  }

  Result<void> useMaterial() {
    materialNow_ = material(std::string(scan_.rest()));
    return {};
  }

  Index material(const std::string& name) {
    const auto [entry, isNew] = materialNumber_.try_emplace(name, static_cast<Index>(materials_.size()));
    if (isNew) materials_.push_back(name);
    return entry->second;
  }

  Result<void> face() {
    const std::size_t first = polygons_.vertices.size();
    for (std::string_view w = scan_.word(); !w.empty(); w = scan_.word()) SHERD_CHECK(corner(w));
    const std::size_t count = polygons_.vertices.size() - first;
    if (count < 3) {
      return scan_.error("a face with " + std::to_string(count) + (count == 1 ? " corner" : " corners"),
                         "a face needs at least 3; the file may be cut off");
    }
    polygons_.close();
    materialOf_.push_back(materialNow_);
    return {};
  }

  // v, v/vt, v//vn or v/vt/vn.
  Result<void> corner(std::string_view word) {
    SHERD_CHECK(full(polygons_.vertices.size()));
    Index vertex = -1;
    Corner c;
    const std::size_t slash = std::min(word.find('/'), word.size());
    const std::size_t second = std::min(word.find('/', slash + 1), word.size());
    const std::string_view uv =
        slash < word.size() ? word.substr(slash + 1, second - slash - 1) : std::string_view();
    const std::string_view normal = second < word.size() ? word.substr(second + 1) : std::string_view();
    SHERD_CHECK(reference(word, word.substr(0, slash), Vertex, vertex));
    if (!uv.empty()) SHERD_CHECK(reference(word, uv, Uv, c.uv));
    if (!normal.empty()) SHERD_CHECK(reference(word, normal, Normal, c.normal));
    polygons_.vertices.push_back(vertex);
    corners_.push_back(c);
    anyUv_ = anyUv_ || c.uv >= 0;
    anyNormal_ = anyNormal_ || c.normal >= 0;
    return {};
  }

  std::size_t entries(Kind kind) const {
    return kind == Vertex ? positions_.size() : kind == Uv ? uvs_.size() : normals_.size();
  }

  Error noSuchEntry(const TextScanner& where, Kind kind, long long number) const {
    return where.error("there is no " + std::string(kKindName[kind]) + " " + std::to_string(number) +
                           ", the file has " + std::to_string(entries(kind)),
                       number == 0 ? "numbers start at 1" : "the file may be cut off or damaged");
  }

  // Numbers count from 1, or backwards from the last entry so far. One that is still to come is allowed.
  Result<void> reference(std::string_view word, std::string_view digits, Kind kind, Index& index) {
    long long number = 0;
    if (!parseInteger(digits, number)) {
      return scan_.error(quoted(word) + " is no corner of a face", "expected v, v/vt, v//vn or v/vt/vn");
    }
    const long long soFar = static_cast<long long>(entries(kind));
    const long long found = number < 0 ? soFar + number : number - 1;
    if (number == 0 || found < 0 || found >= static_cast<long long>(kMostEntries)) {
      return noSuchEntry(scan_, kind, number);
    }
    index = static_cast<Index>(found);
    if (found >= soFar && index > forward_[kind].largest) forward_[kind] = {index, scan_};
    return {};
  }

  Result<void> checkForwardReferences() const {
    for (Kind kind : {Vertex, Uv, Normal}) {
      const Forward& forward = forward_[kind];
      if (forward.largest >= static_cast<long long>(entries(kind))) {
        return noSuchEntry(forward.where, kind, forward.largest + 1LL);
      }
    }
    return {};
  }

  // A corner without a texture vertex where others have one gets (0, 0); one without a normal its triangle's.
  Result<FileMesh> assemble() {
    FileMesh file;
    TriMesh& mesh = file.mesh;
    PolygonTriangles split = triangulate(polygons_, positions_);
    mesh.positions = std::move(positions_);
    mesh.triangles = std::move(split.triangles);
    if (anyUv_) mesh.uvSets.push_back({"uv", {}});
    for (Index c : split.cornerOf) {
      const Corner& corner = corners_[at(c)];
      if (anyUv_) mesh.uvSets[0].uv.push_back(corner.uv < 0 ? Vec2(0, 0) : uvs_[at(corner.uv)]);
      if (anyNormal_) mesh.normals.push_back(corner.normal < 0 ? Vec3(0, 0, 0) : normals_[at(corner.normal)]);
    }
    finishNormals(mesh);
    assembleColors(mesh);
    assembleMaterials(mesh, split);
    file.materialLibraries = std::move(libraries_);
    return file;
  }

  // Vertices without a colour where others have one are white.
  void assembleColors(TriMesh& mesh) {
    if (colors_.empty()) return;
    colors_.resize(mesh.positions.size(), Vec4::Ones());
    mesh.colorSets.push_back({"color", perCorner(mesh.triangles, colors_)});
  }

  // Faces before the first usemtl have the material without a name.
  void assembleMaterials(TriMesh& mesh, const PolygonTriangles& split) {
    if (materials_.empty()) return;
    for (Index& m : materialOf_) {
      if (m < 0) m = material("");
    }
    mesh.materials = std::move(materials_);
    mesh.materialOf.reserve(split.polygonOf.size());
    for (Index p : split.polygonOf) mesh.materialOf.push_back(materialOf_[at(p)]);
  }

  TextScanner scan_;
  const Exec& exec_;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<Vec4> colors_;  ///< per position; may end early
  Polygons polygons_;
  std::vector<Corner> corners_;  ///< along polygons_.vertices
  std::vector<Index> materialOf_;
  Index materialNow_ = -1;
  std::vector<std::string> materials_, libraries_;
  std::unordered_map<std::string, Index> materialNumber_;
  Forward forward_[3];
  bool anyUv_ = false, anyNormal_ = false;
};

}  // namespace

Result<FileMesh> readObj(std::string_view content, const Exec& exec) {
  return ObjReader(content, exec).read();
}

}  // namespace sherd
