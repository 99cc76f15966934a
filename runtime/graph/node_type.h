// What a node type tells of itself: ports, parameters and how to run it. One table per node, written with
// NodeBuilder in <step>_node.cpp, from which JSON reading, hashing, help and schema all derive.
//
// clang-format off
//   NodeType cvdNode() {
//     return NodeBuilder<CvdParams>("CVD", 1, "Places the cells that the body breaks into.")
//         .input<WeightField>("weights", "what each node weighs")
//         .optionalInput<Sites>("sites", "sites to start from")
//         .integer("degree", &CvdParams::degree, {.min = 0, .help = "number of sites; 0: as many as `sites` has"})
//         .choice("labels", &CvdParams::labels, {{"exact", Labels::Exact}, {"flood", Labels::Flood}}, "…")
//         .output<Partition>("cells", "every node's nearest site")
//         .run([](const CvdParams& params, NodeIo& io) -> Result<void> {
//           SHERD_ASSIGN(Partition cells, cvd(*io.in<WeightField>("weights"), …, params, io.exec()));
//           io.out("cells", std::move(cells));
//           return {};
//         });
//   }
// clang-format on
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "graph/migration.h"
#include "graph/value.h"

namespace sherd {

/// A parameter's value after reading: what JSON gave, checked and converted to the parameter's kind.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

enum class ParamKind {
  Boolean,
  Integer,
  Number,
  Vector3,  ///< three numbers
  Text,
  Choice,           ///< one of a list of words
  InputFile,        ///< a file that is read: resolved to an absolute path; its content enters the key
  OutputFile,       ///< a file that is written: resolved to an absolute path
  OutputDirectory,  ///< a directory that is written into: resolved to an absolute path
  List,             ///< a list of what the node itself knows; its value is the JSON text, on one line
};

struct ParamInfo {
  std::string name;
  ParamKind kind = ParamKind::Number;
  std::string unit;                                       ///< "m", "kg/m³", …; empty for a pure number
  ParamValue fallback;                                    ///< the default
  double min = -std::numeric_limits<double>::infinity();  ///< for numbers, per component for vectors
  double max = std::numeric_limits<double>::infinity();
  bool openMin = false, openMax = false;  ///< the limit itself is not allowed
  bool required = false;                  ///< has no default: must be set or wired
  std::vector<std::string> choices;
  std::string help;
  std::function<Result<void>(const std::string& json)> accepts;  ///< of a List: what is wrong with its items
};

struct PortInfo {
  std::string name;
  std::string type;  ///< ValueType::name
  bool required = true;
  std::string help;
  const ValueType* value = nullptr;  ///< how its values are hashed, sized, saved and loaded
  bool gathers = false;  ///< an input that takes all frames and wedges of what is wired to it, in their order
  /// sizeof of the values. Not in ValueType, which the loader may make one object of for all packs, whatever
  /// headers they are built against.
  std::size_t valueBytes = 0;
};

/// Something inside a node that can't be stopped at once: a library's call.
struct Uninterruptible {
  std::string call;      ///< "OpenVDB's meshToVolume"
  double longestMs = 0;  ///< measured, on the models and resolutions that the tests use
};

class Memo;

/// What a running node sees: its inputs, its outputs, the user.
class NodeIo {
 public:
  /// A value at a port.
  struct Port {
    std::string name;
    Value value;
    std::string label;  ///< of a gathered value: "frame 1001, seed 7"
  };
  template <class T>
  struct Labelled {
    std::shared_ptr<const T> value;
    std::string label;
  };

  explicit NodeIo(const Exec& exec, Memo* memo = nullptr) : exec_(exec), memo_(memo) {}

  const Exec& exec() const { return exec_; }
  /// Where parts of the node's work may be kept (base/memo.h). Null where nothing is kept.
  Memo* memo() const { return memo_; }
  /// The value wired to `port`. Never null for a required input; null for an optional one left open.
  template <class T>
  std::shared_ptr<const T> in(std::string_view port) const {
    for (const Port& input : inputs_)
      if (input.name == port) return input.value.as<T>();
    return nullptr;
  }
  /// The values at an input that gathers, by frames and wedges in their order. Those that were left empty are
  /// not in it.
  template <class T>
  std::vector<Labelled<T>> all(std::string_view port) const {
    std::vector<Labelled<T>> values;
    for (const Port& input : inputs_)
      if (auto value = input.name == port ? input.value.as<T>() : nullptr)
        values.push_back({std::move(value), input.label});
    return values;
  }
  template <class T>
  void out(std::string_view port, T value) {
    outShared<T>(port, std::make_shared<const T>(std::move(value)));
  }
  template <class T>
  void outShared(std::string_view port, std::shared_ptr<const T> value) {
    for (Port& output : outputs_)
      if (output.name == port) {
        output.value = Value::of<T>(std::move(value));
        return;
      }
    outputs_.push_back({std::string(port), Value::of<T>(std::move(value)), {}});
  }
  /// Tells the runtime of a file that was written, by its absolute path. Where one of them is missing or has
  /// changed the node runs again; so what lists a directory's files counts as written, too.
  void wrote(std::string path) { written_.push_back(std::move(path)); }

