#include "tessellate/solid_merger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/solid.h"

namespace sherd {
namespace {

double triangleArea(std::span<const Vec3> positions, const Triangle& t) {
  const Vec3& a = positions[at(t[0])];
  return 0.5 * (positions[at(t[1])] - a).cross(positions[at(t[2])] - a).norm();
}

}  // namespace

SolidMerger::SolidMerger(const CellParts& parts, std::span<const Vec3> positions, Solids& solids)
    : parts_(parts), positions_(positions), solids_(solids), joined_(solids.list.size()) {
  std::iota(joined_.begin(), joined_.end(), Index{0});
}

std::size_t SolidMerger::mergeBelow(double minVolume) {
  std::vector<Index> small;
  for (Index s = 0; at(s) < solids_.list.size(); ++s)
    if (!isLargeEnough(s, minVolume)) small.push_back(s);
  if (small.empty()) return 0;
  sumContacts();
  const auto volume = [&](Index s) { return solids_.list[at(s)].sums.volume; };
  std::sort(small.begin(), small.end(),
            [&](Index a, Index b) { return std::pair(volume(a), a) < std::pair(volume(b), b); });
  std::size_t merged = 0;
  for (const Index s : small) {
    if (isLargeEnough(s, minVolume)) continue;
    const bool joins = joinLargestNeighbour(s);
    merged += joins;
    if (!joins && isFlatSkin(s)) joined_[at(s)] = kNone;
  }
  return merged;
}

Index SolidMerger::ownerOf(Index solid) const {
  while (solid != kNone && joined_[at(solid)] != solid) solid = joined_[at(solid)];
  return solid;
}

bool SolidMerger::isLargeEnough(Index solid, double minVolume) const {
  const double volume = solids_.list[at(solid)].sums.volume;
  return volume > 0 && volume >= minVolume;
}

void SolidMerger::sumContacts() {
  contacts_.resize(solids_.list.size());
  for (std::size_t p = parts_.firstSheet(); p < parts_.size(); p += 2) {
    const Index a = solids_.ofPart[p], b = solids_.ofPart[p + 1];
    if (a == b) continue;
    double area = 0;
    parts_.forTriangles(p, [&](const Triangle& t) { area += triangleArea(positions_, t); });
    contacts_[at(a)][b] += area;
    contacts_[at(b)][a] += area;
  }
}

bool SolidMerger::joinLargestNeighbour(Index small) {
  Index best = kNone;
  double largest = 0;
  for (const auto& [solid, area] : contacts_[at(small)])
    if (best == kNone || area > largest) best = solid, largest = area;
  if (best == kNone) return false;  // stands alone: nothing to join
  joined_[at(small)] = best;
  solids_.list[at(best)].sums += solids_.list[at(small)].sums;
  for (const auto& [solid, area] : contacts_[at(small)]) {
    auto& others = contacts_[at(solid)];
    others.erase(small);
    if (solid == best) continue;
    others[best] += area;
    contacts_[at(best)][solid] += area;
  }
  contacts_[at(small)].clear();
  return true;
}

/// A pocket that rounding laid flat into the skin: cut faces that cover each other, and nothing between them
/// but what rounding of their corners left.
bool SolidMerger::isFlatSkin(Index solid) const {
  std::vector<Triangle> faces;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (solids_.ofPart[p] != solid) continue;
    if (!parts_.isSkin(p)) return false;
    parts_.forTriangles(p, [&](const Triangle& t) { faces.push_back(t); });
  }
  double area = 0, largest = 0;
  for (const Triangle& t : faces) {
    area += triangleArea(positions_, t);
    for (const Index v : t) largest = std::max(largest, positions_[at(v)].cwiseAbs().maxCoeff());
  }
  const double thickness = 1e-9 * std::sqrt(area) + 0x1p-46 * largest;
  return std::abs(solidVolume(positions_, faces)) <= thickness * area;
}

}  // namespace sherd
