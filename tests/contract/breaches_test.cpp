// The contract finds what breaks it: made-up nodes, one for each rule.
#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "base/parallel.h"
#include "graph/instances.h"
#include "graph/param.h"
#include "runtime/made_up.h"
#include "support/contract.h"

namespace sherd::test {
namespace {

using namespace std::chrono_literals;

enum class Mode { A, B };
struct Three {
  double data[3] = {0, 0, 0};
  double& operator[](int i) { return data[i]; }
  double operator[](int i) const { return data[i]; }
};
struct Params {
  double length = 1;
  std::int64_t count = 3;
  bool flag = false;
  Three direction;
  Mode mode = Mode::A;
  std::string text, file, out, directory;
};
using Builder = NodeBuilder<Params>;
using Body = std::function<Result<void>(const Params&, NodeIo&)>;

Result<void> nothing(const Params& params, NodeIo& io) {
  io.out("sum", params.length);
  return {};
}

/// A node that keeps all rules of the table.
Builder soundTable() {
  Builder node("Sound", 1, "Does what it says.");
  node.number("length", &Params::length, {.unit = "m", .min = 0, .max = 2, .openMax = true, .help = "of it"})
      .integer("count", &Params::count, {.unit = "pieces", .min = 1, .max = 9, .help = "how many"})
      .boolean("flag", &Params::flag, "whether")
      .vector3("direction", &Params::direction, {.unit = "m", .min = -1, .max = 1, .help = "where to"})
      .choice("mode", &Params::mode, {{"a", Mode::A}, {"b", Mode::B}}, "how")
      .text("text", &Params::text, "a word")
      .inputFile("file", &Params::file, "what is read")
      .outputFile("out", &Params::out, "what is written")
      .outputDirectory("directory", &Params::directory, "where to")
      .output<double>("sum", "of all, m");
  return node;
}
NodeType sound() { return soundTable().run(nothing); }

/// All of them in one text.
std::string joined(const Faults& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + '\n';
  return text;
}

#define EXPECT_FOUND(faults, text) EXPECT_NE(joined(faults).find(text), std::string::npos) << joined(faults)

// ---- The table

TEST(ContractOfTables, ASoundOneKeepsAllRules) {
  const TemporaryDirectory scratch;
  Registry registry;
  ASSERT_TRUE(registry.add(sound()).ok());
  EXPECT_EQ(joined(documentationFaults(sound(), {})), "");
  EXPECT_EQ(joined(keyFaults(sound(), scratch.path().string())), "");
  EXPECT_EQ(joined(badValueFaults(*registry.find("Sound"), registry)), "");
}

TEST(ContractOfTables, HelpAndNamesAreLookedAt) {
  NodeType type = sound();
  type.help.clear();
  type.params[0].help.clear();
  type.params[1].help = "How many";
  type.params[2].help = "whether or not.";
  type.params[3].name = "Direction";
  type.outputs[0].name = "sum total";
  const Faults faults = documentationFaults(type, {});
  EXPECT_EQ(faults.size(), 6u) << joined(faults);
  EXPECT_FOUND(faults, "Sound: has no help");
  EXPECT_FOUND(faults, "Sound.length: has no help");
  EXPECT_FOUND(faults, "Sound.count: its help starts with a capital: \"How\"");
  EXPECT_FOUND(faults, "Sound.flag: its help ends with a full stop");
  EXPECT_FOUND(faults, "Sound.Direction: is no name");
  EXPECT_FOUND(faults, "Sound.sum total: is no name");
  EXPECT_EQ(documentationFaults(type, {.names = {"How"}}).size(), 5u);
}

TEST(ContractOfTables, NumbersNeedAUnitOrADecision) {
  NodeType type = sound();
  type.params[0].unit.clear();
  type.params[1].unit.clear();
  type.params[3].unit.clear();
  type.outputs[0].help = "of all of it";
  const Faults faults = documentationFaults(type, {});
  EXPECT_EQ(faults.size(), 4u) << joined(faults);
  EXPECT_FOUND(faults, "Sound.length: has no unit");
  EXPECT_FOUND(faults, "Sound.count: has no unit");
  EXPECT_FOUND(faults, "Sound.direction: has no unit");
  EXPECT_FOUND(faults, "Sound.sum: its help doesn't end with a unit");
  const ContractExceptions decided{
      .dimensionless = {"Sound.length", "Sound.count", "Sound.direction", "Sound.sum", "Other.length"}};
  EXPECT_EQ(joined(documentationFaults(type, decided)), "");
  EXPECT_EQ(joined(staleExceptions(type, decided)), "");
}

TEST(ContractOfTables, DecisionsThatDoNotApplyAreFound) {
  const Faults faults =
      staleExceptions(sound(), {.dimensionless = {"Sound.length", "Sound.flag", "Sound.lost", "Sound.sum"}});
  EXPECT_EQ(faults.size(), 4u) << joined(faults);
  EXPECT_FOUND(faults, "Sound.lost: is listed as dimensionless, but is no number without a unit");
}

TEST(ContractOfTables, DefaultsAndChoicesAreLookedAt) {
  NodeType type = sound();
  type.params[0].fallback = 2.0;
  type.params[1].fallback = std::int64_t{0};
  type.params[3].fallback = std::vector<double>{0, 0, 1.5};
  type.params[4].choices = {"Not a word"};
  const Faults faults = documentationFaults(type, {});
  EXPECT_EQ(faults.size(), 6u) << joined(faults);
  EXPECT_FOUND(faults, "Sound.length: its default 2 is out of its range");
  EXPECT_FOUND(faults, "Sound.count: its default 0 is out of its range");
  EXPECT_FOUND(faults, "Sound.direction: its default 1.5 is out of its range");
  EXPECT_FOUND(faults, "Sound.mode: \"Not a word\" is no word");
  EXPECT_FOUND(faults, "Sound.mode: leaves no choice");
  EXPECT_FOUND(faults, "Sound.mode: its default is none of its words");
}

TEST(ContractOfTables, ANodeWithoutAnyResultIsFound) {
  NodeType type = sound();
  type.outputs.clear();
  EXPECT_FOUND(documentationFaults(type, {}), "Sound: has no output and writes no files");
}

// ---- Keys

TEST(ContractOfKeys, AForgottenParameterIsFoundWhateverItsKind) {
  const TemporaryDirectory scratch;
  const NodeType type = sound();
  for (const ParamInfo& forgotten : type.params) {
    const RecipeWriter forgetful = [&](Graph::Node& node) {
      node.params[forgotten.name] = defaultParam(forgotten, "/");
      writeRecipe(node);
    };
    const Faults faults = keyFaults(type, scratch.path().string(), forgetful);
    EXPECT_FALSE(faults.empty()) << forgotten.name;
    for (const std::string& fault : faults)
      EXPECT_EQ(fault.rfind("Sound." + forgotten.name + ": ", 0), 0u) << fault;
  }
}

TEST(ContractOfKeys, ARoundedParameterIsFound) {
  const TemporaryDirectory scratch;
  const RecipeWriter rough = [](Graph::Node& node) {
    double& length = std::get<double>(node.params["length"]);
    length = static_cast<float>(length);
    writeRecipe(node);
  };
  EXPECT_FOUND(keyFaults(sound(), scratch.path().string(), rough), "Sound.length: length = 1");
}

TEST(ContractOfKeys, AParameterOfOneValueIsFound) {
  const TemporaryDirectory scratch;
  NodeType type = sound();
  type.params[1].min = type.params[1].max = 3;
  EXPECT_FOUND(keyFaults(type, scratch.path().string()), "Sound.count: has but one value");
}

// ---- Bad values

TEST(ContractOfBadValues, ARangeThatIsNotCheckedIsFound) {
  Registry registry;
  NodeType lax = sound();
  lax.params[0].min = -1;
  lax.params[1].max = 10;
  lax.params[3].openMin = false;
  lax.params[3].min = -2;
  ASSERT_TRUE(registry.add(std::move(lax)).ok());
  const Faults faults = badValueFaults(sound(), registry);
  EXPECT_EQ(faults.size(), 5u) << joined(faults);
  EXPECT_FOUND(faults, "Sound.length: -5e-324 is not rejected with its place");
  EXPECT_FOUND(faults, "Sound.count: 10 is not rejected with its place");
  EXPECT_FOUND(faults, "Sound.direction: [0, -1.0000000000000002, 0] is not rejected with its place");
}

TEST(ContractOfBadValues, AWrongKindThatIsTakenIsFound) {
  Registry registry;
  NodeType lax = sound();
  lax.params[2].kind = ParamKind::Text;
  ASSERT_TRUE(registry.add(std::move(lax)).ok());
  EXPECT_FOUND(badValueFaults(sound(), registry), "Sound.flag: \"yes\" is not rejected with its place");
}

// ---- Runs

/// A node "Made", its Registry and an example of it in a directory of its own.
class Made {
 public:
  explicit Made(Body body, double uninterruptibleMs = 0) {
    Builder node("Made", 1, "Made up.");
    node.inputFile("file", &Params::file, "what is read")
        .outputFile("out", &Params::out, "what is written")
        .outputDirectory("directory", &Params::directory, "where to")
        .output<double>("sum", "of all, m");
    if (uninterruptibleMs > 0) node.uninterruptible("a library's call", uninterruptibleMs);
    EXPECT_TRUE(registry_.add(node.run(std::move(body))).ok());
    directory_.write("in.txt", "content");
    const std::string graph = directory_.write(
        "examples.json",
        R"({"format": 1, "nodes": {"it": {"type": "Made@1", "params": {"file": "in.txt", "out": "out.txt", "directory": "dir"}}}})");
    auto read = Examples::read(graph, registry_, environment(directory_.path()), {});
    EXPECT_TRUE(read.ok()) << read.error().text();
    if (read.ok()) examples_ = std::move(read).value();
  }
  Example example() const { return examples_->of(*registry_.find("Made")).value().at(0); }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  Registry& registry() { return registry_; }
  Examples& examples() { return *examples_; }

