// The single steps of paintBeta(), each on a canvas. For this folder alone.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "beta/canvas.h"
#include "beta/paint_beta.h"

namespace sherd {

Result<void> paintStrokes(Canvas& canvas, std::span<const Stroke> strokes, const Exec& exec);

/// What a triangle has at the point with these weights of its corners, in [0, 1]; nothing where it isn't
/// painted.
using SurfaceChannel = std::function<std::optional<double>(Index, const Vec3&)>;
/// low + channel (high − low) of the closest point, within `band` of the surface.
Result<void> paintSurface(Canvas& canvas, const TriMesh& mesh, const SurfaceChannel& channel,
                          const PaintBetaParams& params, double band, const Exec& exec);

/// The set of colours that the parameters name, or what is wrong.
Result<const TriMesh::ColorSet*> findColors(const TriMesh* mesh, const PaintBetaParams& params);
/// `band` and `noiseSize` as they are, not 0.
Result<void> paintColors(Canvas& canvas, const TriMesh& mesh, const PaintBetaParams& params, double band,
                         const Exec& exec);

struct TextureParts {
  const TriMesh::UvSet* uvs = nullptr;
  Index material = -1;  ///< the one painted; −1: all
};
/// What the parameters name of the mesh, or what is wrong with it or the picture.
Result<TextureParts> findTexture(const TriMesh* mesh, const Picture* picture, const PaintBetaParams& params);
Result<void> paintTexture(Canvas& canvas, const TriMesh& mesh, const Picture& picture,
                          const PaintBetaParams& params, double band, const Exec& exec);

Result<void> paintNoise(Canvas& canvas, const TriMesh* mesh, const PaintBetaParams& params, double noiseSize,
                        const Exec& exec);

/// `other` is no constant.
Result<void> combine(Canvas& canvas, const ScalarGrid& other, Blend blend, const Exec& exec);

/// `deviation`: m, of the Gaussian.
Result<void> smoothen(Canvas& canvas, double deviation, const Exec& exec);

}  // namespace sherd
