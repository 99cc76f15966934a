// Painted fields in Blender's volume import: Debian's, headless, driven by volume_in_blender.py.
#include <gtest/gtest.h>

#include "blender/blender_process.h"
#include "support/program.h"

namespace sherd {
namespace {

constexpr const char* kGraph = R"({
  "format": 1,
  "nodes": {
    "beta": { "type": "PaintBeta@1", "params": {
      "strokes": [{ "points": [[0, 0, 0], [0, 1, 0]], "radius": 0.1, "value": 4 }], "voxel": 0.02 } },
    "mask": { "type": "PaintBeta@1", "params": {
      "name": "mask", "strokes": [{ "points": [0, 0.5, 0], "radius": 0.2, "value": 1 }], "background": 0,
      "voxel": 0.04 } },
    "file": { "type": "WriteVDB@1", "in": { "grid": "beta", "grid_2": "mask" },
              "params": { "file": "fields.vdb", "up": "z" } },
  }
})";

TEST(SlowBlenderVolume, OpensOurGridsOfFloatAndHalf) {
  const ScratchDirectory scratch;
  std::ofstream(scratch.file("paint.json")) << kGraph;
  for (const char* precision : {"float", "half"}) {
    const ProgramRun run =
        runProgram("run '" + scratch.file("paint.json") + "' --set file.precision=" + precision);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const std::string said = blenderSays(SHERD_SOURCE_DIR "/tests/blender/volume_in_blender.py",
                                         {scratch.file("fields.vdb")}, scratch.file("home"));
    EXPECT_NE(said.find("0 faults"), std::string::npos) << precision << said;
  }
}

}  // namespace
}  // namespace sherd
