#include "types/fields.h"

namespace sherd {
namespace {

void hashVec(Hasher& hasher, const Vec3& v) { hasher.add(v.x()).add(v.y()).add(v.z()); }

void hashMotion(Hasher& hasher, const RigidMotion& m) {
  hashVec(hasher, m.position);
  hasher.add(m.rotation.w()).add(m.rotation.x()).add(m.rotation.y()).add(m.rotation.z());
  hashVec(hasher, m.velocity);
  hashVec(hasher, m.angularVelocity);
}

}  // namespace

void hashValue(Hasher& hasher, const Material& m) {
  hasher.add(m.density).add(m.youngModulus).add(m.poissonRatio);
}

void hashValue(Hasher& hasher, const Impact& impact) {
  hasher.add(impact.hit).add(impact.time).add(impact.contacts.size());
  hashVec(hasher, impact.centreOfMass);
  for (const Contact& c : impact.contacts) {
    hashVec(hasher, c.point);
    hashVec(hasher, c.impulse);
    hasher.add(c.duration).add(c.radius);
  }
  hashMotion(hasher, impact.before);
  hashMotion(hasher, impact.after);
}

void hashValue(Hasher& hasher, const EnergyField& field) {
  if (field.tets) hashValue(hasher, *field.tets);
  hashValue(hasher, field.material);
  hasher.add(field.tetEnergy).add(field.nodeEnergy).add(field.displacement);
}

void hashValue(Hasher& hasher, const WeightField& field) {
  if (field.tets) hashValue(hasher, *field.tets);
  hashValue(hasher, field.material);
  hasher.add(field.weight).add(field.volume);
}

std::size_t byteSize(const Impact& impact) {
  return sizeof impact + impact.contacts.size() * sizeof(Contact);
}

std::size_t byteSize(const EnergyField& field) {
  return (field.tetEnergy.size() + field.nodeEnergy.size()) * sizeof(double) +
         field.displacement.size() * sizeof(Vec3);
}

std::size_t byteSize(const WeightField& field) {
  return (field.weight.size() + field.volume.size()) * sizeof(double);
}

}  // namespace sherd