  void setInput(std::string port, Value value, std::string label = {}) {
    inputs_.push_back({std::move(port), std::move(value), std::move(label)});
  }
  const std::vector<Port>& outputs() const { return outputs_; }
  /// The output's value; empty where it was not set.
  Value output(std::string_view port) const {
    for (const Port& output : outputs_)
      if (output.name == port) return output.value;
    return {};
  }
  const std::vector<std::string>& written() const { return written_; }

 private:
  const Exec& exec_;
  Memo* const memo_;
  std::vector<Port> inputs_, outputs_;
  std::vector<std::string> written_;
};

using ParamValues = std::map<std::string, ParamValue>;

struct NodeType {
  std::string name;
  int version = 1;         ///< the interface's version: N of Type@N
  int implementation = 1;  ///< raised when the same inputs and parameters give another result
  std::string help;
  std::vector<PortInfo> inputs, outputs;  ///< the first output is what "node" without a port means
  std::vector<ParamInfo> params;
  bool writesFiles = false;  ///< an exporter: a hit only where the files that it wrote are still there
  std::vector<Migration> migrations;              ///< from each older version to the next
  std::vector<std::string> formerNames;           ///< that graphs may still use
  std::vector<Uninterruptible> uninterruptibles;  ///< where cancelling waits
  /// Runs the node. `params` holds every parameter, checked. May throw only what libraries throw.
  std::function<Result<void>(const ParamValues& params, NodeIo& io)> run;

  const PortInfo* input(const std::string& port) const;
  const PortInfo* output(const std::string& port) const;
  const ParamInfo* param(const std::string& name) const;
};

/// Options of a numeric parameter.
struct NumberOptions {
  std::string unit = {};
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool openMin = false, openMax = false;
  std::string help = {};
};

/// Binds a plain parameter struct P (whose member initialisers are the defaults) to a NodeType.
template <class P>
class NodeBuilder {
 public:
  NodeBuilder(std::string name, int version, std::string help) {
    type_.name = std::move(name);
    type_.version = version;
    type_.help = std::move(help);
  }

  template <class T>
  NodeBuilder& input(std::string name, std::string help) {
    return addInput<T>(std::move(name), std::move(help), true);
  }
  template <class T>
  NodeBuilder& optionalInput(std::string name, std::string help) {
    return addInput<T>(std::move(name), std::move(help), false);
  }
  /// An input that takes the values of all frames and wedges at once; the node runs once for all of them.
  template <class T>
  NodeBuilder& gatheredInput(std::string name, std::string help) {
    addInput<T>(std::move(name), std::move(help), true);
    type_.inputs.back().gathers = true;
    return *this;
  }
  /// The same, and it may be left open.
  template <class T>
  NodeBuilder& optionalGatheredInput(std::string name, std::string help) {
    gatheredInput<T>(std::move(name), std::move(help));
    type_.inputs.back().required = false;
    return *this;
  }
  template <class T>
  NodeBuilder& output(std::string name, std::string help) {
    type_.outputs.push_back({std::move(name), valueTypeName<T>(), false, std::move(help), &valueType<T>()});
    type_.outputs.back().valueBytes = sizeof(T);
    return *this;
  }
  NodeBuilder& implementation(int number) {
    type_.implementation = number;
    return *this;
  }
  NodeBuilder& writesFiles() {
    type_.writesFiles = true;
    return *this;
  }
  /// How nodes written for version `from` become nodes of version from + 1.
  NodeBuilder& migrate(int from, std::vector<MigrationStep> steps) {
    type_.migrations.push_back({from, std::move(steps)});
    return *this;
  }
  /// A name that the type had before.
  NodeBuilder& formerly(std::string name) {
    type_.formerNames.push_back(std::move(name));
    return *this;
  }
  /// A library's call that can't be stopped at once, and how long it took at most when it was measured.
  NodeBuilder& uninterruptible(std::string call, double longestMs) {
    type_.uninterruptibles.push_back({std::move(call), longestMs});
    return *this;
  }

