// PLY, ascii and binary in both byte orders. Vertices with normals, texture coordinates and colours; faces
// with or without texture coordinates per corner; all other elements and properties are passed over.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "load_mesh/file_mesh.h"
#include "load_mesh/ply_header.h"
#include "load_mesh/polygon_fan.h"
#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

using Type = PlyHeader::Type;

// Values of an ascii body, one word each.
class AsciiBody {
 public:
  AsciiBody(std::string_view body, std::size_t firstLine) : scan_(body), firstLine_(firstLine) {}

  bool next(Type, double& value) {
    word_ = scan_.wordOnAnyLine();
    return parseNumber(word_, value);
  }
  /// At least this many bytes are still to come for `count` values.
  bool holds(Type, double) const { return true; }
  Error wrongValue() const {
    if (word_.empty())
      return failure(where() + "the file ends too early", "the file is cut off or its counts are wrong");
    return failure(where() + quoted(word_) + " is not a number", kNumberRemedy);
  }
  std::string where() const { return "line " + std::to_string(firstLine_ + scan_.line() - 1) + ": "; }

 private:
  TextScanner scan_;
  std::size_t firstLine_;
  std::string_view word_;
};

// Values of a binary body, in the order of bytes of this machine or the other.
class BinaryBody {
 public:
  BinaryBody(std::string_view content, std::size_t offset, bool bigEndian)
      : content_(content), offset_(offset), swap_(bigEndian != (std::endian::native == std::endian::big)) {}

  bool next(Type type, double& value) {
    const std::size_t size = sizeOf(type);
    if (content_.size() - offset_ < size) return false;
    unsigned char bytes[8];
    for (std::size_t i = 0; i < size; ++i) {
      bytes[swap_ ? size - 1 - i : i] = static_cast<unsigned char>(content_[offset_ + i]);
    }
    offset_ += size;
    switch (type) {
      case Type::Int8:
        value = as<std::int8_t>(bytes);
        break;
      case Type::Uint8:
        value = as<std::uint8_t>(bytes);
        break;
      case Type::Int16:
        value = as<std::int16_t>(bytes);
        break;
      case Type::Uint16:
        value = as<std::uint16_t>(bytes);
        break;
      case Type::Int32:
        value = as<std::int32_t>(bytes);
        break;
      case Type::Uint32:
        value = as<std::uint32_t>(bytes);
        break;
      case Type::Float32:
        value = static_cast<double>(as<float>(bytes));
        break;
      case Type::Float64:
        value = as<double>(bytes);
        break;
    }
    return true;
  }
  bool holds(Type type, double count) const {
    return count * static_cast<double>(sizeOf(type)) <= static_cast<double>(content_.size() - offset_);
  }
  Error wrongValue() const {
    return failure(where() + "the file ends too early", "the file is cut off or its counts are wrong");
  }
  std::string where() const { return "byte " + std::to_string(offset_) + ": "; }

 private:
  template <class T>
  static T as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  std::string_view content_;
  std::size_t offset_;
  bool swap_;
};

// What a vertex may have. Names in the order of the slots; several names stand for one thing.
enum Slot { X, Y, Z, Nx, Ny, Nz, U, V, Red, Green, Blue, Alpha, SlotCount, Other = SlotCount };

Slot slotNamed(const std::string& name) {
  static constexpr struct {
    std::string_view name;
    Slot slot;
  } kSlots[] = {{"x", X},
                {"y", Y},
                {"z", Z},
                {"nx", Nx},
                {"ny", Ny},
                {"nz", Nz},
                {"s", U},
                {"t", V},
                {"u", U},
                {"v", V},
                {"texture_u", U},
                {"texture_v", V},
                {"texture_s", U},
                {"texture_t", V},
                {"red", Red},
                {"green", Green},
                {"blue", Blue},
                {"alpha", Alpha},
                {"diffuse_red", Red},
                {"diffuse_green", Green},
                {"diffuse_blue", Blue},
                {"diffuse_alpha", Alpha}};
  for (const auto& s : kSlots) {
    if (name == s.name) return s.slot;
  }
  return Other;
}

