// Which packages the launcher and tests/run ask for.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

#include "made_up.h"

namespace sherd {
namespace {

/// What a line of shell prints after runtime/install.sh was read.
std::string printed(const std::string& line) {
  const std::string command = "bash -c '. \"" SHERD_SOURCE_DIR "/runtime/install.sh\"; " + line + "'";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "popen failed";
  std::string text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  return pclose(pipe) == 0 ? text : "failed";
}

TEST(Packages, PartsAreAddedOnlyWhenAskedFor) {
  const test::TemporaryDirectory directory;
  const std::string file =
      directory.write("packages.txt", "# a list\none  # why\n\ntwo\n[slow tests]\nthree\n[other]\nfour\n");
  const std::string list = "sherd_packages \"" + file + "\"";
  EXPECT_EQ(printed(list + " | xargs"), "one two\n");
  EXPECT_EQ(printed(list + " \"\" | xargs"), "one two\n");
  EXPECT_EQ(printed(list + " \"slow tests\" | xargs"), "one two three\n");
}

TEST(Packages, OnlySlowTestsNeedABrowser) {
  const std::string list = "sherd_packages \"" SHERD_SOURCE_DIR "/runtime/packages.txt\"";
  const std::string plain = printed(list), all = printed(list + " \"slow tests\"");
  EXPECT_NE(plain.find("cmake\n"), std::string::npos);
  EXPECT_EQ(plain.find("chromium"), std::string::npos);
  EXPECT_TRUE(all.starts_with(plain));
  EXPECT_NE(all.find("chromium-driver\n"), std::string::npos);
}

}  // namespace
}  // namespace sherd
