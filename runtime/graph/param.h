// Parameter values: read from JSON or taken from a wire, checked against what the node's table says.
#pragma once

#include <filesystem>
#include <string>

#include "base/hash.h"
#include "base/result.h"
#include "graph/json.h"
#include "graph/node_type.h"
#include "graph/value.h"

namespace sherd {

/// The value as the parameter's kind, within its range. Relative paths are relative to `base` and come out
/// absolute.
Result<ParamValue> readParam(const ParamInfo& info, const JsonValue& value,
                             const std::filesystem::path& base);
/// The same from a value on a wire (a Boolean, Integer, Number or String).
Result<ParamValue> readParam(const ParamInfo& info, const Value& value, const std::filesystem::path& base);
/// The default, with paths made absolute.
ParamValue defaultParam(const ParamInfo& info, const std::filesystem::path& base);

/// Whether an output of this type may be wired to the parameter.
bool acceptsWire(const ParamInfo& info, const std::string& valueType);
/// The type of output that may be wired to the parameter; empty where none may.
std::string wireType(ParamKind kind);

/// Whether the parameter is a path.
bool isPath(ParamKind kind);

/// Feeds kind and value into a key.
void hashParam(Hasher& hasher, const ParamValue& value);

/// "an integer, at least 0", "a number in (0, 1) kg/m³", "one of "exact", "flood"".
std::string expectation(const ParamInfo& info);
/// The range alone: "at least 0", "above 0 and at most 1"; empty where there is none.
std::string rangeText(const ParamInfo& info);
/// The value for help and messages.
std::string paramText(const ParamValue& value);
/// "integer", "three numbers", "file to read", …
std::string kindText(ParamKind kind);

}  // namespace sherd
