#include "geometry/paint_place.h"

#include <fmt/format.h>

namespace sherd {
namespace {

constexpr double kMuch = 20;  ///< times as large: more than paint and body differ by as a rule

std::string spanOf(const Box& box) {
  return fmt::format("from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m", box.low.x(), box.low.y(),
                     box.low.z(), box.high.x(), box.high.y(), box.high.z());
}

Box scaled(const Box& box, double factor) { return {factor * box.low, factor * box.high}; }

/// Turned about x by a quarter, one way or the other: another axis up.
Box turned(const Box& box, double sign) {
  Box out;
  for (const Vec3& p : {box.low, box.high}) out.add(Vec3(p.x(), sign * p.z(), -sign * p.y()));
  return out;
}

std::string reasonBeside(const Box& paint, const Box& body) {
  const double ratio = paint.diagonal() / body.diagonal();
  for (const int factor : {1000, 100}) {
    const auto fits = [&](double by) {
      return ratio * by > 1 / kMuch && ratio * by < kMuch && scaled(paint, by).overlaps(body);
    };
    if (fits(1.0 / factor))
      return fmt::format("; it is {:.3g} times as large, and divided by {} would lie on it: another unit?",
                         ratio, factor);
    if (fits(factor))
      return fmt::format("; it is {:.3g} times as large, and multiplied by {} would lie on it: another unit?",
                         ratio, factor);
  }
  if (turned(paint, 1).overlaps(body) || turned(paint, -1).overlaps(body))
    return "; with y and z exchanged it would lie on it: another axis up?";
  if (ratio > kMuch || ratio < 1 / kMuch) return fmt::format("; it is {:.3g} times as large", ratio);
  return {};
}

}  // namespace

std::string placeOfPaint(const ScalarGrid& field, const TetMesh& tets) {
  const Box paint = field.activeBox();
  const bool hasSurface = tets.surface != nullptr && !tets.surface->positions.empty();
  const Box body = hasSurface ? boxOf(tets.surface->positions) : boxOf(tets.nodes);
  const std::string places = fmt::format("the paint lies {}, the body {}", spanOf(paint), spanOf(body));
  if (!paint.overlaps(body)) return places + reasonBeside(paint, body);
  const double ratio = paint.diagonal() / body.diagonal();
  if (ratio > kMuch) return places + fmt::format("; it is {:.3g} times as large: another unit?", ratio);
  return places + "; it may be finer than the tetrahedra, and fall between their nodes" +
         (ratio < 1 / kMuch ? fmt::format(", or in another unit: it is {:.3g} times as large", ratio) : "");
}

}  // namespace sherd
