#include "preview/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "geometry/crack_attributes.h"
#include "pictures/label.h"
#include "preview/cage_soups.h"
#include "preview/camera.h"
#include "preview/field_soup.h"
#include "preview/scene.h"
#include "preview/shading.h"
#include "preview/soups.h"

namespace sherd {
namespace {

const Colour kInk(0.05f, 0.055f, 0.065f);

Result<void> checkInput(const PreviewInput& in) {
  const Fragments* f = in.pieces;
  if (f == nullptr || !f->tets || !f->tets->surface || f->tets->surface->triangles.empty() ||
      f->pieces.empty())
    return failure("there are no pieces to show", "wire Tessellate's `pieces`", "pieces");
  const EnergyField* energy = in.energy;
  if (energy != nullptr &&
      (!energy->tets || !energy->tets->surface || energy->nodeEnergy.size() != energy->tets->nodes.size()))
    return failure("the energy has no values on its tetrahedra", "wire Simulate's `energy`", "energy");
  const Partition* cells = in.cells;
  if (cells != nullptr && (!cells->embedding || !cells->embedding->tets ||
                           cells->label.size() != cells->embedding->tets->nodes.size()))
    return failure("the cells have no labels on their tetrahedra", "wire CVD's `cells`", "cells");
  return {};
}

Result<void> checkParams(const PreviewInput& in, const PreviewParams& params) {
  const auto inRange = [](auto value, auto low, auto high) { return value >= low && value <= high; };
  if (!inRange(params.width, 64, 16384))
    return failure("the width is out of range", "64 to 16384 pixels", "width");
  if (!inRange(params.height, 64, 16384))
    return failure("the height is out of range", "64 to 16384 pixels", "height");
  if (!inRange(params.samples, 1, 1024)) return failure("samples are out of range", "1 to 1024", "samples");
  if (!inRange(params.explode, 0.0, 4.0)) return failure("explode is out of range", "0 to 4", "explode");
  if (!inRange(params.sliceAt, 0.0, 1.0)) return failure("slice_at is out of range", "0 to 1", "slice_at");
  if (params.slice != Slice::None && in.energy == nullptr && in.cells == nullptr)
    return failure("there is nothing to show in a slice", "wire `cells`, `energy` or both", "slice");
  return {};
}

/// What the ends of a panel's colours stand for; `low` alone, and one neutral colour, where there is one
/// value.
struct Ends {
  std::string low, high;
  bool isOne() const { return high.empty(); }
};

/// A scene, and what is written above and below it.
struct Panel {
  Scene scene;
  std::string title;
  std::optional<Ends> ends;
};

std::string countOf(std::size_t pieces) {
  return pieces == 1 ? std::string("1 piece") : fmt::format("{} pieces", pieces);
}

/// Panels of what a body consists of, one after another.
class PanelMaker {
 public:
  PanelMaker(const PreviewInput& in, const PreviewParams& params, const Exec& exec)
      : in_(in),
        params_(params),
        exec_(exec),
        body_(*in.pieces->tets->surface),
        space_(PictureSpace::of(body_)),
        normals_(shadingNormals(body_)) {
    if (params.slice == Slice::None) return;
    const int axis = static_cast<int>(params.slice) - static_cast<int>(Slice::X);
    const Box box = boxOf(body_.positions);
    cut_ = SlicePlane{axis, box.low[axis] + params.sliceAt * (box.high[axis] - box.low[axis])};
  }

  Result<std::vector<Panel>> make() {
    if (params_.before) SHERD_CHECK(add(wholeSoup(body_, normals_, space_, neutralColour()), "before"));
    SHERD_ASSIGN(const std::vector<std::vector<Vec3>> cracks, crackNormals(*in_.pieces, exec_));
    SHERD_CHECK(add(piecesSoup(*in_.pieces, normals_, cracks, space_, params_.explode),
                    countOf(in_.pieces->pieces.size())));
    if (in_.energy != nullptr) SHERD_CHECK(addEnergy());
    if (in_.beta != nullptr) SHERD_CHECK(addBeta());
    if (in_.cells != nullptr) {
      const std::size_t count = in_.cells->siteCount();
      SHERD_CHECK(add(cellsSoup(*in_.cells, cut_, space_),
                      fmt::format("{} cell{}{}", count, count == 1 ? "" : "s", cut_ ? ", cut open" : "")));
    }
    return std::move(panels_);
  }

 private:
  Result<void> add(Soup soup, std::string title, std::optional<Ends> ends = {}) {
    SHERD_ASSIGN(Scene scene, Scene::make(std::move(soup), exec_));
    panels_.push_back({std::move(scene), std::move(title), std::move(ends)});
    return {};
  }

