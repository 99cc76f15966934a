#include "load_mesh/ply_header.h"

#include <algorithm>
#include <optional>

#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

using Type = PlyHeader::Type;

std::optional<Type> typeNamed(std::string_view word) {
  static constexpr struct {
    std::string_view name, alias;
    Type type;
  } kTypes[] = {{"char", "int8", Type::Int8},        {"uchar", "uint8", Type::Uint8},
                {"short", "int16", Type::Int16},     {"ushort", "uint16", Type::Uint16},
                {"int", "int32", Type::Int32},       {"uint", "uint32", Type::Uint32},
                {"float", "float32", Type::Float32}, {"double", "float64", Type::Float64}};
  for (const auto& t : kTypes) {
    if (word == t.name || word == t.alias) return t.type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view content) : content_(content), scan_(content) {}

  Result<PlyHeader> read() {
    if (scan_.word() != "ply" || !scan_.word().empty()) {
      return scan_.error(
          "this is no PLY file",
          "the first line of one is 'ply'; if this is another format, rename the file to its extension");
    }
    bool hasFormat = false;
    for (scan_.nextLine(); !scan_.atEnd(); scan_.nextLine()) {
      const std::string_view keyword = scan_.word();
      if (keyword == "end_header") {
        if (!hasFormat) return scan_.error("the header has no format", "a line such as 'format ascii 1.0'");
        finish();
        return std::move(header_);
      }
      if (keyword == "format") {
        SHERD_CHECK(format());
        hasFormat = true;
      } else if (keyword == "element") {
        SHERD_CHECK(element());
      } else if (keyword == "property") {
        SHERD_CHECK(property());
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        return scan_.error(quoted(keyword) + " is no PLY header line",
                           "expected format, element, property, comment or end_header");
      }
    }
    return scan_.error("the header has no end_header", "the file may be cut off");
  }

 private:
  // A binary body follows the one line end that the whole header uses: its first byte may look like an LF.
  void finish() {
    const std::size_t firstEnd = content_.find_first_of("\r\n");
    const bool loneCr = content_[firstEnd] == '\r' && content_[firstEnd + 1] != '\n';
    scan_.rest();
    const std::size_t end = static_cast<std::size_t>(scan_.position() - content_.data());
    scan_.nextLine();
    const std::size_t next = static_cast<std::size_t>(scan_.position() - content_.data());
    header_.size = loneCr ? std::min(end + 1, next) : next;
    header_.lines = scan_.line() - 1;
  }

  Result<void> format() {
    const std::string_view name = scan_.word();
    const std::string_view version = scan_.word();
    if (name == "ascii") {
      header_.format = PlyHeader::Format::Ascii;
    } else if (name == "binary_little_endian") {
      header_.format = PlyHeader::Format::LittleEndian;
    } else if (name == "binary_big_endian") {
      header_.format = PlyHeader::Format::BigEndian;
    } else {
      return scan_.error("unknown PLY format " + quoted(name),
                         "ascii, binary_little_endian or binary_big_endian");
    }
    if (version != "1.0") return scan_.error("unknown PLY version " + quoted(version), "1.0");
    return {};
  }

  Result<void> element() {
    const std::string name(scan_.word());
    const std::string_view digits = scan_.word();
    long long count = 0;
    if (name.empty() || !parseInteger(digits, count) || count < 0) {
      return scan_.error("an element without a name or a count", "a line such as 'element vertex 8'");
    }
    header_.elements.push_back({name, static_cast<std::size_t>(count), {}});
    return {};
  }

  Result<void> property() {
    if (header_.elements.empty())
      return scan_.error("a property before the first element",
                         "a line such as 'element vertex 8' goes before its properties");
    PlyHeader::Property property{{}, Type::Int8, false, Type::Uint8};
    std::string_view word = scan_.word();
    if (word == "list") {
      property.isList = true;
      SHERD_CHECK(type(scan_.word(), property.countType));
      if (property.countType == Type::Float32 || property.countType == Type::Float64) {
        return scan_.error("a list counted by real numbers", "an integer type such as uchar");
      }
      word = scan_.word();
    }
    SHERD_CHECK(type(word, property.type));
    property.name = scan_.word();
    if (property.name.empty())
      return scan_.error("a property without a name", "a line such as 'property float x'");
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  Result<void> type(std::string_view word, Type& type) const {
    const std::optional<Type> found = typeNamed(word);
    if (!found) {
      return scan_.error("unknown PLY type " + quoted(word),
                         "char, uchar, short, ushort, int, uint, float or double");
    }
    type = *found;
    return {};
  }

  std::string_view content_;
  TextScanner scan_;
  PlyHeader header_;
};

}  // namespace

std::size_t sizeOf(Type type) {
  switch (type) {
    case Type::Int8:
    case Type::Uint8:
      return 1;
    case Type::Int16:
    case Type::Uint16:
      return 2;
    case Type::Int32:
    case Type::Uint32:
    case Type::Float32:
      return 4;
    case Type::Float64:
      break;
  }
  return 8;
}

double fullColor(Type type) {
  switch (type) {
    case Type::Float32:
    case Type::Float64:
      return 1;
    case Type::Int16:
    case Type::Uint16:
      return 65535;
    default:
      return 255;
  }
}

Result<PlyHeader> readPlyHeader(std::string_view content) { return HeaderReader(content).read(); }

}  // namespace sherd
