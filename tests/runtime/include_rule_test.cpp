// What may include what. Reads all sources under runtime/ and nodes/ and fails on any include, and any way of
// printing or ending the program, that the tables below don't allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace sherd {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// Our own layers: what a file in a folder may include besides its own folder.
const std::map<std::string, Names> kLayers{
    {"runtime/base", {}},
    {"runtime/graph", {"base"}},
    {"runtime/eval", {"graph", "base"}},
    {"runtime/plugin", {"graph", "base"}},
    {"runtime/cli", {"plugin", "eval", "graph", "base"}},
    {"nodes/types", {"base"}},
    {"nodes/geometry", {"types", "base"}},
    {"nodes/pictures", {"types", "base"}},
};
const Names kStepLayers{"geometry", "pictures", "types", "base"};

/// Steps that may include the contract of another, <step>/<step>.h, and of which. Acyclic: each only names
/// steps that stand above it.
const std::vector<std::pair<std::string, Names>> kContracts{
    {"repair", {}},
    {"load_mesh", {"repair"}},
    {"load_picture", {}},
    {"tetrahedralize", {}},
    {"warp_rest", {}},
    {"embed", {}},
    {"protect", {}},
    {"rigid", {}},
    {"simulate", {"rigid"}},
    {"beta", {}},
    {"weights", {}},
    {"cvd", {}},
    {"learn_degree", {}},
    {"predict_degree", {"cvd", "learn_degree"}},
    {"train_degree", {"rigid", "simulate", "weights", "cvd", "learn_degree"}},
    {"tessellate", {}},
    {"select_piece", {}},
    {"convex_proxies", {}},
    {"export", {}},
    {"preview", {}},
    {"contact_sheet", {}},
};

/// Libraries, by the beginning of the include, and the beginnings of the paths that may include them.
const std::vector<std::pair<Names, Names>> kLibraries{
    {{"tbb/", "oneapi/"}, {"runtime/base/parallel.cpp"}},
    {{"thread", "future", "omp.h"}, {"runtime/base/parallel.cpp"}},
    {{"xxhash.h"}, {"runtime/base/hash.cpp"}},
    {{"dlfcn.h"}, {"runtime/plugin/"}},
    {{"CLI/"}, {"runtime/cli/"}},
    {{"iostream", "print"}, {"runtime/cli/"}},
    {{"openvdb/"},
     {"nodes/types/scalar_grid_vdb.h", "nodes/types/scalar_grid.cpp", "nodes/types/scalar_grid_archive.cpp",
      "nodes/geometry/level_set.cpp", "nodes/beta/"}},
    {{"bullet/", "bt", "Bullet", "LinearMath/"}, {"nodes/rigid/"}},
    {{"assimp/"}, {"nodes/load_mesh/"}},
    {{"CGAL/"},
     {"nodes/geometry/", "nodes/repair/", "nodes/tetrahedralize/", "nodes/embed/", "nodes/rigid/",
      "nodes/tessellate/"}},
    {{"cholmod.h", "suitesparse/", "cblas.h", "Eigen/CholmodSupport"}, {"nodes/embed/", "nodes/simulate/"}},
    {{"Spectra/"}, {"nodes/embed/"}},
    {{"embree3/"}, {"nodes/geometry/", "nodes/preview/"}},
    {{"png.h"}, {"nodes/pictures/"}},
    {{"Eigen/"}, {"nodes/"}},
    {{"nlohmann/"}, {"runtime/graph/", "runtime/cli/", "nodes/export/", "nodes/load_mesh/"}},
};

/// What only the command line may do.
const std::regex kPrinting(
    R"(\bstd::(cout|cerr|clog)\b|\b(printf|fprintf|vprintf|puts|fputs|putchar|perror)\s*\(|\bfmt::print|\b_?exit\s*\(|\bquick_exit\s*\()");

bool startsWithAny(const std::string& text, const Names& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& p) { return text.starts_with(p); });
}

