// Real models, sound ones and broken ones: those beside the project's folder and those of Debian's package
// libcgal-demo. Where both are absent the test is skipped. Writes a table of what became of each into the
// build folder, repair_corpus.tsv: name, triangles before and after, defects, the stage that was needed, how
// far the visible surface moved (of the diagonal), time, result.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/hash.h"
#include "damage.h"
#include "geometry/surface_tree.h"
#include "load_mesh/file_mesh.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> meshesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  if (folder.empty() || !fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (entry.is_regular_file() &&
        (ending == ".obj" || ending == ".off" || ending == ".ply" || ending == ".stl"))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// libcgal-demo's meshes, unpacked into the build folder; empty where the package is absent.
fs::path demoFolder() {
  const fs::path archive = "/usr/share/doc/libcgal-demo/data.tar.gz";
  const fs::path folder = fs::path(SHERD_BINARY_DIR) / "libcgal-demo";
  if (!fs::exists(archive)) return {};
  fs::create_directories(folder);
  const std::string command = "tar xzf '" + archive.string() + "' -C '" + folder.string() + "' data/meshes";
  return std::system(command.c_str()) == 0 ? folder : fs::path();
}

Result<TriMesh> read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string content = text.str(), ending = file.extension().string();
  auto read = ending == ".obj"   ? readObj(content)
              : ending == ".ply" ? readPly(content)
              : ending == ".stl" ? readStl(content)
                                 : readOff(content);
  if (!read.ok()) return read.error();
  TriMesh mesh;  // the file's attributes make room for known ones
  mesh.positions = std::move(read->mesh.positions);
  mesh.triangles = std::move(read->mesh.triangles);
  mesh.source = file.filename().string();
  weld(mesh);
  test::dress(mesh);
  return mesh;
}

/// How far samples of `a` that don't lie within `solid` are from `b`, at most.
double distance(const TriMesh& a, const SurfaceTree& b, const SurfaceTree* solid) {
  double most = 0;
  for (const Triangle& t : a.triangles) {
    const Vec3 middle = (a.positions[at(t[0])] + a.positions[at(t[1])] + a.positions[at(t[2])]) / 3;
    for (const Vec3& p : {a.positions[at(t[0])], middle}) {
      const double d = b.closest(p).distance;
      if (d > most && (solid == nullptr || !solid->contains(p))) most = d;
    }
  }
  return most;
}

/// How far colours are from the positions that they were made of.
double colourError(const TriMesh& mesh) {
  double most = 0;
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k) {
    const Vec3& p = mesh.positions[at(mesh.triangles[k / 3][k % 3])];
    most = std::max(most, (mesh.colorSets[0].rgba[k].head<3>() - p).norm());
  }
  return most;
}

class SlowRepairCorpus : public ::testing::Test {
 protected:
  void repairFile(const fs::path& file, std::ofstream& table) {
    SCOPED_TRACE(file.filename().string());
    table << file.filename().string() << '\t';
    const auto mesh = read(file);
    if (!mesh.ok()) {
      ++unreadable_;
      table << "0\t0\t\t\t\t\tunreadable: " << mesh.error().text() << std::endl;
      return;
    }
    const auto begun = std::chrono::steady_clock::now();
    const auto result = repair(*mesh, {}, {});
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begun;
    if (!result.ok()) {
      ++refused_;
      table << mesh->triangles.size() << "\t0\t\t\t\t" << ms.count() << "\trefused: " << result.error().text()
            << std::endl;
      return;
    }
    const double off = check(*mesh, *result);
    const RepairReport& report = result->report;
    const auto defects = refusal(report.found, "");
    table << mesh->triangles.size() << '\t' << result->mesh.triangles.size() << '\t'
          << (defects ? defects->what.substr(defects->what.find(": ") + 2) : "") << '\t'
          << nameOf(report.stage) << '\t' << off << '\t' << ms.count() << "\tgood";
    for (const std::string& line : report.done) table << "; " << line.substr(line.find(": ") + 2);
    table << std::endl;
  }

  /// What holds of each result; returns how far the visible surface moved, of the diagonal.
  double check(const TriMesh& given, const Repaired& result) {
    const RepairReport& report = result.report;
    const TriMesh& mesh = result.mesh;
    ++stages_[static_cast<std::size_t>(report.stage)];
    EXPECT_TRUE(inspectSurface(mesh).sound());
    EXPECT_GT(test::volumeOf(mesh), 0);
    if (report.stage == RepairStage::None) {
      Hasher before, after;
      hashValue(before, given);
      hashValue(after, mesh);
      EXPECT_EQ(before.digest(), after.digest());
      return 0;
    }
    const double diagonal = boxOf(given.positions).diagonal();
    const SurfaceTree old(given.positions, given.triangles), fresh(mesh.positions, mesh.triangles);
    const double there = distance(given, fresh, &fresh) / diagonal;
    if (!report.visible) {
      EXPECT_LT(there, 2e-5) << "something visible is gone";
      EXPECT_LT(distance(mesh, old, nullptr), 0.05 * diagonal) << "something is there that was not";
    } else {
      EXPECT_LT(there, 0.02 + report.relativeHausdorff);
    }
    EXPECT_EQ(mesh.normals.size(), mesh.cornerCount());
    EXPECT_EQ(mesh.uvSets.size(), 2u);
    EXPECT_EQ(mesh.materialOf.size(), mesh.triangles.size());
    EXPECT_LT(colourError(mesh), (report.visible ? 0.011 : 3e-5) * diagonal);
    return there;
  }

  std::size_t unreadable_ = 0, refused_ = 0, stages_[4] = {};
};

TEST_F(SlowRepairCorpus, EveryModelIsGoodOrSaysWhyNot) {
  std::vector<fs::path> files = meshesIn(fs::path(SHERD_SOURCE_DIR) / "../shared/meshes");
  for (const fs::path& file : meshesIn(demoFolder())) files.push_back(file);
  if (files.empty()) GTEST_SKIP() << "neither ../shared/meshes nor libcgal-demo is there";
  std::ofstream table(fs::path(SHERD_BINARY_DIR) / "repair_corpus.tsv");
  table << "name\tbefore\tafter\tdefects\tstage\tmoved\tms\tresult\n";
  for (const fs::path& file : files) repairFile(file, table);
  table << "# " << files.size() << " files: " << stages_[0] << " sound, " << stages_[1] << " mended, "
        << stages_[2] << " by the hull, " << stages_[3] << " by a level set, " << refused_ << " refused, "
        << unreadable_ << " unreadable\n";
  RecordProperty("sound", static_cast<int>(stages_[0]));
  EXPECT_LE(refused_ + unreadable_, 1u) << "one of them is a cloud of points";
}

}  // namespace
}  // namespace sherd
