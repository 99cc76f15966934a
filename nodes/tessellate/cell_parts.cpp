#include "tessellate/cell_parts.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/parallel.h"

namespace sherd {

CellParts::CellParts(const TetMesh& tets, const Arrangement& arrangement, const ClippedMeshes& meshes,
                     std::span<const unsigned char> isCut, const Exec& exec)
    : tets_(tets), arrangement_(arrangement), meshes_(meshes), exec_(exec) {
  splitPatches(isCut);
  if (exec.cancelled()) return;
  firstSkin_ = uncut_.size();
  firstSheet_ = firstSkin_ + meshes.skin.parts();
  nameCells();
  connected_ = DisjointSets(size());
  std::vector<Side> sides;
  joinUncut(isCut, sides);
  if (exec.cancelled()) return;
  addBorders(sides);
  joinSides(sides);
  if (exec.cancelled()) return;
  sumUp();
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
  parallelFor(exec_, n, 256, [&](std::size_t begin, std::size_t end) {
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
  for (const auto& triangles : uncut_)
    cell_.push_back(arrangement_.surfaceLabel[at(arrangement_.surface[at(triangles[0])][0])]);
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
  const TrianglePatches& patches = tets_.patches;
  const auto addSide = [&](std::size_t part, Index t, std::size_t side) {
    const Triangle& corners = arrangement_.surface[at(t)];
    const auto [low, high] = std::minmax(corners[side], corners[(side + 1) % 3]);
    sides.push_back({low, high, cell_[part], static_cast<Index>(part)});
  };
  const auto look = [&](std::size_t part, Index t, std::size_t side) {
    const Index next = tets_.surfaceNeighbours[at(t)][side];
    if (isCut[at(next)])
      addSide(part, t, side);
    else
      connected_.join(part, partOfTriangle(next));
  };
  for (std::size_t p = 0; p < patches.count(); ++p) {
    const std::size_t first = at(partBegin_[p]), last = at(partBegin_[p + 1]);
    if (whole_[p]) {  // its links to patches that are not are looked at from there
      for (const Index q : patches.neighboursOf(p))
        if (at(q) > p && whole_[at(q)]) connected_.join(first, at(partBegin_[at(q)]));
      continue;
    }
    for (std::size_t part = first; part < last; ++part)
      for (const Index t : uncut_[part])
        for (std::size_t side = 0; side < 3; ++side) look(part, t, side);
    for (const Index t : patches.trianglesOf(p)) {
      if (!isCut[at(t)]) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        const Index next = tets_.surfaceNeighbours[at(t)][side];
        if (!isCut[at(next)] && whole_[at(patches.patchOf[at(next)])]) addSide(partOfTriangle(next), t, side);
      }
    }
  }
}

void CellParts::addBorders(std::vector<Side>& sides) const {
  const std::size_t uncut = sides.size(), skin = uncut + meshes_.skin.border.size();
  sides.resize(skin + 2 * meshes_.sheet.border.size());
  const auto fill = [&](const auto& mesh, std::size_t k, auto add) {
    std::size_t slot = at(mesh.firstBorder[k]);
    for (const auto& [from, to] : mesh.borderOf(k)) add(slot++, std::min(from, to), std::max(from, to));
  };
  parallelFor(exec_, meshes_.skin.parts(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      fill(meshes_.skin, k, [&](std::size_t slot, Index low, Index high) {
        sides[uncut + slot] = {low, high, cell_[firstSkin_ + k], static_cast<Index>(firstSkin_ + k)};
      });
  });
  parallelFor(exec_, meshes_.sheet.parts(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      fill(meshes_.sheet, k, [&](std::size_t slot, Index low, Index high) {
        for (std::size_t part = firstSheet_ + 2 * k; part < firstSheet_ + 2 * k + 2; ++part)
          sides[skin + 2 * slot + part % 2] = {low, high, cell_[part], static_cast<Index>(part)};
      });
  });
}

/// Joins the parts with a side in common, found by hashing the edges.
void CellParts::joinSides(std::span<const Side> sides) {
  const std::size_t buckets = std::bit_ceil(sides.size() / 2 + 1);
  const auto bucketOf = [&](const Side& s) {
    const std::uint64_t edge = static_cast<std::uint64_t>(s.low) << 32 | static_cast<std::uint32_t>(s.high);
    return (edge * 0x9E3779B97F4A7C15ULL >> 32) & (buckets - 1);
  };
  std::vector<Index> begin(buckets + 1, 0);
  for (const Side& s : sides) ++begin[bucketOf(s) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Side> sorted(sides.size());
  std::vector<Index> fill(begin.begin(), begin.end() - 1);
  for (const Side& s : sides) sorted[at(fill[bucketOf(s)]++)] = s;
  for (std::size_t b = 0; b < buckets; ++b)
    for (Index i = begin[b]; i < begin[b + 1]; ++i)
      for (Index k = i + 1; k < begin[b + 1]; ++k)
        if (sorted[at(i)].meets(sorted[at(k)]))
          connected_.join(at(sorted[at(i)].part), at(sorted[at(k)].part));
}

void CellParts::sumUp() {
  const std::vector<Vec3>& positions = arrangement_.positions;
  const Vec3& origin = tets_.patches.origin;
  sums_.resize(size());
  const auto sumOf = [&](std::size_t part) {
    SolidSums sums;
    forTriangles(part, [&](const Triangle& t) {
      sums.add(positions[at(t[0])] - origin, positions[at(t[1])] - origin, positions[at(t[2])] - origin);
    });
    return sums;
  };
  parallelFor(exec_, tets_.patches.count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t part = at(partBegin_[p]); part < at(partBegin_[p + 1]); ++part)
        sums_[part] = whole_[p] ? tets_.patches.sums[p] : sumOf(part);
  });
  parallelFor(exec_, meshes_.skin.parts(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = firstSkin_ + begin; part < firstSkin_ + end; ++part) sums_[part] = sumOf(part);
  });
  parallelFor(exec_, meshes_.sheet.parts(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = firstSheet_ + 2 * begin; part < firstSheet_ + 2 * end; part += 2) {
      sums_[part] = sumOf(part);
      sums_[part + 1] -= sums_[part];  // the same triangles turned over
    }
  });
}

}  // namespace sherd
