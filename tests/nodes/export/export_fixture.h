// A directory of its own for each test of an export, and what the tests look at of files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "export/export_crack_surface.h"

namespace sherd::export_test {

namespace fs = std::filesystem;
using Params = ExportCrackSurfaceParams;

inline std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void spill(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// What a run says to the user.
struct Listener {
  std::vector<std::string> infos, warnings;
  Exec exec;
  Listener() {
    exec.onMessage = [this](LogLevel level, const std::string& line) {
      (level == LogLevel::Info ? infos : warnings).push_back(line);
    };
  }
};

using Coordinates = std::array<double, 3>;

/// What the tests look at of an OBJ file.
struct Obj {
  std::vector<Coordinates> positions;
  std::vector<std::array<std::size_t, 3>> faces;
  std::vector<std::string> groups, materials;
  std::size_t normals = 0, uvs = 0;
};

inline Obj readObj(const fs::path& path) {
  Obj obj;
  std::ifstream in(path);
  for (std::string line, key; std::getline(in, line);) {
    std::istringstream words(line);
    words >> key;
    if (key == "v") {
      Coordinates p{};
      words >> p[0] >> p[1] >> p[2];
      obj.positions.push_back(p);
    } else if (key == "f") {
      std::array<std::size_t, 3> face{};
      for (auto& corner : face) {
        std::string word;
        words >> word;
        corner = std::stoul(word) - 1;
      }
      obj.faces.push_back(face);
    } else if (key == "g" || key == "usemtl") {
      std::string name;
      words >> name;
      (key == "g" ? obj.groups : obj.materials).push_back(name);
    }
    obj.normals += key == "vn";
    obj.uvs += key == "vt";
  }
  return obj;
}

inline std::set<std::string> namesIn(const fs::path& directory) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) names.insert(entry.path().filename().string());
  return names;
}

class Export : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    root = fs::temp_directory_path() / ("sherd_export_" + std::to_string(::getpid()) + "_" + info->name());
    fs::remove_all(root);
    fs::create_directories(root);
    params.directory = (root / "out").string();
  }
  void TearDown() override { fs::remove_all(root); }

  fs::path out(const std::string& name) const { return fs::path(params.directory) / name; }
  Result<ExportReport> run(const Fragments& f) { return exportCrackSurface(f, params, listener.exec); }

  fs::path root;
  Params params;
  Listener listener;
};

}  // namespace sherd::export_test
