#include "beta/paint_beta.h"

#include <fmt/format.h>
#include <openvdb/tools/Prune.h>

#include <cmath>

#include "beta/layers.h"

namespace sherd {
namespace {

using Params = PaintBetaParams;
using Inputs = PaintBetaInputs;

bool isPainted(const ScalarGrid* grid) { return grid != nullptr && !grid->isConstant(); }

Result<void> checkStroke(const Stroke& stroke, std::size_t number) {
  const auto wrong = [&](const char* what, const char* remedy) {
    return failure(fmt::format("stroke {} {}", number, what), remedy, "strokes");
  };
  if (stroke.points.empty()) return wrong("has no points", "give it one for a dab, two or more for a line");
  for (const Vec3& p : stroke.points)
    if (!p.allFinite()) return wrong("has a point that is no number", "give it finite coordinates");
  if (!(stroke.radius > 0) || !std::isfinite(stroke.radius))
    return wrong("has no radius above zero", "give it one in metres");
  if (!(stroke.falloff >= 0 && stroke.falloff <= 1))
    return wrong("has a falloff out of range", "it would have to be at least 0 and at most 1");
  if (!std::isfinite(stroke.value)) return wrong("has a value that is no number", "give it a finite one");
  return {};
}

Result<void> checkParams(const Params& params) {
  const std::pair<const char*, double> lengths[] = {{"voxel", params.voxel},
                                                    {"band", params.band},
                                                    {"noise_size", params.noiseSize},
                                                    {"smooth", params.smooth}};
  for (const auto& [name, length] : lengths)
    if (!(length >= 0) || !std::isfinite(length))
      return failure(fmt::format("`{}` is no length", name), "it would have to be at least 0 m", name);
  const std::pair<const char*, double> values[] = {{"background", params.background},
                                                   {"low", params.low},
                                                   {"high", params.high},
                                                   {"threshold", params.threshold}};
  for (const auto& [name, value] : values)
    if (!std::isfinite(value) || std::abs(value) > std::numeric_limits<float>::max())
      return failure(fmt::format("`{}` is no number that a grid can hold", name), "give it a finite one",
                     name);
  for (std::size_t i = 0; i < params.strokes.size(); ++i) SHERD_CHECK(checkStroke(params.strokes[i], i + 1));
  return {};
}

Result<void> checkSource(const Inputs& in, const Params& params) {
  if (params.source == PaintSource::Texture) {
    const auto texture = findTexture(in.mesh, in.texture, params);
    if (!texture.ok()) return texture.error();
  }
  if (params.source == PaintSource::Colors) {
    const auto colors = findColors(in.mesh, params);
    if (!colors.ok()) return colors.error();
  }
  if (params.source == PaintSource::Noise && in.mesh == nullptr && !isPainted(in.grid) &&
      !isPainted(in.other))
    return failure("there is nothing that noise could lie in", "wire a mesh, or a grid that is painted",
                   "mesh");
  return {};
}

/// Lengths that are to be found out where they are 0.
struct Lengths {
  double band = 0, noiseSize = 0, voxel = 0;
};

/// Of the mesh, or of what is painted already.
double extentOf(const Inputs& in) {
  if (in.mesh != nullptr) return boxOf(in.mesh->positions).diagonal();
  Box box;
  for (const ScalarGrid* grid : {in.grid, in.other}) {
    if (!isPainted(grid)) continue;
    const openvdb::CoordBBox active = grid->impl().grid->evalActiveVoxelBoundingBox();
    for (int corner = 0; corner < 8; ++corner) {
      const openvdb::Vec3d world = grid->impl().grid->indexToWorld(
          openvdb::Coord(corner & 1 ? active.max().x() + 1 : active.min().x(),
                         corner & 2 ? active.max().y() + 1 : active.min().y(),
                         corner & 4 ? active.max().z() + 1 : active.min().z()));
      box.add(grid->impl().frame.toMetres(Vec3(world.x(), world.y(), world.z())));
    }
  }
  return box.diagonal();
}

Lengths lengthsOf(const Inputs& in, const Params& params) {
  Lengths lengths{params.band, params.noiseSize, params.voxel};
  double smallest = std::numeric_limits<double>::infinity();
  if (params.source == PaintSource::Colors || params.source == PaintSource::Texture) {
    if (lengths.band == 0) lengths.band = extentOf(in) / 32;
    smallest = std::min(smallest, lengths.band);
  }
  if (params.source == PaintSource::Noise) {
    if (lengths.noiseSize == 0) lengths.noiseSize = extentOf(in) / 8;
    smallest = std::min(smallest, lengths.noiseSize);
  }
  for (const Stroke& stroke : params.strokes) smallest = std::min(smallest, stroke.radius);
  if (lengths.voxel == 0 && std::isfinite(smallest)) lengths.voxel = smallest / 4;
  return lengths;
}

double startValue(const Inputs& in, const Params& params) {
  if (in.grid != nullptr && in.grid->isConstant()) return in.grid->impl().constant;
  return params.background;
}

/// Gives the canvas cubes as voxels. OpenVDB takes edges below 1e-5 for none, and large ones for infinite:
/// for those the grid gets a unit of its own.
void setCubes(Canvas& canvas, double voxel, const Exec& exec) {
  constexpr double kSmallest = 1e-4, kLargest = 1e30;
  double edge = voxel / canvas.frame.metresPerUnit;
  if (!(edge >= kSmallest && edge <= kLargest)) {
    exec.warn(fmt::format(
        "voxels of {:.3g} units of the mesh are beyond what OpenVDB holds; the grid's unit is {:.3g} m", edge,
        voxel));
    canvas.frame.metresPerUnit = voxel;
    edge = 1;
  }
  canvas.grid->setTransform(openvdb::math::Transform::createLinearTransform(edge));
}

/// The field before anything is painted, on the lattice that all of it will have.
Result<Canvas> blankCanvas(const Inputs& in, const Params& params, double voxel, const Exec& exec) {
  Canvas canvas;
  if (isPainted(in.grid)) {
    canvas = {in.grid->impl().grid->deepCopy(), in.grid->impl().frame};
  } else {
    canvas.grid = openvdb::FloatGrid::create(static_cast<float>(startValue(in, params)));
    if (isPainted(in.other) && params.voxel == 0) {
      canvas.frame = in.other->impl().frame;
      canvas.grid->setTransform(in.other->impl().grid->transform().copy());
    } else {
      if (in.mesh != nullptr) canvas.frame = in.mesh->frame;
      setCubes(canvas, voxel, exec);
    }
  }
  if (!canvas.grid->transform().isLinear())
    return failure("this grid follows a camera's frustum, and only grids of parallel voxels can be painted",
                   "wire it to `other` and give `voxel`: it is then resampled",
                   isPainted(in.grid) ? "grid" : "other");
  return canvas;
}

Result<void> paintAll(Canvas& canvas, const Inputs& in, const Params& params, const Lengths& lengths,
                      const Exec& exec) {
  if (isPainted(in.other)) {
    SHERD_CHECK(combine(canvas, *in.other, params.blend, exec));
  } else if (in.other != nullptr) {
    canvas.map([&](double value) { return blended(params.blend, value, in.other->impl().constant); });
  }
  exec.progress(0.2);
  if (params.source == PaintSource::Colors)
    SHERD_CHECK(paintColors(canvas, *in.mesh, params, lengths.band, exec));
  if (params.source == PaintSource::Texture)
    SHERD_CHECK(paintTexture(canvas, *in.mesh, *in.texture, params, lengths.band, exec));
  if (params.source == PaintSource::Noise)
    SHERD_CHECK(paintNoise(canvas, in.mesh, params, lengths.noiseSize, exec));
  exec.progress(0.5);
  SHERD_CHECK(paintStrokes(canvas, params.strokes, exec));
  exec.progress(0.7);
  if (params.smooth > 0) SHERD_CHECK(smoothen(canvas, params.smooth, exec));
  if (params.threshold != 0)
    canvas.map([&](double value) { return value >= params.threshold ? params.high : params.low; });
  return {};
}

Result<void> checkFinite(const Canvas& canvas) {
  bool isFinite = std::isfinite(canvas.background());
  for (auto value = canvas.grid->cbeginValueOn(); value && isFinite; ++value)
    isFinite = std::isfinite(*value);
  if (isFinite) return {};
  return failure("what is painted grows beyond what a grid can hold", "add or multiply by less", "strokes");
}

Result<ScalarGrid> wrapped(const Canvas& canvas, const std::string& name) {
  SHERD_CHECK(checkFinite(canvas));
  canvas.grid->setName(name);
  // Painted over, it tells distances no more.
  if (canvas.grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    canvas.grid->setGridClass(openvdb::GRID_UNKNOWN);
  openvdb::tools::pruneInactive(canvas.grid->tree());
  canvas.grid->tree().prune();
  return scalarGridOf(canvas.grid, name, canvas.frame);
}

/// Where nothing is painted at all there are no voxels, whatever their size would be.
Result<ScalarGrid> constantField(const Inputs& in, const Params& params, const std::string& name) {
  Canvas canvas{openvdb::FloatGrid::create(static_cast<float>(startValue(in, params))), {}};
  if (in.other != nullptr)
    canvas.map([&](double value) { return blended(params.blend, value, in.other->impl().constant); });
  if (params.threshold != 0)
    canvas.map([&](double value) { return value >= params.threshold ? params.high : params.low; });
  return wrapped(canvas, name);
}

bool changesNothing(const Inputs& in, const Params& params, const std::string& name) {
  return in.grid != nullptr && in.other == nullptr && params.source == PaintSource::None &&
         params.strokes.empty() && params.smooth == 0 && params.threshold == 0 && name == in.grid->name();
}

}  // namespace

Result<ScalarGrid> paintBeta(const PaintBetaInputs& inputs, const PaintBetaParams& params, const Exec& exec) {
  PaintBetaInputs in = inputs;
  if (in.mesh != nullptr && in.mesh->triangles.empty()) in.mesh = nullptr;
  SHERD_CHECK(checkParams(params));
  SHERD_CHECK(checkSource(in, params));
  std::string name = params.name;
  if (name.empty() && in.grid != nullptr) name = in.grid->name();
  if (name.empty()) name = "beta";
  if (changesNothing(in, params, name)) return *in.grid;
  initializeOpenVdb();
  const bool hasVoxels = isPainted(in.grid) || isPainted(in.other) || params.source != PaintSource::None ||
                         !params.strokes.empty();
  if (!hasVoxels) return constantField(in, params, name);
  const Lengths lengths = lengthsOf(in, params);
  SHERD_ASSIGN(Canvas canvas, blankCanvas(in, params, lengths.voxel, exec));
  SHERD_CHECK(paintAll(canvas, in, params, lengths, exec));
  if (exec.cancelled()) return cancelledError();
  return wrapped(canvas, name);
}

}  // namespace sherd
