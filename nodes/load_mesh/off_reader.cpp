// OFF (Geomview's object file format), text, three dimensions: [ST][C][N]OFF. One vertex and one face per
// line. A face's own colour, behind its corners, is not kept.
#include <limits>
#include <string>

#include "load_mesh/file_mesh.h"
#include "load_mesh/polygon_fan.h"
#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

constexpr long long kMost = std::numeric_limits<Index>::max();

class OffReader {
 public:
  OffReader(std::string_view content, const Exec& exec)
      : scan_(content, TextScanner::CloseComments), exec_(exec) {}

  Result<FileMesh> read() {
    SHERD_CHECK(header());
    for (long long i = 0; i < vertexCount_ && !exec_.cancelled(); ++i) SHERD_CHECK(vertex());
    for (long long i = 0; i < faceCount_ && !exec_.cancelled(); ++i) SHERD_CHECK(face());
    if (exec_.cancelled()) return cancelledError();
    return assemble();
  }

 private:
  // The keyword and the counts of vertices, faces and edges, on one line or several. The last is often left
  // out.
  Result<void> header() {
    std::string_view keyword = scan_.wordOnAnyLine();
    const std::string_view whole = keyword;
    const auto take = [&](std::string_view prefix) {
      const bool there = keyword.starts_with(prefix);
      if (there) keyword.remove_prefix(prefix.size());
      return there;
    };
    hasUv_ = take("ST");
    hasColor_ = take("C");
    hasNormal_ = take("N");
    if (keyword == "4OFF" || keyword == "nOFF" || keyword == "4nOFF") {
      return scan_.error(quoted(whole) + " has vertices that are not three-dimensional",
                         "OFF, COFF, NOFF or CNOFF");
    }
    if (keyword != "OFF")
      return scan_.error("this is no OFF file",
                         "one starts with OFF, COFF, NOFF or CNOFF; if this is another format, rename the "
                         "file to its extension");
    std::string_view first = scan_.wordOnAnyLine();
    if (first == "BINARY") return scan_.error("binary OFF is not read", "save it as text, or as binary PLY");
    SHERD_CHECK(count(first, "vertices", vertexCount_));
    SHERD_CHECK(count(scan_.wordOnAnyLine(), "faces", faceCount_));
    scan_.nextLine();
    if (faceCount_ == 0) return failure("the OFF file has no faces", "export the model as a polygon mesh");
    return {};
  }

  Result<void> count(std::string_view word, const char* kind, long long& value) const {
    if (parseInteger(word, value) && value >= 0 && value < kMost) return {};
    return scan_.error(
        (word.empty() ? std::string("the file ends here") : quoted(word) + " is no number of ") +
            (word.empty() ? "" : kind),
        std::string("behind OFF stand the numbers of vertices, faces and edges; the ") + kind +
            " are missing");
  }

  // Goes to the next line that holds something and gives its first word; empty at the file's end.
  std::string_view firstWord() { return scan_.wordOnAnyLine(); }

  Error wrongNumber(std::string_view word, const char* where) const {
    if (!word.empty()) return scan_.error(quoted(word) + " is not a number", kNumberRemedy);
    return scan_.error(std::string("the file or the line ends within ") + where,
                       "the file may be cut off, or its counts may be wrong");
  }

  // x y z [nx ny nz] [r g b [a]] [s t], each part as the keyword says. What else the line holds is passed
  // over.
  Result<void> vertex() {
    double n[12];
    const int fixed = 3 + (hasNormal_ ? 3 : 0), uv = hasUv_ ? 2 : 0;
    const int least = fixed + (hasColor_ ? 3 : 0) + uv, most = least + (hasColor_ ? 1 : 0);
    int found = 0;
    std::string_view w = firstWord();
    for (; found < most && !w.empty(); w = scan_.word()) {
      if (!parseNumber(w, n[found])) return wrongNumber(w, "a vertex");
      ++found;
    }
    if (found < least) return wrongNumber({}, "a vertex");
    positions_.emplace_back(n[0], n[1], n[2]);
    if (hasNormal_) normals_.emplace_back(n[3], n[4], n[5]);
    if (hasColor_) {
      const double* c = n + fixed;
      const bool hasAlpha = found == most;
      colors_.emplace_back(c[0], c[1], c[2], hasAlpha ? c[3] : -1);
      colorsAreBytes_ = colorsAreBytes_ || c[0] > 1 || c[1] > 1 || c[2] > 1 || (hasAlpha && c[3] > 1);
    }
    if (hasUv_) uvs_.emplace_back(n[found - 2], n[found - 1]);
    scan_.nextLine();
    return {};
  }

  Result<void> face() {
    const std::string_view digits = firstWord();
    long long corners = 0;
    if (!parseInteger(digits, corners)) return wrongNumber(digits, "the faces");
    if (corners < 3)
      return scan_.error("a face with " + std::to_string(corners) + " corners", "a face needs at least 3");
    for (long long i = 0; i < corners; ++i) {
      const std::string_view w = scan_.word();
      long long v = 0;
      if (!parseInteger(w, v)) return wrongNumber(w, "a face");
      if (v < 0 || v >= vertexCount_) {
        return scan_.error("there is no vertex " + std::to_string(v),
                           "vertices are numbered from 0 to " + std::to_string(vertexCount_ - 1));
      }
      polygons_.vertices.push_back(static_cast<Index>(v));
    }
    if (static_cast<long long>(polygons_.vertices.size()) > kMost) {
      return scan_.error("more face corners than can be numbered (2147483647)", "split the model");
    }
    polygons_.close();
    scan_.nextLine();
    return {};
  }

  // Colours are reals up to 1 or integers up to 255, and nothing says which: one above 1 makes all of them
  // the latter.
  void finishColors() {
    const double full = colorsAreBytes_ ? 255 : 1;
    for (Vec4& c : colors_) {
      if (c[3] < 0) c[3] = full;
      c /= full;
    }
  }

  Result<FileMesh> assemble() {
    FileMesh file;
    TriMesh& mesh = file.mesh;
    PolygonTriangles split = triangulate(polygons_, positions_);
    mesh.positions = std::move(positions_);
    mesh.triangles = std::move(split.triangles);
    finishColors();
    if (hasUv_) mesh.uvSets.push_back({"uv", perCorner(mesh.triangles, uvs_)});
    if (hasColor_) mesh.colorSets.push_back({"color", perCorner(mesh.triangles, colors_)});
    if (hasNormal_) mesh.normals = perCorner(mesh.triangles, normals_);
    finishNormals(mesh);
    return file;
  }

  TextScanner scan_;
  const Exec& exec_;
  bool hasUv_ = false, hasColor_ = false, hasNormal_ = false, colorsAreBytes_ = false;
  long long vertexCount_ = 0, faceCount_ = 0;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<Vec4> colors_;  ///< as in the file; alpha −1 where it is left out
  Polygons polygons_;
};

}  // namespace

Result<FileMesh> readOff(std::string_view content, const Exec& exec) {
  return OffReader(withoutByteOrderMark(content), exec).read();
}

}  // namespace sherd
