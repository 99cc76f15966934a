// `fmt`: the layout, what it keeps, and that it keeps everything of random documents.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

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

TEST(Format, KeepsLinesWithinTheLimit) {
  const std::string fits = "{\n  \"a\": \"" + std::string(100, 'x') + "\"\n}\n";
  EXPECT_EQ(formatted(fits), fits);
  for (std::size_t length = 85; length < 110; ++length) {
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
    while (rng_.below(3) == 0) switch (rng_.below(6)) {
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
        default:
          text += ' ';
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
      if (isObject) text += "\"k" + std::to_string(i) + '"' + space() + ':' + space();
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
  auto content = [&] {
    std::ifstream file(path, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
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
