// The faces of all cells in parts that surely hang together, so that cost follows what is cut: whole patches
// of the surface that no sheet touches, what is left of the patches that one does, and the regions of cut
// triangles and sheet polygons.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "geometry/disjoint_sets.h"
#include "tessellate/arrangement.h"
#include "tessellate/clip.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Parts by number: of the surface's uncut triangles, by patch; then of the cut skin; then each of the sheets
/// twice, as its back cell and as its front cell sees it.
class CellParts {
 public:
  /// `isCut`: per surface triangle, and the same for join() and sumUp(), without which connected() and sums()
  /// know nothing; they may run at the same time. When exec is cancelled all three end soon with something
  /// unfinished. Cost O(patches + triangles of patches with a cut one + new triangles).
  CellParts(const TetMesh& tets, const Sheets& sheets, const Arrangement& arrangement,
            const ClippedMeshes& meshes, std::span<const unsigned char> isCut, const Exec& exec);
  /// Mostly one thread's work.
  void join(std::span<const unsigned char> isCut);
  /// In parallel.
  void sumUp(std::span<const unsigned char> isCut);

  std::size_t size() const { return cell_.size(); }
  std::size_t firstSkin() const { return firstSkin_; }
  std::size_t firstSheet() const { return firstSheet_; }
  bool isUncut(std::size_t part) const { return part < firstSkin_; }
  bool isSkin(std::size_t part) const { return part >= firstSkin_ && part < firstSheet_; }
  bool isSheet(std::size_t part) const { return part >= firstSheet_; }
  /// The other side of a sheet's part.
  std::size_t twin(std::size_t part) const { return firstSheet_ + ((part - firstSheet_) ^ 1); }
  /// Number of a part among those of ClippedMeshes::skin or sheet.
  std::size_t skinNumber(std::size_t part) const { return part - firstSkin_; }
  std::size_t sheetNumber(std::size_t part) const { return (part - firstSheet_) / 2; }

  Index cell(std::size_t part) const { return cell_[part]; }
  /// Of the part's triangles, about TrianglePatches::origin.
  const SolidSums& sums(std::size_t part) const { return sums_[part]; }
  /// The surface triangles of an uncut part.
  std::span<const Index> uncutTriangles(std::size_t part) const { return uncut_[part]; }
  std::size_t triangleCount(std::size_t part) const;

  /// Calls f(corners) for each triangle, counter-clockwise from outside the cell.
  template <class F>
  void forTriangles(std::size_t part, F f) const {
    if (isUncut(part))
      for (const Index t : uncut_[part]) f(arrangement_.surface[at(t)]);
    else if (isSkin(part))
      for (const SkinTriangle& t : meshes_.skin.of(skinNumber(part))) f(t.corners);
    else
      for (const SheetTriangle& t : meshes_.sheet.of(sheetNumber(part)))
        f(isBack(part) ? t.corners : Triangle{t.corners[0], t.corners[2], t.corners[1]});
  }

  /// Which parts meet in an edge within their cell.
  DisjointSets& connected() { return connected_; }

 private:
  /// A part's side of an edge, for its cell.
  struct Side {
    Index low, high, cell, part;
    bool meets(const Side& o) const { return low == o.low && high == o.high && cell == o.cell; }
  };
  /// What a block of patches has to do with others.
  struct PatchLinks {
    std::vector<std::array<Index, 2>> joined;  ///< parts
    std::vector<Side> sides;                   ///< of edges to cut triangles
  };

  bool isBack(std::size_t part) const { return (part - firstSheet_) % 2 == 0; }
  void splitPatches(std::span<const unsigned char> isCut);
  Index splitPatch(std::size_t patch, std::span<const unsigned char> isCut);
  void listUncut();
  void nameCells();
  std::size_t partOfTriangle(Index t) const {
    const std::size_t patch = at(tets_.patches.patchOf[at(t)]);
    return at(partBegin_[patch] + (whole_[patch] ? 0 : partOf_[t]));
  }
  void joinUncut(std::span<const unsigned char> isCut, std::vector<Side>& sides);
  void linkPatch(std::size_t patch, std::span<const unsigned char> isCut, PatchLinks& links) const;
  void addSkinBorders(std::vector<Side>& sides) const;
  void joinSheets(std::vector<Side>& sides);
  void joinAround(std::span<const Index> sheets, DisjointSets& bothSides);
  void joinSides(std::span<const Side> sides);
  void sumPatch(std::size_t patch, std::span<const unsigned char> isCut);
  void sumTriangles(std::size_t part);
  void sumSheet(std::size_t back);
  void addTo(SolidSums& sums, const Triangle& t) const;

  const TetMesh& tets_;
  const Sheets& sheets_;
  const Arrangement& arrangement_;
  const ClippedMeshes& meshes_;
  const Exec& exec_;
  std::vector<Index> partBegin_;      ///< per patch: its first part; one more at the end
  std::vector<unsigned char> whole_;  ///< per patch: nothing cuts it
  // Only of patches that are not whole: the rest is never touched.
  std::unique_ptr<Index[]> partOf_;  ///< per triangle: its part within the patch, −1 for a cut one
  std::unique_ptr<Index[]> loose_;   ///< from each patch's begin: its uncut triangles, by part
  std::vector<Index> looseEnd_;      ///< per patch: where these end
  std::vector<std::span<const Index>> uncut_;
  std::size_t firstSkin_ = 0, firstSheet_ = 0;
  std::vector<Index> cell_;
  std::vector<SolidSums> sums_;
  DisjointSets connected_{0};
};

}  // namespace sherd
