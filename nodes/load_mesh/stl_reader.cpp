// STL, ascii and binary. Facet normals are not kept: they say no more than the triangles do, and often less.
// Each facet brings three vertices of its own, since the format knows no shared ones.
#include <bit>
#include <cstring>
#include <limits>
#include <string>

#include "load_mesh/file_mesh.h"
#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;
constexpr std::size_t kMostFacets = static_cast<std::size_t>(std::numeric_limits<Index>::max()) / 3;

std::uint32_t littleEndian32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

Vec3 vertexAt(const char* bytes) {
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = static_cast<double>(std::bit_cast<float>(littleEndian32(bytes + 4 * i)));
  return p;
}

void addFacet(TriMesh& mesh, const Vec3 (&corners)[3]) {
  const Index first = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), std::begin(corners), std::end(corners));
  mesh.triangles.push_back({first, first + 1, first + 2});
}

Result<FileMesh> readBinary(std::string_view content, std::size_t count) {
  if (count > kMostFacets)
    return failure("binary STL with more triangles than can be numbered", "split the model");
  FileMesh file;
  file.mesh.positions.reserve(3 * count);
  file.mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* facet = content.data() + kHeader + kFacet * i + 12;  // behind the facet's normal
    addFacet(file.mesh, {vertexAt(facet), vertexAt(facet + 12), vertexAt(facet + 24)});
  }
  return file;
}

class AsciiStl {
 public:
  AsciiStl(std::string_view content, const Exec& exec) : scan_(content), exec_(exec) {}

  Result<FileMesh> read() {
    for (std::string_view w = scan_.wordOnAnyLine(); !w.empty(); w = scan_.wordOnAnyLine()) {
      if (!is(w, "solid")) return unexpected(w, "solid");
      scan_.nextLine();  // the solid's name
      SHERD_CHECK(solid());
      scan_.nextLine();  // its name again
    }
    return std::move(file_);
  }

 private:
  static bool is(std::string_view word, std::string_view keyword) {
    if (word.size() != keyword.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
      const char c = word[i] >= 'A' && word[i] <= 'Z' ? static_cast<char>(word[i] - 'A' + 'a') : word[i];
      if (c != keyword[i]) return false;
    }
    return true;
  }

  Error unexpected(std::string_view word, const char* wanted) const {
    const std::string remedy = std::string("expected ") + wanted + "; the file may be cut off or damaged";
    return scan_.error(
        word.empty() ? std::string("the file ends here") : quoted(word) + " is not what STL has here",
        remedy);
  }

  Result<void> expect(const char* keyword) {
    const std::string_view w = scan_.wordOnAnyLine();
    if (is(w, keyword)) return {};
    return unexpected(w, keyword);
  }

  Result<void> point(Vec3& p) {
    for (int i = 0; i < 3; ++i) {
      const std::string_view w = scan_.wordOnAnyLine();
      if (!parseNumber(w, p[i])) return unexpected(w, "a number");
    }
    return {};
  }

  Result<void> solid() {
    for (;;) {
      if (exec_.cancelled()) return cancelledError();
      const std::string_view w = scan_.wordOnAnyLine();
      if (is(w, "endsolid")) return {};
      if (!is(w, "facet")) return unexpected(w, "facet or endsolid");
      SHERD_CHECK(facet());
    }
  }

  Result<void> facet() {
    if (file_.mesh.triangles.size() == kMostFacets)
      return scan_.error("more triangles than can be numbered", "split the model");
    Vec3 normal, corners[3];
    SHERD_CHECK(expect("normal"));
    SHERD_CHECK(point(normal));
    SHERD_CHECK(expect("outer"));
    SHERD_CHECK(expect("loop"));
    for (Vec3& corner : corners) {
      SHERD_CHECK(expect("vertex"));
      SHERD_CHECK(point(corner));
    }
    SHERD_CHECK(expect("endloop"));
    SHERD_CHECK(expect("endfacet"));
    addFacet(file_.mesh, corners);
    return {};
  }

  TextScanner scan_;
  const Exec& exec_;
  FileMesh file_;
};

bool startsAsAscii(std::string_view content) {
  const std::string_view w = TextScanner(content.substr(0, 4096)).wordOnAnyLine();
  return w == "solid" || w == "SOLID";
}

Result<FileMesh> readEither(std::string_view content, const Exec& exec) {
  const bool hasHeader = content.size() >= kHeader;
  const std::size_t count = hasHeader ? littleEndian32(content.data() + 80) : 0;
  const std::size_t size = kHeader + kFacet * count;
  // Binary files may start with "solid" too, so the size decides first: no ascii file has it, since four
  // printable characters as a count make it 27 GB at least.
  if (hasHeader && content.size() == size) return readBinary(content, count);
  const std::string_view text = withoutByteOrderMark(content);
  if (startsAsAscii(text)) return AsciiStl(text, exec).read();
  if (!hasHeader) {
    return failure(
        "an STL file of " + std::to_string(content.size()) + " bytes",
        "ascii STL starts with 'solid', binary STL has at least 84 bytes; the file may be cut off");
  }
  return failure("byte 80: a binary STL file with " + std::to_string(count) + " triangles has " +
                     std::to_string(size) + " bytes, this one has " + std::to_string(content.size()),
                 "the file may be cut off or damaged; export it again");
}

}  // namespace

Result<FileMesh> readStl(std::string_view content, const Exec& exec) {
  Result<FileMesh> file = readEither(content, exec);
  if (file.ok() && file->mesh.triangles.empty()) {
    return failure("the STL file has no triangles", "export the model as a triangle mesh");
  }
  return file;
}

}  // namespace sherd
