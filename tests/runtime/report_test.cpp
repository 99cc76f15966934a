#include "cli/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "cli/report_fold.h"
#include "cli/report_groups.h"
#include "cli/report_layout.h"
#include "cli/report_pictures.h"
#include "cli/report_text.h"
#include "made_up.h"
#include "report_data.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
    ++count;
  return count;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// What stands between `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return {};
  const std::size_t first = from + begin.size();
  return text.substr(first, text.find(end, first) - first);
}

Json dataOf(const std::string& page) {
  return Json::parse(between(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
}

std::string contentOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

ReportNode ran(const std::string& name) {
  ReportNode node;
  node.name = name;
  node.state = "run";
  return node;
}

const std::string kPngStart = "\x89PNG\r\n\x1a\n";

TEST(ReportText, EscapesAndShortens) {
  EXPECT_EQ(htmlEscaped("a<b>&\"'é"), "a&lt;b&gt;&amp;&quot;&#39;é");
  EXPECT_EQ(byteText(0), "0 B");
  EXPECT_EQ(byteText(999), "999 B");
  EXPECT_EQ(byteText(1234), "1.2 kB");
  EXPECT_EQ(byteText(999'999), "1.0 MB");
  EXPECT_EQ(byteText(34'200'000), "34 MB");
  EXPECT_EQ(byteText(~std::uint64_t{0}), "18 EB");
  EXPECT_EQ(elided("abcdefghij", 10), "abcdefghij");
  EXPECT_EQ(elided("abcdefghijk", 10), "abcde…hijk");
  EXPECT_EQ(shownLength("é…日"), 4);
  EXPECT_LE(shownLength(elided("日本日本日本日本", 7)), 8);
}

TEST(ReportText, WidthsGrowWithTheText) {
  EXPECT_EQ(widthInEms(""), 0);
  EXPECT_LT(widthInEms("iii"), widthInEms("nnn"));
  EXPECT_LT(widthInEms("nnn"), widthInEms("WWW"));
  EXPECT_GT(widthInEms("日本"), 2);
}

TEST(ReportText, Base64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(ReportPage, EmptyGraphIsAPage) {
  const std::string page = reportPage({});
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_TRUE(dataOf(page).at("groups").empty());
  EXPECT_EQ(countOf(page, "class=\"box "), 0u);
}

TEST(ReportPage, ShowsEachNodeOnceWithItsStateAndTime) {
  const std::string page = reportPage(test::vaseReport(true));
  EXPECT_EQ(countOf(page, "class=\"box "), 12u);  // 18 of them, with frames
  EXPECT_EQ(countOf(page, "class=\"wire\""), 15u);
  EXPECT_EQ(countOf(page, "class=\"box s-failed\""), 1u);
  EXPECT_EQ(countOf(page, "class=\"box s-skipped\""), 3u);
  EXPECT_EQ(countOf(page, "class=\"box s-unneeded\""), 1u);
  EXPECT_EQ(countOf(page, "class=\"box s-hit\""), 3u);
  EXPECT_EQ(countOf(page, "class=\"box s-run\""), 4u);
  EXPECT_TRUE(has(page, ">run · 1840 ms</text>"));
  EXPECT_EQ(countOf(page, ">×4</text>"), 2u);
  EXPECT_TRUE(has(page, "<title>hit.energy → weights.energy</title>"));
  EXPECT_EQ(countOf(page, "<tr data-group="), 12u);
}

TEST(ReportPage, SummarySaysHowItEndedAndWhatWasSkipped) {
  const std::string failed = reportPage(test::vaseReport(true));
  EXPECT_TRUE(has(failed, "<span class=\"verdict s-failed\">failed</span>"));
  EXPECT_TRUE(has(failed,
                  "13 of 18 did not run: 9 skipped, because what they need failed or the run ended before, "
                  "3 found in the cache, 1 not needed for what was asked for."));
  EXPECT_TRUE(has(failed, "</button>: graphs/first_fracture.json:26:5: pieces.cells"));
  EXPECT_TRUE(has(failed, "--set hit.young=3e6"));
  EXPECT_TRUE(has(failed, "5123 ms"));
  const std::string fine = reportPage(test::vaseReport(false));
  EXPECT_TRUE(has(fine, "<span class=\"verdict s-run\">ok</span>"));
  EXPECT_FALSE(has(fine, "<ul class=\"errors\">"));
  ReportData cancelled = test::vaseReport(false);
  cancelled.cancelled = true;
  EXPECT_TRUE(has(reportPage(cancelled), "<span class=\"verdict s-skipped\">cancelled</span>"));
  ReportData allRan;
  allRan.nodes.push_back(ran("only"));
  EXPECT_FALSE(has(reportPage(allRan), "did not run"));
}

TEST(ReportPage, DataHoldsWhatTheDetailsShow) {
  const Json data = dataOf(reportPage(test::vaseReport(false)));
  const auto groupNamed = [&](const std::string& name) {
    for (const Json& group : data.at("groups"))
      if (group.at("name") == name) return group;
    return Json();
  };
  const Json hit = groupNamed("hit");
  EXPECT_EQ(hit.at("type"), "Simulate");
  EXPECT_EQ(hit.at("inputs").size(), 2u);
  EXPECT_EQ(hit.at("outputs").at(0).at("name"), "energy");
  const Json run = hit.at("runs").at(0);
  EXPECT_EQ(run.at("why"), "young 2e6 → 3e6");
  EXPECT_EQ(run.at("threads"), 2);
  EXPECT_EQ(run.at("params").at(0).at("set"), true);
  EXPECT_EQ(run.at("params").at(1).at("unit"), "m");
  EXPECT_EQ(groupNamed("cells").at("runs").at(0).at("messages").size(), 2u);
  EXPECT_EQ(groupNamed("sheet").at("runs").at(0).at("written").at(0), "/shots/vase/out/sheet.png");
  const Json frames = groupNamed("picture").at("runs");
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames.at(3).at("context"), "frame 1004");
  EXPECT_EQ(frames.at(3).at("params").at(2).at("value"), "out/1004.png") << "differs from the first frame's";
}

TEST(ReportPage, TextsAreHarmlessWhereverTheyStand) {
  const std::string evil = "</script><b>\"'&<!--<script>";
  ReportData data = test::vaseReport(true);
  data.title = data.command = evil;
  for (ReportNode& node : data.nodes) {
    node.name += evil;
    for (std::string* text : {&node.graph, &node.context, &node.type, &node.help, &node.why, &node.error})
      *text = evil;
    node.messages = node.written = {evil};
    for (ReportPort& port : node.inputs) port.type = port.help = evil;
    for (ReportParam& param : node.params)
      param.name = param.value = param.fallback = param.unit = param.help = evil;
  }
  for (ReportWire& wire : data.wires) wire.output = wire.input = evil;
  const std::string page = reportPage(data);
  EXPECT_EQ(countOf(page, "<b>\"'"), 0u);
  EXPECT_EQ(countOf(page, "</script>"), 2u);
  EXPECT_EQ(countOf(page, "<script"), 2u);
  EXPECT_EQ(countOf(page, "<!--"), 0u);
  EXPECT_EQ(dataOf(page).at("groups").at(0).at("type"), evil);
}

TEST(ReportPage, BytesThatAreNotUtf8DoNotStopIt) {
  ReportData data = test::vaseReport(false);
  data.nodes[0].written = {"/tmp/\xff\xfe.obj"};
  data.nodes[0].name = "\xc3";
  EXPECT_EQ(dataOf(reportPage(data)).at("groups").at(0).at("runs").at(0).at("written").at(0), "/tmp/��.obj");
}

TEST(ReportPage, LoadsNothingFromAnywhere) {
  std::string page = reportPage(test::vaseReport(false));
  for (const char* harmless : {"xmlns=\"http://www.w3.org/2000/svg\"", "\"http://www.w3.org/2000/svg\""})
    for (std::size_t at; (at = page.find(harmless)) != std::string::npos;)
      page.erase(at, std::string(harmless).size());
  for (const char* loads : {"http:", "https:", "src=\"/", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_FALSE(has(page, loads)) << loads;
}

TEST(ReportPage, SameBytesEachTime) {
  EXPECT_EQ(reportPage(test::vaseReport(true)), reportPage(test::vaseReport(true)));
  EXPECT_EQ(reportPage(test::randomReport(300, 5)), reportPage(test::randomReport(300, 5)));
}

TEST(ReportPage, GraphsOfABatchStandUnderTheirNames) {
  ReportData data = test::vaseReport(false);
  ReportData other = test::vaseReport(false);
  const int offset = static_cast<int>(data.nodes.size());
  for (ReportNode& node : other.nodes) {
    node.graph = "toughness.json";
    data.nodes.push_back(node);
  }
  for (const ReportWire& wire : other.wires)
    data.wires.push_back({wire.from + offset, wire.to + offset, wire.output, wire.input});
  const std::string page = reportPage(data);
  EXPECT_EQ(countOf(page, "class=\"box "), 24u);
  EXPECT_EQ(countOf(page, "class=\"wire\""), 30u);
  EXPECT_TRUE(has(page, ">toughness.json</text>"));
}

TEST(ReportPage, WiredParameterIsAPort) {
  ReportData data;
  data.nodes = {ran("a"), ran("b")};
  data.nodes[0].outputs = {{"number", "Number", ""}};
  data.wires = {{0, 1, "number", "radius"}};
  EXPECT_TRUE(has(reportPage(data), "<g class=\"port param\"><title>radius: a parameter</title>"));
}

TEST(ReportPage, ThousandsOfNodesAreDrawn) {
  const ReportData data = test::randomReport(2000, 1);
  const auto start = std::chrono::steady_clock::now();
  const std::string page = reportPage(data);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(countOf(page, "class=\"box "), 2000u);
  RecordProperty("seconds", std::to_string(took.count()));
}

TEST(ReportPage, WhatNobodyCanLookAtIsFolded) {
  ReportData data = test::randomReport(60'000, 2);
  data.nodes[40'000].state = "failed";
  data.nodes[40'000].error = "the one error";
  for (ReportNode& node : data.nodes)
    if (&node != &data.nodes[40'000] && node.state == "failed") node.state = "hit";
  const std::string page = reportPage(data);
  EXPECT_LT(page.size(), 10u << 20);
  EXPECT_GT(page.size(), 3u << 20);
  EXPECT_TRUE(has(page, "the one error"));
  EXPECT_TRUE(
      has(page, "<span class=\"word s-failed\"><svg><use href=\"#m-failed\"/></svg>failed</span><b>1</b>"));
  const Json shown = dataOf(page);
  const std::size_t boxes = countOf(page, "class=\"box ");
  EXPECT_EQ(shown.at("groups").size(), boxes);
  EXPECT_GT(boxes, 1000u);
  EXPECT_TRUE(
      has(page, "Too much for one page: " + std::to_string(60'000 - boxes) + " of 60000 nodes are counted"));
  for (const Json& wire : shown.at("wires")) {
    ASSERT_LT(wire.at("from").get<std::size_t>(), boxes);
    ASSERT_LT(wire.at("to").get<std::size_t>(), boxes);
  }
}

TEST(ReportPage, FramesThatNobodyCanLookAtAreFolded) {
  ReportData data;
  for (int frame = 0; frame < 100'000; ++frame) {
    ReportNode node = ran(frame % 2 == 0 ? "a" : "b");
    node.context = "frame " + std::to_string(frame);
    node.ms = frame == 777 ? 1000 : 1;
    data.nodes.push_back(std::move(node));
    if (frame % 2 == 1) data.wires.push_back({frame - 1, frame, "out", "in"});
  }
  const std::string page = reportPage(data);
  EXPECT_LT(page.size(), 10u << 20);
  const Json shown = dataOf(page);
  ASSERT_EQ(shown.at("groups").size(), 2u);
  EXPECT_EQ(shown.at("wires").size(), 1u);
  std::size_t runs = 0, leftOut = 0;
  for (const Json& group : shown.at("groups")) {
    EXPECT_EQ(group.at("runs").size() + group.at("leftOut").get<std::size_t>(), 50'000u);
    EXPECT_EQ(group.at("state"), "run");
    runs += group.at("runs").size();
    leftOut += group.at("leftOut").get<std::size_t>();
  }
  EXPECT_GT(runs, 10'000u);
  EXPECT_TRUE(
      has(page, "Too much for one page: " + std::to_string(leftOut) + " frames and wedges are counted"));
  EXPECT_TRUE(has(page, "\"frame 777\""));
  EXPECT_TRUE(has(page, "×50000"));
}

TEST(ReportPage, NothingIsFoldedThatFits) {
  const ReportData data = test::randomReport(500, 3);
  ReportGroups grouped = groupNodes(data);
  foldReport(data, grouped);
  EXPECT_EQ(grouped.groups.size(), 500u);
  EXPECT_EQ(grouped.leftOut, 0u);
  foldReport(data, grouped, 100'000);
  EXPECT_EQ(grouped.groups.size() + grouped.leftOut, 500u);
  EXPECT_LT(grouped.groups.size(), 100u);
  for (const ReportGroup& group : grouped.groups)
    EXPECT_EQ(data.nodes[static_cast<std::size_t>(group.runs.front())].state, "failed");
}

TEST(ReportPictures, AreEmbeddedUpToALimit) {
  const test::TemporaryDirectory directory;
  std::vector<std::string> files;
  for (const auto& [name, size] : {std::pair("a.png", 100), {"b.png", 300}, {"c.png", 100}}) {
    files.push_back((directory.path() / name).string());
    std::ofstream(files.back(), std::ios::binary)
        << kPngStart << std::string(static_cast<std::size_t>(size) - 8, 'x');
  }
  const auto namesOf = [&](std::uint64_t mostBytes) {
    const EmbeddedPictures embedded = embedPictures(files, mostBytes);
    std::string names;
    for (const EmbeddedPicture& picture : embedded.pictures) names += fs::path(picture.file).stem().string();
    return names + std::to_string(embedded.leftOut);
  };
  EXPECT_EQ(namesOf(1000), "abc0");
  EXPECT_EQ(namesOf(500), "abc0");
  EXPECT_EQ(namesOf(499), "ab1");
  EXPECT_EQ(namesOf(250), "ac1");
  EXPECT_EQ(namesOf(99), "3");
  std::ofstream(files[1]) << "no picture";
  fs::remove(files[2]);
  EXPECT_EQ(namesOf(1000), "a0");
  EXPECT_EQ(embedPictures({files[0]}, 1000).pictures.at(0).uri,
            "data:image/png;base64," + base64(contentOf(files[0])));
}

TEST(ReportPictures, ThePageSaysHowManyWereLeftOut) {
  const test::TemporaryDirectory directory;
  ReportData data = test::vaseReport(false);
  data.pictures = {(directory.path() / "small.png").string(), (directory.path() / "large.png").string()};
  std::ofstream(data.pictures[0], std::ios::binary) << kPngStart;
  std::ofstream(data.pictures[1], std::ios::binary) << kPngStart;
  EXPECT_FALSE(has(reportPage(data), "left out"));
  fs::resize_file(data.pictures[1], kMostPictureBytes);
  const std::string page = reportPage(data);
  EXPECT_TRUE(has(page, "1 picture left out: a page holds 20 MB of them at most."));
  EXPECT_EQ(countOf(page, "<figure>"), 1u);
}

TEST(WriteReport, WholeOrNotAtAll) {
  const test::TemporaryDirectory directory;
  const ReportData data = test::vaseReport(false);
  const fs::path file = directory.path() / "new" / "out.html";
  ASSERT_TRUE(writeReport(data, file.string()).ok());
  EXPECT_EQ(contentOf(file), reportPage(data));
  const auto blocked = writeReport(data, (file / "out.html").string());
  ASSERT_FALSE(blocked.ok());
  EXPECT_TRUE(has(blocked.error().text(), "out.html")) << blocked.error().text();
  EXPECT_EQ(contentOf(file), reportPage(data));
}

/// Boxes 100 × 40, wires from the middle of one to the middle of another.
Layout layoutOf(int boxes, const std::vector<std::pair<int, int>>& ends) {
  std::vector<LayoutWire> wires;
  for (const auto& [from, to] : ends) wires.push_back({from, to, 50, 50, 0});
  return layeredLayout(std::vector<LayoutBox>(static_cast<std::size_t>(boxes), {100, 40}), wires);
}

/// Everything lies inside, and no two boxes overlap.
void expectSound(const Layout& layout) {
  for (std::size_t a = 0; a < layout.corners.size(); ++a) {
    const LayoutPoint& p = layout.corners[a];
    EXPECT_GE(p.x, 0);
    EXPECT_GE(p.y, 0);
    EXPECT_LE(p.x + 100, layout.width + 1e-9);
    EXPECT_LE(p.y + 40, layout.height + 1e-9);
    for (std::size_t b = 0; b < a; ++b) {
      const LayoutPoint& q = layout.corners[b];
      EXPECT_TRUE(std::abs(p.x - q.x) > 100 || std::abs(p.y - q.y) > 40) << a << " and " << b;
    }
  }
}

TEST(ReportLayout, NothingAndOneBox) {
  EXPECT_TRUE(layoutOf(0, {}).corners.empty());
  const Layout one = layoutOf(1, {});
  EXPECT_EQ(one.corners, (std::vector<LayoutPoint>{{0, 0}}));
  EXPECT_EQ(one.width, 100);
  EXPECT_EQ(one.height, 40);
}

TEST(ReportLayout, AChainIsAStraightLineDown) {
  const Layout layout = layoutOf(4, {{0, 1}, {1, 2}, {2, 3}});
  expectSound(layout);
  for (std::size_t b = 1; b < 4; ++b) {
    EXPECT_NEAR(layout.corners[b].x, layout.corners[0].x, 1e-6);
    EXPECT_GT(layout.corners[b].y, layout.corners[b - 1].y + 40);
  }
}

TEST(ReportLayout, CrossingsThatNeedNotBeAreNot) {
  // Two chains whose second layer is given in the other order, joined below.
  const Layout layout = layoutOf(5, {{0, 3}, {1, 2}, {3, 4}, {2, 4}});
  expectSound(layout);
  EXPECT_EQ(layout.corners[0].x < layout.corners[1].x, layout.corners[3].x < layout.corners[2].x);
}

TEST(ReportLayout, WiresGoAroundTheBoxesOfTheLayersTheyPass) {
  const Layout layout = layoutOf(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}});
  expectSound(layout);
  const auto& course = layout.courses[3];
  ASSERT_EQ(course.size(), 6u);
  for (const LayoutPoint& point : course)
    for (const std::size_t passed : {1u, 2u}) {
      const LayoutPoint& corner = layout.corners[passed];
      EXPECT_FALSE(point.x > corner.x && point.x < corner.x + 100 && point.y > corner.y &&
                   point.y < corner.y + 40);
    }
}

TEST(ReportLayout, WhatNothingConnectsStandsSideBySide) {
  const Layout layout = layoutOf(300, {});
  expectSound(layout);
  EXPECT_LE(layout.width, 1000);
}

TEST(ReportLayout, LoopsEnd) {
  const Layout layout = layoutOf(4, {{0, 1}, {1, 2}, {2, 0}, {3, 3}});
  expectSound(layout);
  for (const auto& course : layout.courses) EXPECT_GE(course.size(), 2u);
}

TEST(ReportLayout, RandomGraphsAreSoundAndWiresLeadDown) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const int boxes = 2 + static_cast<int>(random() % 80);
    std::vector<std::pair<int, int>> ends;
    for (int i = 0; i < 2 * boxes; ++i) {
      const int to = 1 + static_cast<int>(random() % static_cast<unsigned>(boxes - 1));
      ends.emplace_back(static_cast<int>(random() % static_cast<unsigned>(to)), to);
    }
    const Layout layout = layoutOf(boxes, ends);
    expectSound(layout);
    for (std::size_t w = 0; w < ends.size(); ++w) {
      const auto& course = layout.courses[w];
      const LayoutPoint &from = layout.corners[static_cast<std::size_t>(ends[w].first)],
                        &to = layout.corners[static_cast<std::size_t>(ends[w].second)];
      EXPECT_NEAR(course.front().x, from.x + 50, 1e-9);
      EXPECT_NEAR(course.front().y, from.y + 40, 1e-9);
      EXPECT_NEAR(course.back().x, to.x + 50, 1e-9);
      EXPECT_NEAR(course.back().y, to.y, 1e-9);
      EXPECT_TRUE(std::is_sorted(course.begin(), course.end(),
                                 [](const LayoutPoint& a, const LayoutPoint& b) { return a.y < b.y; }));
    }
  }
}

}  // namespace
}  // namespace sherd
