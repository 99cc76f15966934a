#include "tessellate/cell_parts.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/parallel.h"
#include "tessellate/first_numbers.h"

namespace sherd {

CellParts::CellParts(const TetMesh& tets, const Sheets& sheets, const Arrangement& arrangement,
                     const ClippedMeshes& meshes, std::span<const unsigned char> isCut, const Exec& exec)
    : tets_(tets), sheets_(sheets), arrangement_(arrangement), meshes_(meshes), exec_(exec) {
  splitPatches(isCut);
  if (exec.cancelled()) return;
  firstSkin_ = uncut_.size();
  firstSheet_ = firstSkin_ + meshes.skin.parts();
  nameCells();
}

void CellParts::join(std::span<const unsigned char> isCut) {
  connected_ = DisjointSets(size());
  std::vector<Side> sides;
  joinUncut(isCut, sides);
  if (exec_.cancelled()) return;
  addSkinBorders(sides);
  joinSheets(sides);
  joinSides(sides);
}

std::size_t CellParts::triangleCount(std::size_t part) const {
  if (isUncut(part)) return uncut_[part].size();
  const auto sizeOf = [](const auto& meshes, std::size_t k) { return meshes.end(k) - meshes.begin(k); };
  return isSkin(part) ? sizeOf(meshes_.skin, skinNumber(part)) : sizeOf(meshes_.sheet, sheetNumber(part));
}

void CellParts::splitPatches(std::span<const unsigned char> isCut) {
  const TrianglePatches& patches = tets_.patches;
  const std::size_t n = patches.count();
  whole_.resize(n);
  looseEnd_.resize(n);
  partOf_ = std::make_unique_for_overwrite<Index[]>(arrangement_.surface.size());
  loose_ = std::make_unique_for_overwrite<Index[]>(arrangement_.surface.size());
  partBegin_.assign(n + 1, 0);
  parallelFor(exec_, n, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const auto triangles = patches.trianglesOf(p);
      whole_[p] = patches.regular[p] &&
                  std::none_of(triangles.begin(), triangles.end(), [&](Index t) { return isCut[at(t)]; });
      partBegin_[p + 1] = whole_[p] ? 1 : splitPatch(p, isCut);
    }
  });
  std::partial_sum(partBegin_.begin(), partBegin_.end(), partBegin_.begin());
  listUncut();
}

/// Lists the patch's uncut triangles by connected parts; returns how many parts there are.
Index CellParts::splitPatch(std::size_t patch, std::span<const unsigned char> isCut) {
  const auto triangles = tets_.patches.trianglesOf(patch);
  for (const Index t : triangles) partOf_[at(t)] = -1;
  Index parts = 0, end = tets_.patches.begin[patch];
  for (const Index seed : triangles) {
    if (isCut[at(seed)] || partOf_[at(seed)] >= 0) continue;
    const auto take = [&](Index t) { partOf_[at(t)] = parts, loose_[at(end++)] = t; };
    Index next = end;
    for (take(seed); next < end; ++next)
      for (const Index t : tets_.surfaceNeighbours[at(loose_[at(next)])])
        if (at(tets_.patches.patchOf[at(t)]) == patch && !isCut[at(t)] && partOf_[at(t)] < 0) take(t);
    ++parts;
  }
  looseEnd_[patch] = end;
  return parts;
}

void CellParts::listUncut() {
  const TrianglePatches& patches = tets_.patches;
  uncut_.resize(at(partBegin_.back()));
  for (std::size_t p = 0; p < patches.count(); ++p) {
    if (whole_[p]) {
      uncut_[at(partBegin_[p])] = patches.trianglesOf(p);
      continue;
    }
    for (Index first = patches.begin[p], last; first < looseEnd_[p]; first = last) {
      const Index part = partOf_[at(loose_[at(first)])];
      for (last = first + 1; last < looseEnd_[p] && partOf_[at(loose_[at(last)])] == part;) ++last;
      uncut_[at(partBegin_[p] + part)] = {&loose_[at(first)], at(last - first)};
    }
  }
}

