// The header of a PLY file: what its elements and their properties are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace sherd {

struct PlyHeader {
  enum class Format { Ascii, LittleEndian, BigEndian };
  enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

  struct Property {
    std::string name;
    Type type;  ///< of the value, or of a list's entries
    bool isList;
    Type countType;  ///< of a list
  };
  struct Element {
    std::string name;
    std::size_t count;
    std::vector<Property> properties;
  };

  Format format = Format::Ascii;
  std::vector<Element> elements;
  std::size_t size = 0;   ///< bytes, up to and with the end of the line end_header
  std::size_t lines = 0;  ///< of the header
};

/// Bytes of a value in a binary file.
std::size_t sizeOf(PlyHeader::Type type);
/// What is a full colour in this type: 255 for bytes, 65535 for 16 bits, 1 for reals.
double fullColor(PlyHeader::Type type);

Result<PlyHeader> readPlyHeader(std::string_view content);

}  // namespace sherd
