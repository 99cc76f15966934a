#include <algorithm>

#include "graph/migrate.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using Kind = MigrationStep::Kind;

class NodeMigration {
 public:
  NodeMigration(const NodeEntry& node, const NodeType& type) : node_(node), type_(type) {
    result_.type = type.name + '@' + std::to_string(type.version);
    for (const Setting& setting : node.params) result_.params.push_back({setting.name, setting.name, {}});
    for (const LinkEntry& link : node.in) result_.links.emplace_back(link.port, link.port);
  }

  void apply(const MigrationStep& step) {
    switch (step.kind) {
      case Kind::RenameParam:
        if (MigratedNode::Param* param = findParam(step.from)) param->name = step.to;
        renameLink(step.from, step.to);
        break;
      case Kind::RenameInput:
        renameLink(step.from, step.to);
        break;
      case Kind::RenameOutput:
        renameOutput(step.from, step.to);
        break;
      case Kind::RemoveParam:
        remove(step);
        break;
      case Kind::SetParam:
        if (findParam(step.to) == nullptr && !isWired(step.to))
          result_.params.push_back({"", step.to, step.json});
        break;
      case Kind::ConvertParam:
        convert(step);
        break;
    }
  }

  MigratedNode result() { return std::move(result_); }

 private:
  MigratedNode::Param* findParam(const std::string& name) {
    for (MigratedNode::Param& param : result_.params)
      if (param.name == name) return &param;
    return nullptr;
  }
  bool isWired(const std::string& name) const {
    return std::any_of(result_.links.begin(), result_.links.end(),
                       [&](const auto& link) { return link.second == name; });
  }
  void renameLink(const std::string& from, const std::string& to) {
    for (auto& [was, port] : result_.links)
      if (port == from) port = to;
  }
  void renameOutput(const std::string& from, const std::string& to) {
    for (auto& [was, output] : result_.outputs)
      if (output == from) {
        output = to;
        return;
      }
    result_.outputs.emplace_back(from, to);
  }

  void remove(const MigrationStep& step) {
    MigratedNode::Param* param = findParam(step.from);
    if (param == nullptr && !isWired(step.from)) return;
    result_.remarks.push_back(inQuotes(step.from) + " is gone" + (step.json.empty() ? "" : ": " + step.json));
    renameLink(step.from, "");
    if (param == nullptr) return;
    param->name.clear();
    if (param->was.empty()) result_.params.erase(result_.params.begin() + (param - result_.params.data()));
  }

  /// The value as it stands now, as JSON.
  std::string currentJson(const MigratedNode::Param& param) const {
    if (param.json) return *param.json;
    for (const Setting& setting : node_.params)
      if (setting.name == param.was) return jsonText(setting.value);
    return "null";
  }

  void convert(const MigrationStep& step) {
    for (const auto& [was, port] : result_.links)
      if (port == step.from) return complain(was, "what is wired to it has another meaning now");
    MigratedNode::Param* param = findParam(step.from);
    if (param == nullptr) return;
    const std::string json = currentJson(*param);
    const auto converted = json.find("${") == std::string::npos ? step.convert(json) : std::nullopt;
    Diagnostics ignored;  // whether it can be parsed is all that counts
    if (converted && parseJson(*converted, nullptr, ignored))
      param->json = *converted;
    else
      complain(param->was.empty() ? param->name : param->was,
               "what " + json + " is for " + result_.type + " can't be told");
  }

  void complain(const std::string& param, std::string what) {
    result_.problems.push_back({param, Error{std::move(what),
                                             "write the value by hand, as `sherd nodes " + type_.name +
                                                 "` explains it, and the type as " + inQuotes(result_.type),
                                             {},
                                             Error::Kind::Input}});
  }

  const NodeEntry& node_;
  const NodeType& type_;
  MigratedNode result_;
};

const Migration* migrationFrom(const NodeType& type, int version) {
  for (const Migration& migration : type.migrations)
    if (migration.from == version) return &migration;
  return nullptr;
}

}  // namespace

std::optional<MigratedNode> migrateNode(const NodeEntry& node, const NodeType& type) {
  const bool isCurrent = node.version == type.version && node.type == type.name;
  if (node.version <= 0 || node.version > type.version || isCurrent) return std::nullopt;
  NodeMigration migration(node, type);
  for (int version = node.version; version < type.version; ++version) {
    const Migration* next = migrationFrom(type, version);
    if (next == nullptr) return std::nullopt;
    for (const MigrationStep& step : next->steps) migration.apply(step);
  }
  return migration.result();
}

}  // namespace sherd
