#include "types/fields.h"

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<Impact> && ArchivedValue<EnergyField> && ArchivedValue<WeightField>);
static_assert(sizeof(Contact) == 8 * sizeof(double), "contacts are hashed and saved as they lie in memory");

namespace {

void hashMotion(Hasher& hasher, const RigidMotion& m) {
  hashBits(hasher, m.position);
  hashBits(hasher, m.rotation);
  hashBits(hasher, m.velocity);
  hashBits(hasher, m.angularVelocity);
}

void putMotion(ArchiveWriter& to, const RigidMotion& m) {
  putBits(to, m.position);
  putBits(to, m.rotation);
  putBits(to, m.velocity);
  putBits(to, m.angularVelocity);
}

void getMotion(ArchiveReader& from, RigidMotion& m) {
  getBits(from, m.position);
  getBits(from, m.rotation);
  getBits(from, m.velocity);
  getBits(from, m.angularVelocity);
}

/// The number of nodes and of tetrahedra that a field is about; none without a mesh.
std::size_t nodeCount(const std::shared_ptr<const TetMesh>& tets) { return tets ? tets->nodes.size() : 0; }
std::size_t tetCount(const std::shared_ptr<const TetMesh>& tets) { return tets ? tets->tets.size() : 0; }

}  // namespace

void hashValue(Hasher& hasher, const Impact& impact) {
  hasher.add(impact.hit).add(impact.contacts);
  hashBits(hasher, impact.time);
  hashBits(hasher, impact.centreOfMass);
  hashMotion(hasher, impact.before);
  hashMotion(hasher, impact.after);
}

void hashValue(Hasher& hasher, const EnergyField& field) {
  hashPart(hasher, field.tets);
  hashBits(hasher, field.material);
  hasher.add(field.tetEnergy).add(field.nodeEnergy).add(field.displacement);
}

void hashValue(Hasher& hasher, const WeightField& field) {
  hashPart(hasher, field.tets);
  hashBits(hasher, field.material);
  hasher.add(field.weight).add(field.volume);
  hashBits(hasher, field.alpha);
  hasher.add(field.beta);
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

void saveValue(ArchiveWriter& to, const Impact& impact) {
  to.put(impact.hit);
  to.put(impact.time);
  putBits(to, impact.centreOfMass);
  to.array(impact.contacts);
  putMotion(to, impact.before);
  putMotion(to, impact.after);
}

std::optional<Impact> loadValue(ArchiveReader& from, std::type_identity<Impact>) {
  std::optional<Impact> impact(std::in_place);
  from.get(impact->hit);
  from.get(impact->time);
  getBits(from, impact->centreOfMass);
  from.array(impact->contacts);
  getMotion(from, impact->before);
  getMotion(from, impact->after);
  if (!from.ok()) impact.reset();
  return impact;
}

void saveValue(ArchiveWriter& to, const EnergyField& field) {
  to.part(field.tets);
  putBits(to, field.material);
  to.array(field.tetEnergy);
  to.array(field.nodeEnergy);
  to.array(field.displacement);
}

std::optional<EnergyField> loadValue(ArchiveReader& from, std::type_identity<EnergyField>) {
  std::optional<EnergyField> field(std::in_place);
  field->tets = from.part<TetMesh>();
  getBits(from, field->material);
  from.array(field->tetEnergy);
  from.array(field->nodeEnergy);
  from.array(field->displacement);
  const std::size_t nodes = nodeCount(field->tets), moved = field->displacement.size();
  if (!from.ok() || field->tetEnergy.size() != tetCount(field->tets) || field->nodeEnergy.size() != nodes ||
      (moved != 0 && moved != nodes))
    field.reset();
  return field;
}

void saveValue(ArchiveWriter& to, const WeightField& field) {
  to.part(field.tets);
  putBits(to, field.material);
  to.array(field.weight);
  to.array(field.volume);
  to.put(field.alpha);
  to.put(field.beta);
}

std::optional<WeightField> loadValue(ArchiveReader& from, std::type_identity<WeightField>) {
  std::optional<WeightField> field(std::in_place);
  field->tets = from.part<TetMesh>();
  getBits(from, field->material);
  from.array(field->weight);
  from.array(field->volume);
  from.get(field->alpha);
  field->beta = from.digest();
  const std::size_t nodes = nodeCount(field->tets);
  if (!from.ok() || field->weight.size() != nodes || field->volume.size() != nodes) field.reset();
  return field;
}

}  // namespace sherd
