// An exported fracture in Blender: Debian's, headless, driven by pieces_in_blender.py. tests/run --all
// installs it; where it is missing the test fails.
#include <gtest/gtest.h>

#include "blender/blender_process.h"
#include "support/program.h"
#include "support/textured_crate.h"

namespace sherd {
namespace {

/// Breaks a model that is read by these parameters of LoadMesh, and opens what was exported.
void expectThatBlenderOpens(const std::string& reading) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("run '" SHERD_SOURCE_DIR "/tests/blender/fracture.json' --var out='" +
                                    scratch.file("out") + "'" + reading);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  const std::string said =
      blenderSays(SHERD_SOURCE_DIR "/tests/blender/pieces_in_blender.py",
                  {SHERD_SOURCE_DIR "/assets/mushroom.obj", scratch.file("out")}, scratch.file("home"));
  EXPECT_NE(said.find(" 0 faults"), std::string::npos) << said;
}

TEST(SlowBlender, OpensPiecesInMetresWithYUp) { expectThatBlenderOpens(""); }

TEST(SlowBlender, OpensPiecesOfAFileInDecimetresWithZUp) {
  expectThatBlenderOpens(" --set mesh.unit=0.1 --set mesh.up=z");
}

TEST(SlowBlender, OpensTexturesUvSetsColoursAndHulls) {
  const ScratchDirectory scratch;
  test::writeCrateGlb(scratch.file("crate.glb"));
  const ProgramRun run = runProgram("run '" SHERD_SOURCE_DIR "/tests/blender/crate.json' --var mesh='" +
                                    scratch.file("crate.glb") + "' --var out='" + scratch.file("out") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_EQ(run.output.find("leave [0, 1]"), std::string::npos) << run.output;
  const std::string said = blenderSays(SHERD_SOURCE_DIR "/tests/blender/crate_in_blender.py",
                                       {scratch.file("out")}, scratch.file("home"));
  EXPECT_NE(said.find(" 0 faults"), std::string::npos) << said;
}

}  // namespace
}  // namespace sherd
