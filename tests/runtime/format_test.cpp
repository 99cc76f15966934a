// `fmt`: the layout, what it keeps, and that it keeps everything of random documents.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/line_diff.h"
#include "base/rng.h"
#include "cli/verbs.h"
#include "graph/document.h"
#include "graph/json.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

std::string formatted(const std::string& text) {
  Diagnostics diagnostics;
  const Document document(text, nullptr, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.sorted())
    ADD_FAILURE() << diagnostic.text() << '\n' << text;
  return diagnostics.empty() ? document.formatted() : std::string();
}

namespace fs = std::filesystem;

std::string contentOfFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string contentOf(const std::string& text) {
  Diagnostics diagnostics;
  const auto value = parseJson(text, nullptr, diagnostics);
  return value ? jsonText(*value) : "no JSON";
}

TEST(Format, LaysOutAGraph) {
  EXPECT_EQ(formatted(R"(// head
{"format":1,  // one
  "vars":{"a":1.50e3,"b":[1,2,
   3]},


  "nodes":{
    "c":   {"type":"Constant@1"},  // c

    // about d
    "d":{"type":"Add@1","in":{"a":"c","b":"a rather long name of a node"},"params":{"offset":"another long text"}},}} // end
/* last */)"),
            R"(// head
{
  "format": 1,  // one
  "vars": { "a": 1.50e3, "b": [1, 2, 3] },

  "nodes": {
    "c": { "type": "Constant@1" },  // c

    // about d
    "d": {
      "type": "Add@1",
      "in": { "a": "c", "b": "a rather long name of a node" },
      "params": { "offset": "another long text" }
    }
  }
}  // end
/* last */
)");
}

TEST(Format, KeepsWhatIsLinedUp) {
  const std::string kept = R"({
  "vars": {
    "seed": 7,        // any
    "gamma": 2.5e-3,  // J·m²
    "out": "x"
  },
  "nodes": {
    "mesh": { "type": "LoadMesh@1" },

    // A comment between.
    "bärte": { "type": "Embed@1" },
    "hit":   { "type": "Simulate@1", "in": { "body": "a rather long name of a node", "other": "second" },
               "params": { "height": 1.0, "orientation": [25, 0, 15],
                           "speed": 20,  // m/s
                           "target": [0.35, 0.6, 0.5] } }
  },
  "list": [1000000000, 1000000000, 1000000000, 1000000000, 1000000000, 1000000000, 1000000000,
           2000000000, 2000000000, 2000000000, 2000000000]
}
)";
  const std::string mesh = "\"mesh\": {";
  std::string aligned = kept;
  aligned.replace(aligned.find(mesh), mesh.size(), "\"mesh\":  {");
  EXPECT_EQ(formatted(aligned), aligned);
  EXPECT_EQ(formatted(kept), kept);
}

TEST(Format, LinesUpAnew) {
  // One name has become longer, and one comment has moved.
  EXPECT_EQ(formatted(R"({"nodes": {
    "a":   { "type": "X" },
    "longer": { "type": "X" },
    "bcd": { "type": "X" } },
  "vars": {
    "a": [1, 2, 3, 4], // one
    "b": 1,     // two
    "c": 1.5,   // three
    "d": 12}
})"),
            R"({
  "nodes": {
    "a":      { "type": "X" },
    "longer": { "type": "X" },
    "bcd":    { "type": "X" }
  },
  "vars": {
    "a": [1, 2, 3, 4],  // one
    "b": 1,             // two
    "c": 1.5,           // three
    "d": 12
  }
}
)");
  const std::string single = "{\n  \"a\":    1,      // one\n  \"bc\": 2\n}\n";
  EXPECT_EQ(formatted(single), "{\n  \"a\": 1,  // one\n  \"bc\": 2\n}\n");
}

TEST(Format, BreaksWhatIsTooLongAmongWhatIsLinedUp) {
  const std::string text(60, 'x');
  EXPECT_EQ(formatted("{\"nodes\": {\n\"a\":    { \"t\": 1 },\n\"long\": { \"t\": \"" + text +
                      "\", \"u\": \"" + text + "\" } } }"),
            "{\n  \"nodes\": {\n    \"a\":    { \"t\": 1 },\n    \"long\": { \"t\": \"" + text +
                "\",\n              \"u\": \"" + text + "\" }\n  }\n}\n");
}

TEST(Format, LinesUpGroupsByThemselves) {
  const std::string kept = R"({
  "nodes": {
    "mesh":   { "type": "X" },
    "longer": { "type": "X" },

    // Another group.
    "splinter_crack": { "type": "X" },
    "tets":           { "type": "X" },

    "alone": { "type": "X" },

    "not": { "type": "X" },
    "lined": { "type": "X" },
    "up": { "type": "X" }
  }
}
)";
  EXPECT_EQ(formatted(kept), kept);
}

