#include "nodes/pipeline/random_bodies.h"

#include <cmath>
#include <numbers>

#include "support/surface_families.h"

namespace sherd::test {
namespace {

using namespace families;

TriMesh centredBox(const Vec3& size, int n) { return boxSurface(-0.5 * size, 0.5 * size, n, n, n); }

TriMesh ofCubes(const std::vector<Cube>& cubes, const Vec3& edge) { return *fromCubes(cubes, edge).surface; }

/// The surface as one of positions mapped; `map` keeps orientation.
TriMesh bent(TriMesh mesh, const std::function<Vec3(const Vec3&)>& map) {
  for (Vec3& p : mesh.positions) p = map(p);
  return mesh;
}

struct Shape {
  const char* kind;
  TriMesh mesh;
  double thickness;
};

Shape anyBox(Rng& rng) {
  const Vec3 size{1, logUniformIn(rng, 0.2, 1), logUniformIn(rng, 0.2, 1)};
  return {"box", centredBox(size, 1 + static_cast<int>(rng.below(3))), size.minCoeff()};
}

Shape anyBar(Rng& rng) {
  const double a = logUniformIn(rng, 0.04, 0.2), b = logUniformIn(rng, 0.04, 0.2);
  return {"bar", boxSurface(Vec3(0, 0, 0), Vec3(1, a, b), 1 + static_cast<int>(rng.below(12)), 1, 1),
          std::min(a, b)};
}

/// Its radius changes by less than it would take to fold.
Shape bumpySphere(Rng& rng) {
  const double depth = uniformIn(rng, 0, 0.3), waves = uniformIn(rng, 1, 5);
  const Vec3 phase{uniformIn(rng, 0, 6), uniformIn(rng, 0, 6), uniformIn(rng, 0, 6)};
  const int around = 8 + static_cast<int>(rng.below(16));
  const auto radius = [&](const Vec3& d) {
    return 1 + depth * std::sin(waves * d.x() + phase.x()) * std::sin(waves * d.y() + phase.y()) +
           depth * std::sin(waves * d.z() + phase.z());
  };
  return {"bumpy sphere",
          bent(sphereSurface(Vec3::Zero(), 0.5, around, around / 2),
               [&](const Vec3& p) { return Vec3(radius(2 * p) * p); }),
          0.3};
}

Shape anyTorus(Rng& rng) {
  const double tube = uniformIn(rng, 0.08, 0.25);
  const int around = 12 + static_cast<int>(rng.below(20)), across = 6 + static_cast<int>(rng.below(10));
  return {"torus", torusSurface(0.5, tube, around, across), 2 * tube};
}

Shape anyL(Rng& rng) {
  const int n = 2 + static_cast<int>(rng.below(3)), arm = 1 + static_cast<int>(rng.below(2));
  const double edge = 1.0 / n, deep = uniformIn(rng, 0.3, 1);
  auto mesh = ofCubes(cubesOf(n, n, 1, [=](int i, int j, int) { return i < std::min(arm, n - 1) || j < 1; }),
                      Vec3(edge, edge, deep * edge));
  return {"L", std::move(mesh), deep * edge};
}

Shape anyU(Rng& rng) {
  const int gap = 1 + static_cast<int>(rng.below(2)), height = 2 + static_cast<int>(rng.below(4));
  const Vec3 edge{0.3, uniformIn(rng, 0.1, 0.4), uniformIn(rng, 0.1, 0.4)};
  auto solid = [=](int i, int j, int) { return j < 1 || i < 1 || i >= 1 + gap; };
  return {"U", ofCubes(cubesOf(2 + gap, height, 1, solid), edge), 0.1};
}

/// A bottom with a rim around it.
Shape anyTray(Rng& rng) {
  const double wall = logUniformIn(rng, 0.03, 0.25);
  auto solid = [](int i, int j, int k) { return j == 0 || i == 0 || i == 4 || k == 0 || k == 4; };
  TriMesh mesh = ofCubes(cubesOf(5, 2, 5, solid), Vec3(1, 1, 1));
  const auto place = [=](double x,
                         int last) {  // grid lines 0 and `last` bound the tray, the next ones its wall
    return x <= 0 ? 0.0 : x >= last ? 1.0 : wall + (1 - 2 * wall) * (x - 1) / (last - 2);
  };
  return {"tray",
          bent(std::move(mesh),
               [&](const Vec3& p) {
                 return Vec3(place(p.x(), 5), p.y() <= 0 ? 0 : p.y() >= 2 ? 0.4 : wall, place(p.z(), 5));
               }),
          wall};
}

/// Two to four boxes and spheres in a row.
Shape anyParts(Rng& rng) {
  const int count = 2 + static_cast<int>(rng.below(3));
  const double gap = logUniformIn(rng, 0.15, 0.8);
  TriMesh all;
  double x = 0;
  for (int k = 0; k < count; ++k) {
    const double size = uniformIn(rng, 0.2, 0.6);
    TriMesh part = rng.below(2) == 0 ? centredBox(Vec3(size, size, 0.7 * size), 1)
                                     : sphereSurface(Vec3::Zero(), 0.5 * size, 10, 6);
    x += 0.5 * size;
    for (Vec3& p : part.positions) p.x() += x;
    x += 0.5 * size + gap;
    all = k == 0 ? std::move(part) : joined(std::move(all), part);
  }
  return {"parts", std::move(all), 0.2};
}

Shape thinWall(Rng& rng) {
  const double thickness = logUniformIn(rng, 0.01, 0.06), bow = uniformIn(rng, 0, 0.6);
  TriMesh mesh = boxSurface(Vec3(-0.5, -0.5 * uniformIn(rng, 0.3, 1), 0), Vec3(0.5, 0.4, thickness), 8, 4, 1);
  return {
      "thin wall",
      bent(std::move(mesh), [=](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + bow * p.x() * p.x()); }),
      thickness};
}

Shape hollow(Rng& rng) {
  const double inner = uniformIn(rng, 0.2, 0.8);
  TriMesh mesh = rng.below(2) == 0
                     ? joined(centredBox(Vec3::Ones(), 2), reversed(centredBox(inner * Vec3::Ones(), 1)))
                     : joined(sphereSurface(Vec3::Zero(), 0.5, 16, 8),
                              reversed(sphereSurface(Vec3::Zero(), 0.5 * inner * 0.9, 12, 6)));
  return {"void", std::move(mesh), 0.5 * (1 - inner)};
}

Shape anyTetrahedron(Rng& rng) {
  TriMesh mesh;
  for (int i = 0; i < 4; ++i)
    mesh.positions.push_back(Vec3{uniformIn(rng, 0, 1), uniformIn(rng, 0, 1), uniformIn(rng, 0, 1)});
  const auto& p = mesh.positions;
  const double six = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
  if (six < 0) std::swap(mesh.positions[2], mesh.positions[3]);
  for (const auto& face : kTetraFace) mesh.triangles.push_back({face[0], face[1], face[2]});
  return {"tetrahedron", std::move(mesh), 0.3 * std::abs(six)};
}

Shape sliver(Rng& rng) {
  const Vec3 size{1, logUniformIn(rng, 0.02, 0.3), logUniformIn(rng, 0.002, 0.02)};
  TriMesh mesh = rng.below(2) == 0 ? centredBox(size, 1) : sphereSurface(Vec3::Zero(), 0.5, 12, 6);
  if (mesh.positions.size() > 8)
    for (Vec3& p : mesh.positions) p = p.cwiseProduct(size);
  return {"sliver", std::move(mesh), size.z()};
}

constexpr Shape (*kShapes[])(Rng&) = {anyBox,  anyBar,   bumpySphere, anyTorus, anyL,           anyU,
                                      anyTray, anyParts, thinWall,    hollow,   anyTetrahedron, sliver};

}  // namespace

