#include "beta/read_vdb.h"

#include <fmt/format.h>
#include <openvdb/io/File.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "types/scalar_grid_vdb.h"

namespace sherd {
namespace {

/// A grid as the file's directory lists it.
struct Listed {
  std::string name;
  std::string type;
  bool usable = false;
};

std::vector<Listed> listGrids(openvdb::io::File& file) {
  std::vector<Listed> grids;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const auto grid = file.readGridMetadata(*name);
    grids.push_back({*name, grid->valueType(),
                     grid->isType<openvdb::FloatGrid>() || grid->isType<openvdb::DoubleGrid>()});
  }
  return grids;
}

std::string describe(const std::vector<Listed>& grids) {
  if (grids.empty()) return "it holds no grids";
  std::string text = "it holds";
  for (const Listed& grid : grids)
    text += fmt::format("{} '{}' ({})", &grid == &grids.front() ? "" : ",", grid.name, grid.type);
  return text;
}

Result<Listed> choose(const std::vector<Listed>& grids, const ReadVdbParams& params, const Exec& exec) {
  const Listed* chosen = nullptr;
  std::size_t usable = 0;
  for (const Listed& grid : grids) {
    usable += grid.usable;
    if (chosen == nullptr && (params.grid.empty() ? grid.usable : grid.name == params.grid)) chosen = &grid;
  }
  if (chosen == nullptr && params.grid.empty())
    return failure(fmt::format("'{}' has no grid of floats or doubles: {}", params.file, describe(grids)),
                   "paint the field into a float grid", "file");
  if (chosen == nullptr)
    return failure(fmt::format("'{}' has no grid named '{}'", params.file, params.grid), describe(grids),
                   "grid");
  if (!chosen->usable)
    return failure(
        fmt::format("grid '{}' of '{}' holds values of type {}", params.grid, params.file, chosen->type),
        "it would have to be float or double; " + describe(grids), "grid");
  if (params.grid.empty() && usable > 1)
    exec.info(fmt::format("taking grid '{}' of '{}'; {}", chosen->name, params.file, describe(grids)));
  return *chosen;
}

openvdb::FloatGrid::Ptr asFloat(const openvdb::GridBase::Ptr& grid) {
  if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
  const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
  return doubles ? std::make_shared<openvdb::FloatGrid>(*doubles) : nullptr;
}

/// Values that are no numbers would spread to every weight.
Result<void> checkFinite(const openvdb::FloatGrid& grid, const Listed& listed, const ReadVdbParams& params) {
  const std::string where = fmt::format("grid '{}' of '{}' holds ", listed.name, params.file);
  const auto kind = [](float v) { return std::isnan(v) ? "NaN" : "an infinite value"; };
  if (!std::isfinite(grid.background()))
    return failure(where + kind(grid.background()) + " as its background", "give it a finite one", "file");
  std::size_t bad = 0;
  std::string first;
  for (auto value = grid.cbeginValueOn(); value; ++value)
    if (!std::isfinite(*value) && bad++ == 0) {
      const openvdb::Coord c = value.getCoord();
      first = fmt::format("{} at voxel ({}, {}, {})", kind(*value), c.x(), c.y(), c.z());
    }
  if (bad == 0) return {};
  if (bad > 1) first += fmt::format(" and {} more such", bad - 1);
  return failure(where + first, "repaint it there or deactivate these voxels", "file");
}

/// A level set's inside is inactive, of −background; active, it counts. Where it is a tile it stays one.
void keepInside(openvdb::FloatGrid& grid) {
  for (auto value = grid.beginValueOff(); value; ++value)
    if (*value < 0) value.setActiveState(true);
}

Result<ScalarGrid> read(const ReadVdbParams& params, const Exec& exec) {
  openvdb::io::File file(params.file);
  file.open(/*delayLoad=*/false);
  SHERD_ASSIGN(const Listed chosen, choose(listGrids(file), params, exec));
  if (exec.cancelled()) return cancelledError();
  const openvdb::FloatGrid::Ptr grid = asFloat(file.readGrid(chosen.name));
  file.close();
  if (!grid)
    return failure("'" + params.file + "' is damaged: its directory and its grids disagree", {}, "file");
  SHERD_CHECK(checkFinite(*grid, chosen, params));
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) keepInside(*grid);
  return scalarGridOf(grid, chosen.name, FileFrame{params.unit, params.up});
}

}  // namespace

Result<ScalarGrid> readVdb(const ReadVdbParams& params, const Exec& exec) {
  std::error_code code;
  if (!std::filesystem::exists(params.file, code))
    return failure("there is no file '" + params.file + "'", "give the path of a VDB file", "file");
  if (std::filesystem::is_directory(params.file, code))
    return failure("'" + params.file + "' is a directory", "give the path of a VDB file", "file");
  if (!(params.unit > 0) || !std::isfinite(params.unit))
    return failure("a unit has to be a length above zero", "1 for metres, 0.01 for centimetres", "unit");
  try {
    initializeOpenVdb();
    return read(params, exec);
  } catch (const std::exception& e) {
    return failure(fmt::format("'{}' cannot be read as OpenVDB: {}", params.file, e.what()),
                   "write it anew from the program that painted it", "file");
  }
}

}  // namespace sherd
