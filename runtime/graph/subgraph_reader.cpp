#include "graph/graph_reader.h"
#include "graph/name_rule.h"
#include "graph/suggest.h"

namespace sherd {

using Kind = JsonValue::Kind;

void GraphReader::readSubgraphs(const JsonValue& value, const std::string& inside,
                                std::vector<SubgraphEntry>& list) {
  if (!expect(value, Kind::Object, inside + "subgraphs")) return;
  for (const JsonMember& member : value.members) {
    const std::string where = inside + "subgraphs." + member.key;
    if (!isName(member.key))
      diagnostics_.add(member.origin, where, "this is no name for a subgraph", kNameRule);
    SubgraphEntry& entry = list.emplace_back();
    entry.name = member.key;
    entry.origin = member.origin;
    if (member.value.kind == Kind::String)
      readSubgraphFileName(member.value, where, entry);
    else if (member.value.kind == Kind::Object)
      entry.definition =
          std::make_shared<const Subgraph>(readSubgraph(member.value, inside + member.key + '/'));
    else
      diagnostics_.add(member.value.origin, where, "this is " + kindName(member.value.kind),
                       "it would have to be a subgraph, or the name of a file that holds one");
  }
}

void GraphReader::readSubgraphFileName(const JsonValue& value, const std::string& where,
                                       SubgraphEntry& entry) {
  entry.fileOrigin = value.origin;
  if (value.text.empty())
    diagnostics_.add(value.origin, where, "the name of the file is empty", "name a file with a subgraph");
  else if (value.text.find("${") != std::string::npos)
    diagnostics_.add(value.origin, where, "a subgraph's file can't be named by variables",
                     "write its path, relative to this file");
  else
    entry.file = value.text;
}

Subgraph GraphReader::readSubgraph(const JsonValue& value, const std::string& inside) {
  Names keys{"help", "vars", "inputs", "outputs", "nodes", "subgraphs"};
  const std::string where = inside.substr(0, inside.empty() ? 0 : inside.size() - 1);
  if (inside.empty()) keys.push_back("format");
  findUnknownKeys(value, keys, where, "a subgraph");
  Subgraph subgraph;
  if (const JsonValue* help = value.find("help")) readHelp(*help, inside + "help", subgraph.help);
  if (const JsonValue* vars = value.find("vars")) readVars(*vars, inside, subgraph.vars);
  if (const JsonValue* inputs = value.find("inputs")) readInputs(*inputs, inside, subgraph);
  if (const JsonValue* outputs = value.find("outputs")) readOutputs(*outputs, inside, subgraph);
  if (const JsonValue* list = value.find("subgraphs")) readSubgraphs(*list, inside, subgraph.subgraphs);
  if (const JsonValue* nodes = value.find("nodes"))
    readNodes(*nodes, inside, subgraph.nodes);
  else
    diagnostics_.add(value.origin, where, "the key \"nodes\" is missing", "a subgraph has nodes");
  for (const NodeEntry& node : subgraph.nodes)
    if (node.name == "in")
      diagnostics_.add(node.origin, inside + node.name, "\"in\" stands for the subgraph's inputs",
                       "choose another name for the node");
  return subgraph;
}

void GraphReader::readInputs(const JsonValue& value, const std::string& inside, Subgraph& subgraph) {
  if (!expect(value, Kind::Object, inside + "inputs")) return;
  for (const JsonMember& member : value.members) {
    const std::string where = inside + "inputs." + member.key;
    if (!isName(member.key))
      diagnostics_.add(member.origin, where, "this is no name for an input", kNameRule);
    DeclaredPort& port = subgraph.inputs.emplace_back();
    port.name = member.key;
    port.origin = member.origin;
    if (member.value.kind == Kind::String) {
      readPortType(member.value, where, port);
      continue;
    }
    if (!expect(member.value, Kind::Object, where)) continue;
    findUnknownKeys(member.value, {"type", "optional", "help"}, where, "an input");
    if (const JsonValue* type = member.value.find("type"))
      readPortType(*type, where, port);
    else
      diagnostics_.add(member.value.origin, where, "the key \"type\" is missing",
                       "say what is wired to it, as \"type\": \"TetMesh\"");
    if (const JsonValue* optional = member.value.find("optional");
        optional != nullptr && expect(*optional, Kind::Boolean, where + ".optional"))
      port.optional = optional->boolean;
    if (const JsonValue* help = member.value.find("help")) readHelp(*help, where + ".help", port.help);
  }
}

void GraphReader::readOutputs(const JsonValue& value, const std::string& inside, Subgraph& subgraph) {
  if (!expect(value, Kind::Object, inside + "outputs")) return;
  for (const JsonMember& member : value.members) {
    const std::string where = inside + "outputs." + member.key;
    if (!isName(member.key))
      diagnostics_.add(member.origin, where, "this is no name for an output", kNameRule);
    DeclaredPort& port = subgraph.outputs.emplace_back();
    port.name = member.key;
    port.origin = member.origin;
    port.from = {member.key, member.value.origin, {}, {}};
    if (member.value.kind == Kind::String) {
      readLink(member.value, where, port.from);
      continue;
    }
    if (!expect(member.value, Kind::Object, where)) continue;
    findUnknownKeys(member.value, {"from", "type", "help"}, where, "an output");
    if (const JsonValue* from = member.value.find("from"))
      readLink(*from, where, port.from);
    else
      diagnostics_.add(member.value.origin, where, "the key \"from\" is missing",
                       "say where it comes from, as \"from\": \"node.port\"");
    if (const JsonValue* type = member.value.find("type")) readPortType(*type, where, port);
    if (const JsonValue* help = member.value.find("help")) readHelp(*help, where + ".help", port.help);
  }
}

void GraphReader::readPortType(const JsonValue& value, const std::string& where, DeclaredPort& port) {
  port.typeOrigin = value.origin;
  if (!expect(value, Kind::String, where)) return;
  if (value.text.empty())
    diagnostics_.add(value.origin, where, "the type is empty", "`sherd nodes TYPE` shows the types of ports");
  port.type = value.text;
}

void GraphReader::readHelp(const JsonValue& value, const std::string& where, std::string& help) {
  if (expect(value, Kind::String, where)) help = value.text;
}

}  // namespace sherd
