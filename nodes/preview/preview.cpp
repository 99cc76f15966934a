#include "preview/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "geometry/crack_attributes.h"
#include "pictures/label.h"
#include "preview/camera.h"
#include "preview/scene.h"
#include "preview/shading.h"
#include "preview/soups.h"

namespace sherd {
namespace {

const Colour kInk(0.05f, 0.055f, 0.065f);
const Colour kClay(0.62f, 0.60f, 0.57f);

Result<void> checkInput(const Fragments& f, const EnergyField* energy, const PreviewParams& params) {
  if (!f.tets || !f.tets->surface || f.tets->surface->triangles.empty() || f.pieces.empty())
    return failure("there are no pieces to show", "wire Tessellate's `pieces`", "pieces");
  if (energy != nullptr &&
      (!energy->tets || !energy->tets->surface || energy->nodeEnergy.size() != energy->tets->nodes.size()))
    return failure("the energy has no values on its tetrahedra", "wire Simulate's `energy`", "energy");
  const auto inRange = [](auto value, auto low, auto high) { return value >= low && value <= high; };
  if (!inRange(params.width, 64, 16384))
    return failure("the width is out of range", "64 to 16384 pixels", "width");
  if (!inRange(params.height, 64, 16384))
    return failure("the height is out of range", "64 to 16384 pixels", "height");
  if (!inRange(params.samples, 1, 1024)) return failure("samples are out of range", "1 to 1024", "samples");
  if (!inRange(params.explode, 0.0, 4.0)) return failure("explode is out of range", "0 to 4", "explode");
  return {};
}

/// A scene, and what is written above it.
struct Panel {
  Scene scene;
  std::string title;
  std::optional<EnergyScale> scale;
};

std::string countOf(std::size_t pieces) {
  return pieces == 1 ? std::string("1 piece") : fmt::format("{} pieces", pieces);
}

Result<std::vector<Panel>> makePanels(const Fragments& f, const EnergyField* energy,
                                      const PreviewParams& params, const Exec& exec) {
  const TriMesh& body = *f.tets->surface;
  const PictureSpace space = PictureSpace::of(body);
  const std::vector<Vec3> normals = shadingNormals(body);
  std::vector<Panel> panels;
  if (params.before) {
    SHERD_ASSIGN(Scene before, Scene::make(wholeSoup(body, normals, space, kClay), exec));
    panels.push_back({std::move(before), "before", {}});
  }
  SHERD_ASSIGN(const std::vector<std::vector<Vec3>> cracks, crackNormals(f, exec));
  SHERD_ASSIGN(Scene pieces, Scene::make(piecesSoup(f, normals, cracks, space, params.explode), exec));
  panels.push_back({std::move(pieces), countOf(f.pieces.size()), {}});
  if (energy == nullptr) return panels;
  const TriMesh& shown = *energy->tets->surface;
  const std::vector<double> densities = surfaceEnergyDensity(*energy);
  const EnergyScale scale = energyScale(densities);
  Soup soup = wholeSoup(shown, &shown == &body ? normals : shadingNormals(shown), space, kClay);
  for (const Triangle& t : shown.triangles)
    for (const Index v : t) soup.values.push_back(scale.place(densities[at(v)]));
  SHERD_ASSIGN(Scene strained, Scene::make(std::move(soup), exec));
  panels.push_back(
      {std::move(strained), scale.high > 0 ? "strain energy, J/m^3" : "no strain energy", scale});
  return panels;
}

/// The bar that shows what the energy's colours stand for, and its two ends in words below it.
struct Legend {
  int left = 0, top = 0, width = 0, height = 0, dots = 1;

  static Legend in(const PanelFrame& frame, int dots) {
    const int width = frame.width / 2, height = 5 * dots;
    return {frame.left + (frame.width - width) / 2, frame.top + frame.height - 18 * dots - height, width,
            height, dots};
  }
  void draw(Picture& picture, const EnergyScale& scale) const {
    for (int x = 0; x < width; ++x) {
      const Rgb colour = toRgb(energyColour(static_cast<float>(x) / static_cast<float>(width - 1)));
      for (int y = 0; y < height; ++y) paint(picture, left + x, top + y, colour);
    }
    const std::string low = fmt::format("{:.1e}", scale.low), high = fmt::format("{:.1e}", scale.high);
    const int below = top + height + 2 * dots;
    drawText(picture, left, below, low, dots, toRgb(kInk));
    drawText(picture, left + width - textWidth(high, dots), below, high, dots, toRgb(kInk));
  }
};

void annotate(Picture& picture, const PanelFrame& frame, const Panel& panel) {
  const int dots = std::max(1, std::min(frame.width / 220, frame.height / 200));
  const int x = frame.left + (frame.width - textWidth(panel.title, dots)) / 2;
  drawText(picture, x, frame.top + 6 * dots, panel.title, dots, toRgb(kInk));
  if (panel.scale && panel.scale->high > 0 && frame.height > 60 * dots)
    Legend::in(frame, dots).draw(picture, *panel.scale);
}

Picture toPicture(const Canvas& canvas) {
  Picture picture{canvas.width, canvas.height, {}};
  picture.rgb.reserve(3 * canvas.pixels.size());
  for (const Colour& pixel : canvas.pixels)
    for (const std::uint8_t byte : toRgb(pixel)) picture.rgb.push_back(byte);
  return picture;
}

}  // namespace

Result<Picture> renderPreview(const Fragments& f, const EnergyField* energy, const PreviewParams& params,
                              const Exec& exec) {
  SHERD_CHECK(checkInput(f, energy, params));
  SHERD_ASSIGN(const std::vector<Panel> panels, makePanels(f, energy, params, exec));
  const int count = static_cast<int>(panels.size());
  // One camera for all, so that sizes can be compared; the pieces moved apart need the most room.
  std::vector<Vec3f> points;
  for (const Panel& panel : panels)
    points.insert(points.end(), panel.scene.soup().corners.begin(), panel.scene.soup().corners.end());
  const float aspect = static_cast<float>(params.width / count) / static_cast<float>(params.height);
  const Camera camera = threeQuarterView(points, aspect, 0.84f);

  Canvas canvas{params.width, params.height, {}};
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
