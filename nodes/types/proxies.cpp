#include "types/proxies.h"

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<Proxies>);

namespace {

/// Every number of a proxy, for `each` to hash, save or load.
template <class Proxy, class Each>
void eachNumber(Proxy& p, const Each& each) {
  each(p.pieceVolume);
  each(p.volume);
  each(p.error);
  each(p.overlap);
  each(p.mass);
  each(p.centreOfMass);
  each(p.inertia);
}

}  // namespace

void hashValue(Hasher& hasher, const Proxies& proxies) {
  hashBits(hasher, proxies.frame);
  hasher.add(proxies.pieces.size());
  for (const PieceProxy& p : proxies.pieces) {
    hasher.add(p.name).add(p.hulls.size());
    eachNumber(p, [&](const auto& number) { hashBits(hasher, number); });
    for (const ConvexHull& hull : p.hulls) {
      hasher.add(hull.positions).add(hull.triangles);
      hashBits(hasher, hull.volume);
    }
  }
}

std::size_t byteSize(const Proxies& proxies) {
  std::size_t bytes = 0;
  for (const PieceProxy& p : proxies.pieces) {
    bytes += sizeof p;
    for (const ConvexHull& hull : p.hulls)
      bytes += sizeof hull + hull.positions.size() * sizeof(Vec3) + hull.triangles.size() * sizeof(Triangle);
  }
  return bytes;
}

void saveValue(ArchiveWriter& to, const Proxies& proxies) {
  putBits(to, proxies.frame);
  putList(to, proxies.pieces, [&](const PieceProxy& p) {
    to.text(p.name);
    eachNumber(p, [&](const auto& number) { putBits(to, number); });
    putList(to, p.hulls, [&](const ConvexHull& hull) {
      to.array(hull.positions);
      to.array(hull.triangles);
      to.put(hull.volume);
    });
  });
}

std::optional<Proxies> loadValue(ArchiveReader& from, std::type_identity<Proxies>) {
  std::optional<Proxies> loaded(std::in_place);
  getBits(from, loaded->frame);
  bool sound = true;
  getList(from, loaded->pieces, [&](PieceProxy& p) {
    p.name = from.text();
    eachNumber(p, [&](auto& number) { getBits(from, number); });
    getList(from, p.hulls, [&](ConvexHull& hull) {
      from.array(hull.positions);
      from.array(hull.triangles);
      from.get(hull.volume);
      sound = sound && allInRange(hull.triangles, 0, hull.positions.size());
    });
  });
  if (!from.ok() || !sound) loaded.reset();
  return loaded;
}

}  // namespace sherd
