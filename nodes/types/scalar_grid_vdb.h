// The OpenVDB side of ScalarGrid, for the few files that read or write grids.
#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "types/scalar_grid.h"
#include "types/tri_mesh.h"

// Instantiated once, in scalar_grid_vdb.cpp. Otherwise each file that makes a grid would compile all that the
// virtual functions of grids and trees call, which takes longer than the rest of the file.
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::FloatTree>;

namespace sherd {

struct ScalarGrid::Impl {
  std::string name;
  openvdb::FloatGrid::ConstPtr grid;  ///< null for a constant; inactive voxels hold the background
  FileFrame frame;                    ///< of the grid's world space
  double constant = 0;
  Digest content;  ///< of everything above
};

/// Of everything but impl.content itself. Cost O(stored voxels).
Digest contentOf(const ScalarGrid::Impl& impl);

/// Registers OpenVDB's types once. To be called before a grid is read or written.
void initializeOpenVdb();

/// Wraps an OpenVDB grid whose world space lies in `frame`. Inactive voxels are set to the background first,
/// since that is what ScalarGrid promises of them. A grid without active voxels, or whose active voxels all
/// hold the background, becomes a constant. Cost O(stored voxels).
ScalarGrid scalarGridOf(openvdb::FloatGrid::Ptr grid, std::string name, const FileFrame& frame);

}  // namespace sherd
