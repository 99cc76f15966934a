// Learning the degree: how far off models are on hits that they were not made of, by the protocol of
// Schvartzman and Otaduy (2014), section 3.2.
//
//   bench_learn [--part methods|figures|balls|hits|paper] [--mesh FILE] [--tets N] [--orientations N]
//               [--tests N] [--repeats N] [--pieces N] [--gamma G] [--threads N] [--out DIRECTORY]
//               [--balls N] [--ball-radius SHARE] [--slowest V] [--fastest V] [--figures DIRECTORY]
//               [--results FILE.md]
//
// Six heights, 64 orientations with three searches each to learn from, 18 others to test on. Without a γ, one
// is taken from the whole body's E_D as if that fell as N^(-2/3) to the median drop's `pieces` (20). Parts,
// all but `paper` where none is asked for:
// methods  a line per method: mean absolute error and R² on the test set, the noise that no model can
//          foretell, time to fit and (median) to foretell; then means per height of the first two
// figures  Figures 8 and 9, as SVG and CSV into --figures
// balls    the models on thrown balls (m/s from --slowest to --fastest), beside one that was made of balls
// hits     foretelling and searching on the same hits: times, degrees, E_D against γ
// paper    the columns of the paper's Tables 1 and 2 for its models; takes no --mesh
// Writes CSV and Markdown into the directory (default build/bench_learn), and each part's tables into a
// section of FILE.md.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <string>

#include "base/parallel.h"
#include "bench/learn_parts.h"
#include "bench/measured_table.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::map<std::string, std::string> text{{"part", ""},
                                          {"mesh", SHERD_SOURCE_DIR "/../shared/meshes/horse.obj"},
                                          {"tets", "5256"},
                                          {"orientations", "64"},
                                          {"tests", "18"},
                                          {"repeats", "3"},
                                          {"pieces", "20"},
                                          {"gamma", "0"},
                                          {"threads", "0"},
                                          {"balls", "100"},
                                          {"ball-radius", "0.05"},
                                          {"slowest", "3"},
                                          {"fastest", "15"},
                                          {"out", SHERD_BINARY_DIR "/bench_learn"},
                                          {"figures", SHERD_BINARY_DIR "/bench_learn"},
                                          {"results", ""}};
  int integer(const char* name) const { return std::stoi(text.at(name)); }
  double number(const char* name) const { return std::stod(text.at(name)); }
};

Setup setupOf(const Arguments& arguments) {
  Setup setup;
  setup.body = bodyOf(arguments.text.at("mesh"), arguments.integer("tets"));
  TrainDegreeParams& params = setup.params;
  params.orientations = arguments.integer("orientations");
  params.repeats = arguments.integer("repeats");
  params.gamma = arguments.number("gamma");
  if (params.gamma == 0) params.gamma = gammaFor(setup.body, params, arguments.number("pieces"));
  setup.trainingSeconds = secondsOf([&] { setup.training = dropsOf(setup.body, params); });
  TrainDegreeParams unseen = params;
  unseen.orientations = arguments.integer("tests");
  unseen.seed = 1001;
  setup.tests = dropsOf(setup.body, unseen);
  return setup;
}

BallParams ballsOf(const Arguments& arguments) {
  BallParams balls;
  balls.throws = arguments.integer("balls");
  balls.radius = arguments.number("ball-radius");
  balls.slowest = arguments.number("slowest");
  balls.fastest = arguments.number("fastest");
  return balls;
}

void write(const Arguments& arguments, const std::string& section, const std::string& report) {
  fmt::print("\n{}", report);
  if (!arguments.text.at("results").empty())
    writeSection(arguments.text.at("results"), "bench_learn " + section, report);
}

void measure(const Arguments& arguments) {
  setThreadLimit(arguments.integer("threads"));
  const std::string& part = arguments.text.at("part");
  if (part == "paper") return write(arguments, part, paperPart());
  const fs::path out = arguments.text.at("out"), figures = arguments.text.at("figures");
  fs::create_directories(out);
  fs::create_directories(figures);
  const Setup setup = setupOf(arguments);
  const std::string& name = setup.body.name;
  const auto asked = [&](const char* which) { return part.empty() || part == which; };
  if (asked("methods")) write(arguments, name, methodsPart(setup, out));
  if (asked("figures")) fmt::print("\n{}", figuresPart(setup, figures));
  if (asked("balls")) write(arguments, "balls " + name, ballsPart(setup, ballsOf(arguments)));
  if (asked("hits")) write(arguments, "hits " + name, hitsPart(setup));
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  sherd::bench::Arguments arguments;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (!name.starts_with("--") || !arguments.text.contains(name.substr(2))) {
      fmt::print(stderr, "bench_learn: there is no {}\n", name);
      return 2;
    }
    arguments.text[name.substr(2)] = argv[i + 1];
  }
  sherd::inArena([&] { sherd::bench::measure(arguments); });
  return 0;
}