double uniformIn(Rng& rng, double low, double high) { return low + (high - low) * rng.uniform(); }

double logUniformIn(Rng& rng, double low, double high) {
  return std::exp(uniformIn(rng, std::log(low), std::log(high)));
}

Vec3 anyDirection(Rng& rng) {
  const double z = uniformIn(rng, -1, 1), turn = uniformIn(rng, 0, 2 * std::numbers::pi);
  return {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
}

RandomBody randomBody(Rng& rng) {
  Shape shape = kShapes[rng.below(std::size(kShapes))](rng);
  RandomBody body;
  body.kind = shape.kind;
  const double scale = logUniformIn(rng, 1e-3, 1e3);
  body.thickness = scale * shape.thickness;
  body.size = scale * boxOf(shape.mesh.positions).diagonal();
  body.distance = rng.below(2) == 0 ? 0 : logUniformIn(rng, 1, 1e6);
  const Vec3 place = body.distance * body.size * anyDirection(rng);
  const double angle = uniformIn(rng, 0, 6);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, anyDirection(rng)));
  const bool isTurned = rng.below(4) != 0;
  for (Vec3& p : shape.mesh.positions) p = place + scale * (isTurned ? Vec3(turn * p) : p);
  body.surface = std::make_shared<const TriMesh>(std::move(shape.mesh));
  return body;
}

RandomBody scaledByTwo(const RandomBody& body, int exponent) {
  RandomBody out = body;
  const double factor = std::ldexp(1.0, exponent);
  TriMesh mesh = *body.surface;
  for (Vec3& p : mesh.positions) p *= factor;
  out.surface = std::make_shared<const TriMesh>(std::move(mesh));
  out.size *= factor;
  out.thickness *= factor;
  return out;
}

}  // namespace sherd::test
