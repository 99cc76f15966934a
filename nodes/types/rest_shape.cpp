#include "types/rest_shape.h"

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<RestShape>);

void hashValue(Hasher& hasher, const RestShape& rest) {
  hashPart(hasher, rest.tets);
  hasher.add(rest.positions);
}

std::size_t byteSize(const RestShape& rest) { return rest.positions.size() * sizeof(Vec3); }

void saveValue(ArchiveWriter& to, const RestShape& rest) {
  to.part(rest.tets);
  to.array(rest.positions);
}

std::optional<RestShape> loadValue(ArchiveReader& from, std::type_identity<RestShape>) {
  std::optional<RestShape> rest(std::in_place);
  rest->tets = from.part<TetMesh>();
  from.array(rest->positions);
  const std::size_t nodes = rest->tets ? rest->tets->nodes.size() : 0;
  if (!from.ok() || rest->positions.size() != nodes) rest.reset();
  return rest;
}

bool isOf(const RestShape& rest, const TetMesh& tets) {
  if (rest.tets == nullptr || rest.positions.size() != tets.nodes.size()) return false;
  return rest.tets.get() == &tets || (rest.tets->nodes == tets.nodes && rest.tets->tets == tets.tets);
}

}  // namespace sherd
