// A scalar field painted by an artist (toughness β and the like), held in an OpenVDB grid that this header
// hides.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "base/archive.h"
#include "base/hash.h"
#include "types/vec.h"

namespace sherd {

/// Immutable; copies share the grid. Positions are in metres, program axes.
class ScalarGrid {
 public:
  static constexpr const char* typeName = "ScalarGrid";
  static constexpr int archiveVersion = 1;
  struct Impl;  ///< defined where OpenVDB is included: types/scalar_grid_vdb.h

  /// The same value everywhere; costs nothing to sample.
  static ScalarGrid constant(double value);
  explicit ScalarGrid(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  const std::string& name() const;
  bool isConstant() const;
  /// Trilinear samples at `points` (m); the grid's background outside of its active voxels. out.size() =
  /// points.size().
  void sample(std::span<const Vec3> points, std::span<double> out) const;
  /// What it is where nothing is painted; a constant's value.
  double background() const;
  /// Around the active voxels, m; empty for a constant. Cost O(stored blocks).
  Box activeBox() const;
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

void hashValue(Hasher& hasher, const ScalarGrid& grid);
std::size_t byteSize(const ScalarGrid& grid);
/// The grid itself with its transform and metadata, bit for bit. Loading also refuses bytes that another
/// version of OpenVDB wrote.
void saveValue(ArchiveWriter& to, const ScalarGrid& grid);
std::optional<ScalarGrid> loadValue(ArchiveReader& from, std::type_identity<ScalarGrid>);

}  // namespace sherd
