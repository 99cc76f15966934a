// All node packs and the runtime share namespace sherd: a type's name belongs to one header. Two of one name
// are an error that no tool reports, and whose destructors may be taken for one another.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace sherd {
namespace {

namespace fs = std::filesystem;

/// Where each type of a namespace (no nested ones: these are indented) is defined, by text of a header.
using Homes = std::map<std::string, std::string>;

/// "name: this header and that", for types that `homes` has from elsewhere.
std::vector<std::string> addTypes(const std::string& header, const std::string& text, Homes& homes) {
  static const std::regex kDefinition(R"(^(?:enum class|enum|struct|class) (\w+)(?: final)?(?: :[^:].*)? \{)");
  std::vector<std::string> twice;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, kDefinition)) continue;
    const auto [home, isNew] = homes.try_emplace(match[1], header);
    if (!isNew) twice.push_back(match[1].str() + ": " + home->second + " and " + header);
  }
  return twice;
}

TEST(OneDefinition, EachTypeHasOneHeader) {
  const fs::path root = SHERD_SOURCE_DIR;
  Homes homes;
  for (const char* top : {"runtime", "nodes"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file() || entry.path().extension() != ".h") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      for (const std::string& twice :
           addTypes(entry.path().lexically_relative(root).string(), text.str(), homes))
        ADD_FAILURE() << twice;
    }
  EXPECT_GT(homes.size(), 200u);
}

TEST(OneDefinition, FindsWhatIsDefinedTwice) {
  Homes homes;
  EXPECT_TRUE(
      addTypes("a.h", "struct Gap {\n  struct Side {\n  };\n};\nclass Tree;\nstruct Tree;\n", homes).empty());
  EXPECT_TRUE(addTypes("b.h", "class Tree {\nstruct Side : Base {\nenum class Kind { A };\n", homes).empty());
  EXPECT_EQ(addTypes("c.h", "class Gap final {\n", homes), std::vector<std::string>{"Gap: a.h and c.h"});
  EXPECT_EQ(addTypes("c.h", "struct Kind {};\n", homes), std::vector<std::string>{"Kind: b.h and c.h"});
}

}  // namespace
}  // namespace sherd
