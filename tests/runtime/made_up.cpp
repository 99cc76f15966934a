#include "runtime/made_up.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/parallel.h"
#include "graph/migrate.h"
#include "graph/subgraphs.h"

namespace sherd::test {

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (fs::temp_directory_path() / "sherd_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) std::abort();
  path_ = fs::canonical(name);
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code problem;
  fs::remove_all(path_, problem);
}

std::string TemporaryDirectory::write(const std::string& name, const std::string& content) const {
  const fs::path path = path_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
  return path.string();
}

void hashValue(Hasher& hasher, const Blob& blob) { hasher.add(blob.numbers); }
std::size_t byteSize(const Blob& blob) { return blob.numbers.size() * sizeof(double); }
void saveValue(ArchiveWriter& to, const Blob& blob) { to.array(blob.numbers); }
std::optional<Blob> loadValue(ArchiveReader& from, std::type_identity<Blob>) {
  Blob blob;
  from.array(blob.numbers);
  if (!from.ok()) return std::nullopt;
  return blob;
}

namespace {

struct ConstantParams {
  double value = 0;
};
struct AddParams {
  double offset = 0;
};
struct BlobParams {
  int size = 1000;
  std::int64_t seed = 0;
};
struct FileParams {
  std::string file;
};
struct WordParams {
  std::string text = "word";
};
struct SinkParams {
  std::string directory;
};
struct NoParams {};
enum class Mode { Fast, Exact };
struct Three {
  double data[3] = {0, 0, 0};
  double& operator[](int i) { return data[i]; }
  double operator[](int i) const { return data[i]; }
};
struct KindsParams {
  bool flag = false;
  int count = 1;
  double length = 1;
  Three direction;
  std::string text = "t";
  Mode mode = Mode::Fast;
};

NodeType constantNode(const std::shared_ptr<Counters>& counters) {
  return NodeBuilder<ConstantParams>("Constant", 1, "A number.")
      .number("value", &ConstantParams::value, {.min = -1000, .max = 1000, .help = "the number"})
      .output<double>("value", "the number")
      .output<std::int64_t>("whole", "its whole part")
      .run([counters](const ConstantParams& params, NodeIo& io) -> Result<void> {
        ++counters->constants;
        io.out<double>("value", params.value);
        io.out<std::int64_t>("whole", static_cast<std::int64_t>(params.value));
        return {};
      });
}

NodeType addNode(const std::shared_ptr<Counters>& counters) {
  return NodeBuilder<AddParams>("Add", 1, "Adds.")
      .input<double>("a", "a number")
      .optionalInput<double>("b", "another")
      .number("offset", &AddParams::offset, {.unit = "m", .min = -100, .max = 100, .openMax = true})
      .output<double>("sum", "a + b + offset")
      .run([counters](const AddParams& params, NodeIo& io) -> Result<void> {
        ++counters->adds;
        const auto b = io.in<double>("b");
        io.out<double>("sum", *io.in<double>("a") + (b ? *b : 0) + params.offset);
        return {};
      });
}

NodeType makeBlobNode(const std::shared_ptr<Counters>& counters) {
  return NodeBuilder<BlobParams>("MakeBlob", 1, "Many numbers.")
      .integer("size", &BlobParams::size, {.min = 0, .max = 1e7})
      .integer("seed", &BlobParams::seed, {.min = 0})
      .output<Blob>("blob", "the numbers")
      .run([counters](const BlobParams& params, NodeIo& io) -> Result<void> {
        ++counters->blobs;
        Blob blob;
        blob.numbers.resize(static_cast<std::size_t>(params.size));
        parallelFor(io.exec(), blob.numbers.size(), 100, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            blob.numbers[i] = 1.0 / static_cast<double>(i + 3) + static_cast<double>(params.seed);
        });
        io.out("blob", std::move(blob));
        return {};
      });
}

NodeType passBlobNode() {
  return NodeBuilder<NoParams>("PassBlob", 1, "Passes through.")
      .input<Blob>("blob", "numbers")
      .output<Blob>("blob", "the same")
      .run([](const NoParams&, NodeIo& io) -> Result<void> {
        io.outShared<Blob>("blob", io.in<Blob>("blob"));
        return {};
      });
}

NodeType sumBlobNode() {
  return NodeBuilder<NoParams>("SumBlob", 1, "Sums up.")
      .input<Blob>("blob", "numbers")
      .output<double>("sum", "their sum")
      .run([](const NoParams&, NodeIo& io) -> Result<void> {
        const auto blob = io.in<Blob>("blob");
        io.out<double>("sum", parallelSum(io.exec(), blob->numbers.size(), 64, 0.0,
                                          [&](std::size_t begin, std::size_t end) {
                                            double sum = 0;
                                            for (std::size_t i = begin; i < end; ++i) sum += blob->numbers[i];
                                            return sum;
                                          }));
        return {};
      });
}

NodeType readTextNode(const std::shared_ptr<Counters>& counters) {
  return NodeBuilder<FileParams>("ReadText", 1, "Reads a file.")
      .inputFile("file", &FileParams::file, "a file")
      .output<std::string>("text", "its content")
      .run([counters](const FileParams& params, NodeIo& io) -> Result<void> {
        ++counters->reads;
        std::ifstream file(params.file);
        std::stringstream text;
        text << file.rdbuf();
        io.out<std::string>("text", text.str());
        return {};
      });
}

NodeType wordNode() {
  return NodeBuilder<WordParams>("Word", 1, "A text.")
      .text("text", &WordParams::text, "the text")
      .output<std::string>("text", "the text")
      .run([](const WordParams& params, NodeIo& io) -> Result<void> {
        io.out<std::string>("text", params.text);
        return {};
      });
}

NodeType sinkNode(const std::shared_ptr<Counters>& counters) {
  return NodeBuilder<SinkParams>("Sink", 1, "Writes a number.")
      .input<double>("value", "the number")
      .outputDirectory("directory", &SinkParams::directory, "where to")
      .writesFiles()
      .run([counters](const SinkParams& params, NodeIo& io) -> Result<void> {
        ++counters->sinks;
        fs::create_directories(params.directory);
        const std::string path = params.directory + "/value.txt";
        std::ofstream(path) << *io.in<double>("value");
        io.wrote(path);
        return {};
      });
}

NodeType kindsNode() {
  return NodeBuilder<KindsParams>("Kinds", 2, "Parameters of all kinds.")
      .boolean("flag", &KindsParams::flag, "a flag")
      .integer("count", &KindsParams::count, {.min = 1, .max = 10, .help = "a count"})
      .number("length", &KindsParams::length, {.unit = "m", .min = 0, .openMin = true, .help = "a length"})
      .vector3("direction", &KindsParams::direction, {.min = -1, .max = 1})
      .text("text", &KindsParams::text, "a text")
      .choice("mode", &KindsParams::mode, {{"fast", Mode::Fast}, {"exact", Mode::Exact}}, "a mode")
      .output<std::string>("text", "the text")
      .run([](const KindsParams& params, NodeIo& io) -> Result<void> {
        io.out<std::string>("text", params.text);
        return {};
      });
}

}  // namespace

