#include "types/fragments.h"

#include "types/fields.h"

namespace sherd {

void hashValue(Hasher& hasher, const Fragments& f) {
  if (f.tets) hashValue(hasher, *f.tets);
  hashValue(hasher, f.material);
  hasher.add(f.positions).add(f.pieces.size()).add(f.sites).add(f.energy).add(f.gamma);
  hasher.add(f.degreeGiven);
  hasher.bytes(f.cutCorners.data(), f.cutCorners.size() * sizeof(f.cutCorners[0]));
  for (const Piece& p : f.pieces) {
    hasher.add(p.name).add(p.cell).add(p.surface).add(p.surfaceSource).add(p.surfaceCut);
    hasher.add(p.crack).add(p.crackNeighbour).add(p.volume);
  }
}

std::size_t byteSize(const Fragments& f) {
  std::size_t bytes = f.positions.size() * sizeof(Vec3) + f.cutCorners.size() * 3 * sizeof(CornerWeights);
  for (const Piece& p : f.pieces)
    bytes += p.surface.size() * (sizeof(Triangle) + 2 * sizeof(Index)) +
             p.crack.size() * (sizeof(Triangle) + sizeof(Index));
  return bytes;
}

}  // namespace sherd
