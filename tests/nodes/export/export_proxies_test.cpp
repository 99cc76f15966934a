#include "export/export_proxies.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "export/owned_files.h"
#include "support/program.h"

namespace sherd {
namespace {

ConvexHull tetrahedron(const Vec3& at, double size) {
  ConvexHull hull;
  hull.positions = {at, at + Vec3(size, 0, 0), at + Vec3(0, size, 0), at + Vec3(0, 0, size)};
  hull.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  hull.volume = size * size * size / 6;
  return hull;
}

Proxies twoPieces() {
  Proxies proxies;
  proxies.frame = {0.01, FileFrame::Up::Z};
  proxies.pieces.resize(2);
  proxies.pieces[0].name = "piece_0001";
  proxies.pieces[0].hulls = {tetrahedron(Vec3::Zero(), 1), tetrahedron(Vec3(2, 0, 0), 0.5)};
  proxies.pieces[0].pieceVolume = 0.16;
  proxies.pieces[0].error = 0.25;
  proxies.pieces[0].overlap = 0.016;
  proxies.pieces[1].name = "piece_0002_0003";
  proxies.pieces[1].hulls = {tetrahedron(Vec3(0, 5, 0), 1)};
  proxies.pieces[1].mass = 7;
  return proxies;
}

TEST(ExportProxies, OneFilePerPieceWithAnObjectPerHull) {
  const ScratchDirectory scratch;
  const auto report = exportProxies(twoPieces(), {.directory = scratch.file("out")}, Exec{});
  ASSERT_TRUE(report.ok()) << report.error().text();
  const std::string first = contentOf(scratch.file("out/piece_0001_hulls.obj"));
  EXPECT_NE(
      first.find("o piece_0001_hull_01\ng piece_0001_hull_01\nv 0 0 0\nv 100 0 0\nv 0 0 100\nv 0 -100 0\n"),
      std::string::npos)
      << first;
  EXPECT_NE(first.find("o piece_0001_hull_02\n"), std::string::npos);
  EXPECT_NE(first.find("\nf 5 7 6\n"), std::string::npos) << "numbers go on through the file";
  const std::string second = contentOf(scratch.file("out/piece_0002_0003_hulls.obj"));
  EXPECT_NE(second.find("o piece_0002_0003_hull_01\n"), std::string::npos);
  EXPECT_NE(second.find("\nf 1 3 2\n"), std::string::npos) << "and begin anew in the next";

  const auto json = nlohmann::json::parse(contentOf(report->description));
  EXPECT_EQ(json["piece_count"], 2);
  EXPECT_EQ(json["hull_count"], 3);
  EXPECT_EQ(json["largest_volume_error"], 0.25);
  EXPECT_DOUBLE_EQ(json["largest_overlap_share"].get<double>(), 0.1);
  EXPECT_EQ(json["pieces"][0]["hulls"][1]["name"], "piece_0001_hull_02");
  EXPECT_EQ(json["pieces"][1]["file"], "piece_0002_0003_hulls.obj");
  EXPECT_EQ(json["pieces"][1]["mass"], 7);
  EXPECT_EQ(json["files_frame"]["up"], "z");
}

TEST(ExportProxies, OneFileForAllReplacesThoseOfAnEarlierRunAndNothingElse) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  ASSERT_TRUE(exportProxies(twoPieces(), {.directory = out}, Exec{}).ok());
  std::ofstream(out + "/piece_0009_hulls.obj") << "mine";
  const auto report =
      exportProxies(twoPieces(), {.directory = out, .files = ExportProxiesParams::Files::One}, Exec{});
  ASSERT_TRUE(report.ok()) << report.error().text();
  EXPECT_EQ(report->removed, 2u);
  EXPECT_FALSE(std::filesystem::exists(out + "/piece_0001_hulls.obj"));
  EXPECT_EQ(contentOf(out + "/piece_0009_hulls.obj"), "mine");
  const std::string all = contentOf(out + "/proxies.obj");
  for (const char* name : {"piece_0001_hull_01", "piece_0001_hull_02", "piece_0002_0003_hull_01"})
    EXPECT_NE(all.find(std::string("o ") + name), std::string::npos);
  EXPECT_NE(all.find("\nf 9 11 10\n"), std::string::npos);
}

TEST(ExportProxies, ASecondRunWritesNothing) {
  const ScratchDirectory scratch;
  const ExportProxiesParams params{.directory = scratch.file("out")};
  ASSERT_EQ(exportProxies(twoPieces(), params, Exec{})->written, 3u);
  EXPECT_EQ(exportProxies(twoPieces(), params, Exec{})->written, 0u);
}

TEST(ExportProxies, AForeignFileIsAnError) {
  const ScratchDirectory scratch;
  std::filesystem::create_directories(scratch.file("out"));
  std::ofstream(scratch.file("out/proxies.json")) << "mine";
  const auto report = exportProxies(twoPieces(), {.directory = scratch.file("out")}, Exec{});
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().port, "directory");
  EXPECT_FALSE(std::filesystem::exists(scratch.file("out/piece_0001_hulls.obj")));
  EXPECT_FALSE(exportProxies(Proxies{}, {.directory = scratch.file("out")}, Exec{}).ok());
}

TEST(ExportProxies, NamesThatCanBeOurs) {
  for (const char* name : {"proxies.json", "proxies.obj", "piece_0001_hulls.obj", "piece_0001_0002_hulls.obj",
                           "piece_0001_0002_0003_surface.obj", "piece_1_2_crack.ply"})
    EXPECT_TRUE(OwnedFiles::canBeOurs(name)) << name;
  for (const char* name : {"piece__0001_hulls.obj", "piece_0001__0002_hulls.obj", "piece_0001_x_hulls.obj",
                           "piece_hulls.obj", "piece_0001_0002_.obj", "../piece_0001_hulls.obj"})
    EXPECT_FALSE(OwnedFiles::canBeOurs(name)) << name;
}

}  // namespace
}  // namespace sherd
