// ${name} in strings: variables of the graph (overridden by --var), ${ASSETS}, environment variables, in this
// order.
// "$${" stands for a literal "${".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graph/graph_file.h"

namespace sherd {

/// What a graph sees of the machine.
struct Environment {
  std::filesystem::path currentDirectory;  ///< absolute; what the command line's relative paths start from
  std::filesystem::path assets;            ///< ${ASSETS}; empty where it was not found
  std::function<std::optional<std::string>(const std::string&)> variable;  ///< of the process's environment

  /// That of the running process; `assets` as given.
  static Environment ofProcess(std::filesystem::path assets);
};

/// "name=value" of --var, or "node.param=value" of --set.
struct Assignment {
  std::string name;
  std::string text;
  SourcePtr source;  ///< the option as it was typed, with the current directory
};

/// Splits "name=value" typed behind `option`; an Error where there is no "=".
Result<Assignment> parseAssignment(const std::string& option, const std::string& typed,
                                   const Environment& environment);

/// A value with its variables replaced.
struct Expanded {
  JsonValue value;
  SourcePtr base;           ///< the source that its first characters come from: a relative path starts there
  std::uint64_t reads = 0;  ///< what it depends on: bit 0 the frame, bit k the wedge's k-th variable, from 1
};

/// What a graph is run for: every frame with every combination of the wedge's values.
struct Sweep {
  struct Dimension {
    std::string name;  ///< of the variable
    std::vector<JsonValue> values;
  };
  static constexpr std::size_t kMostDimensions = 63;
  std::vector<std::int64_t> frames;  ///< empty: the graph has none
  std::vector<Dimension> wedge;
};

class Variables {
 public:
  /// Takes the overrides over the graph's own and resolves all of them, reporting loops and unknown names.
  Variables(const GraphFile& graph, const std::vector<Assignment>& overrides, const Environment& environment,
            Diagnostics& diagnostics);

  /// Replaces variables in strings, also those in lists and in their objects. A string that is exactly "${x}"
  /// becomes x's value, with its kind. Nothing where something is wrong, which then has been reported for
  /// `where`. `scope`: whose variables these are, as in Setting. ${frame} and the wedge's variables have the
  /// values last moved to.
  std::optional<Expanded> expand(const JsonValue& value, const std::string& where,
                                 const std::string& scope = {});

  /// The sweep's frame and values by their places in it: at[0] of the frames, at[k] of the wedge's k-th
  /// variable. At first all are 0. `sweep` is kept.
  void sweepOver(const Sweep& sweep, double fps);
  void moveTo(const std::vector<int>& at);
  /// The frame that was moved to, with at least `digits` digits; nothing in a graph without frames.
  std::optional<std::string> frameText(int digits) const;

 private:
  enum class State { Untouched, Resolving, Resolved, Broken };
  struct Variable {
    Setting setting;
    State state = State::Untouched;
    Expanded expanded;
    std::size_t wedge = 0;  ///< its number in the wedge, from 1; 0: it isn't in it
  };
  static constexpr std::size_t kLongestText = 1 << 16;
  static constexpr std::size_t kDeepest = 64;

  const Expanded* resolve(Variable& variable);
  const Expanded* lookUp(const std::string& name, const Origin& origin, const std::string& where,
                         const std::string& scope);
  std::string remedyFor(const std::string& name, const std::string& scope) const;
  const Expanded* fromOutside(const std::string& name);
  const Expanded* fromFrame(const std::string& name, const std::string& reference, const Origin& origin,
                            const std::string& where);
  std::optional<Expanded> expandText(const JsonValue& value, const std::string& where,
                                     const std::string& scope);
  bool append(Expanded& result, const std::string& name, const JsonValue& value, const std::string& where);

  const Environment& environment_;
  Diagnostics& diagnostics_;
  std::map<std::string, Variable> variables_;
  std::map<std::string, Expanded> outside_;
  std::vector<const Variable*> stack_;  ///< those that are being resolved, for the text of a loop
  Sweep sweep_;
  double fps_ = 24;
  std::vector<int> at_;
  std::map<std::string, Expanded> ofFrame_;  ///< ${frame:04} and the like, at the frame moved to
};

}  // namespace sherd
