// A box broken into cells of equal weight under a metric that an artist bent, and what is measured of pieces.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <memory>
#include <vector>

#include "cvd/cvd.h"
#include "embed/embed.h"
#include "geometry/convex_hull.h"
#include "support/fragment_families.h"
#include "tessellate/tessellate.h"

namespace sherd::test {

/// Weights are volumes.
inline WeightField evenWeights(const std::shared_ptr<const TetMesh>& tets) {
  WeightField field{tets, {}, lumpedVolumes(*tets), lumpedVolumes(*tets)};
  return field;
}

inline Fragments broken(const std::shared_ptr<const Embedding>& embedding, int degree,
                        const TessellateParams& mode = {}) {
  const auto cells = cvd(embedding, evenWeights(embedding->tets), nullptr, {.degree = degree}, Exec{});
  EXPECT_TRUE(cells.ok()) << (cells.ok() ? "" : cells.error().text());
  auto pieces = tessellate(*cells, mode, Exec{});
  EXPECT_TRUE(pieces.ok()) << (pieces.ok() ? "" : pieces.error().text());
  return std::move(pieces).value();
}

inline Fragments broken(const std::shared_ptr<const TetMesh>& tets, int degree,
                        const MetricControls& controls, const EmbedParams& params = {}) {
  auto embedding = embed(tets, params, Exec{}, controls);
  EXPECT_TRUE(embedding.ok()) << (embedding.ok() ? "" : embedding.error().text());
  return broken(std::make_shared<const Embedding>(std::move(embedding).value()), degree);
}

/// Mean over pieces of their extent (standard deviation of the solid) along `axis` over that across.
inline double meanElongation(const Fragments& f, const Vec3& axis) {
  double sum = 0;
  for (const Piece& piece : f.pieces) {
    // ∫ x xᵀ = ½ tr(J) 1 − J, J for density 1.
    const Mat3 second = 0.5 * piece.inertia.trace() * Mat3::Identity() - piece.inertia;
    const double along = axis.normalized().dot(second * axis.normalized());
    sum += std::sqrt(along / (0.5 * (second.trace() - along)));
  }
  return sum / static_cast<double>(f.pieces.size());
}

/// Volume over that of the convex hull, mean over pieces by volume.
inline double meanConvexity(const Fragments& f) {
  double hulls = 0, volumes = 0;
  for (const Piece& piece : f.pieces) {
    std::vector<Vec3> points;
    for (const auto* faces : {&piece.surface, &piece.crack})
      for (const Triangle& t : *faces)
        for (const Index v : t) points.push_back(f.positions[at(v)]);
    const auto hull = convexHull(points);
    EXPECT_TRUE(hull.ok());
    hulls += hull->volume;
    volumes += piece.volume;
  }
  return volumes / hulls;
}

/// Of a crack triangle: its normal times its area, m².
inline Vec3 areaNormal(const Fragments& f, const Triangle& t) {
  const Vec3& a = f.positions[at(t[0])];
  return 0.5 * (f.positions[at(t[1])] - a).cross(f.positions[at(t[2])] - a);
}

/// How much more area the sheets have than if each were flat: Σ |A| / Σ |Σ A| − 1.
inline double meanRoughness(const Fragments& f) {
  std::vector<Vec3> sums;
  double area = 0;
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    for (std::size_t t = 0; t < f.pieces[p].crack.size(); ++t) {
      if (at(f.pieces[p].crackNeighbour[t]) < p) continue;  // its twin
      const std::size_t sheet = at(f.pieces[p].crackSheet[t]);
      if (sums.size() <= sheet) sums.resize(sheet + 1, Vec3::Zero());
      const Vec3 normal = areaNormal(f, f.pieces[p].crack[t]);
      sums[sheet] += normal;
      area += normal.norm();
    }
  double flat = 0;
  for (const Vec3& sum : sums) flat += sum.norm();
  return area / flat - 1;
}

}  // namespace sherd::test
