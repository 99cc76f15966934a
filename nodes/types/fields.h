// What the physics hands on: the impact, the strain energy, and the weights made of it.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/material.h"
#include "types/tet_mesh.h"
#include "types/vec.h"

namespace sherd {

/// One contact of the first impact.
struct Contact {
  Vec3 point;       ///< m, in the body's rest space (where the mesh is)
  Vec3 impulse;     ///< N·s on the body, in rest space
  double duration;  ///< s, that the impulse is spread over
  double radius;    ///< m, of the patch that the force is spread over
};

/// The body's rigid motion, world space: x_world = rotation · (x_rest − centreOfMass) + position.
struct RigidMotion {
  Vec3 position = Vec3::Zero();  ///< m, of the centre of mass
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero();         ///< m/s
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s, world space
};

/// The first impact of a body, or that there was none in the time given.
struct Impact {
  static constexpr const char* typeName = "Impact";
  static constexpr int archiveVersion = 1;
  bool hit = false;
  double time = 0;                   ///< s since the release
  Vec3 centreOfMass = Vec3::Zero();  ///< m, rest space
  std::vector<Contact> contacts;
  RigidMotion before, after;
};

/// Quasi-static strain energy of the body under the impact's loads.
struct EnergyField {
  static constexpr const char* typeName = "Energy";
  static constexpr int archiveVersion = 1;
  std::shared_ptr<const TetMesh> tets;
  Material material;
  std::vector<double> tetEnergy;   ///< J, per tetrahedron
  std::vector<double> nodeEnergy;  ///< J, per node: e_n, a quarter of each incident tetrahedron's, inside the
                                   ///< surface: what holds up nodes outside of it doesn't count
  std::vector<Vec3> displacement;  ///< m, per node, free of rigid motion
};

/// w_n of design section 4, point 1: β V (e/V)^α, rescaled. The only weights that later steps use.
struct WeightField {
  static constexpr const char* typeName = "Weights";
  static constexpr int archiveVersion = 2;
  std::shared_ptr<const TetMesh> tets;
  Material material;
  std::vector<double> weight;  ///< J, per node, ≥ 0
  std::vector<double> volume;  ///< m³, per node: V_n, used where a cell's weights are all zero
  double alpha = 1;            ///< what they were made with
  Digest beta{};               ///< of β at the nodes; zero where it is 1 at all of them
};

void hashValue(Hasher& hasher, const Impact& impact);
void hashValue(Hasher& hasher, const EnergyField& field);
void hashValue(Hasher& hasher, const WeightField& field);
std::size_t byteSize(const Impact& impact);
std::size_t byteSize(const EnergyField& field);
std::size_t byteSize(const WeightField& field);
void saveValue(ArchiveWriter& to, const Impact& impact);
std::optional<Impact> loadValue(ArchiveReader& from, std::type_identity<Impact>);
void saveValue(ArchiveWriter& to, const EnergyField& field);
std::optional<EnergyField> loadValue(ArchiveReader& from, std::type_identity<EnergyField>);
void saveValue(ArchiveWriter& to, const WeightField& field);
std::optional<WeightField> loadValue(ArchiveReader& from, std::type_identity<WeightField>);

}  // namespace sherd
