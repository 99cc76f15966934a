// The lower envelope of the sites' values in one tetrahedron (envelope.h), as polygons with named corners.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tessellate/envelope.h"

namespace sherd {

/// Names a vertex: nodes and ranks, each ascending and padded with −1.
struct VertexName {
  Tetra nodes{-1, -1, -1, -1}, ranks{-1, -1, -1, -1};
  /// Both, as numbers that are quick to compare.
  std::array<std::uint64_t, 4> words() const { return std::bit_cast<std::array<std::uint64_t, 4>>(*this); }
  friend bool operator==(const VertexName& x, const VertexName& y) {
    const auto a = x.words(), b = y.words();
    return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2]) | (a[3] ^ b[3])) == 0;
  }
  std::size_t dimension() const { return nodes[2] < 0 ? 1 : nodes[3] < 0 ? 2 : 3; }
};

/// What the polygons of a block of tetrahedra are made of.
struct BlockPolygons {
  struct Polygon {
    Index tet, back, front, count;  ///< ranks
  };
  std::vector<Polygon> polygons;
  std::vector<VertexName> corners;
  std::vector<SheetEdgeLine> lines;
  std::vector<unsigned char> onCage;
  std::size_t cutTets = 0;
};

/// The envelope in one tetrahedron after another; keeps its memory. Corners are placed in doubles, with a
/// bound of their error, first; where that leaves a sign open, it is that of a determinant, exactly.
class TetEnvelope {
 public:
  TetEnvelope(const TetMesh& tets, const SiteValues& values);
  ~TetEnvelope();

  /// Adds the polygons between `candidates`: ranks, ascending, of all sites that may be least somewhere in
  /// the tetrahedron. Cost O(m³) for m of them.
  void addPolygons(Index tet, std::span<const Index> candidates, BlockPolygons& out);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