  NodeBuilder& number(std::string name, double P::*member, NumberOptions options) {
    return add(std::move(name), ParamKind::Number, P{}.*member, std::move(options),
               [member](P& p, const ParamValue& v) { p.*member = std::get<double>(v); });
  }
  /// `member` may be any integral type; values are range-checked against min and max before.
  template <class I>
  requires(std::is_integral_v<I> && !std::is_same_v<I, bool>) NodeBuilder& integer(std::string name,
                                                                                   I P::*member,
                                                                                   NumberOptions options) {
    return add(
        std::move(name), ParamKind::Integer, static_cast<std::int64_t>(P{}.*member), std::move(options),
        [member](P& p, const ParamValue& v) { p.*member = static_cast<I>(std::get<std::int64_t>(v)); });
  }
  NodeBuilder& boolean(std::string name, bool P::*member, std::string help) {
    return add(std::move(name), ParamKind::Boolean, P{}.*member, {.unit = {}, .help = std::move(help)},
               [member](P& p, const ParamValue& v) { p.*member = std::get<bool>(v); });
  }
  /// V is a vector of three doubles with operator[] (Eigen::Vector3d).
  template <class V>
  NodeBuilder& vector3(std::string name, V P::*member, NumberOptions options) {
    const V v = P{}.*member;
    return add(std::move(name), ParamKind::Vector3, std::vector<double>{v[0], v[1], v[2]}, std::move(options),
               [member](P& p, const ParamValue& value) {
                 const auto& numbers = std::get<std::vector<double>>(value);
                 for (int i = 0; i < 3; ++i) (p.*member)[i] = numbers[static_cast<std::size_t>(i)];
               });
  }
  NodeBuilder& text(std::string name, std::string P::*member, std::string help) {
    return addText(std::move(name), ParamKind::Text, member, std::move(help));
  }
  /// File parameters without a default (an empty string) must be set.
  NodeBuilder& inputFile(std::string name, std::string P::*member, std::string help) {
    return addText(std::move(name), ParamKind::InputFile, member, std::move(help));
  }
  NodeBuilder& outputFile(std::string name, std::string P::*member, std::string help) {
    return addText(std::move(name), ParamKind::OutputFile, member, std::move(help));
  }
  NodeBuilder& outputDirectory(std::string name, std::string P::*member, std::string help) {
    return addText(std::move(name), ParamKind::OutputDirectory, member, std::move(help));
  }
  /// A list whose items `read` turns from JSON into what the node works with; empty by default. What it has
  /// to say of wrong ones is said by `check` already.
  template <class T>
  NodeBuilder& list(std::string name, std::vector<T> P::*member,
                    Result<std::vector<T>> (*read)(const std::string& json), std::string help) {
    add(std::move(name), ParamKind::List, std::string("[]"), {.unit = {}, .help = std::move(help)},
        [member, read](P& p, const ParamValue& v) { p.*member = read(std::get<std::string>(v)).value(); });
    type_.params.back().accepts = [read](const std::string& json) -> Result<void> {
      const auto items = read(json);
      return items.ok() ? Result<void>{} : items.error();
    };
    return *this;
  }
  /// One of a list of words, each standing for a value of the enumeration E.
  template <class E>
  NodeBuilder& choice(std::string name, E P::*member, std::vector<std::pair<std::string, E>> words,
                      std::string help) {
    std::string fallback;
    for (const auto& [word, value] : words)
      if (value == P{}.*member) fallback = word;
    add(std::move(name), ParamKind::Choice, fallback, {.unit = {}, .help = std::move(help)},
        [member, words](P& p, const ParamValue& v) {
          for (const auto& [word, value] : words)
            if (word == std::get<std::string>(v)) p.*member = value;
        });
    for (const auto& [word, value] : words) type_.params.back().choices.push_back(word);
    return *this;
  }

  /// Ends the table: f(const P&, NodeIo&) -> Result<void>.
  template <class F>
  NodeType run(F f) {
    type_.run = [setters = std::move(setters_), f](const ParamValues& values, NodeIo& io) -> Result<void> {
      P params{};
      for (const auto& [name, set] : setters) set(params, values.at(name));
      return f(static_cast<const P&>(params), io);
    };
    return std::move(type_);
  }

 private:
  using Setter = std::function<void(P&, const ParamValue&)>;

  template <class T>
  NodeBuilder& addInput(std::string name, std::string help, bool required) {
    type_.inputs.push_back({std::move(name), valueTypeName<T>(), required, std::move(help), &valueType<T>()});
    type_.inputs.back().valueBytes = sizeof(T);
    return *this;
  }
  NodeBuilder& add(std::string name, ParamKind kind, ParamValue fallback, NumberOptions options,
                   Setter setter) {
    setters_.emplace_back(name, std::move(setter));
    ParamInfo info;
    info.name = std::move(name);
    info.kind = kind;
    info.fallback = std::move(fallback);
    info.unit = std::move(options.unit);
    info.min = options.min;
    info.max = options.max;
    info.openMin = options.openMin;
    info.openMax = options.openMax;
    info.help = std::move(options.help);
    type_.params.push_back(std::move(info));
    return *this;
  }
  NodeBuilder& addText(std::string name, ParamKind kind, std::string P::*member, std::string help) {
    const std::string fallback = P{}.*member;
    add(std::move(name), kind, fallback, {.unit = {}, .help = std::move(help)},
        [member](P& p, const ParamValue& v) { p.*member = std::get<std::string>(v); });
    type_.params.back().required = kind != ParamKind::Text && fallback.empty();
    return *this;
  }

  NodeType type_;
  std::vector<std::pair<std::string, Setter>> setters_;
};

}  // namespace sherd
