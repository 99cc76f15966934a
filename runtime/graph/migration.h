// How nodes of an older interface version become nodes of the next one. A migration is a list of steps, each
// of which can be done to a node in memory (graphs of an older version still load) and to the text of a file
// (`sherd upgrade`).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sherd {

struct MigrationStep {
  enum class Kind {
    RenameParam,   ///< from → to
    RenameInput,   ///< from → to
    RenameOutput,  ///< from → to, in the links that other nodes have to it
    RemoveParam,   ///< from; `json` says in words what becomes of it
    SetParam,      ///< to := json, where the node doesn't set or wire it: the default has changed
    ConvertParam,  ///< from: its value goes through `convert`
  };
  Kind kind = Kind::RenameParam;
  std::string from, to, json;
  /// The new value's JSON text for the old one's; nothing where it can't be told (a variable, a bad value):
  /// the user is then asked to write it.
  std::function<std::optional<std::string>(const std::string& json)> convert;
};

struct Migration {
  int from = 1;  ///< the version that it starts from; it leads to from + 1
  std::vector<MigrationStep> steps;
};

inline MigrationStep renameParam(std::string from, std::string to) {
  return {MigrationStep::Kind::RenameParam, std::move(from), std::move(to), {}, {}};
}
inline MigrationStep renameInput(std::string from, std::string to) {
  return {MigrationStep::Kind::RenameInput, std::move(from), std::move(to), {}, {}};
}
inline MigrationStep renameOutput(std::string from, std::string to) {
  return {MigrationStep::Kind::RenameOutput, std::move(from), std::move(to), {}, {}};
}
/// `instead`: what the user should know, as "the mesher now chooses it".
inline MigrationStep removeParam(std::string name, std::string instead) {
  return {MigrationStep::Kind::RemoveParam, std::move(name), {}, std::move(instead), {}};
}
/// The default changed: nodes that rely on the old one get it written out.
inline MigrationStep keepDefault(std::string name, std::string oldDefaultAsJson) {
  return {MigrationStep::Kind::SetParam, {}, std::move(name), std::move(oldDefaultAsJson), {}};
}
inline MigrationStep convertParam(std::string name,
                                  std::function<std::optional<std::string>(const std::string&)> convert) {
  return {MigrationStep::Kind::ConvertParam, std::move(name), {}, {}, std::move(convert)};
}

}  // namespace sherd
