// Graphs that are longer, wider and more oddly named than anybody's.
#include <nlohmann/json.hpp>

#include "faults/program_process.h"

namespace sherd::faults {
namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t linesWith(const std::string& text, const std::string& part) {
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += holds(line, part);
  return count;
}

/// Each adds a number of its own to what comes before.
std::string chain(int length) {
  std::string nodes;
  for (int i = 0; i < length; ++i) {
    const std::string in = i == 0 ? "" : R"("in": {"a": "n)" + std::to_string(i - 1) + R"("}, )";
    nodes += "\"n" + std::to_string(i) + R"(": {"type": "Add@1", )" + in + R"("params": {"offset": )" +
             std::to_string(i + 1) + "}},\n";
  }
  return R"({"format": 1, "nodes": {)" + nodes + "}}\n";
}

void runAChain(int length) {
  const ScratchDirectory scratch;
  const std::string graph = scratch.file("chain.json"), page = scratch.file("page.html");
  writeText(graph, chain(length));
  const auto sherd = [&](std::vector<std::string> words) {
    words.insert(words.begin() + 1, {graph, "--cache", scratch.file("cache")});
    const Ended ended = runSherd(words, scratch.file(""));
    EXPECT_EQ(ended.exitCode, 0) << ended.err.substr(0, 1000);
    EXPECT_EQ(ended.err, "");
    return ended.out;
  };
  const auto count = static_cast<std::size_t>(length);
  EXPECT_TRUE(holds(sherd({"plan"}), std::to_string(count) + " to run, 0 may run, 0 hits, 0 not needed"));
  EXPECT_EQ(linesWith(sherd({"run", "--json", "--report", page}), R"("state":"run")"), count);
  const std::string html = contentOf(page);
  EXPECT_LT(html.size(), 10u << 20);
  const bool isFolded = holds(html, "Too much for one page: ");
  EXPECT_EQ(isFolded, length > 10'000);
  EXPECT_TRUE(isFolded || holds(html, "n" + std::to_string(length - 1)));
  EXPECT_EQ(linesWith(sherd({"plan", "--json"}), R"("state":"hit")"), count);
  EXPECT_EQ(linesWith(sherd({"run", "--json"}), R"("state":"hit")"), count);
  // A change at the far end runs all again: each sum is another one.
  EXPECT_EQ(linesWith(sherd({"run", "--json", "--set", "n0.offset=1.5"}), R"("state":"run")"), count);
}

TEST(LongChain, ThousandsOfNodesRunAndAreReported) { runAChain(3'000); }
TEST(LongChainSlow, AHundredThousandNodesRunAndAreReported) { runAChain(100'000); }

TEST(WideNode, TakesTenThousandInputs) {
  const ScratchDirectory scratch;
  const std::string graph = scratch.file("wide.json"), page = scratch.file("page.html");
  std::string nodes, in;
  double sum = 0;
  for (int i = 0; i < 10'000; ++i) {
    const std::string number = std::to_string(i);
    nodes += "\"c" + number + R"(": {"type": "Add@1", "params": {"offset": )" + number + "}},\n";
    in += "\"n" + number + R"(": "c)" + number + "\", ";
    sum += i;
  }
  writeText(graph, R"({"format": 1, "nodes": {)" + nodes + R"("wide": {"type": "Wide@1", "in": {)" + in +
                       R"(}, "params": {"name": "sum", "log": ")" + scratch.file("log") + "\"}}}}\n");
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"plan"}, {"run", "--json", "--report", page}, {"plan", "--json"}, {"run"}}) {
    std::vector<std::string> words = verb;
    words.insert(words.begin() + 1, {graph, "--cache", scratch.file("cache")});
    const Ended ended = runSherd(words, scratch.file(""));
    EXPECT_EQ(ended.exitCode, 0) << ended.err.substr(0, 1000);
    EXPECT_EQ(ended.err, "");
  }
  EXPECT_EQ(linesOf(scratch.file("log")),
            std::vector<std::string>{"sum " + std::to_string(static_cast<std::int64_t>(sum))});
  EXPECT_LT(fs::file_size(page), 10u << 20);
  EXPECT_TRUE(holds(contentOf(page), ">wide<"));
}

/// Spaces, several scripts, a character beyond the 16 bits, and what HTML, JSON and shells make something of.
const char* const kOddGraph = R"({"format": 1,
  "vars": {"размер 大": 300, "out": "выход 出力"},
  "targets": {"всё 🦔": ["write <it> & so"]},
  "subgraphs": {"Под граф": {
    "vars": {"число µ": 1},
    "inputs": {"вход a": "FaultBytes"},
    "outputs": {"выход": "первый 节点.bytes"},
    "nodes": {"первый 节点": {"type": "Work@1", "in": {"a": "in.вход a"}, "params": {"seed": "${число µ}"}}}}},
  "nodes": {
    "мой узел 🦔": {"type": "Work@1", "params": {"size": "${размер 大}", "name": "ünï <b> & \"so\" \\ 'on'"}},
    "под": {"type": "Под граф", "in": {"вход a": "мой узел 🦔"}, "params": {"число µ": 3}},
    "write <it> & so": {"type": "WriteFiles@1", "in": {"bytes": "под.выход"},
                        "params": {"directory": "${out}/с пробелом", "count": 2}}
  }})";

TEST(OddNames, GoThroughEveryVerb) {
  const ScratchDirectory scratch;
  const std::string folder = scratch.file("Папка ☃ <b>&amp; 'q' \"d\""), graph = folder + "/граф 図 1.json";
  fs::create_directories(folder);
  writeText(graph, kOddGraph);
  const std::set<std::string> names{"мой узел 🦔", "под/первый 节点", "write <it> & so"};
  const auto sherd = [&](std::vector<std::string> words) {
    words.insert(words.begin() + 1, {graph, "--cache", folder + "/тайник 箱"});
    const Ended ended = runSherd(words, scratch.file(""));
    EXPECT_EQ(ended.exitCode, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return ended.out;
  };
  EXPECT_EQ(namesIn(statesIn(sherd({"plan", "--json"})), "run"), names);
  const std::string page = folder + "/отчёт.html";
  EXPECT_EQ(namesIn(statesIn(sherd({"run", "--json", "--report", page})), "run"), names);
  const auto files = filesBelow(folder + "/выход 出力");
  EXPECT_TRUE(files.contains("с пробелом/piece_2_crack.obj"));
  const std::string html = contentOf(page);
  for (const std::string text : {"мой узел 🦔", "первый 节点"})
    EXPECT_TRUE(holds(html, text)) << text;
  EXPECT_FALSE(holds(html, "write <it> & so"));  // as it stands it would be a tag
  EXPECT_EQ(namesIn(statesIn(sherd({"plan", "--json", "--target", "всё 🦔"})), "hit"), names);
  EXPECT_EQ(namesIn(statesIn(sherd({"run", "--json", "--to", "под"})), "hit"),
            (std::set<std::string>{"мой узел 🦔", "под/первый 节点"}));
  EXPECT_EQ(
      namesIn(
          statesIn(sherd({"run", "--json", "--set", "мой узел 🦔.seed=2", "--var", "размер 大=10"})),
          "run"),
      names);
  for (const std::string& name : names) EXPECT_TRUE(holds(sherd({"plan"}), name)) << name;
}

}  // namespace
}  // namespace sherd::faults
