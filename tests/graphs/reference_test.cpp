// nodes/README.md is what the nodes' tables say.
#include <gtest/gtest.h>

#include <sstream>

#include "support/program.h"

namespace sherd {
namespace {

TEST(NodeReference, IsWhatTheProgramPrints) {
  const ProgramRun run = runProgram("nodes --markdown", "SHERD_NODE_PATH=");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  std::istringstream printed(run.output), kept(contentOf(SHERD_SOURCE_DIR "/nodes/README.md"));
  std::string now, then;
  for (int number = 1; std::getline(printed, now); ++number) {
    std::getline(kept, then);
    ASSERT_EQ(then, now) << "nodes/README.md, line " << number
                         << ", is out of date; from the top of the tree:\n"
                            "    SHERD_NODE_PATH= build/bin/sherd nodes --markdown > nodes/README.md";
  }
  EXPECT_FALSE(std::getline(kept, then)) << "nodes/README.md goes on with " << then;
}

}  // namespace
}  // namespace sherd
