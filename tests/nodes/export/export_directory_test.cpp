// What a run of the export leaves in its directory: with files of an earlier run or of others there, and when
// it is stopped or fails.
#include <sys/resource.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "nodes/export/export_fixture.h"
#include "support/fragment_families.h"

namespace sherd::export_test {
namespace {

TEST_F(Export, TwelveAfterSixtySevenLeavesTwelveAndForeignFilesAlone) {
  ASSERT_TRUE(run(test::slicedBox(67)).ok());
  spill(out("notes.txt"), "mine");
  spill(out("piece_0070_surface.obj"), "mine too");
  const auto result = run(test::slicedBox(12));
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->removed, 2u * 55);
  EXPECT_EQ(namesIn(params.directory).size(), 2u * 12 + 2 + 2);
  EXPECT_EQ(slurp(out("notes.txt")), "mine");
  EXPECT_EQ(slurp(out("piece_0070_surface.obj")), "mine too");
}

TEST_F(Export, SecondRunTouchesNothingAndMendsWhatWasChanged) {
  const Fragments f = test::slicedBox(3);
  const auto first = run(f);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(first->written, 7u);
  EXPECT_EQ(first->files.size(), 8u);
  const std::string whole = slurp(out("piece_0002_crack.obj"));
  const auto time = fs::last_write_time(out("sherd_manifest.json"));
  const auto second = run(f);
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->written, 0u);
  EXPECT_EQ(second->kept, 7u);
  EXPECT_EQ(fs::last_write_time(out("sherd_manifest.json")), time);
  spill(out("piece_0002_crack.obj"), whole.substr(0, whole.size() - 1) + "x");
  fs::remove(out("piece_0001_surface.obj"));
  const auto third = run(f);
  ASSERT_TRUE(third.ok());
  EXPECT_EQ(third->written, 3u);  // the two, and the description that was withdrawn before them
  EXPECT_EQ(slurp(out("piece_0002_crack.obj")), whole);
}

TEST_F(Export, ALonelyCrackTriangleIsAnErrorBeforeAnythingIsWritten) {
  Fragments f = test::slicedBox(2);
  std::swap(f.pieces[0].crack[0][0], f.pieces[0].crack[0][1]);
  const auto result = run(f);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "pieces");
  EXPECT_FALSE(fs::exists(params.directory));
}

TEST_F(Export, RefusesForeignFileUnderOurNameBeforeWriting) {
  fs::create_directories(params.directory);
  spill(out("piece_0002_crack.obj"), "a stranger's");
  const auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("piece_0002_crack.obj"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_EQ(namesIn(params.directory), std::set<std::string>{"piece_0002_crack.obj"});
}

TEST_F(Export, KilledRunIsCleanedUp) {
  ASSERT_TRUE(run(test::slicedBox(5)).ok());
  // A run of more pieces that was killed while it wrote piece 6: claimed, partly there.
  auto manifest = nlohmann::json::parse(slurp(out("sherd_manifest.json")));
  manifest["files"]["piece_0006_surface.obj"] = "";
  manifest["files"]["piece_0007_surface.obj"] = "";
  spill(out("sherd_manifest.json"), manifest.dump());
  spill(out("piece_0006_surface.obj"), "v 0 0 0");
  spill(out("piece_0007_surface.obj.0123456789abcdef.partial"), "v 0");
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  EXPECT_EQ(namesIn(params.directory).size(), 2u * 2 + 2);
}

TEST_F(Export, HostileManifestRemovesNothingOfOthers) {
  fs::create_directories(params.directory);
  spill(root / "precious.txt", "precious");
  spill(root / "piece_0009_surface.obj", "precious");
  spill(out("scene.blend"), "precious");
  spill(
      out("sherd_manifest.json"),
      R"({"files": {"../precious.txt": "", "../piece_0009_surface.obj": "", "scene.blend": "", "..": "", "": 3}})");
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  EXPECT_EQ(slurp(root / "precious.txt"), "precious");
  EXPECT_EQ(slurp(root / "piece_0009_surface.obj"), "precious");
  EXPECT_EQ(slurp(out("scene.blend")), "precious");
}

TEST_F(Export, DamagedManifestIsAnError) {
  fs::create_directories(params.directory);
  for (const char* text : {"", "{", "[]", "{\"files\": 3}", "\xff\xfe"}) {
    spill(out("sherd_manifest.json"), text);
    const auto result = run(test::slicedBox(2));
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().what.find("sherd_manifest.json"), std::string::npos);
  }
}

TEST_F(Export, DirectoryThatCannotBe) {
  spill(root / "file", "");
  params.directory = (root / "file").string();
  auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("is a file, not a directory"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  params.directory = (root / "file" / "below").string();
  result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("cannot create the directory"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  params.directory = "/proc/sherd";
  EXPECT_FALSE(run(test::slicedBox(2)).ok());
}

TEST_F(Export, FailedWriteLeavesNoStrayFile) {
  // No file may grow beyond the limit: what a full disk does, without one. The manifest of the names still
  // fits.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{700, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const auto result = run(test::slicedBox(2));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("cannot write '" + params.directory), std::string::npos)
      << result.error().what;
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_FALSE(result.error().remedy.empty());
  for (const std::string& name : namesIn(params.directory))
    EXPECT_EQ(name.find(".partial"), std::string::npos);
  EXPECT_TRUE(run(test::slicedBox(2)).ok());
}

TEST_F(Export, CancelledRunLeavesNoPieces) {
  CancelToken token;
  token.cancel();
  listener.exec.cancel = &token;
  const auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
  EXPECT_FALSE(fs::exists(params.directory));
}

/// New pieces never stand beside the description of old ones.
TEST_F(Export, CancelledMidwayLeavesNoDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  CancelToken token;
  listener.exec.cancel = &token;
  listener.exec.onProgress = [&](double share) {
    if (share >= 0.5) token.cancel();  // beyond the three old pieces' names
  };
  auto result = run(test::slicedBox(9));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
  EXPECT_EQ(result.error().port, "");
  EXPECT_FALSE(fs::exists(out("pieces.json")));
  EXPECT_TRUE(fs::exists(out("piece_0001_surface.obj")));
  listener.exec.cancel = nullptr;
  ASSERT_TRUE(run(test::slicedBox(9)).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["piece_count"], 9);
}

TEST_F(Export, FailedMidwayLeavesNoDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  fs::remove(out("piece_0002_surface.obj"));
  fs::create_directories(out("piece_0002_surface.obj") / "in the way");
  const auto result = run(test::slicedBox(4));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_FALSE(result.error().remedy.empty());
  EXPECT_FALSE(fs::exists(out("pieces.json")));
  fs::remove_all(out("piece_0002_surface.obj"));
  ASSERT_TRUE(run(test::slicedBox(4)).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["piece_count"], 4);
}

TEST_F(Export, CancelledWhereNothingChangesKeepsTheDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  CancelToken token;
  listener.exec.cancel = &token;
  listener.exec.onProgress = [&](double) { token.cancel(); };
  ASSERT_FALSE(run(test::slicedBox(3)).ok());
  EXPECT_TRUE(fs::exists(out("pieces.json")));
}

}  // namespace
}  // namespace sherd::export_test
