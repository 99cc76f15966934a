// Measures what is promised of every fracture.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "types/fragments.h"

namespace sherd {

struct PromiseReport {
  std::size_t openEdges = 0;     ///< edges of a piece not used once in each direction (or equally often)
  std::size_t lonelyCracks = 0;  ///< crack triangles without exactly one opposite twin in the piece they name
  std::size_t degenerate = 0;    ///< triangles with two corners at one place
  std::size_t badSolids = 0;     ///< pieces that are not one solid of positive volume
  std::size_t badSources = 0;    ///< untouched triangles that differ from their source
  double volumeError = 0;        ///< |Σ pieces − source| / source
  double areaError = 0;          ///< the same for the outer skin
};

namespace detail {

inline double sixVolumes(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles, const Vec3& o) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += (p[at(t[0])] - o).cross(p[at(t[1])] - o).dot(p[at(t[2])] - o);
  return sum;
}

inline double area(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += (p[at(t[1])] - p[at(t[0])]).cross(p[at(t[2])] - p[at(t[0])]).norm() / 2;
  return sum;
}

/// Shells of positive volume among the triangles joined by edges.
inline int positiveShells(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles, const Vec3& o) {
  std::map<std::pair<Index, Index>, std::size_t> first;
  std::vector<std::size_t> root(triangles.size());
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
  auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [known, isNew] = first.emplace(std::minmax(triangles[i][c], triangles[i][(c + 1) % 3]), i);
      if (!isNew) root[find(i)] = find(known->second);
    }
  std::map<std::size_t, double> volume;
  for (std::size_t i = 0; i < triangles.size(); ++i) volume[find(i)] += sixVolumes(p, {triangles[i]}, o);
  return static_cast<int>(
      std::count_if(volume.begin(), volume.end(), [](const auto& v) { return v.second > 0; }));
}

}  // namespace detail

inline PromiseReport measurePromises(const Fragments& f) {
  PromiseReport report;
  const TriMesh& source = *f.tets->surface;
  const Vec3 origin = source.positions.front();
  std::map<std::tuple<Triangle, std::pair<Index, Index>, Index>, int> cracks;
  double volume = 0, area = 0;
  for (std::size_t i = 0; i < f.pieces.size(); ++i) {
    const Piece& piece = f.pieces[i];
    std::vector<Triangle> all = piece.surface;
    all.insert(all.end(), piece.crack.begin(), piece.crack.end());
    std::map<std::pair<Index, Index>, int> edges;
    for (const Triangle& t : all) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Index a = t[c], b = t[(c + 1) % 3];
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
        report.degenerate += f.positions[at(a)] == f.positions[at(b)];
      }
    }
    for (const auto& [edge, balance] : edges) report.openEdges += balance != 0;
    report.badSolids += detail::positiveShells(f.positions, all, origin) != 1;
    volume += detail::sixVolumes(f.positions, all, origin);
    area += detail::area(f.positions, piece.surface);
    for (std::size_t t = 0; t < piece.crack.size(); ++t) {
      Triangle sorted = piece.crack[t];
      std::sort(sorted.begin(), sorted.end());
      int inversions = 0;
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = a + 1; b < 3; ++b) inversions += piece.crack[t][a] > piece.crack[t][b];
      const Index other = piece.crackNeighbour[t];
      cracks[{sorted, std::minmax(static_cast<Index>(i), other), piece.crackSheet[t]}] +=
          (inversions % 2 == 0 ? 1 : -1) * (1000 + (static_cast<Index>(i) < other ? 1 : 0));
    }
    for (std::size_t t = 0; t < piece.surface.size(); ++t)
      if (piece.surfaceCut[t] < 0)
        report.badSources += piece.surface[t] != source.triangles[at(piece.surfaceSource[t])];
  }
  for (const auto& [key, balance] : cracks) report.lonelyCracks += std::abs(balance) != 1;
  const double whole = detail::sixVolumes(f.positions, source.triangles, origin);
  report.volumeError = std::abs(volume - whole) / std::abs(whole);
  const double wholeArea = detail::area(source.positions, source.triangles);
  report.areaError = std::abs(area - wholeArea) / wholeArea;
  return report;
}

inline void expectPromises(const Fragments& f) {
  const PromiseReport r = measurePromises(f);
  EXPECT_EQ(r.openEdges, 0u);
  EXPECT_EQ(r.lonelyCracks, 0u);
  EXPECT_EQ(r.degenerate, 0u);
  EXPECT_EQ(r.badSolids, 0u);
  EXPECT_EQ(r.badSources, 0u);
  EXPECT_LT(r.volumeError, 1e-9);
  EXPECT_LT(r.areaError, 1e-9);
}

}  // namespace sherd
