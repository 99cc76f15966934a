// Small values by hand with every optional field set, and with numbers that are easily lost: −0, NaN, the
// smallest and the largest.
#pragma once

#include <limits>
#include <memory>
#include <utility>

#include "support/tet_families.h"
#include "types/degree_model.h"
#include "types/fields.h"
#include "types/fragments.h"
#include "types/partition.h"
#include "types/proxies.h"
#include "types/rest_shape.h"
#include "types/surface_looks.h"

namespace sherd::made {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
inline constexpr double kLargest = std::numeric_limits<double>::max();

inline SurfaceLooks surfaceLooks() {
  SurfaceLooks looks;
  looks.images = {{"a b.png", std::string("\x89PNG\r\n\0\x1a", 8)}, {"", ""}};
  Look glazed;
  glazed.baseColour = {0.25, -0.0, 1, kSmallest};
  glazed.metallic = 0.5;
  glazed.emissive = {0, kLargest, 1};
  glazed.alpha = Look::Alpha::Mask;
  glazed.doubleSided = true;
  glazed.colourTexture = {0, 1, 0.5, Texture::Wrap::Mirror, Texture::Wrap::Clamp};
  glazed.emissiveTexture.image = 1;
  glazed.mtl = {{"Kd 0.25 0 1", -1}, {"map_Kd -bm 2", 0}};
  looks.looks = {glazed, std::nullopt, Look{}};
  return looks;
}

inline TriMesh triMesh() {
  TriMesh mesh = *families::box(1, 1, 1, Vec3(1, 2, 3)).surface;
  const std::size_t corners = mesh.cornerCount();
  mesh.positions[0] = Vec3(-0.0, kSmallest, -kLargest);
  mesh.normals.assign(corners, Vec3(0, -0.0, 1));
  mesh.uvSets = {{"map1", std::vector<Vec2>(corners, Vec2(0.25, -0.0))},
                 {"", std::vector<Vec2>(corners, Vec2(kNan, 2))}};
  mesh.colorSets = {{"Farbe ä", std::vector<Vec4>(corners, Vec4(0, 0.5, 1, -0.0))}};
  mesh.materials = {"clay", "", "glaze"};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.materialOf.push_back(static_cast<Index>(t % 3));
  mesh.frame = {0.01, FileFrame::Up::Z};
  mesh.source = "a b/ü.obj";
  mesh.piece = "piece_0003_0002";
  mesh.looks = std::make_shared<const SurfaceLooks>(surfaceLooks());
  return mesh;
}

inline TetMesh tetMesh() {
  TetMesh mesh = families::box(1, 1, 1, Vec3(1, 2, 3));
  mesh.surface = std::make_shared<const TriMesh>(triMesh());
  mesh.insideFraction[0] = -0.0;
  mesh.quality = {70, 110, 6, 5.5, kSmallest};
  TrianglePatches& patches = mesh.patches;  // one with all
  const std::size_t triangles = mesh.surface->triangles.size();
  patches.begin = {0, static_cast<Index>(triangles)};
  for (std::size_t t = 0; t < triangles; ++t) patches.triangles.push_back(static_cast<Index>(t));
  patches.indexTriangles();
  patches.neighbourBegin = {0, 1};
  patches.neighbours = {0};
  patches.regular = {1};
  patches.sums = {{-0.0, {1, 2, 3}, {4, kSmallest, 6, 7, 8, 9}}};
  patches.origin = Vec3(-0.0, 1, 2);
  return mesh;
}

inline std::shared_ptr<const TetMesh> sharedTets() { return std::make_shared<const TetMesh>(tetMesh()); }

inline Impact impact() {
  Impact impact;
  impact.hit = true;
  impact.time = 0.45;
  impact.centreOfMass = Vec3(-0.0, 1, kNan);
  impact.contacts = {{Vec3(1, 2, 3), Vec3(4, -0.0, 6), 1e-4, 0.01},
                     {Vec3(3, 2, 1), Vec3(6, 5, 4), 1e-5, 0.02}};
  impact.before = {Vec3(0, 1, 0), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Vec3(0, -4, 0), Vec3(1, 2, 3)};
  impact.after = {Vec3(0, 1, 0), Eigen::Quaterniond(0.5, 0.5, 0.5, -0.0), Vec3(0, 1, 0), Vec3(-0.0, 0, 3)};
  return impact;
}

inline EnergyField energyField() {
  EnergyField field;
  field.tets = sharedTets();
  field.material = {7800, 2e11, 0.3};
  field.tetEnergy.assign(field.tets->tets.size(), kSmallest);
  field.nodeEnergy.assign(field.tets->nodes.size(), -0.0);
  field.displacement.assign(field.tets->nodes.size(), Vec3(1e-6, kNan, -0.0));
  return field;
}

inline WeightField weightField() {
  WeightField field;
  field.tets = sharedTets();
  field.material = {1, 2, -0.25};
  field.weight.assign(field.tets->nodes.size(), 0.125);
  field.volume.assign(field.tets->nodes.size(), 0.75);
  field.alpha = -0.0;
  field.beta = {1, 2};
  return field;
}

inline DegreeModel degreeModel() {
  DegreeModel m;
  m.validFor = {{1, 2}, {3, 4}, {7800, 2e11, 0.3}, kSmallest, 0.5, {5, 6}};
  m.method = DegreeMethod::Network;
  m.scale = -0.0;
  m.mean = {1, -0.0, kSmallest, 4};
  m.basis = Eigen::MatrixXd::Random(2, 4);
  m.residualFactor = 0.5;
  m.featureScale = Eigen::MatrixXd::Random(3, 2);
  m.order = {2, 0, 3, 1};
  m.points = Eigen::MatrixXd::Random(5, 7);
  m.centres = {6, 0};
  m.coefficient = {-0.0, kLargest};
  m.bias = -0.0;
  m.whitening = Eigen::MatrixXd::Identity(2, 2);
  m.variance = 3;
  m.noise = kNan;
  m.reach = kSmallest;
  m.errors = {1, 2, -0.0, 4, 5};
  return m;
}

inline Embedding embedding() {
  Embedding e;
  e.tets = sharedTets();
  e.metric = Embedding::Metric::Interior;
  e.coordinates = Eigen::MatrixXd::Random(5, static_cast<Eigen::Index>(e.tets->nodes.size()));
  e.coordinates(4, 0) = -0.0;
  e.diameter = 3.7;
  return e;
}

inline RestShape restShape() {
  RestShape rest{sharedTets(), {}};
  rest.positions.assign(rest.tets->nodes.size(), Vec3(-0.0, kSmallest, 3));
  return rest;
}

inline Sites sites() {
  Sites s;
  s.positions = Eigen::MatrixXd::Random(5, 3);
  s.energy = 0.5;
  s.gamma = kNan;
  s.degreeGiven = true;
  s.pinned = 2;
  return s;
}

inline Partition partition() {
  Partition p;
  p.embedding = std::make_shared<const Embedding>(embedding());
  p.material = {2, 3, 0.4};
  p.sites = Eigen::MatrixXd::Random(5, 3);
  for (std::size_t n = 0; n < p.embedding->tets->nodes.size(); ++n)
    p.label.push_back(static_cast<Index>(n % 3));
  p.energy = kLargest;
  p.gamma = 1e-9;
  p.degreeGiven = true;
  p.iterations = 17;
  p.converged = true;
  return p;
}

inline Piece piece(const char* name, Index cell) {
  Piece p;
  p.name = name;
  p.cell = cell;
  p.surface = {{0, 1, 2}, {2, 1, 3}};
  p.surfaceSource = {0, 5};
  p.surfaceCut = {-1, 0};
  p.crack = {{3, 2, 1}};
  p.crackNeighbour = {1 - cell};
  p.crackSheet = {0};
  p.volume = 0.1;
  p.centreOfMass = Vec3(1, -0.0, 2);
  p.inertia << 1, 2, 3, 4, 5, 6, 7, 8, -0.0;
  return p;
}

inline Fragments fragments() {
  Fragments f;
  f.tets = sharedTets();
  f.material = {3, 4, 0.1};
  f.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, -0.0), Vec3(0, 0, kSmallest)};
  f.cutCorners = {{CornerWeights(1, 0, 0), CornerWeights(0, 1, 0), CornerWeights(0.25, 0.25, 0.5)}};
  f.pieces = {piece("piece_0001", 0), piece("piece_0002", 1)};
  f.sites = 3;
  f.energy = 2;
  f.gamma = 3;
  f.degreeGiven = true;
  f.counts = {1, 2, 3, 4, 5, 6, 7};
  return f;
}

inline PieceProxy pieceProxy(const char* name) {
  PieceProxy p;
  p.name = name;
  p.hulls = {{{Vec3(0, 0, 0), Vec3(1, 0, -0.0), Vec3(0, kSmallest, 0)}, {{0, 1, 2}, {0, 2, 1}}, -0.0},
             {{Vec3(kNan, 0, 0)}, {}, 3}};
  p.pieceVolume = 0.5;
  p.volume = 0.75;
  p.error = kSmallest;
  p.overlap = -0.0;
  p.mass = kLargest;
  p.centreOfMass = Vec3(1, -0.0, 2);
  p.inertia << 1, 2, 3, 4, 5, 6, 7, 8, -0.0;
  return p;
}

inline Proxies proxies() {
  Proxies p;
  p.pieces = {pieceProxy("piece_0001"), pieceProxy("piece_0002")};
  p.frame = {0.01, FileFrame::Up::Z};
  return p;
}

}  // namespace sherd::made
