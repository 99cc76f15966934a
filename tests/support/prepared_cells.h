// From a mesh file to cells, as a graph with default parameters would, for tests and benchmarks of what comes
// after.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd::test {

struct PreparedCells {
  std::shared_ptr<const Embedding> embedding;
  std::vector<std::shared_ptr<const Partition>> cells;  ///< one per count asked for
};

struct PrepareParams {
  int tets = 5000;
  std::vector<int> counts;  ///< of sites, ascending
  bool euclidean = false;   ///< whatever the body's shape
};

/// Weights are volumes: cells of about equal size. Kept in `store`, by the file's content and the parameters.
Result<PreparedCells> prepareCells(const std::string& file, const PrepareParams& params,
                                   const std::filesystem::path& store);
/// The same for a surface at hand; `name` has to tell it from all others.
Result<PreparedCells> prepareCells(std::shared_ptr<const TriMesh> surface, const std::string& name,
                                   const PrepareParams& params, const std::filesystem::path& store);

/// Where prepared values are kept unless somebody says otherwise: $SHERD_TEST_STORE, else a directory of the
/// build.
std::filesystem::path defaultStore();

/// All volumes as weights.
WeightField volumeWeights(const std::shared_ptr<const TetMesh>& tets);

}  // namespace sherd::test
