// The single steps of paintBeta(), each on a canvas. For this folder alone.
#pragma once

#include <span>

#include "beta/canvas.h"
#include "beta/paint_beta.h"

namespace sherd {

Result<void> paintStrokes(Canvas& canvas, std::span<const Stroke> strokes, const Exec& exec);

/// The set of colours that the parameters name, or what is wrong.
Result<const TriMesh::ColorSet*> findColors(const TriMesh* mesh, const PaintBetaParams& params);
/// `band` and `noiseSize` as they are, not 0.
Result<void> paintColors(Canvas& canvas, const TriMesh& mesh, const PaintBetaParams& params, double band,
                         const Exec& exec);
Result<void> paintNoise(Canvas& canvas, const TriMesh* mesh, const PaintBetaParams& params, double noiseSize,
                        const Exec& exec);

/// `other` is no constant.
Result<void> combine(Canvas& canvas, const ScalarGrid& other, Blend blend, const Exec& exec);

/// `deviation`: m, of the Gaussian.
Result<void> smoothen(Canvas& canvas, double deviation, const Exec& exec);

}  // namespace sherd
