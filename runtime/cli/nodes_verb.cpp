#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/verbs.h"
#include "graph/param.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

std::string versioned(const NodeType& type) { return type.name + '@' + std::to_string(type.version); }

/// Characters, not bytes: units such as m³ take more of the latter.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

using Row = std::vector<std::string>;

/// Columns of text, aligned; the last is wrapped to what is left of the line.
void printTable(const std::vector<Row>& rows, int width, std::ostream& out) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows)
    for (std::size_t c = 0; c + 1 < row.size(); ++c) {
      if (widths.size() <= c) widths.push_back(0);
      widths[c] = std::max(widths[c], widthOf(row[c]));
    }
  for (const Row& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c + 1 < row.size(); ++c)
      line += row[c] + std::string(widths[c] - widthOf(row[c]) + 2, ' ');
    const std::size_t indent = widthOf(line);
    const std::size_t right =
        std::max<std::size_t>(indent + 30, static_cast<std::size_t>(std::max(width, 40)));
    std::size_t column = indent;
    const std::string& text = row.back();
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      const std::string word = text.substr(begin, end - begin);
      if (column > indent && column + widthOf(word) > right) {
        line += '\n' + std::string(indent, ' ');
        column = indent;
      }
      line += word + ' ';
      column += widthOf(word) + 1;
      begin = end + 1;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  }
}

void printPorts(const char* title, const std::vector<PortInfo>& ports, bool inputs, Console& console) {
  if (ports.empty()) return;
  console.out << '\n' << title << '\n';
  std::vector<Row> rows;
  for (const PortInfo& port : ports)
    rows.push_back({port.name, port.type, (inputs && !port.required ? "(optional) " : "") + port.help});
  printTable(rows, console.width, console.out);
}

std::string defaultText(const ParamInfo& info) {
  if (info.required) return "required";
  std::string text = paramText(info.fallback);
  if (!info.unit.empty()) text += ' ' + info.unit;
  return text;
}

void printType(const NodeType& type, Console& console) {
  console.out << versioned(type) << (type.writesFiles ? "  (writes files)" : "") << '\n';
  printTable({{type.help}}, console.width, console.out);
  printPorts("Inputs", type.inputs, true, console);
  if (!type.params.empty()) {
    console.out << "\nParameters, with their defaults\n";
    std::vector<Row> rows;
    for (const ParamInfo& info : type.params) {
      std::string help = info.help;
      const std::string range =
          info.kind == ParamKind::Choice ? "one of " + quotedList(info.choices) : rangeText(info);
      if (!range.empty()) help += (help.empty() ? "" : "; ") + range;
      rows.push_back({info.name, kindText(info.kind), defaultText(info), help});
    }
    printTable(rows, console.width, console.out);
  }
  printPorts("Outputs", type.outputs, false, console);
}

Json portsJson(const std::vector<PortInfo>& ports, bool inputs) {
  Json list = Json::array();
  for (const PortInfo& port : ports) {
    Json entry{{"name", port.name}, {"type", port.type}};
    if (inputs) entry["required"] = port.required;
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
  return Json{{"name", type.name},
              {"version", type.version},
              {"help", type.help},
              {"writesFiles", type.writesFiles},
              {"inputs", portsJson(type.inputs, true)},
              {"outputs", portsJson(type.outputs, false)},
              {"params", std::move(params)}};
}

}  // namespace

int nodesVerb(const NodesOptions& options, const Registry& registry, Console& console) {
  std::vector<const NodeType*> types = registry.all();
  if (!options.type.empty()) {
    const NodeType* type = registry.find(options.type.substr(0, options.type.find('@')));
    if (type == nullptr) {
      std::vector<std::string> names;
      for (const NodeType* known : types) names.push_back(known->name);
      console.err << "there is no node type " << inQuotes(options.type) << "; "
                  << suggestion(options.type, names, "node types", "sherd nodes") << '\n';
      return kWrongInput;
    }
    types = {type};
  }
  if (options.json) {
    Json list = Json::array();
    for (const NodeType* type : types) list.push_back(typeJson(*type));
    console.out << list.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else if (!options.type.empty()) {
    printType(*types.front(), console);
  } else {
    std::vector<Row> rows;
    for (const NodeType* type : types) rows.push_back({versioned(*type), type->help});
    printTable(rows, console.width, console.out);
    console.out << "\n`sherd nodes TYPE` tells of inputs, parameters and outputs.\n";
  }
  return kOk;
}

}  // namespace sherd
