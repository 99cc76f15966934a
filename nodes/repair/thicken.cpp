#include "repair/thicken.h"

#include <optional>

#include "repair/leaves.h"
#include "repair/sheets.h"
#include "repair/shells.h"

namespace sherd {
namespace {

void note(SheetCount& counted, const Patchwork& surface, const std::vector<Index>& sheet) {
  if (sheet.empty()) return;
  if (counted.count++ == 0) counted.place = surface.positions[at(surface.triangles[at(sheet[0])][0])];
  counted.area += areaOf(surface, sheet);
}

}  // namespace

void LooseSheets::takeHanging(Patchwork& surface, const Exec& exec) {
  const std::vector<DanglingSheet> sheets = danglingSheets(surface, rules_.thin, exec);
  if (sheets.empty()) return;
  hanging_.positions = surface.positions;
  std::vector<bool> keep(surface.triangles.size(), true);
  for (const DanglingSheet& sheet : sheets) {
    for (const Index t : sheet.triangles) keep[at(t)] = false;
    if (sheet.area < rules_.small) {
      note(strays_, surface, sheet.triangles);
      continue;
    }
    for (const Index t : sheet.triangles) hanging_.add(surface.triangles[at(t)], surface.facets[at(t)]);
    hangingEnds_.push_back(hanging_.triangles.size());
  }
  keepOnly(surface, keep);
}

/// Back into the surface, as its last triangles.
void LooseSheets::addHanging(Patchwork& surface, std::vector<std::vector<Index>>& sheets) const {
  const auto shift = static_cast<Index>(surface.positions.size());
  surface.positions.insert(surface.positions.end(), hanging_.positions.begin(), hanging_.positions.end());
  std::size_t t = 0;
  for (const std::size_t end : hangingEnds_) {
    sheets.emplace_back();
    for (; t < end; ++t) {
      sheets.back().push_back(static_cast<Index>(surface.triangles.size()));
      Triangle corners = hanging_.triangles[t];
      for (Index& v : corners) v += shift;
      surface.add(corners, hanging_.facets[t]);
    }
  }
}

std::size_t LooseSheets::thicken(Patchwork& surface, const Exec& exec) {
  std::vector<std::vector<Index>> sheets = findLeaves(surface, rules_.thin);
  const std::size_t found = sheets.size();
  if (found == 0 && hangingEnds_.empty()) return 0;
  if (!hangingEnds_.empty()) addHanging(surface, sheets);
  std::vector<bool> isSheet(surface.triangles.size(), false);
  std::size_t count = 0;
  for (const auto& sheet : sheets)
    for (const Index t : sheet) isSheet[at(t)] = true, ++count;
  std::optional<Footing> solid;
  if (count < surface.triangles.size()) solid.emplace(surface, isSheet);
  std::vector<Index> plain;
  std::vector<std::vector<Index>> standing;
  for (std::size_t s = 0; s < sheets.size() && !exec.cancelled(); ++s) {
    std::vector<Index> own;  // without what fills its holes
    for (const Index t : sheets[s])
      if (!surface.facets[at(t)].isNew) own.push_back(t);
    const bool hangs = s >= found;
    const SheetPlace where =
        solid && !hangs ? placeOf(surface, own, *solid, rules_.touching) : SheetPlace::Touching;
    if (solid && !hangs && where == SheetPlace::Within) {
      note(within_, surface, own);
    } else if (solid && !hangs && where == SheetPlace::Touching && areaOf(surface, own) < rules_.small) {
      note(strays_, surface, own);
    } else if (solid && !slabOverlaps(surface, own, *solid, rules_.thickness) &&
               (hangs || placeOf(surface, own, *solid, 0.5 * rules_.thickness) == SheetPlace::Touching)) {
      note(united_, surface, own);
      standing.push_back(std::move(own));
    } else {
      note(free_, surface, own);
      plain.insert(plain.end(), own.begin(), own.end());
    }
  }
  addSlabs(surface, plain, rules_.thickness);
  for (const auto& sheet : standing) addSlabs(surface, sheet, rules_.thickness, &*solid);
  std::vector<bool> keep = std::move(isSheet);
  keep.flip();
  keep.resize(surface.triangles.size(), true);
  keepOnly(surface, keep);
  joinEqual(surface);
  return found;
}

}  // namespace sherd
