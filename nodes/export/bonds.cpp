#include "export/bonds.h"

#include <algorithm>

#include "geometry/crack_contacts.h"

namespace sherd {
namespace {

/// Sums over a contact, about its first vertex.
struct Sums {
  Vec3 origin = Vec3::Zero(), areaVector = Vec3::Zero(), moment = Vec3::Zero();
  double area = 0;

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 twice = (b - a).cross(c - a);
    const double own = twice.norm() / 2;
    areaVector += twice / 2;
    area += own;
    moment += own / 3 * ((a - origin) + (b - origin) + (c - origin));
  }
  Bond bond(Index low, Index high) const {
    Bond bond{low, high, area, origin, Vec3::Zero()};
    if (area > 0) bond.centroid += moment / area;
    // What is left of a closed contact's normal is rounding.
    if (areaVector.norm() > 1e-9 * area) bond.normal = areaVector.normalized();
    return bond;
  }
};

}  // namespace

Result<std::vector<Bond>> findBonds(const Fragments& f, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<CrackContact> contacts, crackContacts(f, exec));
  std::vector<Bond> bonds;
  for (std::size_t k = 0; k < contacts.size();) {
    const Index low = contacts[k].low, high = contacts[k].high;
    const std::vector<Triangle>& crack = f.pieces[at(low)].crack;
    Sums sums;
    sums.origin = f.positions[at(crack[at(contacts[k].twins.front().low)][0])];
    for (; k < contacts.size() && contacts[k].low == low && contacts[k].high == high; ++k)
      for (const CrackTwin& twin : contacts[k].twins) {
        const Triangle& t = crack[at(twin.low)];
        sums.add(f.positions[at(t[0])], f.positions[at(t[1])], f.positions[at(t[2])]);
      }
    bonds.push_back(sums.bond(low, high));
  }
  return bonds;
}

std::vector<std::vector<Bond>> bondsByPiece(const std::vector<Bond>& bonds, std::size_t pieces) {
  std::vector<std::vector<Bond>> byPiece(pieces);
  for (const Bond& bond : bonds) byPiece[at(bond.high)].push_back(bond);  // lower neighbours first
  for (const Bond& bond : bonds) byPiece[at(bond.low)].push_back(bond);
  return byPiece;
}

}  // namespace sherd
