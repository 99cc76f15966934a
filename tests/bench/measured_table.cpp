#include "bench/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>

namespace sherd::bench {
namespace {

struct Median {
  double real = 0, processor = 0;  ///< ms
};

std::map<std::string, Median>& medians() {
  static std::map<std::string, Median> known;
  return known;
}

/// The console's report, which also remembers the medians.
class Remembering : public benchmark::ConsoleReporter {
 public:
  Remembering() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Aggregate && run.aggregate_name == "median")
        medians()[run.run_name.function_name] = {run.GetAdjustedRealTime(), run.counters.at(kProcessorTime)};
    ConsoleReporter::ReportRuns(runs);
  }
};

}  // namespace

void runMeasured() {
  Remembering reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::ClearRegisteredBenchmarks();
}

double medianOf(const std::string& name) { return medians()[name].real; }
double processorMedianOf(const std::string& name) { return medians()[name].processor; }

double leastProcessorMs(int runs, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < runs; ++k) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

std::string number(double value) {
  if (!std::isfinite(value)) return "";
  if (value >= 100 || value == 0) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, value >= 10 ? 1 : value >= 1 ? 2 : 3);
}

std::string scientific(double value) { return fmt::format("{:.1e}", value); }
std::string count(std::size_t value) { return fmt::format("{}", value); }

namespace {

bool isNumber(const std::string& text) {
  char* end = nullptr;
  return !text.empty() && std::isfinite(std::strtod(text.c_str(), &end)) && *end == '\0';
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return out + "\"";
}

}  // namespace

void Table::write(const std::filesystem::path& csv) const {
  std::ofstream out(csv);
  for (const auto& row : rows_) out << fmt::format("{}\n", fmt::join(row, ","));
  std::ofstream json(std::filesystem::path(csv).replace_extension(".json"));
  json << "[";
  for (std::size_t r = 1; r < rows_.size(); ++r) {
    json << (r > 1 ? ",\n {" : "\n {");
    for (std::size_t c = 0; c < rows_[r].size(); ++c) {
      const std::string& cell = rows_[r][c];
      json << (c > 0 ? ", " : "") << quoted(rows_[0][c]) << ": "
           << (cell.empty()     ? "null"
               : isNumber(cell) ? cell
                                : quoted(cell));
    }
    json << "}";
  }
  json << "\n]\n";
}

std::string Table::markdown() const {
  std::string text;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    text += fmt::format("| {} |\n", fmt::join(rows_[r], " | "));
    if (r > 0) continue;
    for (std::size_t c = 0; c < rows_[r].size(); ++c) text += "|---";
    text += "|\n";
  }
  return text;
}

void writeSection(const std::filesystem::path& file, const std::string& name, const std::string& text) {
  std::ifstream in(file);
  std::string all(std::istreambuf_iterator<char>(in), {});
  const std::string begin = fmt::format("<!-- begin {} -->\n", name),
                    end = fmt::format("<!-- end {} -->\n", name);
  const std::size_t from = all.find(begin), to = all.find(end);
  const std::string section = begin + text + end;
  if (from != std::string::npos && to != std::string::npos)
    all.replace(from, to + end.size() - from, section);
  else
    all += section;
  std::ofstream(file) << all;
}

}  // namespace sherd::bench
