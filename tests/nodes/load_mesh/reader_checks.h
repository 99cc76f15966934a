// What every reader's tests ask: what an error says, and that no damaged file crashes it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/rng.h"
#include "load_mesh/file_mesh.h"

namespace sherd::test {

using Reader = Result<FileMesh> (*)(std::string_view, const Exec&);

inline void expectError(const Result<FileMesh>& file, const std::string& part) {
  ASSERT_FALSE(file.ok()) << "expected an error with: " << part;
  EXPECT_NE(file.error().text().find(part), std::string::npos) << file.error().text();
}

/// Whatever a reader accepts hangs together.
inline void expectConsistent(const FileMesh& file) {
  const TriMesh& m = file.mesh;
  for (const Triangle& t : m.triangles) {
    for (Index v : t) ASSERT_TRUE(v >= 0 && at(v) < m.positions.size());
  }
  ASSERT_TRUE(m.normals.empty() || m.normals.size() == m.cornerCount());
  for (const auto& set : m.uvSets) ASSERT_EQ(set.uv.size(), m.cornerCount());
  for (const auto& set : m.colorSets) ASSERT_EQ(set.rgba.size(), m.cornerCount());
  ASSERT_EQ(m.materialOf.size(), m.materials.empty() ? 0 : m.triangles.size());
  for (Index i : m.materialOf) ASSERT_TRUE(i >= 0 && at(i) < m.materials.size());
}

/// Reads a copy of exactly these bytes, so that a sanitizer sees a read behind them.
inline void readDamaged(Reader reader, const std::string& content) {
  const std::vector<char> bytes(content.begin(), content.end());
  const Result<FileMesh> file = reader(std::string_view(bytes.data(), bytes.size()), {});
  if (file.ok()) {
    expectConsistent(*file);
  } else {
    EXPECT_FALSE(file.error().what.empty());
  }
}

/// A file that is all right is not read to its end when nobody wants it any more.
inline void expectEndsWhenCancelled(Reader reader, const std::string& content) {
  ASSERT_TRUE(reader(content, {}).ok());
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const Result<FileMesh> file = reader(content, exec);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().kind, Error::Kind::Cancelled);
}

inline void expectNoCrashOnDamage(Reader reader, const std::string& content, int mutations = 3000) {
  for (std::size_t size = 0; size <= content.size(); ++size) readDamaged(reader, content.substr(0, size));
  Rng rng(20141);
  for (int i = 0; i < mutations; ++i) {
    std::string damaged = content;
    for (std::uint64_t k = 1 + rng.below(4); k > 0; --k) {
      const std::size_t where = rng.below(damaged.size());
      const char byte = static_cast<char>(rng.below(256));
      switch (rng.below(3)) {
        case 0:
          damaged[where] = byte;
          break;
        case 1:
          damaged.insert(where, 1, byte);
          break;
        default:
          damaged.erase(where, 1 + rng.below(3));
      }
      if (damaged.empty()) break;
    }
    readDamaged(reader, damaged);
  }
}

inline std::string exactly(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Numbers that single precision or careless rounding changes.
inline std::vector<Vec3> awkwardPoints() {
  std::vector<Vec3> points{{1000000.1234567, 0.1, -1e-300},
                           {1 / 3.0, -0.0, 4.9406564584124654e-324},
                           {1.7976931348623157e308, 9007199254740993.0, 2.2250738585072014e-308}};
  Rng rng(7);
  for (int i = 0; i < 297; ++i) {
    const double scale = std::exp2(40 * rng.uniform() - 20);
    points.emplace_back(scale * (rng.uniform() - 0.5), scale * rng.uniform(), -scale * rng.uniform());
  }
  return points;
}

inline double areaOf(const TriMesh& m) {
  double area = 0;
  for (const Triangle& t : m.triangles) {
    const Vec3& a = m.positions[at(t[0])];
    area += 0.5 * (m.positions[at(t[1])] - a).cross(m.positions[at(t[2])] - a).norm();
  }
  return area;
}

}  // namespace sherd::test