template <class Body>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Body body, const Exec& exec)
      : header_(header), body_(std::move(body)), exec_(exec) {}

  Result<FileMesh> read() {
    SHERD_CHECK(checkHeader());
    for (const PlyHeader::Element& e : header_.elements) {
      if (e.properties.empty()) continue;  // takes no place in the file
      for (std::size_t i = 0; i < e.count; ++i) {
        if (exec_.cancelled()) return cancelledError();
        SHERD_CHECK(&e == vertexElement_ ? vertex(e) : &e == faceElement_ ? face(e) : passOver(e));
      }
    }
    if (polygons_.size() == 0)
      return failure("the PLY file has no faces", "export the model as a polygon mesh");
    return assemble();
  }

 private:
  Result<void> checkHeader() {
    for (const PlyHeader::Element& e : header_.elements) {
      if (e.name == "vertex" && vertexElement_ == nullptr) vertexElement_ = &e;
      if (e.name == "face" && faceElement_ == nullptr) faceElement_ = &e;
    }
    if (vertexElement_ == nullptr)
      return failure("the PLY header has no element 'vertex'", "export the model as a polygon mesh");
    if (faceElement_ == nullptr) {
      return failure("the PLY header has no element 'face'",
                     "export the model as a polygon mesh, not as points or strips");
    }
    for (const PlyHeader::Property& p : vertexElement_->properties) {
      slots_.push_back(p.isList ? Other : slotNamed(p.name));
      has_[slots_.back()] = true;
      full_[slots_.back()] = slots_.back() >= Red ? fullColor(p.type) : 1;
    }
    if (!has_[X] || !has_[Y] || !has_[Z])
      return failure("the PLY file's vertices lack x, y or z",
                     "export the vertices with their positions, as the properties x, y and z");
    for (const PlyHeader::Property& p : faceElement_->properties) {
      const bool indices = p.isList && (p.name == "vertex_indices" || p.name == "vertex_index");
      if (indices && indexList_ == nullptr) indexList_ = &p;
      if (p.isList && p.name == "texcoord" && uvList_ == nullptr) uvList_ = &p;
    }
    if (indexList_ == nullptr)
      return failure("the PLY file's faces lack the list vertex_indices",
                     "export the faces with a line such as 'property list uchar int vertex_indices'");
    return {};
  }

  Result<void> vertex(const PlyHeader::Element& e) {
    std::array<double, SlotCount + 1> values{};
    values[Alpha] = 1;
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      const PlyHeader::Property& p = e.properties[k];
      if (p.isList) {
        SHERD_CHECK(passOverList(p));
        continue;
      }
      double value = 0;
      if (!body_.next(p.type, value)) return body_.wrongValue();
      values[slots_[k]] = value / full_[slots_[k]];
    }
    positions_.emplace_back(values[X], values[Y], values[Z]);
    if (hasNormals()) normals_.emplace_back(values[Nx], values[Ny], values[Nz]);
    if (hasUvs()) uvs_.emplace_back(values[U], values[V]);
    if (hasColors()) colors_.emplace_back(values[Red], values[Green], values[Blue], values[Alpha]);
    if (positions_.size() < static_cast<std::size_t>(std::numeric_limits<Index>::max())) return {};
    return failure(body_.where() + "more vertices than can be numbered (2147483647)", "split the model");
  }

  Result<void> face(const PlyHeader::Element& e) {
    for (const PlyHeader::Property& p : e.properties) {
      if (&p == indexList_) {
        SHERD_CHECK(indices(p));
      } else if (&p == uvList_) {
        SHERD_CHECK(cornerUvs(p));
      } else {
        SHERD_CHECK(passOver(p));
      }
    }
    const std::size_t corners = polygons_.vertices.size();
    if (uvList_ != nullptr && wedgeUvs_.size() != corners) {
      // An empty list: a face without texture in a file that has some.
      if (wedgeUvs_.size() > static_cast<std::size_t>(polygons_.start[polygons_.start.size() - 2])) {
        return failure(body_.where() + "a face has more or fewer texture coordinates than corners",
                       "the list texcoord has two numbers per corner");
      }
      wedgeUvs_.resize(corners, Vec2::Zero());
    }
    return {};
  }

  Result<void> listCount(const PlyHeader::Property& p, std::size_t& count) {
    double n = 0;
    if (!body_.next(p.countType, n)) return body_.wrongValue();
    if (!(n >= 0 && n < 4294967296.0) || n != std::floor(n)) {
      return failure(body_.where() + "a list cannot have that many entries", "the file may be damaged");
    }
    if (!body_.holds(p.type, n)) return body_.wrongValue();
    count = static_cast<std::size_t>(n);
    return {};
  }

  Result<void> indices(const PlyHeader::Property& p) {
    std::size_t count = 0;
    SHERD_CHECK(listCount(p, count));
    if (count < 3) {
      return failure(
          body_.where() + "a face with " + std::to_string(count) + (count == 1 ? " corner" : " corners"),
          "a face needs at least 3");
    }
    const double most = static_cast<double>(vertexElement_->count);
    for (std::size_t i = 0; i < count; ++i) {
      double v = 0;
      if (!body_.next(p.type, v)) return body_.wrongValue();
      if (!(v >= 0 && v < most) || v != std::floor(v) || v >= std::numeric_limits<Index>::max()) {
        return failure(body_.where() + "a face names a vertex that does not exist",
                       "vertices are numbered from 0 to " + std::to_string(vertexElement_->count - 1));
      }
      polygons_.vertices.push_back(static_cast<Index>(v));
    }
    if (polygons_.vertices.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
      return failure(body_.where() + "more face corners than can be numbered (2147483647)",
                     "split the model");
    }
    polygons_.close();
    return {};
  }

  Result<void> cornerUvs(const PlyHeader::Property& p) {
    std::size_t count = 0;
    SHERD_CHECK(listCount(p, count));
    if (count % 2 != 0)
      return failure(body_.where() + "an odd number of texture coordinates", "two per corner");
    for (std::size_t i = 0; i < count; i += 2) {
      Vec2 uv;
      if (!body_.next(p.type, uv.x()) || !body_.next(p.type, uv.y())) return body_.wrongValue();
      wedgeUvs_.push_back(uv);
    }
    return {};
  }

  Result<void> passOver(const PlyHeader::Element& e) {
    for (const PlyHeader::Property& p : e.properties) SHERD_CHECK(passOver(p));
    return {};
  }
  Result<void> passOver(const PlyHeader::Property& p) {
    if (p.isList) return passOverList(p);
    double value = 0;
    if (!body_.next(p.type, value)) return body_.wrongValue();
    return {};
  }
  Result<void> passOverList(const PlyHeader::Property& p) {
    std::size_t count = 0;
    SHERD_CHECK(listCount(p, count));
    double value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!body_.next(p.type, value)) return body_.wrongValue();
    }
    return {};
  }

  bool hasNormals() const { return has_[Nx] && has_[Ny] && has_[Nz]; }
  bool hasUvs() const { return has_[U] && has_[V]; }
  bool hasColors() const { return has_[Red] && has_[Green] && has_[Blue]; }

  // Texture coordinates per corner come before those per vertex, should a file have both.
  Result<FileMesh> assemble() {
    FileMesh file;
    TriMesh& mesh = file.mesh;
    PolygonTriangles split = triangulate(polygons_, positions_);
    mesh.positions = std::move(positions_);
    mesh.triangles = std::move(split.triangles);
    if (uvList_ != nullptr) {
      auto& set = mesh.uvSets.emplace_back(TriMesh::UvSet{"uv", {}});
      for (Index c : split.cornerOf) set.uv.push_back(wedgeUvs_[at(c)]);
    }
    if (hasUvs()) mesh.uvSets.push_back({uvList_ != nullptr ? "uv1" : "uv", perCorner(mesh.triangles, uvs_)});
    if (hasColors()) mesh.colorSets.push_back({"color", perCorner(mesh.triangles, colors_)});
    if (hasNormals()) mesh.normals = perCorner(mesh.triangles, normals_);
    finishNormals(mesh);
    return file;
  }

  const PlyHeader& header_;
  Body body_;
  const Exec& exec_;
  const PlyHeader::Element* vertexElement_ = nullptr;
  const PlyHeader::Element* faceElement_ = nullptr;
  const PlyHeader::Property* indexList_ = nullptr;
  const PlyHeader::Property* uvList_ = nullptr;
  std::vector<Slot> slots_;  ///< per property of a vertex
  std::array<bool, SlotCount + 1> has_{};
  std::array<double, SlotCount + 1> full_{};
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_, wedgeUvs_;
  std::vector<Vec4> colors_;
  Polygons polygons_;
};

}  // namespace

Result<FileMesh> readPly(std::string_view content, const Exec& exec) {
  SHERD_ASSIGN(const PlyHeader header, readPlyHeader(content));
  if (header.format == PlyHeader::Format::Ascii) {
    return PlyReader(header, AsciiBody(content.substr(header.size), header.lines + 1), exec).read();
  }
  const bool bigEndian = header.format == PlyHeader::Format::BigEndian;
  return PlyReader(header, BinaryBody(content, header.size, bigEndian), exec).read();
}

}  // namespace sherd
