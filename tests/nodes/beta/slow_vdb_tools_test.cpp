// What OpenVDB's own tool says of our files: Debian's vdb_print. tests/run --all installs it; where it is
// missing the tests fail.
#include <cstdio>

#include "beta/paint_beta.h"
#include "beta/write_vdb.h"
#include "nodes/beta/fields.h"
#include "support/program.h"

namespace sherd {
namespace {

using namespace test;

std::string outputOf(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "popen failed";
  std::string text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  return pclose(pipe) == 0 ? text : "failed (vdb_print is installed by tests/run --all): " + text;
}

ScalarGrid paintedDab(const std::string& name) {
  PaintBetaParams params;
  params.name = name;
  params.voxel = 0.25;
  params.background = 0.5;
  params.strokes = {{{{0, 0, 0}}, 1, 0.5, 3, Blend::Replace}};
  auto result = paintBeta({}, params, {});
  EXPECT_TRUE(result.ok());
  return *result;
}

TEST(SlowVdbTools, PrintNamesTypesSizesAndTransforms) {
  const ScratchDirectory scratch;
  const std::vector<ScalarGrid> grids{paintedDab("beta"), paintedDab("mask")};
  for (const auto precision : {WriteVdbParams::Precision::Float, WriteVdbParams::Precision::Half}) {
    WriteVdbParams params;
    params.file = scratch.file("fields.vdb");
    params.precision = precision;
    ASSERT_TRUE(writeVdb(grids, params, {}).ok());
    const std::string brief = outputOf("vdb_print '" + params.file + "'");
    const std::string all = outputOf("vdb_print -l -m '" + params.file + "'");
    const bool isHalf = precision == WriteVdbParams::Precision::Half;
    EXPECT_TRUE(says(brief, "beta"));
    EXPECT_TRUE(says(brief, "mask"));
    EXPECT_TRUE(says(brief, "float"));
    EXPECT_TRUE(says(all, "Background value: 0.5"));
    EXPECT_TRUE(says(all, "voxel size: 0.25"));
    EXPECT_TRUE(says(all, std::to_string(voxelsOf(grids[0]).activeVoxelCount())));
    EXPECT_TRUE(says(all, isHalf ? "is_saved_as_half_float: true" : "is_saved_as_half_float: false"));
  }
}

}  // namespace
}  // namespace sherd