Registry madeUpNodes(const std::shared_ptr<Counters>& counters) {
  Registry registry;
  for (NodeType& type : std::vector<NodeType>{
           constantNode(counters), addNode(counters), makeBlobNode(counters), passBlobNode(), sumBlobNode(),
           readTextNode(counters), wordNode(), sinkNode(counters), kindsNode()}) {
    const auto added = registry.add(std::move(type));
    if (!added.ok()) ADD_FAILURE() << added.error().text();
  }
  return registry;
}

Environment environment(const fs::path& current, const fs::path& assets) {
  return {current, assets, [](const std::string& name) -> std::optional<std::string> {
            if (name == "SET_OUTSIDE") return "outside";
            if (name == "SET_TO_SEVEN") return "7";
            return std::nullopt;
          }};
}

Checked check(const std::string& text, const Registry& registry, const std::vector<std::string>& sets,
              const std::vector<std::string>& vars, const fs::path& directory) {
  Diagnostics diagnostics;
  const Environment outside = environment();
  Overrides overrides;
  for (const std::string& set : sets)
    overrides.sets.push_back(parseAssignment("--set", set, outside).value());
  for (const std::string& var : vars)
    overrides.vars.push_back(parseAssignment("--var", var, outside).value());
  GraphFile file =
      readGraph(text, std::make_shared<const Source>(Source{"test.json", directory}), diagnostics);
  expandSubgraphs(file, diagnostics);
  Checked checked;
  migrate(file, registry, diagnostics, checked.notes);
  checked.graph = checkGraph(file, registry, overrides, outside, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.sorted()) checked.errors.push_back(diagnostic.text());
  return checked;
}

Graph graphOf(const std::string& nodes, const Registry& registry, const fs::path& directory,
              const std::string& more) {
  Checked checked =
      check("{\"format\": 1, " + more + "\"nodes\": {" + nodes + "}}", registry, {}, {}, directory);
  for (const std::string& error : checked.errors) ADD_FAILURE() << error;
  return std::move(checked.graph);
}

std::vector<int> nodesOf(const Graph& graph, const std::vector<std::string>& names) {
  std::vector<int> nodes;
  for (const std::string& name : names) nodes.push_back(graph.find(name));
  return nodes;
}

Value valueAt(const Graph& graph, const EvalReport& report, const std::string& node,
              const std::string& port) {
  const int i = graph.find(node);
  const auto found = report.outputs.find(i);
  if (found == report.outputs.end()) return {};
  const std::vector<PortInfo>& ports = graph.nodes[static_cast<std::size_t>(i)].type->outputs;
  for (std::size_t o = 0; o < ports.size(); ++o)
    if (ports[o].name == port) return found->second.at(o).value;
  return {};
}

double numberAt(const Graph& graph, const EvalReport& report, const std::string& node,
                const std::string& port) {
  const Value value = valueAt(graph, report, node, port);
  return value.empty() ? std::numeric_limits<double>::quiet_NaN() : *value.as<double>();
}

std::string stateOf(const Graph& graph, const EvalReport& report, const std::string& node) {
  for (const NodeReport& entry : report.nodes)
    if (entry.node == graph.find(node)) return stateName(entry.state);
  return "absent";
}

}  // namespace sherd::test
