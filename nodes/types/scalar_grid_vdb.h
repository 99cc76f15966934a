// The OpenVDB side of ScalarGrid, for the few files that read or write grids.
#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "types/scalar_grid.h"

namespace sherd {

struct ScalarGrid::Impl {
  std::string name;
  openvdb::FloatGrid::ConstPtr grid;  ///< null for a constant
  double constant = 0;
  Digest content;                     ///< of the values and the transform
};

}  // namespace sherd
