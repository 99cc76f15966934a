#include "eval/history.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/archive.h"
#include "base/processor.h"
#include "graph/param.h"

namespace sherd {
namespace {

constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kMostNamed = 3;

std::string typeText(const NodeType& type) {
  return type.name + '@' + std::to_string(type.version) + " implementation " +
         std::to_string(type.implementation) + " on " + processorLevel();
}

std::string textOf(const std::vector<std::pair<std::string, std::string>>& params, const ParamInfo& info) {
  for (const auto& [name, text] : params)
    if (name == info.name) return text;
  return paramText(info.fallback);
}

std::string withUnit(const ParamInfo& info, const std::string& before, const std::string& now) {
  return info.name + ' ' + before + " → " + now + (info.unit.empty() ? "" : ' ' + info.unit);
}

}  // namespace

std::string sourceName(const Graph& graph, int reader, int source) {
  const Graph::Node& node = graph.nodes[static_cast<std::size_t>(source)];
  const int own = graph.nodes[static_cast<std::size_t>(reader)].context;
  return node.context == own ? node.name : graph.labelOf(source);
}

PastNode describe(const Graph& graph, int i, const std::vector<std::vector<Digest>>& digests,
                  const WiredFiles& wiredFiles, FileDigests& files) {
  const Graph::Node& node = graph.nodes[static_cast<std::size_t>(i)];
  const NodeType& type = *node.type;
  PastNode past;
  past.type = typeText(type);
  const auto addFile = [&](const std::string& param, const std::string& path) {
    const auto content = files.of(path);
    past.files.push_back({param, path, content.ok() ? *content : Digest{}});
  };
  std::vector<bool> wired(type.params.size(), false);
  for (const Graph::Wire& wire : node.wiredParams) wired[static_cast<std::size_t>(wire.to)] = true;
  for (std::size_t p = 0; p < type.params.size(); ++p) {
    const ParamInfo& info = type.params[p];
    if (wired[p]) {
      for (const auto& [param, path] : wiredFiles)
        if (param == info.name) addFile(param, path);
      continue;
    }
    const ParamValue& value = node.params.at(info.name);
    if (value != info.fallback) past.params.emplace_back(info.name, paramText(value));
    const std::string* path = info.kind == ParamKind::InputFile ? std::get_if<std::string>(&value) : nullptr;
    if (path != nullptr && !path->empty()) addFile(info.name, *path);
  }
  forEachWire(node, [&](const Graph::Wire& wire, bool isParam) {
    const auto place = static_cast<std::size_t>(wire.to);
    const std::vector<Digest>& source = digests[static_cast<std::size_t>(wire.node)];
    const auto output = static_cast<std::size_t>(wire.output);
    past.inputs.push_back({isParam ? type.params[place].name : type.inputs[place].name,
                           sourceName(graph, i, wire.node),
                           output < source.size() ? source[output] : Digest{}});
  });
  return past;
}

void update(History& history, const Graph& graph, int shot, const EvalReport& report, FileDigests& files) {
  std::vector<std::vector<Digest>> digests(graph.nodes.size());
  for (const NodeReport& node : report.nodes) digests[static_cast<std::size_t>(node.node)] = node.digests;
  for (const NodeReport& node : report.nodes) {
    if (node.state != NodeState::Run && node.state != NodeState::Hit) continue;
    if (graph.nodes[static_cast<std::size_t>(node.node)].shot != shot) continue;
    PastNode& past = history[graph.labelOf(node.node)];
    past = describe(graph, node.node, digests, node.wiredFiles, files);
    past.key = node.key;
  }
  std::set<std::string, std::less<>> names;
  for (const Graph::Node& node : graph.nodes)
    if (node.shot == shot) names.insert(node.name);
  std::erase_if(history, [&](const auto& entry) {
    const std::string_view label = entry.first;
    return !names.contains(label) && !names.contains(label.substr(0, label.rfind(" (")));
  });
}

std::string pack(const History& history) {
  ArchiveWriter to;
  to.put(kFormat);
  to.put(static_cast<std::uint64_t>(history.size()));
  for (const auto& [label, node] : history) {
    to.text(label);
    to.text(node.type);
    to.put(static_cast<std::uint64_t>(node.params.size()));
    for (const auto& [name, text] : node.params) {
      to.text(name);
      to.text(text);
    }
    to.put(static_cast<std::uint64_t>(node.files.size()));
    for (const PastNode::File& file : node.files) {
      to.text(file.param);
      to.text(file.path);
      to.put(file.content);
    }
    to.put(static_cast<std::uint64_t>(node.inputs.size()));
    for (const PastNode::Input& input : node.inputs) {
      to.text(input.port);
      to.text(input.source);
      to.put(input.digest);
    }
    to.put(node.key);
  }
  return to.bytes();
}

History unpack(std::string_view bytes) {
  ArchiveReader from(bytes, {});
  History history;
  if (from.get<std::uint32_t>() != kFormat) return {};
  for (auto left = from.get<std::uint64_t>(); left > 0 && from.ok(); --left) {
    const std::string label = from.text();
    PastNode node;
    node.type = from.text();
    for (auto n = from.get<std::uint64_t>(); n > 0 && from.ok(); --n) {
      std::string name = from.text();
      node.params.emplace_back(std::move(name), from.text());
    }
    for (auto n = from.get<std::uint64_t>(); n > 0 && from.ok(); --n) {
      PastNode::File file{from.text(), {}, {}};
      file.path = from.text();
      file.content = from.digest();
      node.files.push_back(std::move(file));
    }
    for (auto n = from.get<std::uint64_t>(); n > 0 && from.ok(); --n) {
      PastNode::Input input{from.text(), {}, {}};
      input.source = from.text();
      input.digest = from.digest();
      node.inputs.push_back(std::move(input));
    }
    node.key = from.digest();
    history.emplace(label, std::move(node));
  }
  return from.ok() && from.atEnd() ? history : History();
}

std::string difference(const PastNode& before, const PastNode& now, const NodeType& type) {
  std::vector<std::string> found;
  if (before.type != now.type) found.push_back(before.type + " → " + now.type);
  for (const ParamInfo& info : type.params) {
    const std::string old = textOf(before.params, info), current = textOf(now.params, info);
    if (old != current) found.push_back(withUnit(info, old, current));
  }
  for (const PastNode::File& file : now.files)
    for (const PastNode::File& old : before.files)
      if (old.param == file.param && old.path == file.path && old.content != file.content)
        found.push_back(std::filesystem::path(file.path).filename().string() + " has changed");
  const bool sameWires = std::equal(before.inputs.begin(), before.inputs.end(), now.inputs.begin(),
                                    now.inputs.end(), [](const PastNode::Input& a, const PastNode::Input& b) {
                                      return a.port == b.port && a.source == b.source;
                                    });
  if (!sameWires) {
    found.emplace_back("wired differently");
  } else {
    for (std::size_t k = 0; k < now.inputs.size(); ++k)
      if (before.inputs[k].digest != now.inputs[k].digest && now.inputs[k].digest != Digest{})
        found.push_back("upstream: " + now.inputs[k].source);
  }
  std::string text;
  for (std::size_t k = 0; k < found.size() && k < kMostNamed; ++k) text += (k == 0 ? "" : ", ") + found[k];
  if (found.size() > kMostNamed) text += " and " + std::to_string(found.size() - kMostNamed) + " more";
  return text;
}

}  // namespace sherd
