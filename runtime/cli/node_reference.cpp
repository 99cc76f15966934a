#include "cli/node_reference.h"

#include "cli/node_words.h"
#include "cli/text_table.h"
#include "graph/param.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

constexpr const char* kIntroduction =
    R"(# Node reference

Generated from the nodes' own tables; `sherd nodes TYPE` prints the same for one type. After changing a node, from
the top of the tree:

    SHERD_NODE_PATH= build/bin/sherd nodes --markdown > nodes/README.md

Any parameter but a list can be wired in `in` instead of being set in `params`. Paths are relative to
the graph file.

)";

/// Bars would end the cell, angle brackets begin HTML, stars emphasis.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '>' || c == '*' || c == '\\') safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

std::string code(const std::string& text) { return '`' + text + '`'; }

std::string table(const Row& titles, const std::vector<Row>& rows) {
  if (rows.empty()) return {};
  std::string text;
  auto line = [&](const Row& row) {
    for (const std::string& cell : row) text += "| " + cell + ' ';
    text += "|\n";
  };
  line(titles);
  line(Row(titles.size(), "---"));
  for (const Row& row : rows) line(row);
  return text + '\n';
}

std::string portTable(const char* title, const std::vector<PortInfo>& ports, bool inputs) {
  std::vector<Row> rows;
  for (const PortInfo& port : ports)
    rows.push_back({code(port.name), port.type, escaped(inputs ? helpText(port) : port.help)});
  return table({title, "Type", ""}, rows);
}

std::string paramTable(const std::vector<ParamInfo>& params) {
  std::vector<Row> rows;
  for (const ParamInfo& info : params)
    rows.push_back({code(info.name), kindText(info.kind),
                    info.required ? "required" : escaped(defaultText(info)), escaped(helpText(info))});
  return table({"Parameter", "Kind", "Default", ""}, rows);
}

std::string versionsText(const NodeType& type) {
  std::string text;
  for (const auto& [versions, steps] : migrationTexts(type))
    text += "Version " + versions + ": " + escaped(steps) + ".\n\n";
  if (!type.formerNames.empty()) text += "Formerly " + quotedList(type.formerNames) + ".\n\n";
  return text;
}

std::string section(const NodeType& type, const Registry& registry) {
  std::string text = "## " + versioned(type) + "\n\n" + escaped(type.help) + "\n\n";
  if (type.writesFiles) text += "Writes files.\n\n";
  text += portTable("Input", type.inputs, true);
  text += paramTable(type.params);
  text += portTable("Output", type.outputs, false);
  for (const std::string& wait : waitTexts(type)) text += "Cancelling waits for " + escaped(wait) + ".\n\n";
  text += versionsText(type);
  return text + "```json\n" + snippetText(snippetOf(type, registry), 100) + "\n```\n";
}

}  // namespace

std::string nodeReference(const Registry& registry) {
  std::string text = kIntroduction;
  for (const NodeType* type : registry.all()) {
    std::string anchor;
    for (const char c : versioned(*type))
      if (c != '@') anchor += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    text += "- [" + versioned(*type) + "](#" + anchor + "): " + escaped(type->help) + '\n';
  }
  for (const NodeType* type : registry.all()) text += '\n' + section(*type, registry);
  return text;
}

}  // namespace sherd
