// Lengths of paths through a tetrahedral mesh.
#pragma once

#include <span>
#include <vector>

#include "types/tet_mesh.h"

namespace sherd {

/// Shortest paths along edges, and straight across a face from corner to opposite corner where that line
/// stays inside. Paths zigzag: they are longer than geodesics by some percent, alike all over a regular mesh.
class PathGraph {
 public:
  /// `tets` with their neighbours across faces (−1 on the border). `stretch`: per node, what lengths there
  /// are multiplied by (on a link, the mean of its ends'); empty: 1 everywhere.
  PathGraph(std::span<const Vec3> nodes, std::span<const Tetra> tets, std::span<const Tetra> neighbours,
            std::span<const double> stretch = {});
  /// Length from `source` to every node, m; infinite where there is no path. Dijkstra, O(links log nodes).
  std::vector<double> lengthsFrom(Index source) const;
  double meanLink() const { return meanLink_; }  ///< m, mean length of the links

 private:
  struct Link {
    Index to;
    double length;
  };
  std::vector<std::vector<Link>> links_;
  double meanLink_ = 0;
};

}  // namespace sherd
