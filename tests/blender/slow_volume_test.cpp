// Painted fields in Blender's volume import: Debian's, headless, driven by volume_in_blender.py.
#include <gtest/gtest.h>

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
    const std::string command =
        "HOME='" + scratch.file("home") +
        "' blender --background --factory-startup --python-exit-code 1 --python '" SHERD_SOURCE_DIR
        "/tests/blender/volume_in_blender.py' -- '" +
        scratch.file("fields.vdb") + "' 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string said;
    char buffer[4096];
    while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) said.append(buffer, n);
    const int status = pclose(pipe);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << said << "\n(Blender is installed by tests/run --all.)";
    EXPECT_NE(said.find("0 faults"), std::string::npos) << precision << said;
  }
}

}  // namespace
}  // namespace sherd
