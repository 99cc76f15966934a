// Reads exported pieces back from their OBJ files and measures them, with nothing but the files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace sherd {

struct ObjTriangles {
  using Point = std::array<double, 3>;
  std::vector<std::array<Point, 3>> triangles;
  /// Per triangle: does the last `g` or `usemtl` before it hold "inside" or "crack"? So those take it for a
  /// crack face who know nothing but the file.
  std::vector<bool> saidCrack;

  double sixVolumes() const {
    double sum = 0;
    for (const auto& t : triangles) {
      const auto& [a, b, c] = t;
      sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
             a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
  }
};

inline ObjTriangles readObjTriangles(const std::filesystem::path& path) {
  ObjTriangles result;
  std::vector<ObjTriangles::Point> points;
  std::ifstream in(path);
  std::string line, key, word;
  bool saysCrack = false;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    key.clear();
    words >> key;
    if (line.rfind("v ", 0) == 0) {
      ObjTriangles::Point p;
      words >> p[0] >> p[1] >> p[2];
      points.push_back(p);
    } else if (key == "g" || key == "usemtl") {
      words >> word;
      saysCrack = word.find("inside") != std::string::npos || word.find("crack") != std::string::npos;
    } else if (line.rfind("f ", 0) == 0) {
      std::array<ObjTriangles::Point, 3> t;
      for (auto& corner : t) {
        words >> word;
        corner = points.at(static_cast<std::size_t>(std::stol(word) - 1));
      }
      result.triangles.push_back(t);
      result.saidCrack.push_back(saysCrack);
    }
  }
  return result;
}

struct ExportedReport {
  std::size_t pieces = 0;
  std::size_t openEdges = 0;     ///< over all pieces
  std::size_t lonelyCracks = 0;  ///< crack triangles without exactly one opposite twin
  std::size_t misnamed = 0;      ///< triangles of a skin said to be crack, and the other way round
  double volumeError = 0;        ///< relative to the source
};

/// `directory` holds piece_*_surface.obj and piece_*_crack.obj.
inline ExportedReport measureExported(const std::filesystem::path& directory,
                                      const std::filesystem::path& source) {
  ExportedReport report;
  std::map<std::array<ObjTriangles::Point, 3>, int> cracks;
  double volume = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    const auto suffix = name.find("_surface.obj");
    if (suffix == std::string::npos) continue;
    ++report.pieces;
    ObjTriangles piece = readObjTriangles(entry.path());
    report.misnamed +=
        static_cast<std::size_t>(std::count(piece.saidCrack.begin(), piece.saidCrack.end(), true));
    const auto crackPath = directory / (name.substr(0, suffix) + "_crack.obj");
    if (std::filesystem::exists(crackPath)) {
      const ObjTriangles crack = readObjTriangles(crackPath);
      report.misnamed +=
          static_cast<std::size_t>(std::count(crack.saidCrack.begin(), crack.saidCrack.end(), false));
      for (const auto& t : crack.triangles) {
        auto sorted = t;
        std::sort(sorted.begin(), sorted.end());
        const int inversions = (t[0] > t[1]) + (t[1] > t[2]) + (t[0] > t[2]);
        cracks[sorted] += inversions % 2 == 0 ? 1 : -1;
      }
      piece.triangles.insert(piece.triangles.end(), crack.triangles.begin(), crack.triangles.end());
    }
    std::map<std::pair<ObjTriangles::Point, ObjTriangles::Point>, int> edges;
    for (const auto& t : piece.triangles)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto &a = t[c], &b = t[(c + 1) % 3];
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    for (const auto& [edge, balance] : edges) report.openEdges += balance != 0;
    volume += piece.sixVolumes();
  }
  for (const auto& [crack, balance] : cracks) report.lonelyCracks += balance != 0;
  const double whole = readObjTriangles(source).sixVolumes();
  report.volumeError = std::abs(volume - whole) / std::abs(whole);
  return report;
}

}  // namespace sherd