 private:
  TemporaryDirectory directory_;
  Registry registry_;
  std::unique_ptr<Examples> examples_;
};

TEST(ContractOfExamples, ATypeWithoutOneIsFound) {
  Made made(nothing);
  EXPECT_EQ(joined(made.examples().missing(made.registry())), "");
  ASSERT_TRUE(made.registry().add(sound()).ok());
  EXPECT_FOUND(made.examples().missing(made.registry()), "Sound: has no example; add it to ");
  const auto none = made.examples().of(*made.registry().find("Sound"));
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().what, "Sound has no example");
}

TEST(ContractOfReads, DeclaredFilesAreNoFault) {
  const Made made([](const Params& params, NodeIo& io) {
    std::string word;
    std::ifstream(params.file) >> word;
    std::ofstream(params.out) << word;
    std::filesystem::create_directories(params.directory);
    std::ofstream(params.directory + "/inside.txt") << word;
    return nothing(params, io);
  });
  EXPECT_EQ(joined(undeclaredReads(made.example(), {})), "");
}

/// That reading `path` as `read` does is found.
void expectFileFound(const std::function<void(const std::string&)>& read) {
  const TemporaryDirectory elsewhere;
  const std::string path = elsewhere.write("hidden.txt", "content");
  const Made made([&](const Params& params, NodeIo& io) {
    read(path);
    return nothing(params, io);
  });
  const Faults faults = undeclaredReads(made.example(), {});
  ASSERT_EQ(faults.size(), 1u) << joined(faults);
  EXPECT_EQ(faults[0], "Made (\"it\"): opens the file \"" + path + "\", which no parameter names");
  EXPECT_EQ(joined(undeclaredReads(made.example(), {.files = {elsewhere.path().string()}})), "");
}

void readStream(const std::string& path) {
  std::string word;
  std::ifstream(path) >> word;
  EXPECT_EQ(word, "content");
}

TEST(ContractOfReads, AHiddenFileIsFoundThroughAStream) { expectFileFound(readStream); }

TEST(ContractOfReads, AHiddenFileIsFoundThroughTheCLibrary) {
  expectFileFound([](const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    ASSERT_NE(file, nullptr);
    std::fclose(file);
  });
}

TEST(ContractOfReads, AHiddenFileIsFoundOnAnotherThread) {
  expectFileFound([](const std::string& path) { std::thread(readStream, path).join(); });
  expectFileFound([](const std::string& path) {
    parallelFor({}, 64, 1, [&](std::size_t, std::size_t) { readStream(path); });
  });
}

TEST(ContractOfReads, AListedDirectoryIsFound) {
  const TemporaryDirectory elsewhere;
  const Made made([&](const Params& params, NodeIo& io) {
    for (const auto& entry : std::filesystem::directory_iterator(elsewhere.path())) (void)entry;
    return nothing(params, io);
  });
  EXPECT_FOUND(undeclaredReads(made.example(), {}), "opens the file \"" + elsewhere.path().string() + '"');
}

TEST(ContractOfReads, ANeighbourOfADeclaredFileIsFound) {
  const Made made([](const Params& params, NodeIo& io) {
    std::ifstream(params.file + ".mtl");
    std::ofstream(params.directory + "_too");
    std::ofstream(params.out + ".log");
    return nothing(params, io);
  });
  EXPECT_EQ(undeclaredReads(made.example(), {}).size(), 3u);
}

TEST(ContractOfReads, RealRandomNumbersAreFound) {
  const Made made([](const Params& params, NodeIo& io) {
    std::random_device device("/dev/urandom");
    (void)device();
    return nothing(params, io);
  });
  EXPECT_FOUND(undeclaredReads(made.example(), {}), "opens the file \"/dev/urandom\"");
}

TEST(ContractOfReads, AVariableOfTheEnvironmentIsFound) {
  const Made made([](const Params& params, NodeIo& io) {
    (void)std::getenv("SHERD_HIDDEN_A");
    parallelFor({}, 64, 1, [&](std::size_t, std::size_t) { (void)::secure_getenv("SHERD_HIDDEN_B"); });
    return nothing(params, io);
  });
  const Faults faults = undeclaredReads(made.example(), {});
  EXPECT_EQ(faults.size(), 2u) << joined(faults);
  EXPECT_FOUND(faults,
               "Made (\"it\"): reads the environment variable SHERD_HIDDEN_A, which is no part of its");
  EXPECT_FOUND(faults, "reads the environment variable SHERD_HIDDEN_B");
  EXPECT_EQ(joined(undeclaredReads(made.example(), {.variables = {"SHERD_HIDDEN_"}})), "");
}

TEST(ContractOfThreads, ResultsThatDependOnThemAreFound) {
  const Made made([](const Params&, NodeIo& io) {
    io.out("sum", static_cast<double>(threadLimit()));
    return Result<void>();
  });
  const Faults faults = nondeterminism(made.example());
  EXPECT_EQ(faults.size(), 2u) << joined(faults);
  EXPECT_FOUND(faults, "Made (\"it\"): sum is another one with 4 threads than with one");
}

TEST(ContractOfThreads, ResultsThatDifferEveryTimeAreFound) {
  double runs = 0;
  const Made made([&](const Params&, NodeIo& io) {
    io.out("sum", ++runs);
    return Result<void>();
  });
  EXPECT_FOUND(nondeterminism(made.example()), "sum is another one the second time");
}

TEST(ContractOfThreads, WrittenFilesThatDifferAreFound) {
  int runs = 0;
  const Made made([&](const Params& params, NodeIo& io) {
    std::ofstream(params.out) << ++runs;
    io.wrote(params.out);
    return nothing(params, io);
  });
  EXPECT_FOUND(nondeterminism(made.example()), "out.txt\" is another one");
}

// ---- Cancelling

/// Works for so long, asking now and then whether to end.
Body busy(std::chrono::milliseconds whole, std::chrono::milliseconds between) {
  return [=](const Params& params, NodeIo& io) -> Result<void> {
    const auto start = std::chrono::steady_clock::now();
    auto asked = start;
    for (auto now = start; now - start < whole; now = std::chrono::steady_clock::now()) {
      if (now - asked < between) continue;
      asked = now;
      if (io.exec().cancelled()) return cancelledError();
    }
    return nothing(params, io);
  };
}

TEST(ContractOfCancelling, ANodeThatAsksOftenKeepsIt) {
  const Made made(busy(60ms, 1ms));
  const CancelResult result = cancelling(made.example());
  EXPECT_EQ(joined(result.faults), "");
  EXPECT_GE(result.cancelled, 3);
  EXPECT_GE(result.usualMs, 60);
  EXPECT_LT(result.longestMs, 100);
}

TEST(ContractOfCancelling, ANodeThatAsksSeldomIsFound) {
  const Made made(busy(200ms, 1h));
  const CancelResult result = cancelling(made.example(), {.delays = 2, .mostMs = 20, .repetitions = 2});
  ASSERT_FALSE(result.faults.empty());
  EXPECT_FOUND(result.faults, "ms after it is cancelled at ");
  EXPECT_FOUND(result.faults, "it would have to in 20: check exec.cancelled() more often");
  EXPECT_GT(result.longestMs, 20);
}

TEST(ContractOfCancelling, ALibrarysCallMayTakeThreeTimesWhatWasMeasured) {
  const Made made(busy(100ms, 1h), /*uninterruptibleMs=*/1000);
  EXPECT_EQ(joined(cancelling(made.example(), {.delays = 2, .mostMs = 1, .repetitions = 1}).faults), "");
}

TEST(ContractOfCancelling, AFailureThatIsNoCancellationIsFound) {
  const Made made([](const Params& params, NodeIo& io) -> Result<void> {
    for (int i = 0; i < 50; ++i) {
      if (io.exec().cancelled()) return failure("half of it is missing");
      std::this_thread::sleep_for(1ms);
    }
    return nothing(params, io);
  });
  EXPECT_FOUND(cancelling(made.example()).faults,
               "it fails with \"half of it is missing\" instead of cancelledError()");
}

}  // namespace