  Result<void> addEnergy() {
    const EnergyField& energy = *in_.energy;
    const TriMesh& shown = *energy.tets->surface;
    const std::vector<double> densities = surfaceEnergyDensity(energy);
    const EnergyScale scale = energyScale(densities);
    Soup soup =
        wholeSoup(shown, &shown == &body_ ? normals_ : shadingNormals(shown), space_, neutralColour());
    for (const Triangle& t : shown.triangles)
      for (const Index v : t) soup.values.push_back(scale.place(densities[at(v)]));
    SHERD_CHECK(addEnergy(std::move(soup), scale, "strain energy, J/m^3"));
    if (!cut_) return {};
    return addEnergy(energySoup(energy, scale, cut_, space_), scale, "strain energy inside, J/m^3");
  }
  Result<void> addEnergy(Soup soup, const EnergyScale& scale, const char* title) {
    if (!(scale.high > 0)) return add(std::move(soup), "no strain energy");
    return add(std::move(soup), title,
               Ends{fmt::format("{:.1e}", scale.low), fmt::format("{:.1e}", scale.high)});
  }

  Result<void> addBeta() {
    SHERD_ASSIGN(FieldSoup field, fieldSoup(body_, normals_, *in_.beta, space_));
    const bool isOne = field.scale.isOne();
    return add(std::move(field.soup), isOne ? "fragility everywhere" : "fragility",
               Ends{fmt::format("{:.3g}", field.scale.low),
                    isOne ? std::string() : fmt::format("{:.3g}", field.scale.high)});
  }

  const PreviewInput& in_;
  const PreviewParams& params_;
  const Exec& exec_;
  const TriMesh& body_;
  PictureSpace space_;
  std::vector<Vec3> normals_;
  std::optional<SlicePlane> cut_;
  std::vector<Panel> panels_;
};

/// The bar that shows what the colours stand for, and its two ends in words below it.
struct Legend {
  int left = 0, top = 0, width = 0, height = 0, dots = 1;

  static Legend in(const PanelFrame& frame, int dots) {
    const int width = frame.width / 2, height = 5 * dots;
    return {frame.left + (frame.width - width) / 2, frame.top + frame.height - 18 * dots - height, width,
            height, dots};
  }
  void draw(Picture& picture, const Ends& ends) const {
    for (int x = 0; x < width; ++x) {
      const float place = static_cast<float>(x) / static_cast<float>(width - 1);
      const Rgb colour = toRgb(ends.isOne() ? neutralColour() : energyColour(place));
      for (int y = 0; y < height; ++y) paint(picture, left + x, top + y, colour);
    }
    const int below = top + height + 2 * dots;
    if (ends.isOne()) {
      const int middle = left + (width - textWidth(ends.low, dots)) / 2;
      return drawText(picture, middle, below, ends.low, dots, toRgb(kInk));
    }
    drawText(picture, left, below, ends.low, dots, toRgb(kInk));
    drawText(picture, left + width - textWidth(ends.high, dots), below, ends.high, dots, toRgb(kInk));
  }
};

void annotate(Picture& picture, const PanelFrame& frame, const Panel& panel) {
  const int dots = std::max(1, std::min(frame.width / 220, frame.height / 200));
  const int x = frame.left + (frame.width - textWidth(panel.title, dots)) / 2;
  drawText(picture, x, frame.top + 6 * dots, panel.title, dots, toRgb(kInk));
  if (panel.ends && frame.height > 60 * dots) Legend::in(frame, dots).draw(picture, *panel.ends);
}

Picture toPicture(const PixelBuffer& canvas) {
  Picture picture{canvas.width, canvas.height, {}};
  picture.rgb.reserve(3 * canvas.pixels.size());
  for (const Colour& pixel : canvas.pixels)
    for (const std::uint8_t byte : toRgb(pixel)) picture.rgb.push_back(byte);
  return picture;
}

}  // namespace

Result<Picture> renderPreview(const PreviewInput& in, const PreviewParams& params, const Exec& exec) {
  SHERD_CHECK(checkInput(in));
  SHERD_CHECK(checkParams(in, params));
  SHERD_ASSIGN(const std::vector<Panel> panels, PanelMaker(in, params, exec).make());
  const int count = static_cast<int>(panels.size());
  // One camera for all, so that sizes can be compared; the pieces moved apart need the most room.
  std::vector<Vec3f> points;
  for (const Panel& panel : panels)
    points.insert(points.end(), panel.scene.soup().corners.begin(), panel.scene.soup().corners.end());
  const float aspect = static_cast<float>(params.width / count) / static_cast<float>(params.height);
  const Camera camera = threeQuarterView(points, aspect, 0.84f);

  PixelBuffer canvas{params.width, params.height, {}};
  canvas.pixels.resize(static_cast<std::size_t>(params.width) * static_cast<std::size_t>(params.height));
  const auto frameOf = [&](int p) {
    const int left = params.width * p / count, right = params.width * (p + 1) / count;
    return PanelFrame{left, 0, right - left, params.height};
  };
  for (int p = 0; p < count; ++p) {
    drawPanel(panels[static_cast<std::size_t>(p)].scene, camera, frameOf(p), params.samples, canvas, exec);
    if (exec.cancelled()) return cancelledError();
    exec.progress(static_cast<double>(p + 1) / count);
  }
  Picture picture = toPicture(canvas);
  for (int p = 0; p < count; ++p) annotate(picture, frameOf(p), panels[static_cast<std::size_t>(p)]);
  return picture;
}

}  // namespace sherd
