#include "types/fragments.h"

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<Fragments>);

namespace {

void hashPiece(Hasher& hasher, const Piece& p) {
  hasher.add(p.name).add(p.cell).add(p.surface).add(p.surfaceSource).add(p.surfaceCut);
  hasher.add(p.crack).add(p.crackNeighbour).add(p.crackSheet);
  hashBits(hasher, p.volume);
  hashBits(hasher, p.centreOfMass);
  hashBits(hasher, p.inertia);
}

void putPiece(ArchiveWriter& to, const Piece& p) {
  to.text(p.name);
  to.put(p.cell);
  to.array(p.surface);
  to.array(p.surfaceSource);
  to.array(p.surfaceCut);
  to.array(p.crack);
  to.array(p.crackNeighbour);
  to.array(p.crackSheet);
  to.put(p.volume);
  putBits(to, p.centreOfMass);
  putBits(to, p.inertia);
}

void getPiece(ArchiveReader& from, Piece& p) {
  p.name = from.text();
  from.get(p.cell);
  from.array(p.surface);
  from.array(p.surfaceSource);
  from.array(p.surfaceCut);
  from.array(p.crack);
  from.array(p.crackNeighbour);
  from.array(p.crackSheet);
  from.get(p.volume);
  getBits(from, p.centreOfMass);
  getBits(from, p.inertia);
}

bool isSound(const Piece& p, const Fragments& f) {
  const TriMesh* source = f.tets ? f.tets->surface.get() : nullptr;
  return p.cell >= -1 && p.surfaceSource.size() == p.surface.size() &&
         p.surfaceCut.size() == p.surface.size() && p.crackNeighbour.size() == p.crack.size() &&
         p.crackSheet.size() == p.crack.size() && allInRange(p.surface, 0, f.positions.size()) &&
         allInRange(p.crack, 0, f.positions.size()) &&
         allInRange(p.surfaceSource, 0, source ? source->triangles.size() : 0) &&
         allInRange(p.surfaceCut, -1, f.cutCorners.size()) &&
         allInRange(p.crackNeighbour, 0, f.pieces.size()) &&
         allInRange(p.crackSheet, 0, std::numeric_limits<std::size_t>::max());
}

bool isSound(const Fragments& f) {
  return std::all_of(f.pieces.begin(), f.pieces.end(), [&](const Piece& p) { return isSound(p, f); });
}

}  // namespace

void hashValue(Hasher& hasher, const Fragments& f) {
  hashPart(hasher, f.tets);
  hashBits(hasher, f.material);
  hasher.add(f.positions).add(f.cutCorners).add(f.pieces.size()).add(f.sites);
  hashBits(hasher, f.energy);
  hashBits(hasher, f.gamma);
  hasher.add(f.degreeGiven);
  hashBits(hasher, f.counts);
  for (const Piece& p : f.pieces) hashPiece(hasher, p);
}

std::size_t byteSize(const Fragments& f) {
  std::size_t bytes = f.positions.size() * sizeof(Vec3) + f.cutCorners.size() * 3 * sizeof(CornerWeights);
  for (const Piece& p : f.pieces)
    bytes += p.surface.size() * (sizeof(Triangle) + 2 * sizeof(Index)) +
             p.crack.size() * (sizeof(Triangle) + 2 * sizeof(Index));
  return bytes;
}

void saveValue(ArchiveWriter& to, const Fragments& f) {
  to.part(f.tets);
  putBits(to, f.material);
  to.array(f.positions);
  to.array(f.cutCorners);
  putList(to, f.pieces, [&](const Piece& p) { putPiece(to, p); });
  to.put(static_cast<std::uint64_t>(f.sites));
  to.put(f.energy);
  to.put(f.gamma);
  to.put(f.degreeGiven);
  putBits(to, f.counts);
}

std::optional<Fragments> loadValue(ArchiveReader& from, std::type_identity<Fragments>) {
  std::optional<Fragments> loaded(std::in_place);
  Fragments& f = *loaded;
  f.tets = from.part<TetMesh>();
  getBits(from, f.material);
  from.array(f.positions);
  from.array(f.cutCorners);
  getList(from, f.pieces, [&](Piece& p) { getPiece(from, p); });
  f.sites = from.get<std::uint64_t>();
  from.get(f.energy);
  from.get(f.gamma);
  from.get(f.degreeGiven);
  getBits(from, f.counts);
  if (!from.ok() || !isSound(f)) loaded.reset();
  return loaded;
}

}  // namespace sherd
