// Real models: their pieces can be broken again, all but truly flat ones.
#include <gtest/gtest.h>

#include <filesystem>

#include "load_mesh/load_mesh.h"
#include "select_piece/select_piece.h"
#include "support/broken_again.h"
#include "support/promises.h"

namespace sherd {
namespace {

class SlowPiecesAgain : public testing::TestWithParam<std::tuple<const char*, int>> {};

/// Empty where the piece breaks again and every promise is kept; else what went wrong.
std::string whyNot(const Fragments& broken, const std::string& name) {
  const auto piece = selectPiece(broken, {.piece = name}, Exec{});
  if (!piece.ok()) return piece.error().text();
  const auto again =
      test::breakBody(std::make_shared<const TriMesh>(piece->mesh), {.tets = 300, .degree = 4});
  if (!again.ok()) return again.error().text();
  const PromiseReport r = measurePromises(*again);
  if (r.openEdges + r.lonelyCracks + r.degenerate + r.badSolids + r.badSources > 0 || r.volumeError > 1e-9 ||
      r.areaError > 1e-9)
    return "a promise is broken: open " + std::to_string(r.openEdges) + ", lonely " +
           std::to_string(r.lonelyCracks) + ", degenerate " + std::to_string(r.degenerate) + ", solids " +
           std::to_string(r.badSolids) + ", sources " + std::to_string(r.badSources) + ", volume " +
           std::to_string(r.volumeError);
  return {};
}

TEST_P(SlowPiecesAgain, AllOfThemBreak) {
  const auto [model, degree] = GetParam();
  std::string file = std::string(SHERD_SOURCE_DIR "/assets/") + model + ".obj";
  if (!std::filesystem::exists(file))
    file = std::string(SHERD_SOURCE_DIR "/../shared/meshes/") + model + ".obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  LoadMeshParams load;
  load.file = file;
  const auto mesh = loadMesh(load, Exec{});
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  const auto broken =
      test::breakBody(std::make_shared<const TriMesh>(*mesh), {.tets = 5000, .degree = degree});
  ASSERT_TRUE(broken.ok()) << broken.error().text();
  std::size_t good = 0;
  std::string failures;
  for (const Piece& p : broken->pieces) {
    const std::string problem = whyNot(*broken, p.name);
    good += problem.empty();
    if (!problem.empty()) failures += p.name + ": " + problem + "\n";
  }
  EXPECT_EQ(good, broken->pieces.size()) << failures;
}

INSTANTIATE_TEST_SUITE_P(Cases, SlowPiecesAgain,
                         testing::Combine(testing::Values("vase", "mushroom", "table", "wall", "horse"),
                                          testing::Values(7, 48)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_" +
                                  std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace sherd
