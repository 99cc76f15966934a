// Cuts every mesh of a corpus into several numbers of pieces, with exact and canonical cells, and tells what
// of the promises was kept.
//
//   test_corpus                 real models and those of Debian's libcgal-demo, at 7, 67 and 250 pieces
//   test_corpus --assets        the project's own models, at 5, 18 and 67
//   options  --only NAME (may be repeated)  --counts 7,67  --out DIRECTORY  --prepare (cells only)
//
// Checked by tests/support/fracture_check.h and, for the whole corpus, by ../shared/check/fragments.cpp on
// exported files. Writes corpus.csv and corpus.md into the output directory, row by row. Exit code 0: all
// meshes that bound a solid were cut and every promise was kept; 1: not so; 77: there was nothing to cut.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "corpus/models.h"
#include "corpus/outside_checker.h"
#include "support/fracture_check.h"
#include "support/prepared_cells.h"
#include "tessellate/tessellate.h"

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

struct Options {
  bool assets = false, prepareOnly = false;
  std::vector<std::string> only;
  std::vector<int> counts{7, 67, 250};
  fs::path out = SHERD_BINARY_DIR "/corpus";
};

struct Totals {
  std::size_t meshes = 0, refused = 0, cuts = 0, good = 0, pieces = 0, selfIntersecting = 0, forced = 0;
};

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Rows of a table, in two formats.
class Table {
 public:
  explicit Table(const fs::path& directory) {
    fs::create_directories(directory);
    csv_.open(directory / "corpus.csv");
    markdown_.open(directory / "corpus.md");
    const std::vector<std::string> head{"mesh",   "triangles",    "tets",    "sites",  "cells", "pieces",
                                        "result", "volume error", "selfint", "forced", "cut ms"};
    row(head);
    for (std::size_t i = 0; i < head.size(); ++i) markdown_ << "|---";
    markdown_ << "|\n";
  }
  void row(const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      csv_ << (i ? ";" : "") << cells[i];
      markdown_ << "| " << cells[i] << " ";
    }
    csv_ << std::endl;
    markdown_ << "|" << std::endl;
    fmt::print("{}\n", fmt::join(cells, "  "));
    std::fflush(stdout);
  }
  void note(const std::string& text) {
    markdown_ << "\n" << text << "\n";
    fmt::print("{}\n", text);
  }

 private:
  std::ofstream csv_, markdown_;
};

class Corpus {
 public:
  Corpus(Options options, std::optional<OutsideChecker> checker)
      : options_(std::move(options)), checker_(std::move(checker)), table_(options_.out) {}

  void add(const fs::path& file) {
    PrepareParams params;
    params.counts = options_.counts;
    if (options_.assets) params.tets = 1400;
    const auto prepared = prepareCells(file.string(), params, options_.out / "prepared");
    ++totals_.meshes;
    if (!prepared.ok()) {
      ++totals_.refused;
      table_.row({file.filename().string(), "", "", "", "", "",
                  "refused: " + oneLine(withoutFolder(prepared.error().what, file))});
      return;
    }
    if (options_.prepareOnly) return;
    for (const auto& cells : prepared->cells)
      for (const CellMode mode : {CellMode::Exact, CellMode::Canonical})
        cut(file.filename().string(), *cells, mode);
  }

  int finish(const std::vector<std::string>& absent) {
    for (const std::string& what : absent) table_.note(what);
    if (checker_ && !checker_->why().empty()) table_.note("checker of exported pieces: " + checker_->why());
    table_.note(
        fmt::format("{} meshes, {} of them refused; {} cuts, {} good; {} pieces, {} of them intersect "
                    "themselves; {} forced triangles",
                    totals_.meshes, totals_.refused, totals_.cuts, totals_.good, totals_.pieces,
                    totals_.selfIntersecting, totals_.forced));
    if (options_.prepareOnly) return 0;
    if (totals_.cuts == 0) return 77;
    return totals_.good == totals_.cuts ? 0 : 1;
  }

