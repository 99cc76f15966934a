// The scanner and parser: positions, what JSON doesn't allow but we do, and what nobody may write.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/rng.h"
#include "graph/json.h"
#include "graph/json_scanner.h"

namespace sherd {
namespace {

const SourcePtr kSource = std::make_shared<const Source>(Source{"f.json", "/"});

struct Parsed {
  std::optional<JsonValue> value;
  std::vector<std::string> errors;
};

Parsed parse(std::string_view text) {
  Diagnostics diagnostics;
  Parsed parsed{parseJson(text, kSource, diagnostics), {}};
  for (const Diagnostic& d : diagnostics.sorted()) parsed.errors.push_back(d.text());
  return parsed;
}

/// The only error of a text that must not parse.
std::string errorOf(std::string_view text) {
  const Parsed parsed = parse(text);
  EXPECT_FALSE(parsed.value) << text;
  EXPECT_EQ(parsed.errors.size(), 1u) << text;
  return parsed.errors.empty() ? "" : parsed.errors.front();
}

TEST(Json, ReadsValuesOfEveryKind) {
  const Parsed parsed =
      parse(R"({"a": 1, "b": -2.5e3, "c": "x\n\u00e9\ud83d\ude00", "d": [true, false, null], "e": {}})");
  ASSERT_TRUE(parsed.errors.empty()) << parsed.errors[0];
  const JsonValue& root = *parsed.value;
  EXPECT_EQ(root.find("a")->integer, 1);
  EXPECT_EQ(root.find("b")->number, -2500);
  EXPECT_EQ(root.find("c")->text, "x\n\xC3\xA9\xF0\x9F\x98\x80");
  EXPECT_EQ(root.find("d")->items.size(), 3u);
  EXPECT_EQ(root.find("e")->kind, JsonValue::Kind::Object);
  EXPECT_EQ(root.find("f"), nullptr);
}

TEST(Json, KnowsWhereValuesStand) {
  const Parsed parsed = parse("\xEF\xBB\xBF{\n  \"ä\": 1, // é\n\t\"b\": [2,\r\n 3]\n}");
  ASSERT_TRUE(parsed.value);
  EXPECT_EQ(parsed.value->find("ä")->origin.text(), "f.json:2:8");
  EXPECT_EQ(parsed.value->members[1].origin.text(), "f.json:3:2");
  EXPECT_EQ(parsed.value->find("b")->items[1].origin.text(), "f.json:4:2");
}

TEST(Json, SkipsCommentsAndTrailingCommas) {
  const Parsed parsed = parse("/* a\n * b */ {\"x\": [1, 2,], // c\n \"y\": {\"z\": 1,},} // no line end");
  ASSERT_TRUE(parsed.errors.empty()) << parsed.errors[0];
  EXPECT_EQ(parsed.value->find("x")->items.size(), 2u);
  EXPECT_EQ(errorOf("[1,,2]"),
            "f.json:1:4: a value is missing; a string, number, list or object would have to stand here");
  EXPECT_EQ(errorOf("[,]").substr(0, 11), "f.json:1:2:");
}

TEST(Json, ScannerYieldsCommentsForFormatters) {
  JsonScanner scanner("1 // one");
  JsonToken token;
  ASSERT_TRUE(scanner.next(token));
  EXPECT_EQ(token.kind, JsonToken::Kind::Integer);
  ASSERT_TRUE(scanner.next(token));
  EXPECT_EQ(token.kind, JsonToken::Kind::Comment);
  EXPECT_EQ(token.begin, 2u);
  EXPECT_EQ(token.end, 8u);
  ASSERT_TRUE(scanner.next(token));
  EXPECT_EQ(token.kind, JsonToken::Kind::End);
}

TEST(Json, TellsOfDuplicateKeysAndKeepsTheFirst) {
  const Parsed parsed = parse("{\"nodes\": {\"cells\": {\"params\": {\n\"degree\": 1,\n\"degree\": 2}}}}");
  ASSERT_EQ(parsed.errors.size(), 1u);
  EXPECT_EQ(parsed.errors[0],
            "f.json:3:1: cells.degree: the key \"degree\" is there twice; the other one is in line 2; keep "
            "one of them");
  EXPECT_EQ(parsed.value->find("nodes")->find("cells")->find("params")->find("degree")->integer, 1);
}

TEST(Json, TellsWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "1:1: the file ends too early"},
      {"{\"a\": 1", "1:8: a: the file ends too early"},
      {"{\"a\" 1}", "1:6: a: a colon is missing"},
      {"{\"a\": 1 \"b\": 2}", "1:9: a: a comma is missing"},
      {"[1 2]", "1:4: a comma is missing"},
      {"{a: 1}", "1:2: unexpected word \"a\""},
      {"{'a': 1}", "1:2: a single quotation mark"},
      {"[1] 2", "1:5: something follows the end"},
      {"[1}", "1:3: a comma is missing"},
      {"\"abc", "1:1: a string that is not closed"},
      {"\"ab\nc\"", "1:1: a string that is not closed"},
      {"/* abc", "1:1: a comment that is not closed"},
      {"/ 1", "1:1: a stray \"/\""},
      {R"("C:\path")", "1:4: an unknown escape"},
      {R"("\u12g4")", "1:2: \\u without four hexadecimal digits"},
      {R"("\u12)", "1:2: \\u without four hexadecimal digits"},
      {R"("\ud800")", "1:8: half of a surrogate pair"},
      {R"("\udc00")", "1:8: half of a surrogate pair"},
      {R"("\u0000")", "1:8: \\u0000 in a string"},
      {"\"a\tb\"", "1:3: control character 0x09"},
      {"\"a\xFF\"", "1:3: byte 0xff is not UTF-8"},
      {"\"\xC0\x80\"", "1:2: byte 0xc0 is not UTF-8"},
      {"\"\xED\xA0\x80\"", "1:2: byte 0xed is not UTF-8"},
      {"[\xFF]", "1:2: byte 0xff is not UTF-8"},
      {std::string("[1,\0]", 5), "1:4: unexpected byte 0x00"},
      {std::string("\"a\0\"", 4), "1:3: control character 0x00"},
      {"01", "1:1: a number with a leading zero"},
      {"1.", "1:3: no digit after the decimal point"},
      {".5", "1:1: unexpected word \".5\""},
      {"-", "1:2: no digit after the sign"},
      {"+1", "1:1: a number with a plus sign"},
      {"1e", "1:3: no digit after the exponent"},
      {"10mm", "1:3: a number with something stuck to it"},
      {"1e999", "1:1: a number that is too large"},
      {"NaN", "1:1: unexpected word \"NaN\""},
  };
  for (const auto& [text, expected] : cases) {
    const std::string error = errorOf(text);
    EXPECT_EQ(error.substr(0, 7 + expected.size()), "f.json:" + expected) << text;
  }
}