TEST(Format, BreaksHangingLinesThatAreTooLong) {
  const std::string text(40, 'x');
  EXPECT_EQ(formatted("{\"nodes\": {\"a\": { \"b\": \"" + text + "\", \"c\": \"" + text + "\", \"d\": \"" +
                      text + "\",\n\"e\": 1}}}"),
            "{\n  \"nodes\": {\n    \"a\": { \"b\": \"" + text + "\", \"c\": \"" + text +
                "\",\n           \"d\": \"" + text + "\",\n           \"e\": 1 }\n  }\n}\n");
  // So are objects in them.
  const std::string half(70, 'x');
  EXPECT_EQ(formatted("{\"nodes\": {\"a\": { \"type\": \"X\",\n\"params\": { \"b\": \"" + half +
                      "\", \"c\": \"" + half + "\"}}}}"),
            "{\n  \"nodes\": {\n    \"a\": { \"type\": \"X\",\n           \"params\": { \"b\": \"" + half +
                "\",\n                       \"c\": \"" + half + "\" } }\n  }\n}\n");
  // What fits nowhere stands below.
  const std::string endless(130, 'x');
  EXPECT_EQ(
      formatted("{\"nodes\": {\"a\": { \"b\": 1,\n\"c\": \"" + endless + "\"}}}"),
      "{\n  \"nodes\": {\n    \"a\": {\n      \"b\": 1,\n      \"c\": \"" + endless + "\"\n    }\n  }\n}\n");
}

TEST(Format, ShippedGraphsAreInItsForm) {
  std::vector<fs::path> files{SHERD_SOURCE_DIR "/tests/sdk_example/volume.json"};
  for (const auto& entry : fs::recursive_directory_iterator(SHERD_SOURCE_DIR "/graphs"))
    if (entry.path().extension() == ".json" && entry.path().string().find("/out/") == std::string::npos)
      files.push_back(entry.path());
  EXPECT_GE(files.size(), 8u);
  for (const fs::path& file : files) {
    const std::string text = contentOfFile(file);
    EXPECT_EQ(unifiedDiff(text, formatted(text), file.string()), "")
        << "bash runtime/sherd fmt --write " << file.string() << " mends this";
  }
}

TEST(Format, SoIsTheGraphOfTheReadme) {
  std::istringstream readme(contentOfFile(SHERD_SOURCE_DIR "/README.md"));
  std::string graph;
  for (std::string line; std::getline(readme, line);) {
    const bool begins = line == "    {" && graph.empty();
    if (!begins && graph.empty()) continue;
    graph += (line.size() > 4 ? line.substr(4) : "") + '\n';
    if (line == "    }") break;
  }
  EXPECT_NE(graph.find("\"format\": 1"), std::string::npos) << graph;
  EXPECT_EQ(unifiedDiff(graph, formatted(graph), "README.md"), "");
}

TEST(Format, KeepsLinesWithinTheLimit) {
  const std::string fits = "{\n  \"a\": \"" + std::string(110, 'x') + "\"\n}\n";
  EXPECT_EQ(formatted(fits), fits);
  for (std::size_t length = 85; length < 120; ++length) {
    const std::string text = formatted("{\"key\": {\"ä\": \"" + std::string(length, 'x') + "\"}, \"b\": 1}");
    const bool isShort = length + std::string("  \"key\": { \"a\": \"\" },").size() <= Document::kLongestLine;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), isShort ? 4 : 6) << text;
  }
}

TEST(Format, HandlesScalarsEmptyOnesAndComments) {
  EXPECT_EQ(formatted("3"), "3\n");
  EXPECT_EQ(formatted("\xEF\xBB\xBF{ }"), "{}\n");
  EXPECT_EQ(formatted("{\"a\":[ ],\"b\":{}}"), "{\n  \"a\": [],\n  \"b\": {}\n}\n");
  EXPECT_EQ(formatted("{// x\n}"), "{  // x\n}\n");
  EXPECT_EQ(formatted("[1 // a\n /* b\n c */, 2]"), "[\n  1,  // a\n  /* b\n c */\n  2\n]\n");
  EXPECT_EQ(formatted("{\"a\" /* k */ : /* v */ 1}"), "{\n  /* k */\n  /* v */\n  \"a\": 1\n}\n");
  EXPECT_EQ(formatted("{\r\n\"a\": 1, // x\r\n\"b\": 2\r\n}\r\n"), "{\n  \"a\": 1,  // x\n  \"b\": 2\n}\n");
}

/// A random document with comments and blank lines in all places where they may be.
class RandomDocument {
 public:
  explicit RandomDocument(std::uint64_t seed) : rng_(seed) {}
  std::string text() { return space() + value(0) + space(); }
  const std::vector<std::string>& comments() const { return comments_; }