/// Blanks out comments and the content of strings, so that words in them don't count; lines stay lines.
/// Includes keep their names.
std::string codeOnly(const std::string& text) {
  std::string code = text;
  enum class In { Code, Line, Block, String } in = In::Code;
  bool isDirective = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (c == '\n') isDirective = false;
    if (c == '#' && in == In::Code) isDirective = true;
    if (in == In::Code && c == '/' && next == '/')
      in = In::Line;
    else if (in == In::Code && c == '/' && next == '*')
      in = In::Block;
    else if (in == In::Code && c == '"' && !isDirective)
      in = In::String;
    else if (in == In::Line && c == '\n')
      in = In::Code;
    else if (in == In::Block && c == '*' && next == '/') {
      code[i] = code[i + 1] = ' ';
      ++i;
      in = In::Code;
    } else if (in == In::String && c == '\\')
      code[i++] = ' ';
    else if (in == In::String && (c == '"' || c == '\n'))
      in = In::Code;  // a raw string may end early; harmless
    if (in != In::Code && text[i] != '\n') code[i] = ' ';
  }
  return code;
}

/// The folder of ours that a path belongs to: "runtime/graph", "nodes/cvd".
std::string folderOf(const std::string& path) {
  const std::size_t first = path.find('/'), second = path.find('/', first + 1);
  return second == std::string::npos ? path.substr(0, first) : path.substr(0, second);
}

bool ownAllowed(const std::string& path, const std::string& include) {
  const std::string folder = folderOf(path), name = folder.substr(folder.find('/') + 1);
  const std::string target = include.substr(0, include.find('/'));
  if (include.find('/') == std::string::npos) return false;
  if (path == "nodes/pack.cpp") return target == "plugin";
  if (target == name) return true;
  auto has = [&](const Names& names) { return std::find(names.begin(), names.end(), target) != names.end(); };
  if (const auto layer = kLayers.find(folder); layer != kLayers.end()) return has(layer->second);
  if (!folder.starts_with("nodes/")) return false;
  if (has(kStepLayers)) return true;
  if (path.ends_with("_node.cpp")) return target == "graph";
  for (const auto& [step, contracts] : kContracts)
    if (step == name && has(contracts)) return include == target + '/' + target + ".h";
  return false;
}

bool libraryAllowed(const std::string& path, const std::string& include) {
  for (const auto& [prefixes, places] : kLibraries)
    if (startsWithAny(include, prefixes)) {
      if (include.starts_with("nlohmann/") && !path.ends_with(".cpp")) return false;
      // Plain names such as <thread> are meant as they are, not as beginnings.
      const bool isPlain = std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& p) {
        return p == include || p.ends_with('/') || include.find('/') != std::string::npos || p == "bt" ||
               p == "Bullet";
      });
      if (isPlain) return startsWithAny(path, places);
    }
  return true;
}

/// "path:line: what", for each thing in a source that isn't allowed.
Names violations(const std::string& path, const std::string& text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  Names found;
  std::istringstream lines(codeOnly(text));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string place = path + ':' + std::to_string(number) + ": ";
    const bool isDirective = line.find('#') != std::string::npos;
    const bool mayPrint = line.find('(') != std::string::npos || line.find("std::c") != std::string::npos;
    if (!isDirective && !mayPrint) continue;  // regular expressions are slow
    std::smatch match;
    if (isDirective && std::regex_search(line, match, kInclude)) {
      const bool isOwn = match[1] == "\"";
      if (!(isOwn ? ownAllowed(path, match[2]) : libraryAllowed(path, match[2])))
        found.push_back(place + "may not include " + match[2].str());
    } else if (!path.starts_with("runtime/cli/") && std::regex_search(line, match, kPrinting)) {
      found.push_back(place + "only runtime/cli prints or exits: " + match[0].str());
    }
  }
  return found;
}

