#include "graph/upgrade.h"

#include <algorithm>
#include <map>

#include "graph/json.h"
#include "graph/migrate.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

const DocumentValue* valueAt(const DocumentValue* object, std::string_view key) {
  const DocumentEntry* entry = object == nullptr ? nullptr : object->find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

class Upgrader {
 public:
  Upgrader(const Document& document, const Registry& registry, Diagnostics& diagnostics)
      : text_(document.text()), registry_(registry), diagnostics_(diagnostics) {}

  /// The nodes, outputs and subgraphs that `object` holds.
  void upgrade(const DocumentValue& object, const std::vector<NodeEntry>& nodes,
               const std::vector<SubgraphEntry>& subgraphs, const std::string& inside) {
    const DocumentValue* table = valueAt(&object, "nodes");
    std::map<std::string, const DocumentValue*> places;
    if (table != nullptr)
      for (const DocumentEntry& entry : table->entries) places.emplace(entry.key, &entry.value);
    renamed_.clear();
    for (const NodeEntry& node : nodes)
      if (const auto place = places.find(node.name); place != places.end())
        upgradeNode(*place->second, node, inside);
    if (!renamed_.empty()) renameOutputs(object, places);
    for (const SubgraphEntry& entry : subgraphs)
      if (const DocumentValue* place = valueAt(valueAt(&object, "subgraphs"), entry.name);
          place != nullptr && entry.definition != nullptr)
        upgrade(*place, entry.definition->nodes, entry.definition->subgraphs, inside + entry.name + '/');
  }

  std::vector<TextEdit> edits() { return std::move(edits_); }

 private:
  void replace(std::size_t begin, std::size_t end, std::string text) {
    edits_.push_back({begin, end, std::move(text)});
  }

  void upgradeNode(const DocumentValue& place, const NodeEntry& node, const std::string& inside) {
    const NodeType* type = node.type.empty() ? nullptr : registry_.find(node.type);
    if (type == nullptr) return;
    const auto migrated = migrateNode(node, *type);
    const std::string where = inside + node.name;
    if (!migrated) {
      if (node.version > 0 && node.version < type->version)
        diagnostics_.add(node.typeOrigin, where,
                         "there is no way from " + inQuotes(node.type + '@' + std::to_string(node.version)) +
                             " to version " + std::to_string(type->version),
                         "adapt the node to what `sherd nodes " + type->name + "` says");
      return;
    }
    for (const MigratedNode::Problem& problem : migrated->problems)
      diagnostics_.add(node.typeOrigin, where + '.' + problem.param, problem.error);
    if (!migrated->problems.empty()) return;
    if (const DocumentValue* value = valueAt(&place, "type"))
      replace(value->begin, value->end, jsonString(migrated->type));
    changeParams(place, migrated->params);
    if (const DocumentValue* in = valueAt(&place, "in"))
      for (const auto& [was, port] : migrated->links) changeKey(*in, was, port);
    for (const auto& [was, output] : migrated->outputs)
      renamed_[node.name + '.' + was] = node.name + '.' + output;
  }

  void changeParams(const DocumentValue& place, const std::vector<MigratedNode::Param>& params) {
    const DocumentValue* object = valueAt(&place, "params");
    std::string added;
    std::size_t left = 0;
    for (const MigratedNode::Param& param : params) {
      if (param.was.empty()) {
        added += (added.empty() ? "" : ", ") + jsonString(param.name) + ": " + param.json.value_or("null");
        continue;
      }
      changeKey(*object, param.was, param.name);
      left += param.name.empty() ? 0 : 1;
      const DocumentEntry* entry = object->find(param.was);
      if (!param.name.empty() && param.json) replace(entry->value.begin, entry->value.end, *param.json);
    }
    if (added.empty()) return;
    if (object != nullptr)
      replace(object->begin + 1, object->begin + 1, ' ' + added + (left > 0 ? "," : " "));
    else if (!place.entries.empty())
      replace(place.entries.back().value.end, place.entries.back().value.end,
              ", \"params\": { " + added + " }");
  }

  void changeKey(const DocumentValue& object, const std::string& was, const std::string& name) {
    const DocumentEntry* entry = object.find(was);
    if (entry == nullptr || was == name) return;
    if (name.empty())
      remove(object, *entry);
    else
      replace(entry->keyBegin, entry->keyEnd, jsonString(name));
  }

  /// The entry with its comma, and its line where nothing else is on it.
  void remove(const DocumentValue& object, const DocumentEntry& entry) {
    std::size_t begin = entry.keyBegin, end = entry.value.end;
    const std::size_t next = text_.find_first_not_of(" \t\r\n", end);
    if (next != std::string::npos && text_[next] == ',') {
      end = std::min(text_.find_first_not_of(" \t", next + 1), text_.size());
    } else if (&entry != &object.entries.front()) {
      const std::size_t comma = text_.find_last_not_of(" \t\r\n", begin - 1);
      const bool isFree = std::none_of(edits_.begin(), edits_.end(), [&](const TextEdit& edit) {
        return edit.begin <= comma && comma < edit.end;
      });
      if (text_[comma] == ',' && isFree) begin = comma;
    }
    const std::size_t lineBegin = text_.find_last_not_of(" \t", begin - 1) + 1;
    if (text_[lineBegin - 1] == '\n' && end < text_.size() && text_[end] == '\n') {
      begin = lineBegin;
      ++end;
    }
    replace(begin, end, "");
  }

  void renameLink(const DocumentValue* value) {
    if (value == nullptr) return;
    for (const auto& [was, link] : renamed_)
      if (value->text == jsonString(was)) replace(value->begin, value->end, jsonString(link));
  }

  void renameOutputs(const DocumentValue& object, const std::map<std::string, const DocumentValue*>& places) {
    for (const auto& [name, place] : places)
      if (const DocumentValue* in = valueAt(place, "in"))
        for (const DocumentEntry& link : in->entries) renameLink(&link.value);
    if (const DocumentValue* outputs = valueAt(&object, "outputs"))
      for (const DocumentEntry& output : outputs->entries) {
        renameLink(&output.value);
        renameLink(valueAt(&output.value, "from"));
      }
  }

  const std::string& text_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  std::vector<TextEdit> edits_;
  std::map<std::string, std::string> renamed_;  ///< links within one table of nodes, before and after
};

}  // namespace

std::vector<TextEdit> upgradeEdits(const Document& document, const GraphFile& file, const Registry& registry,
                                   Diagnostics& diagnostics) {
  Upgrader upgrader(document, registry, diagnostics);
  if (file.subgraph != nullptr)
    upgrader.upgrade(document.root(), file.subgraph->nodes, file.subgraph->subgraphs, "");
  else
    upgrader.upgrade(document.root(), file.nodes, file.subgraphs, "");
  return upgrader.edits();
}

}  // namespace sherd
