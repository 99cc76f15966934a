#include "graph/migrate.h"

#include <map>
#include <set>

#include "graph/suggest.h"

namespace sherd {
namespace {

using Renamed = std::map<std::pair<std::string, std::string>, std::string>;  // node and output before → after

class Migrator {
 public:
  Migrator(GraphFile& file, const Registry& registry, Diagnostics& diagnostics,
           std::vector<std::string>& notes)
      : file_(file),
        registry_(registry),
        diagnostics_(diagnostics),
        notes_(notes),
        told_(notes.begin(), notes.end()) {}

  void run() {
    for (NodeEntry& node : file_.nodes) {
      const NodeType* type = node.type.empty() ? nullptr : registry_.find(node.type);
      if (type == nullptr) continue;
      if (const auto migrated = migrateNode(node, *type)) apply(*migrated, *type, node);
    }
    if (!renamed_.empty()) renameOutputs();
    for (GraphFile& unused : file_.unused) migrate(unused, registry_, diagnostics_, notes_);
  }

 private:
  void apply(const MigratedNode& migrated, const NodeType& type, NodeEntry& node) {
    tell(migrated, node);
    for (const MigratedNode::Problem& problem : migrated.problems)
      diagnostics_.add(originOf(node, problem.param), node.name + '.' + problem.param, problem.error);
    // What can't be converted is left out, and then not also missing.
    node.paramsAreUnread = node.paramsAreUnread || !migrated.problems.empty();
    std::set<std::string> leftOut;
    for (const MigratedNode::Problem& problem : migrated.problems) leftOut.insert(problem.param);
    std::vector<Setting> params;
    for (const MigratedNode::Param& param : migrated.params)
      if (!param.name.empty() && !leftOut.contains(param.was.empty() ? param.name : param.was))
        params.push_back(settingOf(param, node));
    node.params = std::move(params);
    for (std::size_t i = 0; i < node.in.size(); ++i) node.in[i].port = migrated.links[i].second;
    std::erase_if(node.in, [&](const LinkEntry& link) { return link.port.empty(); });
    for (const auto& [was, output] : migrated.outputs) renamed_[{node.name, was}] = output;
    node.type = type.name;
    node.version = type.version;
  }

  static Origin originOf(const NodeEntry& node, const std::string& param) {
    for (const Setting& setting : node.params)
      if (setting.name == param) return setting.value.origin;
    for (const LinkEntry& link : node.in)
      if (link.port == param) return link.origin;
    return node.typeOrigin;
  }

  static Setting settingOf(const MigratedNode::Param& param, const NodeEntry& node) {
    Setting setting{param.name, node.typeOrigin, {}, {}};
    setting.value.origin = node.typeOrigin;
    for (const Setting& before : node.params)
      if (!param.was.empty() && before.name == param.was) setting = before;
    setting.name = param.name;
    if (!param.json) return setting;
    Diagnostics none;  // migrateNode() has seen that it can be parsed
    const Origin origin = setting.value.origin;
    setting.value = parseJson(*param.json, origin.source, none).value_or(JsonValue{});
    setting.value.origin = origin;
    return setting;
  }

  void tell(const MigratedNode& migrated, const NodeEntry& node) {
    const std::string leaf = node.name.substr(node.name.rfind('/') + 1);
    if (!told_.insert(node.typeOrigin.text() + leaf).second) return;
    std::string note = node.typeOrigin.text() + ": " + node.name + ": " + node.type + '@' +
                       std::to_string(node.version) + " is read as " + migrated.type;
    for (const std::string& remark : migrated.remarks) note += "; " + remark;
    if (const SourcePtr& source = node.typeOrigin.source; source != nullptr)
      note += "; `sherd upgrade " + source->name + "` rewrites it";
    notes_.push_back(std::move(note));
  }

  void rename(const std::string& node, std::string& output) const {
    if (const auto found = renamed_.find({node, output}); found != renamed_.end()) output = found->second;
  }

  void renameOutputs() {
    for (NodeEntry& node : file_.nodes)
      for (LinkEntry& link : node.in) rename(link.node, link.output);
    for (ExpectedType& expected : file_.expectedTypes) rename(expected.node, expected.output);
    for (GroupEntry& group : file_.groups)
      for (auto& [name, link] : group.outputs) {
        const std::size_t dot = link.find('.');
        if (dot == std::string::npos) continue;
        const std::string node = link.substr(0, dot);
        std::string output = link.substr(dot + 1);
        rename(node, output);
        link = node + '.' + output;
      }
  }

  GraphFile& file_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  std::vector<std::string>& notes_;
  std::set<std::string> told_;
  Renamed renamed_;
};

}  // namespace

void migrate(GraphFile& file, const Registry& registry, Diagnostics& diagnostics,
             std::vector<std::string>& notes) {
  Migrator(file, registry, diagnostics, notes).run();
}

}  // namespace sherd
