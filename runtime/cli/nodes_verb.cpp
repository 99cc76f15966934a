#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/node_reference.h"
#include "cli/node_words.h"
#include "cli/schema.h"
#include "cli/text_table.h"
#include "cli/verbs.h"
#include "graph/param.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

/// Nothing where there are no rows.
void printSection(const char* title, const std::vector<Row>& rows, Console& console) {
  if (rows.empty()) return;
  console.out << '\n' << title << '\n';
  printTable(rows, console.width, console.out);
}

void printPorts(const char* title, const std::vector<PortInfo>& ports, bool inputs, Console& console) {
  std::vector<Row> rows;
  for (const PortInfo& port : ports)
    rows.push_back({port.name, port.type, inputs ? helpText(port) : port.help});
  printSection(title, rows, console);
}

void printParams(const NodeType& type, Console& console) {
  std::vector<Row> rows;
  for (const ParamInfo& info : type.params)
    rows.push_back({info.name, kindText(info.kind), defaultText(info), helpText(info)});
  printSection("Parameters, with their defaults", rows, console);
}

void printHistory(const NodeType& type, Console& console) {
  std::vector<Row> waits, versions;
  for (const std::string& wait : waitTexts(type)) waits.push_back({wait});
  printSection("Cancelling waits for", waits, console);
  for (const auto& [step, changes] : migrationTexts(type)) versions.push_back({step, changes});
  printSection("Older versions, which still load", versions, console);
  if (!type.formerNames.empty()) printSection("Former names", {{quotedList(type.formerNames)}}, console);
}

void printType(const NodeType& type, const Registry& registry, Console& console) {
  console.out << versioned(type) << (type.writesFiles ? "  (writes files)" : "") << '\n';
  printTable({{type.help}}, console.width, console.out);
  printPorts("Inputs", type.inputs, true, console);
  printParams(type, console);
  printPorts("Outputs", type.outputs, false, console);
  printHistory(type, console);
  console.out << "\nA node of it, to paste\n"
              << snippetText(snippetOf(type, registry), static_cast<std::size_t>(std::max(console.width, 40)))
              << '\n';
}

Json portsJson(const std::vector<PortInfo>& ports, bool inputs) {
  Json list = Json::array();
  for (const PortInfo& port : ports) {
    Json entry{{"name", port.name}, {"type", port.type}};
    if (inputs) entry["required"] = port.required;
    if (port.gathers) entry["gathers"] = true;
    entry["help"] = port.help;
    list.push_back(std::move(entry));
  }
  return list;
}

Json paramJson(const ParamInfo& info) {
  Json entry{{"name", info.name}, {"kind", kindText(info.kind)}, {"required", info.required}};
  if (!info.unit.empty()) entry["unit"] = info.unit;
  if (!info.required) std::visit([&](const auto& value) { entry["default"] = value; }, info.fallback);
  if (std::isfinite(info.min)) entry[info.openMin ? "above" : "min"] = info.min;
  if (std::isfinite(info.max)) entry[info.openMax ? "below" : "max"] = info.max;
  if (!info.choices.empty()) entry["choices"] = info.choices;
  entry["help"] = info.help;
  return entry;
}

Json typeJson(const NodeType& type) {
  Json params = Json::array();
  for (const ParamInfo& info : type.params) params.push_back(paramJson(info));
  Json waits = Json::array();
  for (const Uninterruptible& wait : type.uninterruptibles)
    waits.push_back({{"call", wait.call}, {"longestMs", wait.longestMs}});
  return Json{{"name", type.name},
              {"version", type.version},
              {"help", type.help},
              {"writesFiles", type.writesFiles},
              {"formerNames", type.formerNames},
              {"uninterruptible", std::move(waits)},
              {"inputs", portsJson(type.inputs, true)},
              {"outputs", portsJson(type.outputs, false)},
              {"params", std::move(params)}};
}

bool migratesFrom(const NodeType& type, const std::string& asked) {
  return std::any_of(type.migrations.begin(), type.migrations.end(), [&](const Migration& migration) {
    return asked == type.name + '@' + std::to_string(migration.from);
  });
}

/// The type that is asked for, "Name" or "Name@N", or null where there is none; then that has been told.
const NodeType* findType(const std::string& asked, const Registry& registry, Console& console) {
  const std::string name = asked.substr(0, asked.find('@'));
  if (const NodeType* type = registry.find(name)) {
    if (name != asked && versioned(*type) != asked)
      console.err << "this is " << versioned(*type) << "; " << inQuotes(asked) << " is "
                  << (migratesFrom(*type, asked) ? "an older version, which still loads" : "not known")
                  << '\n';
    return type;
  }
  std::vector<std::string> names;
  for (const NodeType* known : registry.all()) names.push_back(known->name);
  console.err << "there is no node type " << inQuotes(asked) << "; "
              << suggestion(name, names, "node types", "sherd nodes") << '\n';
  return nullptr;
}

void printList(const std::vector<const NodeType*>& types, Console& console) {
  std::vector<Row> rows;
  for (const NodeType* type : types) rows.push_back({versioned(*type), type->help});
  printTable(rows, console.width, console.out);
  console.out << "\n`sherd nodes TYPE` tells of inputs, parameters and outputs.\n";
}

void printJson(const std::vector<const NodeType*>& types, Console& console) {
  Json list = Json::array();
  for (const NodeType* type : types) list.push_back(typeJson(*type));
  console.out << list.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace

int nodesVerb(const NodesOptions& options, const Registry& registry, Console& console) {
  const NodeType* one = options.type.empty() ? nullptr : findType(options.type, registry, console);
  if (!options.type.empty() && one == nullptr) return kWrongInput;
  const auto types = one == nullptr ? registry.all() : std::vector<const NodeType*>{one};
  if (options.schema)
    console.out << graphSchema(registry);
  else if (options.markdown)
    console.out << nodeReference(registry);
  else if (options.json)
    printJson(types, console);
  else if (one != nullptr)
    printType(*one, registry, console);
  else
    printList(types, console);
  return kOk;
}

}  // namespace sherd
