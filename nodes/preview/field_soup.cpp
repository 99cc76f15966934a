#include "preview/field_soup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

constexpr double kStep = 1.0 / 96;           // between samples, of the body's size
constexpr std::size_t kMostParts = 200'000;  // that triangles are divided into, all together
constexpr std::size_t kMostAlong = 96;       // parts of an edge

/// Into how many parts the longest edge of a triangle is divided.
std::size_t partsOf(const TriMesh& mesh, const Triangle& t, double step) {
  double longest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    longest = std::max(longest, (mesh.positions[at(t[c])] - mesh.positions[at(t[(c + 1) % 3])]).norm());
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(longest / step)), 1, kMostAlong);
}

std::vector<std::size_t> division(const TriMesh& mesh, double size) {
  std::vector<std::size_t> parts(mesh.triangles.size());
  std::size_t total = 0;
  double step = kStep * size;
  do {
    total = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) {
      parts[t] = partsOf(mesh, mesh.triangles[t], step);
      total += parts[t] * parts[t];
    }
    step *= 1.5;
  } while (total > std::max(kMostParts, parts.size()));
  return parts;
}

/// Corners of the parts of a triangle, three each, by the weights of its own corners.
std::vector<Vec3> partsOfTriangle(std::size_t n) {
  std::vector<Vec3> corners;
  const auto point = [n](std::size_t i, std::size_t j) {
    const double a = static_cast<double>(i) / static_cast<double>(n),
                 b = static_cast<double>(j) / static_cast<double>(n);
    return Vec3(1 - a - b, a, b);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; i + j < n; ++j) {
      corners.insert(corners.end(), {point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + j + 1 < n)
        corners.insert(corners.end(), {point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  return corners;
}

}  // namespace

Result<FieldSoup> fieldSoup(const TriMesh& mesh, const std::vector<Vec3>& normals, const ScalarGrid& field,
                            const PictureSpace& space) {
  const std::vector<std::size_t> parts = division(mesh, space.size);
  std::vector<std::vector<Vec3>> divided(kMostAlong + 1);
  FieldSoup out;
  std::vector<Vec3> points;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    if (divided[parts[t]].empty()) divided[parts[t]] = partsOfTriangle(parts[t]);
    for (const Vec3& w : divided[parts[t]]) {
      points.push_back(w[0] * mesh.positions[at(corners[0])] + w[1] * mesh.positions[at(corners[1])] +
                       w[2] * mesh.positions[at(corners[2])]);
      out.soup.corners.push_back(space.place(points.back()));
      const Vec3 normal = w[0] * normals[3 * t] + w[1] * normals[3 * t + 1] + w[2] * normals[3 * t + 2];
      out.soup.normals.push_back(normal.normalized().cast<float>());
    }
  }
  std::vector<double> values(points.size());
  field.sample(points, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      return failure(fmt::format("the field is {} at ({:.6g}, {:.6g}, {:.6g}) m", values[i], points[i].x(),
                                 points[i].y(), points[i].z()),
                     "paint it with finite values", "beta");
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  out.scale = {*low, *high};
  if (out.scale.isOne()) {
    out.soup.palette = {neutralColour()};
    out.soup.paint.assign(values.size() / 3, 0);
  } else {
    for (const double value : values) out.soup.values.push_back(out.scale.place(value));
  }
  return out;
}

}  // namespace sherd