TEST(IncludeRule, HoldsInAllSources) {
  const fs::path root = SHERD_SOURCE_DIR;
  std::size_t read = 0;
  for (const char* top : {"runtime", "nodes"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string ending = entry.path().extension().string();
      if (!entry.is_regular_file() || (ending != ".h" && ending != ".cpp")) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      ++read;
      for (const std::string& violation :
           violations(entry.path().lexically_relative(root).string(), text.str()))
        ADD_FAILURE() << violation;
    }
  EXPECT_GT(read, 50u);
}

TEST(IncludeRule, ContractsHaveNoCycle) {
  std::set<std::string> above;
  for (const auto& [step, contracts] : kContracts) {
    for (const std::string& other : contracts) EXPECT_TRUE(above.contains(other)) << step << " → " << other;
    above.insert(step);
  }
}

TEST(IncludeRule, FindsWhatIsNotAllowed) {
  auto isAllowed = [](const std::string& path, const std::string& text) {
    return violations(path, text).empty();
  };
  const std::string graph = "#include \"graph/node_type.h\"\n", tbb = "#include <tbb/parallel_for.h>\n";
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", graph));
  EXPECT_TRUE(isAllowed("nodes/cvd/cvd_node.cpp", graph));
  EXPECT_TRUE(isAllowed("runtime/eval/evaluator.h", graph));
  EXPECT_FALSE(isAllowed("runtime/base/hash.h", graph));
  EXPECT_FALSE(isAllowed("nodes/types/tri_mesh.h", graph));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd_node.cpp", "#include \"eval/evaluator.h\"\n"));
  EXPECT_FALSE(isAllowed("runtime/graph/graph.h", "#include \"eval/evaluator.h\"\n"));
  EXPECT_TRUE(isAllowed("runtime/base/parallel.cpp", tbb));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", tbb));
  EXPECT_TRUE(isAllowed("nodes/predict_degree/predict_degree.cpp", "#include \"cvd/cvd.h\"\n"));
  EXPECT_FALSE(isAllowed("nodes/predict_degree/predict_degree.cpp", "#include \"cvd/distance.h\"\n"));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", "#include \"predict_degree/predict_degree.h\"\n"));
  EXPECT_FALSE(isAllowed("nodes/geometry/solid.h", "#include \"cvd/cvd.h\"\n"));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", "#include \"distance.h\"\n"));
  EXPECT_TRUE(isAllowed("nodes/pack.cpp", "#include \"plugin/plugin.h\"\n"));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", "#include <openvdb/openvdb.h>\n"));
  EXPECT_TRUE(isAllowed("nodes/beta/read_vdb.cpp", "#include <openvdb/openvdb.h>\n"));
  EXPECT_FALSE(isAllowed("nodes/simulate/simulate.cpp", "#include <btBulletDynamicsCommon.h>\n"));
  EXPECT_TRUE(isAllowed("nodes/rigid/rigid.cpp", "#include <btBulletDynamicsCommon.h>\n"));
  EXPECT_FALSE(isAllowed("runtime/graph/json.h", "#include <nlohmann/json.hpp>\n"));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", "#include <thread>\n"));
  EXPECT_FALSE(isAllowed("nodes/cvd/cvd.cpp", "void f() { std::cout << 1; }\n"));
  EXPECT_FALSE(isAllowed("runtime/eval/key.cpp", "void f() { printf(\"x\"); }\n"));
  EXPECT_FALSE(isAllowed("runtime/eval/key.cpp", "void f() { exit(1); }\n"));
  EXPECT_TRUE(isAllowed("runtime/cli/main.cpp", "#include <iostream>\nvoid f() { std::cout << 1; }\n"));
  EXPECT_TRUE(
      isAllowed("nodes/cvd/cvd.cpp",
                "// std::cout\n/* exit(1) */ const char* s = \"printf(\";\nint n = snprintf(a, 1, b);\n"));
}

}  // namespace
}  // namespace sherd
