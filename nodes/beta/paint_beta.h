// Makes and edits a scalar field (toughness β and the like) on a sparse grid.
//
// One field goes through these in their order; each is left out where its parameters say nothing:
//   1. the field to begin with: `grid`, or `background` everywhere
//   2. `other`, met by `blend`
//   3. a source, met by `blend`: the mesh's vertex colours or a texture near its surface, or noise
//   4. strokes, one after the other, each by its own blend
//   5. smoothing
//   6. a threshold
//
// Voxels. A grid that is painted keeps its transform, which has to be linear (any affine one); a new one has
// cubes, with centres on whole multiples of their edge, in the axes and the unit of the mesh (or of `other`).
// (OpenVDB holds no edges below 1e-5 units; a grid of such voxels has its voxel as its unit, with a warning.)
// Voxels that nothing has touched are not stored: memory is that of the active voxels, in blocks of 8³, and a
// field that is the same everywhere stays a constant.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "beta/stroke.h"
#include "types/picture.h"
#include "types/scalar_grid.h"
#include "types/tri_mesh.h"

namespace sherd {

enum class PaintSource {
  None,
  Colors,   ///< vertex colours of the mesh
  Texture,  ///< a picture over the mesh's texture coordinates
  Noise,    ///< value noise
};
enum class ColorChannel { Red, Green, Blue, Alpha };

struct PaintBetaParams {
  std::string name;       ///< of the field; empty: that of `grid`, else "beta"
  double background = 1;  ///< where nothing is painted, without `grid`
  double voxel = 0;       ///< m, edge of a new grid's voxels; 0: a quarter of the smallest radius, `band` and
                          ///< `noiseSize` in use, or those of `other` where nothing else is painted
  std::vector<Stroke> strokes;
  Blend blend = Blend::Multiply;  ///< of `other` and of the source

  PaintSource source = PaintSource::None;
  double low = 0.5, high = 2;  ///< what a channel or noise of 0 and of 1 stand for; what a threshold leaves
  ColorChannel channel = ColorChannel::Red;
  std::string colorSet;  ///< by name; empty: the first
  std::string uvSet;     ///< of the texture, by name; empty: the first
  std::string material;  ///< of the texture: it lies on the triangles of this one; empty: on all
  double band = 0;  ///< m, how far from the surface colours and texture reach; 0: 1/32 of the mesh's diagonal
  double noiseSize = 0;   ///< m, between independent values; 0: 1/8 of the diagonal of what it covers
  std::int64_t seed = 1;  ///< of the noise

  double smooth = 0;     ///< m, standard deviation of a Gaussian; 0: none
  double threshold = 0;  ///< values from here on become `high`, those below `low`; 0: none
};

struct PaintBetaInputs {
  const ScalarGrid* grid = nullptr;   ///< what is painted on; null: `background`
  const ScalarGrid* other = nullptr;  ///< what is combined with it
  const TriMesh* mesh = nullptr;      ///< of the colours; what noise lies in; the axes of a new grid
  const Picture* texture = nullptr;
};

/// - `other` that is a constant holds everywhere. Else `replace` counts where it is painted, and the other
///   blends also meet the two backgrounds. On another lattice it is interpolated linearly.
/// - Colours: within `band` of the surface, the channel (clamped to [0, 1]) at the closest point, the lowest
///   triangle where several are as close; low + channel (high − low).
/// - Texture: the same with the channel (red, green or blue, as in the file, over 255) of the picture at the
/// closest
///   point's texture coordinates: v runs upwards, the picture repeats, and is linear between pixels' middles.
///   What is finer than the voxels is not averaged. Where another material's triangle is closest nothing is
///   painted.
/// - Noise: uniform values in [0, 1) on a cubic lattice of edge `noiseSize` in the program's space (fixed by
///   `seed` alone, counter-based), interpolated by t³ (10 − 15 t + 6 t²); in the blocks that the mesh's solid
///   touches, or without a mesh where the field is painted already.
/// - Smoothing runs along the grid's axes, with weights up to 3 standard deviations that sum to 1; a constant
///   region stays what it is, and the background holds outside.
///
/// The same bits for any number of threads. Errors, each with its port: a missing mesh or picture, mesh
/// without such colours, texture coordinates or material; a grid that isn't linear; values that are no
/// numbers; a result that isn't finite; voxels so small that it takes more than 2^20 blocks (2 GiB), with the
/// size that they had. A stroke thinner than a voxel is a warning. Cost O(voxels touched), of colours times
/// the triangles near a block.
Result<ScalarGrid> paintBeta(const PaintBetaInputs& inputs, const PaintBetaParams& params, const Exec& exec);

}  // namespace sherd