// ---- Values that don't survive the disk

struct Forgetful {
  static constexpr const char* typeName = "Forgetful";
  static constexpr int archiveVersion = 1;
  double kept = 1, lost = 0;
};
void hashValue(Hasher& hasher, const Forgetful& value) { hasher.add(value.kept).add(value.lost); }
std::size_t byteSize(const Forgetful&) { return sizeof(Forgetful); }
void saveValue(ArchiveWriter& to, const Forgetful& value) { to.put(value.kept); }
std::optional<Forgetful> loadValue(ArchiveReader& from, std::type_identity<Forgetful>) {
  Forgetful value;
  from.get(value.kept);
  return value;
}

struct Homeless {
  static constexpr const char* typeName = "Homeless";
};
void hashValue(Hasher&, const Homeless&) {}
std::size_t byteSize(const Homeless&) { return 1; }

namespace {

template <class T>
Faults roundTripOf(const T& value) {
  Registry registry;
  struct None {};
  NodeBuilder<None> node("Maker", 1, "Makes one.");
  node.template output<T>("value", "the value");
  EXPECT_TRUE(registry
                  .add(node.run([value](const None&, NodeIo& io) -> Result<void> {
                    io.out("value", value);
                    return {};
                  }))
                  .ok());
  const TemporaryDirectory directory;
  const std::string graph =
      directory.write("examples.json", R"({"format": 1, "nodes": {"it": {"type": "Maker@1"}}})");
  auto examples = Examples::read(graph, registry, environment(directory.path()), {});
  EXPECT_TRUE(examples.ok());
  return roundTripFaults((*examples)->of(*registry.find("Maker")).value().at(0), directory.path().string());
}

TEST(ContractOfRoundTrips, WhatIsLostOnTheWayIsFound) {
  EXPECT_EQ(joined(roundTripOf(Forgetful{})), "");
  EXPECT_FOUND(roundTripOf(Forgetful{1, 2}),
               "Maker (\"it\"): value comes back from the disk cache as something else");
}

TEST(ContractOfRoundTrips, AValueThatCannotBeKeptIsFound) {
  EXPECT_FOUND(roundTripOf(Homeless{}), "Maker (\"it\"): value can't be kept in the disk cache");
}

TEST(ContractOfRoundTrips, ScalarsAreKept) {
  EXPECT_EQ(joined(roundTripOf(std::string("text"))), "");
  EXPECT_EQ(joined(roundTripOf(0.1)), "");
}

}  // namespace
}  // namespace sherd::test
