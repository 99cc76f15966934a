#include "beta/write_vdb.h"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "base/partial_file.h"
#include "types/scalar_grid_vdb.h"

namespace sherd {
namespace {

using openvdb::FloatGrid;
using Params = WriteVdbParams;

constexpr double kLargestHalf = 65504;

/// OpenVDB's archive, written into memory.
class MemoryArchive : public openvdb::io::Archive {
 public:
  Ptr copy() const override { return std::make_shared<MemoryArchive>(*this); }

  std::string bytesOf(const openvdb::GridCPtrVec& grids) const {
    std::ostringstream out(std::ios::binary);
    Archive::write(out, grids, /*seekable=*/true);
    std::string bytes = std::move(out).str();
    return isGood(out) ? withTagOfContent(std::move(bytes)) : std::string();
  }

 private:
  static bool isGood(const std::ostringstream& out) { return static_cast<bool>(out); }

  /// The header is magic (8 bytes), three versions (4 each), one byte for the index, then the tag, 36
  /// characters of a UUID.
  static std::string withTagOfContent(std::string bytes) {
    constexpr std::size_t kTag = 21, kLength = 36;
    const std::string digest = Hasher()
                                   .add(std::string_view(bytes).substr(0, kTag))
                                   .add(std::string_view(bytes).substr(kTag + kLength))
                                   .digest()
                                   .hex();
    for (std::size_t i = 0, digit = 0; i < kLength; ++i)
      if (bytes[kTag + i] != '-') bytes[kTag + i] = digest[digit++ % digest.size()];
    return bytes;
  }
};

FileFrame frameOf(const FileFrame& own, const Params& params) {
  FileFrame frame = own;
  if (params.up == Params::Up::Y) frame.up = FileFrame::Up::Y;
  if (params.up == Params::Up::Z) frame.up = FileFrame::Up::Z;
  if (params.unit > 0) frame.metresPerUnit = params.unit;
  return frame;
}

/// The transform of the same grid in a file of another unit or axes.
Result<openvdb::math::Transform::Ptr> transformFor(const ScalarGrid::Impl& impl, const Params& params) {
  const openvdb::math::Transform::Ptr transform = impl.grid->transform().copy();
  const FileFrame frame = frameOf(impl.frame, params);
  if (frame.up == impl.frame.up && frame.metresPerUnit == impl.frame.metresPerUnit) return transform;
  if (!transform->isLinear())
    return failure(
        fmt::format("grid '{}' follows a camera's frustum, which can't be turned or scaled", impl.name),
        "leave out `up` and `unit`", "up");
  // OpenVDB's vectors are rows: row i is where axis i goes.
  openvdb::Mat4d turn = openvdb::Mat4d::identity();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 image = frame.toFile(impl.frame.toMetres(Vec3::Unit(axis)));
    for (int k = 0; k < 3; ++k) turn(axis, k) = image[k];
  }
  transform->postMult(turn);
  return transform;
}

/// What is inside of a level set becomes inactive again.
FloatGrid::ConstPtr withQuietInside(const FloatGrid::ConstPtr& grid) {
  const FloatGrid::Ptr copy = grid->deepCopy();
  for (auto value = copy->beginValueOn(); value; ++value)
    if (*value == -copy->background()) value.setValueOff();
  return copy;
}

Result<openvdb::MetaMap> metadataFor(const FloatGrid& grid, const std::string& name, const Params& params) {
  const FloatGrid::Ptr carrier = FloatGrid::create(grid);
  carrier->setName(name);
  carrier->setSaveFloatAsHalf(params.precision == Params::Precision::Half);
  if (params.gridClass == Params::GridClass::Fog) carrier->setGridClass(openvdb::GRID_FOG_VOLUME);
  if (params.gridClass == Params::GridClass::LevelSet) carrier->setGridClass(openvdb::GRID_LEVEL_SET);
  if (carrier->getGridClass() == openvdb::GRID_LEVEL_SET && !(grid.background() > 0))
    return failure(fmt::format("grid '{}' is no level set: its background is {}", name, grid.background()),
                   "it would have to be the half width of the band, above zero", "grid_class");
  return openvdb::MetaMap(*carrier);
}

Result<void> checkHalf(const FloatGrid& grid, const std::string& name) {
  const auto wrong = [&](double value, const std::string& where) {
    return failure(
        fmt::format("grid '{}' holds {:.6g} {}, and half precision ends at 65504", name, value, where),
        "write it as float", "precision");
  };
  if (std::abs(grid.background()) > kLargestHalf)
    return wrong(static_cast<double>(grid.background()), "as its background");
  for (auto value = grid.cbeginValueOn(); value; ++value)
    if (std::abs(*value) > kLargestHalf) {
      const openvdb::Coord c = value.getCoord();
      return wrong(static_cast<double>(*value), fmt::format("at voxel ({}, {}, {})", c.x(), c.y(), c.z()));
    }
  return {};
}

Result<FloatGrid::ConstPtr> gridFor(const ScalarGrid& field, const std::string& name, const Params& params) {
  const ScalarGrid::Impl& impl = field.impl();
  FloatGrid::ConstPtr grid = impl.grid;
  if (grid == nullptr) grid = FloatGrid::create(static_cast<float>(impl.constant));
  if (params.precision == Params::Precision::Half) SHERD_CHECK(checkHalf(*grid, name));
  SHERD_ASSIGN(const openvdb::MetaMap metadata, metadataFor(*grid, name, params));
  openvdb::math::Transform::Ptr transform = grid->transform().copy();
  if (impl.grid != nullptr) {
    SHERD_ASSIGN(transform, transformFor(impl, params));
  }
  const FloatGrid::ConstPtr result = grid->copyReplacingMetadataAndTransform(metadata, transform);
  return result->getGridClass() == openvdb::GRID_LEVEL_SET ? withQuietInside(result) : result;
}

Result<void> writeFile(const std::string& file, const std::string& bytes) {
  const std::filesystem::path directory = std::filesystem::path(file).parent_path();
  if (!directory.empty()) SHERD_CHECK(makeDirectory(directory.string()));
  const auto written = writeFileAtomically(file, bytes);
  if (!written.ok()) return written.error();
  return removeAbandoned(file);
}

Result<openvdb::GridCPtrVec> gridsFor(std::span<const ScalarGrid> fields, const Params& params) {
  openvdb::GridCPtrVec grids;
  std::set<std::string> names;
  for (const ScalarGrid& field : fields) {
    std::string name = grids.empty() && !params.name.empty() ? params.name : field.name();
    if (name.empty()) name = "beta";
    if (!names.insert(name).second)
      return failure(fmt::format("two of the grids are named '{}'", name),
                     "name the first here, and others in the nodes that make them", "name");
    SHERD_ASSIGN(FloatGrid::ConstPtr grid, gridFor(field, name, params));
    grids.push_back(std::move(grid));
  }
  return grids;
}

}  // namespace

Result<void> writeVdb(std::span<const ScalarGrid> fields, const WriteVdbParams& params, const Exec& exec) {
  if (fields.empty()) return failure("there is no grid to write", "wire one", "grid");
  if (!(params.unit >= 0) || !std::isfinite(params.unit))
    return failure("a unit has to be a length", "1 for metres, 0.01 for centimetres, 0 for the grid's own",
                   "unit");
  try {
    initializeOpenVdb();
    SHERD_ASSIGN(const openvdb::GridCPtrVec grids, gridsFor(fields, params));
    if (exec.cancelled()) return cancelledError();
    const std::string bytes = MemoryArchive().bytesOf(grids);
    if (exec.cancelled()) return cancelledError();
    if (bytes.empty())
      return failure("there is not enough memory to write '" + params.file + "'", {}, "file");
    Result<void> written = writeFile(params.file, bytes);
    if (written.ok()) return {};
    Error error = written.error();
    if (error.kind != Error::Kind::Cancelled) error.port = "file";
    return error;
  } catch (const std::exception& e) {
    return failure(fmt::format("OpenVDB cannot write '{}': {}", params.file, e.what()), {}, "file");
  }
}

}  // namespace sherd