TEST(Json, ReadsNumbersExactly) {
  EXPECT_EQ(parse("9223372036854775807").value->integer, INT64_MAX);
  EXPECT_EQ(parse("-9223372036854775808").value->integer, INT64_MIN);
  EXPECT_EQ(parse("9223372036854775808").value->kind, JsonValue::Kind::Number);
  EXPECT_EQ(parse("0.1").value->number, 0.1);
  EXPECT_EQ(parse("1e-999").value->number, 0.0);
  EXPECT_EQ(numberText(0.1), "0.1");
  EXPECT_EQ(numberText(1e300), "1e+300");
}

TEST(Json, RefusesDeepNestingAtAnyDepth) {
  const std::string deepest(kDeepestJson, '['), closed = deepest + std::string(kDeepestJson, ']');
  EXPECT_TRUE(parse(closed).value);
  EXPECT_NE(errorOf("[" + closed + "]").find("nested more than 64 levels deep"), std::string::npos);
  EXPECT_NE(errorOf(std::string(1000000, '[')).find("nested"), std::string::npos);
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_NE(errorOf(objects).find("nested"), std::string::npos);
}

TEST(Json, SurvivesAnyBytes) {
  Rng rng(1);
  const std::string seed =
      "{\"format\": 1, /* c */ \"nodes\": {\"a\": {\"type\": \"T@1\", \"in\": {\"x\": \"b.c\"}, // d\n"
      "\"params\": {\"n\": -1.5e3, \"s\": \"\\u00e9\\ud83d\\ude00\", \"l\": [1, true, null,]}}}}";
  for (int round = 0; round < 20000; ++round) {
    std::string text = round % 4 == 0 ? std::string(rng.below(64), ' ') : seed;
    const std::uint64_t edits = round % 4 == 0 ? text.size() : 1 + rng.below(4);
    for (std::uint64_t e = 0; e < edits && !text.empty(); ++e) {
      const std::size_t at = round % 4 == 0 ? e : rng.below(text.size());
      const auto byte = static_cast<char>(rng.below(256));
      if (round % 4 == 2)
        text.erase(at, rng.below(10));
      else if (round % 4 == 3)
        text.insert(at, text.substr(rng.below(text.size()), 8));
      else
        text[at] = byte;
    }
    const Parsed parsed = parse(text);
    EXPECT_TRUE(parsed.value || parsed.errors.size() >= 1);
  }
}

TEST(Json, TypedTextsAreJsonWhereTheyParse) {
  EXPECT_EQ(parseTyped("3", kSource).integer, 3);
  EXPECT_EQ(parseTyped("[1,2,3]", kSource).items.size(), 3u);
  EXPECT_EQ(parseTyped("models/horse.obj", kSource).text, "models/horse.obj");
  EXPECT_EQ(parseTyped("\"3\"", kSource).kind, JsonValue::Kind::String);
  EXPECT_EQ(parseTyped("", kSource).kind, JsonValue::Kind::String);
  EXPECT_EQ(scalarText(parseTyped("007.obj", kSource)), "007.obj");
  EXPECT_EQ(scalarText(parseTyped("1.50", kSource)), "1.50");
}

}  // namespace
}  // namespace sherd
