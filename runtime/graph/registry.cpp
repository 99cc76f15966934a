#include "graph/registry.h"

#include <algorithm>
#include <set>
#include <utility>

#include "graph/suggest.h"

namespace sherd {
namespace {

/// Mistakes in a node's own table, found when it is registered rather than when somebody trips over them.
Result<void> checkTable(const NodeType& type) {
  const std::string name = "node type " + inQuotes(type.name);
  if (type.name.empty() || type.name.find_first_of("@. ") != std::string::npos)
    return failure(name + " has a name that no graph can write", "letters and digits only");
  if (type.version < 1)
    return failure(name + " has version " + std::to_string(type.version), "the first is 1");
  if (!type.run) return failure(name + " has nothing to run", "end its table with run()");
  std::set<std::string> names;
  auto once = [&](const std::string& word) { return !word.empty() && names.insert(word).second; };
  for (const PortInfo& port : type.inputs)
    if (!once(port.name)) return failure(name + " has two inputs or parameters " + inQuotes(port.name));
  for (const ParamInfo& param : type.params) {
    if (!once(param.name)) return failure(name + " has two inputs or parameters " + inQuotes(param.name));
    if (param.kind == ParamKind::Choice &&
        std::find(param.choices.begin(), param.choices.end(), std::get<std::string>(param.fallback)) ==
            param.choices.end())
      return failure(name + " has a parameter " + inQuotes(param.name) +
                     " whose default is none of its words");
  }
  names.clear();
  constexpr std::size_t kMostOutputs = 64;  // evaluation keeps a bit for each
  if (type.outputs.size() > kMostOutputs)
    return failure(name + " has " + std::to_string(type.outputs.size()) + " outputs", "64 is the most");
  for (const PortInfo& port : type.outputs)
    if (!once(port.name)) return failure(name + " has two outputs " + inQuotes(port.name));
  return {};
}

}  // namespace

Result<void> Registry::checkValues(const NodeType& type) const {
  for (const auto* ports : {&type.inputs, &type.outputs})
    for (const PortInfo& port : *ports) {
      const auto known = port.valueBytes == 0 ? values_.end() : values_.find(port.type);
      if (known == values_.end() || known->second.bytes == port.valueBytes) continue;
      return failure("node type " + inQuotes(type.name) + ": its " + port.type + " has " +
                         std::to_string(port.valueBytes) + " bytes, that of " +
                         inQuotes(known->second.nodeType) + " has " + std::to_string(known->second.bytes),
                     "build both node packs against the same headers");
    }
  return {};
}

Result<void> Registry::add(NodeType type) {
  SHERD_CHECK(checkTable(type));
  SHERD_CHECK(checkValues(type));
  for (const auto* ports : {&type.inputs, &type.outputs})
    for (const PortInfo& port : *ports)
      if (port.value != nullptr) values_.try_emplace(port.type, KnownValue{port.valueBytes, type.name});
  for (const std::string& former : type.formerNames) formerNames_.emplace(former, type.name);
  const auto found = types_.find(type.name);
  if (found == types_.end()) {
    std::string name = type.name;
    types_.emplace(std::move(name), std::move(type));
    return {};
  }
  if (found->second.version == type.version)
    return failure("node type \"" + type.name + '@' + std::to_string(type.version) + "\" is there already",
                   "load one of the two node packs only");
  if (type.version > found->second.version) found->second = std::move(type);
  return {};
}

const NodeType* Registry::find(const std::string& name) const {
  if (const auto found = types_.find(name); found != types_.end()) return &found->second;
  const auto former = formerNames_.find(name);
  return former == formerNames_.end() ? nullptr : &types_.at(former->second);
}

std::vector<const NodeType*> Registry::all() const {
  std::vector<const NodeType*> list;
  for (const auto& [name, type] : types_) list.push_back(&type);
  return list;
}

}  // namespace sherd
