#include "cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/partial_file.h"
#include "cli/console.h"
#include "cli/report_assets.h"
#include "cli/report_drawing.h"
#include "cli/report_fold.h"
#include "cli/report_groups.h"
#include "cli/report_json.h"
#include "cli/report_pictures.h"
#include "cli/report_text.h"

namespace sherd {
namespace {

const char* const kNotRunBecause[kShownStates.size()] = {
    nullptr, "skipped, because what they need failed or the run ended before", nullptr, "found in the cache",
    "not needed for what was asked for"};

std::string word(std::size_t state, const std::string& text) {
  return fmt::format("<span class=\"word s-{0}\"><svg><use href=\"#m-{0}\"/></svg>{1}</span>",
                     kShownStates[state].style, htmlEscaped(text));
}

std::array<int, kShownStates.size()> countStates(const ReportData& data) {
  std::array<int, kShownStates.size()> counts{};
  for (const ReportNode& node : data.nodes) ++counts[shownState(node.state)];
  return counts;
}

std::string verdict(const ReportData& data) {
  const char* text = data.cancelled ? "cancelled" : data.ok ? "ok" : "failed";
  const char* style = data.cancelled ? "skipped" : data.ok ? "run" : "failed";
  return fmt::format("<span class=\"verdict s-{}\">{}</span>", style, text);
}

/// "3 of 12 did not run: 2 found in the cache, 1 not needed for what was asked for."
std::string skipsLine(const ReportData& data) {
  const auto counts = countStates(data);
  std::string parts;
  int sum = 0;
  for (std::size_t s = 0; s < counts.size(); ++s)
    if (kNotRunBecause[s] != nullptr && counts[s] > 0) {
      parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", counts[s], kNotRunBecause[s]);
      sum += counts[s];
    }
  if (sum == 0) return {};
  return fmt::format("<p class=\"skips\">{} of {} did not run: {}.</p>\n", sum, data.nodes.size(), parts);
}

/// What is left out, so that nobody takes what is shown for all.
std::string foldLine(const ReportGroups& grouped) {
  std::size_t runs = 0;
  for (const ReportGroup& group : grouped.groups) runs += group.all - group.runs.size();
  if (grouped.leftOut + runs == 0) return {};
  std::string what;
  if (grouped.leftOut > 0)
    what = fmt::format("{} of {} nodes", grouped.leftOut, grouped.leftOut + grouped.groups.size());
  if (runs > 0)
    what += fmt::format("{}{} frames and wedges", what.empty() ? "" : ", and of the others ", runs);
  return fmt::format(
      "<p class=\"skips\">Too much for one page: {} are counted, but not shown. What failed or took longest "
      "is here.</p>\n",
      what);
}

void addErrors(std::string& page, const ReportData& data, const ReportGroups& grouped) {
  std::string errors;
  for (std::size_t g = 0; g < grouped.groups.size(); ++g)
    for (const int run : grouped.groups[g].runs) {
      const ReportNode& node = data.nodes[static_cast<std::size_t>(run)];
      if (node.error.empty()) continue;
      const std::string context = node.context.empty() ? "" : " (" + node.context + ")";
      errors += fmt::format("<li><button data-group=\"{}\">{}</button>: {}</li>\n", g,
                            htmlEscaped(node.name + context), htmlEscaped(node.error));
    }
  if (!errors.empty()) page += "<ul class=\"errors\">\n" + errors + "</ul>\n";
}

void addSummary(std::string& page, const ReportData& data, const ReportGroups& grouped) {
  page += fmt::format(
      "<header>\n<div class=\"headline\"><h1>{}</h1>{}<span class=\"total\">{}</span>"
      "<code class=\"command\">{}</code></div>\n<ul class=\"counts\">\n",
      htmlEscaped(data.title), verdict(data), durationText(data.ms), htmlEscaped(data.command));
  const auto counts = countStates(data);
  for (const std::size_t s : {2u, 3u, 1u, 0u, 4u})
    page += fmt::format("<li{}>{}<b>{}</b></li>\n", counts[s] == 0 ? " class=\"none\"" : "",
                        word(s, kShownStates[s].name), counts[s]);
  page += "</ul>\n" + skipsLine(data) + foldLine(grouped);
  addErrors(page, data, grouped);
  page += "</header>\n";
}

void addDrawing(std::string& page, const ReportData& data, const ReportGroups& grouped) {
  page +=
      "<main>\n<div id=\"graph\" class=\"card-like\"><div id=\"scroll\">\n" + drawGraphs(data, grouped) +
      "</div><div class=\"tools\"><button id=\"further\" title=\"smaller\" aria-label=\"smaller\">−</button>"
      "<button id=\"closer\" title=\"larger\" aria-label=\"larger\">+</button>"
      "<button id=\"whole\" title=\"show the whole graph\">whole</button></div></div>\n"
      "<aside id=\"details\" class=\"card-like\" aria-live=\"polite\"><p class=\"soft\">A click on a node "
      "shows "
      "its details here.</p></aside>\n</main>\n";
}

std::string numberCell(double key, const std::string& text) {
  return fmt::format("<td class=\"number\" data-key=\"{}\">{}</td>", key, text);
}

void addRow(std::string& page, const ReportData& data, std::size_t number, const ReportGroup& group,
            double slowest) {
  const ReportNode& node = data.nodes[static_cast<std::size_t>(group.runs.front())];
  std::string why;
  for (const int run : group.runs)
    if (const std::string& reason = data.nodes[static_cast<std::size_t>(run)].why; why.empty()) why = reason;
  const std::string bar =
      fmt::format("<span class=\"bar s-{}\"><i style=\"width:{:.1f}%\"></i></span>",
                  kShownStates[group.state].style, slowest > 0 ? 100 * group.ms / slowest : 0);
  page += fmt::format(
      "<tr data-group=\"{}\"><td><button data-group=\"{}\"><b>{}</b></button></td><td>{}</td><td>{}</td>",
      number, number, htmlEscaped(node.name), htmlEscaped(node.type), word(group.state, group.stateText()));
  page += numberCell(group.ms, (group.ms > 0 ? durationText(group.ms) : "") + bar);
  page += numberCell(static_cast<double>(group.all), fmt::format("{}", group.all));
  page += numberCell(static_cast<double>(group.memoryBytes),
                     group.memoryBytes > 0 ? byteText(group.memoryBytes) : "");
  page += numberCell(static_cast<double>(group.cacheBytes),
                     group.cacheBytes > 0 ? byteText(group.cacheBytes) : "");
  page += fmt::format("<td>{}</td></tr>\n", htmlEscaped(elided(why, 120)));
}

void addTable(std::string& page, const ReportData& data, const ReportGroups& grouped) {
  page +=
      "<section class=\"wide\"><div class=\"card-like\"><div class=\"tablehead\"><h2>All nodes</h2>"
      "<input id=\"filter\" type=\"search\" placeholder=\"name, type or state\" aria-label=\"show "
      "only\"></div>\n"
      "<table id=\"nodes\"><thead><tr>";
  for (const char* heading : {"node", "type", "state"})
    page += fmt::format("<th><button>{}</button></th>", heading);
  for (const char* heading : {"time", "frames", "in memory", "in the cache"})
    page += fmt::format("<th class=\"number\"><button>{}</button></th>", heading);
  page += "<th>why</th></tr></thead><tbody>\n";
  double slowest = 0;
  for (const ReportGroup& group : grouped.groups) slowest = std::max(slowest, group.ms);
  for (std::size_t g = 0; g < grouped.groups.size(); ++g) addRow(page, data, g, grouped.groups[g], slowest);
  page += "</tbody></table></div></section>\n";
}

void addPictures(std::string& page, const ReportData& data) {
  const EmbeddedPictures embedded = embedPictures(data.pictures, kMostPictureBytes);
  if (embedded.pictures.empty() && embedded.leftOut == 0) return;
  page += "<section class=\"wide\"><div class=\"card-like\"><h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const EmbeddedPicture& picture : embedded.pictures) {
    const std::string name = htmlEscaped(std::filesystem::path(picture.file).filename().string());
    page += fmt::format(
        "<figure><button title=\"larger\"><img alt=\"{}\" "
        "src=\"{}\"></button><figcaption>{}</figcaption></figure>\n",
        name, picture.uri, htmlEscaped(picture.file));
  }
  page += "</div>\n";
  if (embedded.leftOut > 0)
    page += fmt::format("<p class=\"soft\">{} left out: a page holds {} of them at most.</p>\n",
                        countText(embedded.leftOut, "picture"), byteText(kMostPictureBytes));
  page += "</div></section>\n";
}

}  // namespace

std::string reportPage(const ReportData& data) {
  ReportGroups grouped = groupNodes(data);
  foldReport(data, grouped);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src 'unsafe-inline'; img-src data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
      htmlEscaped(data.title) + "</title>\n<style>" + kReportStyle + "</style>\n</head>\n<body>\n" +
      kReportMarks;
  addSummary(page, data, grouped);
  addDrawing(page, data, grouped);
  addTable(page, data, grouped);
  addPictures(page, data);
  page += "<footer></footer>\n<script type=\"application/json\" id=\"data\">" + reportJson(data, grouped) +
          "</script>\n<script>" + kReportScript + "</script>\n</body>\n</html>\n";
  return page;
}

Result<void> writeReport(const ReportData& data, const std::string& file) {
  const std::filesystem::path directory = std::filesystem::path(file).parent_path();
  if (!directory.empty()) SHERD_CHECK(makeDirectory(directory.string()));
  const auto written = writeFileAtomically(file, reportPage(data));
  return written.ok() ? removeAbandoned(file) : written.error();
}

}  // namespace sherd