void CellParts::nameCells() {
  cell_.reserve(firstSheet_ + 2 * meshes_.sheet.parts());
  cell_.resize(uncut_.size());
  parallelFor(exec_, uncut_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
      cell_[part] = arrangement_.surfaceLabel[at(arrangement_.surface[at(uncut_[part][0])][0])];
  });
  for (std::size_t k = 0; k < meshes_.skin.parts(); ++k)
    cell_.push_back(meshes_.skin.triangles[meshes_.skin.begin(k)].cell);
  for (std::size_t k = 0; k < meshes_.sheet.parts(); ++k) {
    const SheetTriangle& t = meshes_.sheet.triangles[meshes_.sheet.begin(k)];
    cell_.push_back(t.back);
    cell_.push_back(t.front);
  }
}

/// Uncut triangles that are neighbours lie in one cell; those beside a cut one meet its parts over the edge.
void CellParts::joinUncut(std::span<const unsigned char> isCut, std::vector<Side>& sides) {
  constexpr std::size_t block = 64;
  const std::size_t n = whole_.size();
  std::vector<PatchLinks> links((n + block - 1) / block);
  parallelFor(exec_, n, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (!whole_[p]) linkPatch(p, isCut, links[begin / block]);
  });
  for (std::size_t p = 0; p < n; ++p) {
    if (!whole_[p]) continue;  // its links to others were looked at from there
    for (const Index q : tets_.patches.neighboursOf(p))
      if (at(q) > p && whole_[at(q)]) connected_.join(at(partBegin_[p]), at(partBegin_[at(q)]));
  }
  for (const PatchLinks& l : links) {
    for (const auto& [one, other] : l.joined) connected_.join(at(one), at(other));
    sides.insert(sides.end(), l.sides.begin(), l.sides.end());
  }
}

void CellParts::linkPatch(std::size_t patch, std::span<const unsigned char> isCut, PatchLinks& links) const {
  const TrianglePatches& patches = tets_.patches;
  for (const Index t : patches.trianglesOf(patch))
    for (std::size_t side = 0; side < 3; ++side) {
      const Index next = tets_.surfaceNeighbours[at(t)][side];
      const std::size_t beyond = at(patches.patchOf[at(next)]);
      Index owner = -1;  // the uncut one of a cut and an uncut triangle
      if (isCut[at(t)] && !isCut[at(next)] && whole_[beyond])
        owner = next;
      else if (!isCut[at(t)] && isCut[at(next)])
        owner = t;
      else if (!isCut[at(t)] && beyond != patch)
        links.joined.push_back(
            {static_cast<Index>(partOfTriangle(t)), static_cast<Index>(partOfTriangle(next))});
      if (owner < 0) continue;
      const auto part = static_cast<Index>(partOfTriangle(owner));
      const Triangle& corners = arrangement_.surface[at(t)];
      const auto [low, high] = std::minmax(corners[side], corners[(side + 1) % 3]);
      links.sides.push_back({low, high, cell_[at(part)], part});
    }
}

void CellParts::addSkinBorders(std::vector<Side>& sides) const {
  sides.reserve(sides.size() + meshes_.skin.border.size());
  for (std::size_t k = 0; k < meshes_.skin.parts(); ++k)
    for (const BorderEdge& e : meshes_.skin.borderOf(k))
      sides.push_back({std::min(e.from, e.to), std::max(e.from, e.to), cell_[firstSkin_ + k],
                       static_cast<Index>(firstSkin_ + k)});
}

/// Along whole edges by what runs along them; other edges are left to joinSides.
void CellParts::joinSheets(std::vector<Side>& sides) {
  std::vector<Index> numberAt(sheets_.corners.size(), -1);  // of the part whose border begins there
  for (std::size_t k = 0; k < meshes_.sheet.parts(); ++k)
    for (const BorderEdge& e : meshes_.sheet.borderOf(k)) {
      if (e.corner >= 0) {
        numberAt[at(e.corner)] = static_cast<Index>(k);
        continue;
      }
      for (const std::size_t part : {firstSheet_ + 2 * k, firstSheet_ + 2 * k + 1})
        sides.push_back(
            {std::min(e.from, e.to), std::max(e.from, e.to), cell_[part], static_cast<Index>(part)});
    }
  DisjointSets bothSides(meshes_.sheet.parts());  // half the work for what goes on as it is
  std::vector<Index> around;
  for (std::size_t e = 0; e < sheets_.edges.size(); ++e) {
    around.clear();
    for (const Index corner : sheets_.cornersAlong(static_cast<Index>(e)))
      if (const Index k = numberAt[at(corner)]; k >= 0) around.push_back(k);
    joinAround(around, bothSides);
  }
  for (std::size_t k = 0; k < meshes_.sheet.parts(); ++k)
    if (const std::size_t one = bothSides.find(k); one != k)
      for (const std::size_t side : {0u, 1u})
        connected_.join(firstSheet_ + 2 * one + side, firstSheet_ + 2 * k + side);
}