 private:
  static std::string withoutFolder(std::string text, const fs::path& file) {
    const std::size_t found = text.find(file.string());
    if (found != std::string::npos) text.replace(found, file.string().size(), file.filename().string());
    return text;
  }

  static std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    std::replace(text.begin(), text.end(), '|', '/');
    std::replace(text.begin(), text.end(), ';', ',');
    return text;
  }

  std::string verdict(const Fragments& f, const FractureCheck& check) const {
    if (!check.good()) return check.text();
    if (!checker_ || !checker_->why().empty()) return "good";
    const OutsideChecker::Verdict outside = checker_->check(f);
    return outside.good ? "good" : "outside checker: " + oneLine(outside.text);
  }

  void cut(const std::string& name, const Partition& cells, CellMode mode) {
    TessellateParams params;
    params.cells = mode;
    const TetMesh& tets = *cells.embedding->tets;
    std::vector<std::string> row{name, std::to_string(tets.surface->triangles.size()),
                                 std::to_string(tets.tets.size()), std::to_string(cells.siteCount()),
                                 mode == CellMode::Exact ? "exact" : "canonical"};
    ++totals_.cuts;
    const auto start = std::chrono::steady_clock::now();
    const auto fragments = tessellate(cells, params, Exec{});
    const double ms = millisecondsSince(start);
    if (!fragments.ok()) {
      row.insert(row.end(),
                 {"", "failed: " + oneLine(fragments.error().what), "", "", "", fmt::format("{:.1f}", ms)});
      return table_.row(row);
    }
    const FractureCheck check = checkFracture(*fragments, {.points = 100, .selfIntersections = true});
    const std::string result = verdict(*fragments, check);
    totals_.good += result == "good";
    totals_.pieces += check.pieces;
    totals_.selfIntersecting += check.selfIntersecting;
    totals_.forced += fragments->counts.forcedTriangles;
    row.insert(row.end(), {std::to_string(check.pieces), result, fmt::format("{:.1e}", check.volumeError),
                           std::to_string(check.selfIntersecting),
                           std::to_string(fragments->counts.forcedTriangles), fmt::format("{:.1f}", ms)});
    table_.row(row);
  }

  Options options_;
  std::optional<OutsideChecker> checker_;
  Table table_;
  Totals totals_;
};

std::optional<Options> read(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool more = i + 1 < argc;
    if (word == "--assets") {
      options.assets = true;
      options.counts = {5, 18, 67};
    } else if (word == "--prepare") {
      options.prepareOnly = true;
    } else if (word == "--only" && more) {
      options.only.push_back(argv[++i]);
    } else if (word == "--out" && more) {
      options.out = fs::absolute(argv[++i]);
    } else if (word == "--counts" && more) {
      options.counts.clear();
      std::istringstream list(argv[++i]);
      for (std::string count; std::getline(list, count, ',');) options.counts.push_back(std::stoi(count));
    } else {
      fmt::print(stderr, "test_corpus: unknown argument '{}'\n", word);
      return std::nullopt;
    }
  }
  return options;
}

int run(const Options& options) {
  const CorpusModels models = options.assets ? assetModels() : allModels(options.out / "models");
  std::optional<OutsideChecker> checker;
  if (!options.assets && !options.prepareOnly) checker.emplace(options.out / "checker");
  Corpus corpus(options, std::move(checker));
  for (const fs::path& file : models.files) {
    const auto asked = [&](const std::string& name) {
      return file.filename().string().find(name) != std::string::npos;
    };
    if (options.only.empty() || std::any_of(options.only.begin(), options.only.end(), asked))
      corpus.add(file);
  }
  return corpus.finish(models.absent);
}

}  // namespace
}  // namespace sherd::test

int main(int argc, char** argv) {
  const auto options = sherd::test::read(argc, argv);
  return options ? sherd::test::run(*options) : 2;
}
