#include "geometry/crack_contacts.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "base/parallel.h"

namespace sherd {
namespace {

/// One crack triangle, with what it has in common with its twin.
struct Side {
  Index high, sheet;
  Triangle vertices;  ///< ascending
  bool isOdd;         ///< how the triangle turns, seen from the lower piece
  bool isHigh;        ///< it is the higher piece's
  Index triangle;

  auto common() const { return std::tie(high, sheet, vertices, isOdd); }
  friend bool operator<(const Side& a, const Side& b) {
    return a.common() != b.common() ? a.common() < b.common()
                                    : std::tie(a.isHigh, a.triangle) < std::tie(b.isHigh, b.triangle);
  }
};

/// Per piece, the sides of the contacts in which it is the lower one.
std::vector<std::vector<Side>> sidesByLowerPiece(const Fragments& f) {
  std::vector<std::vector<Side>> sides(f.pieces.size());
  for (std::size_t p = 0; p < f.pieces.size(); ++p) {
    const Piece& piece = f.pieces[p];
    const auto own = static_cast<Index>(p);
    for (std::size_t t = 0; t < piece.crack.size(); ++t) {
      const Index other = piece.crackNeighbour[t];
      const Triangle& c = piece.crack[t];
      Side side{.high = std::max(own, other),
                .sheet = piece.crackSheet[t],
                .vertices = c,
                .isOdd = ((c[0] > c[1]) + (c[1] > c[2]) + (c[0] > c[2])) % 2 == 1,
                .isHigh = own > other,
                .triangle = static_cast<Index>(t)};
      std::sort(side.vertices.begin(), side.vertices.end());
      side.isOdd ^= side.isHigh;
      sides[at(std::min(own, other))].push_back(side);
    }
  }
  return sides;
}

Error lonely(const Fragments& f, Index low, const Side& side) {
  const std::string &own = f.pieces[at(side.isHigh ? side.high : low)].name,
                    &other = f.pieces[at(side.isHigh ? low : side.high)].name;
  return failure(
      "crack triangle " + std::to_string(side.triangle) + " of " + own + " has no twin in " + other,
      "pieces have to be whole, as Tessellate makes them", "pieces");
}

Result<std::vector<CrackContact>> contactsOf(const Fragments& f, Index low, std::vector<Side>& sides) {
  std::sort(sides.begin(), sides.end());
  std::vector<CrackContact> contacts;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i, lows = 0;
    for (; end < sides.size() && sides[end].common() == sides[i].common(); ++end) lows += !sides[end].isHigh;
    if (2 * lows != end - i) return lonely(f, low, sides[i]);
    const Index high = sides[i].high, sheet = sides[i].sheet;
    if (contacts.empty() || contacts.back().high != high || contacts.back().sheet != sheet)
      contacts.push_back({low, high, sheet, {}});
    for (; i + lows < end; ++i)
      contacts.back().twins.push_back({sides[i].triangle, sides[i + lows].triangle});
    i = end;
  }
  for (CrackContact& contact : contacts)
    std::sort(contact.twins.begin(), contact.twins.end(),
              [](const CrackTwin& a, const CrackTwin& b) { return a.low < b.low; });
  return contacts;
}

}  // namespace

Result<std::vector<CrackContact>> crackContacts(const Fragments& f, const Exec& exec) {
  std::vector<std::vector<Side>> sides = sidesByLowerPiece(f);
  std::vector<std::optional<Result<std::vector<CrackContact>>>> found(sides.size());
  parallelFor(exec, sides.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) found[p] = contactsOf(f, static_cast<Index>(p), sides[p]);
  });
  if (exec.cancelled()) return cancelledError();
  std::vector<CrackContact> contacts;
  for (auto& own : found) {
    if (!own->ok()) return own->error();
    std::move(own->value().begin(), own->value().end(), std::back_inserter(contacts));
  }
  return contacts;
}

}  // namespace sherd