/// Each cell around an edge of the sheets is bounded by two parts there.
void CellParts::joinAround(std::span<const Index> sheets, DisjointSets& bothSides) {
  for (std::size_t i = 0; i < sheets.size(); ++i)
    for (std::size_t k = i + 1; k < sheets.size(); ++k) {
      const std::size_t part = firstSheet_ + 2 * at(sheets[i]), other = firstSheet_ + 2 * at(sheets[k]);
      if (cell_[part] == cell_[other] && cell_[part + 1] == cell_[other + 1]) {
        bothSides.join(at(sheets[i]), at(sheets[k]));
        continue;
      }
      for (const std::size_t p : {part, part + 1})
        for (const std::size_t o : {other, other + 1})
          if (cell_[p] == cell_[o]) connected_.join(p, o);
    }
}

/// Joins the parts with a side in common, found by hashing the edges.
void CellParts::joinSides(std::span<const Side> sides) {
  std::vector<Index> slots(std::bit_ceil(2 * sides.size() + 8), -1);
  const std::size_t mask = slots.size() - 1;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    std::size_t slot = hashOfIndices(std::array{side.low, side.high, side.cell}) & mask;
    while (slots[slot] >= 0 && !sides[at(slots[slot])].meets(side)) slot = (slot + 1) & mask;
    if (slots[slot] < 0)
      slots[slot] = static_cast<Index>(i);
    else
      connected_.join(at(sides[at(slots[slot])].part), at(side.part));
  }
}

void CellParts::sumUp(std::span<const unsigned char> isCut) {
  sums_.resize(size());
  const std::size_t patches = whole_.size(), skin = patches + meshes_.skin.parts();
  parallelFor(exec_, skin + meshes_.sheet.parts(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (i < patches)
        sumPatch(i, isCut);
      else if (i < skin)
        sumTriangles(firstSkin_ + i - patches);
      else
        sumSheet(firstSheet_ + 2 * (i - skin));
  });
}

void CellParts::sumTriangles(std::size_t part) {
  SolidSums sums;
  forTriangles(part, [&](const Triangle& t) { addTo(sums, t); });
  sums_[part] = sums;
}

void CellParts::sumSheet(std::size_t back) {
  sumTriangles(back);
  sums_[back + 1] -= sums_[back];  // the same triangles turned over
}

/// The largest part gets what the others and the cut triangles leave of the patch.
void CellParts::sumPatch(std::size_t patch, std::span<const unsigned char> isCut) {
  const std::size_t first = at(partBegin_[patch]), last = at(partBegin_[patch + 1]);
  if (first == last) return;
  std::size_t largest = first;
  for (std::size_t part = first; part < last; ++part)
    if (uncut_[part].size() > uncut_[largest].size()) largest = part;
  SolidSums rest = tets_.patches.sums[patch];
  if (!whole_[patch]) {
    SolidSums cut;
    for (const Index t : tets_.patches.trianglesOf(patch))
      if (isCut[at(t)]) addTo(cut, arrangement_.surface[at(t)]);
    rest -= cut;
  }
  for (std::size_t part = first; part < last; ++part) {
    if (part == largest) continue;
    sumTriangles(part);
    rest -= sums_[part];
  }
  sums_[largest] = rest;
}

void CellParts::addTo(SolidSums& sums, const Triangle& t) const {
  const std::vector<Vec3>& positions = arrangement_.positions;
  const Vec3& origin = tets_.patches.origin;
  sums.add(positions[at(t[0])] - origin, positions[at(t[1])] - origin, positions[at(t[2])] - origin);
}

}  // namespace sherd