 private:
  std::string space() {
    std::string text;
    while (rng_.below(3) == 0) switch (rng_.below(8)) {
        case 0:
          text += "\n";
          break;
        case 1:
          text += "\n\n\n";
          break;
        case 2:
          comments_.push_back("// c" + std::to_string(comments_.size()) + ";");
          text += comments_.back() + "\n";
          break;
        case 3:
          comments_.push_back("/* c" + std::to_string(comments_.size()) + "; */");
          text += comments_.back();
          break;
        case 4:
          comments_.push_back("/* c" + std::to_string(comments_.size()) + ";\n  more */");
          text += comments_.back();
          break;
        case 5:
        case 6:
          text += "\n  ";
          break;
        default:
          text += std::string(1 + rng_.below(4), ' ');
      }
    return text;
  }
  std::string scalar() {
    static const std::vector<std::string> kScalars{"1",
                                                   "-2.50e-3",
                                                   "true",
                                                   "null",
                                                   "\"ä\\n\\\"\"",
                                                   "\"\"",
                                                   "\"a rather long string that fills the line\""};
    return kScalars[rng_.below(kScalars.size())];
  }
  std::string value(int depth) {
    if (depth > 4 || rng_.below(3) == 0) return scalar();
    const bool isObject = rng_.below(2) == 0;
    std::string text = isObject ? "{" : "[";
    const auto count = rng_.below(5);
    for (std::uint64_t i = 0; i < count; ++i) {
      text += space();
      if (isObject)
        text += "\"k" + std::string(rng_.below(4), 'y') + std::to_string(i) + '"' + space() + ':' + space();
      text += value(depth + 1) + space();
      if (i + 1 < count || rng_.below(4) == 0) text += ',';
    }
    return text + space() + (isObject ? '}' : ']');
  }

  Rng rng_;
  std::vector<std::string> comments_;
};

TEST(Format, KeepsContentAndCommentsAndIsStable) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    RandomDocument random(seed);
    const std::string text = random.text();
    const std::string once = formatted(text);
    ASSERT_EQ(contentOf(once), contentOf(text)) << seed << '\n' << text << "\n---\n" << once;
    ASSERT_EQ(formatted(once), once) << seed << '\n' << text;
    std::size_t found = 0;
    for (const std::string& comment : random.comments())
      found += once.find(comment) != std::string::npos ? 1 : 0;
    ASSERT_EQ(found, random.comments().size()) << seed << '\n' << text << "\n---\n" << once;
  }
}

TEST(LineDiff, ShowsChangesWithContext) {
  EXPECT_EQ(unifiedDiff("a\nb\n", "a\nb\n", "f"), "");
  EXPECT_EQ(unifiedDiff("1\n2\n3\n4\n5\n6\n7\n8\n9\n", "1\n2\n3\n4\nfive\n6\n7\n8\n9\n", "f"),
            "--- f\n+++ f\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
  EXPECT_EQ(unifiedDiff("", "a\n", "f"), "--- f\n+++ f\n@@ -0,0 +1,1 @@\n+a\n");
  EXPECT_EQ(unifiedDiff("a", "a\n", "f"), "--- f\n+++ f\n\\ Now a newline at end of file\n");
  std::string before, after;
  for (int i = 0; i < 40; ++i) {
    before += std::to_string(i) + '\n';
    after += (i == 5 || i == 30 ? "x" : std::to_string(i)) + '\n';
  }
  EXPECT_EQ(unifiedDiff(before, after, "f"),
            "--- f\n+++ f\n@@ -3,7 +3,7 @@\n 2\n 3\n 4\n-5\n+x\n 6\n 7\n 8\n"
            "@@ -28,7 +28,7 @@\n 27\n 28\n 29\n-30\n+x\n 31\n 32\n 33\n");
}

TEST(Fmt, ShowsChecksAndWrites) {
  const TemporaryDirectory directory;
  const std::string path = directory.write("g.json", "{\"a\":1}");
  std::ostringstream out, err;
  CancelToken cancel;
  Console console{out, err, cancel, false, 80};
  const auto content = [&] { return contentOfFile(path); };
  EXPECT_EQ(fmtVerb({{path}, false, false}, console), kOk);
  EXPECT_EQ(out.str(), "--- " + path + "\n+++ " + path +
                           "\n@@ -1,1 +1,3 @@\n-{\"a\":1}\n+{\n+  \"a\": 1\n+}\n" +
                           "\\ Now a newline at end of file\n");
  EXPECT_EQ(fmtVerb({{path}, true, false}, console), kNodeFailed);
  EXPECT_EQ(content(), "{\"a\":1}");
  EXPECT_EQ(fmtVerb({{path}, false, true}, console), kOk);
  EXPECT_EQ(content(), "{\n  \"a\": 1\n}\n");
  out.str("");
  EXPECT_EQ(fmtVerb({{path}, true, false}, console), kOk);
  EXPECT_EQ(out.str() + err.str(), "");
  const std::string twice = directory.write("twice.json", "{\"a\": 1, \"a\": 2}");
  EXPECT_EQ(fmtVerb({{twice, path + "no"}, false, true}, console), kWrongInput);
  EXPECT_NE(err.str().find("twice.json:1:10: a: the key \"a\" is there twice"), std::string::npos)
      << err.str();
  EXPECT_NE(err.str().find("g.jsonno: the graph can't be opened"), std::string::npos) << err.str();
}

}  // namespace
}  // namespace sherd::test
