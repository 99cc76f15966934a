// Which triangles bound which connected solid.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "tessellate/arrangement.h"
#include "tessellate/clip.h"

namespace sherd {

/// All faces of the cells, by number: the surface's triangles (of which only the uncut ones count), then the
/// cut skin, then each sheet triangle twice, as its back cell and as its front cell sees it.
class CellFaces {
 public:
  CellFaces(const Arrangement& a, const ClippedMeshes& m, std::span<const unsigned char> isCut)
      : a_(a), m_(m), isCut_(isCut), firstSkin_(a.surface.size()), firstSheet_(firstSkin_ + m.skin.size()) {}

  std::size_t size() const { return firstSheet_ + 2 * m_.sheet.size(); }
  std::size_t firstSkin() const { return firstSkin_; }
  std::size_t firstSheet() const { return firstSheet_; }
  bool exists(std::size_t face) const { return face >= firstSkin_ || !isCut_[face]; }
  bool isSheet(std::size_t face) const { return face >= firstSheet_; }
  /// The other side of a sheet triangle.
  std::size_t twin(std::size_t face) const { return firstSheet_ + ((face - firstSheet_) ^ 1); }

  /// Counter-clockwise from outside the cell.
  Triangle corners(std::size_t face) const {
    if (face < firstSkin_) return a_.surface[face];
    if (face < firstSheet_) return m_.skin[face - firstSkin_].corners;
    const Triangle& t = m_.sheet[(face - firstSheet_) / 2].corners;
    return (face - firstSheet_) % 2 == 0 ? t : Triangle{t[0], t[2], t[1]};
  }
  Index cell(std::size_t face) const {
    if (face < firstSkin_) return a_.surfaceLabel[at(a_.surface[face][0])];
    if (face < firstSheet_) return m_.skin[face - firstSkin_].cell;
    const SheetTriangle& t = m_.sheet[(face - firstSheet_) / 2];
    return (face - firstSheet_) % 2 == 0 ? t.back : t.front;
  }
  Index source(std::size_t face) const {
    return face < firstSkin_ ? static_cast<Index>(face) : m_.skin[face - firstSkin_].source;
  }

 private:
  const Arrangement& a_;
  const ClippedMeshes& m_;
  std::span<const unsigned char> isCut_;
  std::size_t firstSkin_, firstSheet_;
};

struct Solid {
  Index cell = -1;
  double volume = 0;  ///< m³
};

struct Solids {
  std::vector<Solid> list;
  std::vector<Index> ofFace;  ///< per face of CellFaces; −1 for those that don't exist
  std::size_t detached = 0;   ///< solids beyond the first of their cells
};

/// Joins a cell's faces over their edges into shells, and gives each void to the smallest solid of its cell
/// that holds it. A shell of no volume that nothing holds is a solid of its own. Cost O(faces).
Solids findSolids(const CellFaces& faces, std::span<const Vec3> positions,
                  std::span<const Triangle> neighbours, const Exec& exec);

}  // namespace sherd
