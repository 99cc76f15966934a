// Files that are read along with one that names them are part of the key.
#include "graph/companion_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "eval/key.h"
#include "graph/node_type.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

struct Reading {
  std::string file;
};

/// A text that names one file per line.
std::vector<std::string> named(const std::string& path) {
  std::vector<std::string> files;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    files.push_back((fs::path(path).parent_path() / line).string());
  return files;
}

class CompanionFiles : public testing::Test {
 protected:
  CompanionFiles()
      : type_(NodeBuilder<Reading>("Reads", 1, "")
                  .inputFile("file", &Reading::file, "")
                  .run([](const Reading&, NodeIo&) -> Result<void> { return {}; })) {
    setCompanionFiles(".list", named);
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CompanionFiles() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string keyOf(const std::string& name) {
    Graph::Node node;
    node.type = &type_;
    node.readsFiles = true;
    node.params["file"] = (folder_ / name).string();
    FileDigests files;
    const auto recipe = recipeWithFiles(node, node.params, files);
    EXPECT_TRUE(recipe.ok());
    return recipe.ok() ? recipe->hex() : "";
  }

  NodeType type_;
  fs::path folder_ = fs::temp_directory_path() / ("sherd_companions_" + std::to_string(::getpid()));
};

TEST_F(CompanionFiles, GoByTheEnding) {
  write("a.LIST", "b\nc\n");
  EXPECT_EQ(companionFiles((folder_ / "a.LIST").string()),
            (std::vector<std::string>{(folder_ / "b").string(), (folder_ / "c").string()}));
  EXPECT_TRUE(companionFiles((folder_ / "a.text").string()).empty());
  EXPECT_TRUE(companionFiles((folder_ / "nowhere.list").string()).empty());
}

TEST_F(CompanionFiles, TheirContentAndWhetherTheyAreThereMakesAnotherKey) {
  write("a.list", "b\nc\n");
  write("b", "one");
  const std::string first = keyOf("a.list");
  EXPECT_EQ(keyOf("a.list"), first);
  write("b", "two");
  const std::string second = keyOf("a.list");
  EXPECT_NE(second, first);
  write("c", "");
  EXPECT_NE(keyOf("a.list"), second);
  fs::remove(folder_ / "c");
  EXPECT_EQ(keyOf("a.list"), second);
  write("d", "of no account");
  EXPECT_EQ(keyOf("a.list"), second);
}

/// A folder that moves as a whole keeps its results.
TEST_F(CompanionFiles, NamesCountFromTheFileThatNamesThem) {
  for (const char* place : {"x", "y"}) {
    fs::create_directories(folder_ / place);
    write(std::string(place) + "/a.list", "b\n");
    write(std::string(place) + "/b", "one");
  }
  EXPECT_EQ(keyOf("x/a.list"), keyOf("y/a.list"));
}

}  // namespace
}  // namespace sherd
