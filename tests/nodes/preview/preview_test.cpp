#include "preview/preview.h"

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/parallel.h"
#include "pictures/png_file.h"
#include "preview/colour.h"
#include "preview/soups.h"
#include "support/fragment_families.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

/// An energy that falls with the distance from the origin.
EnergyField energyOn(std::shared_ptr<const TriMesh> surface) {
  EnergyField energy;
  const auto cage = test::gridCage(std::move(surface), 4);
  const std::vector<double> volumes = lumpedVolumes(*cage);
  for (std::size_t n = 0; n < cage->nodes.size(); ++n)
    energy.nodeEnergy.push_back(volumes[n] * std::exp(-3 * cage->nodes[n].norm()));
  energy.tets = cage;
  return energy;
}

PreviewParams small() {
  PreviewParams params;
  params.width = 240;
  params.height = 96;
  params.samples = 2;
  return params;
}

/// Distinct colours among the pixels of columns [begin, end).
std::size_t coloursIn(const Picture& image, int begin, int end) {
  std::set<std::array<std::uint8_t, 3>> seen;
  for (int y = 0; y < image.height; ++y)
    for (int x = begin; x < end; ++x) {
      const std::size_t i = 3 * static_cast<std::size_t>(y * image.width + x);
      seen.insert({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    }
  return seen.size();
}

/// Sum over columns [begin, end) of how far each pixel is from grey.
double colourfulness(const Picture& image, int begin, int end) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = begin; x < end; ++x) {
      const std::size_t i = 3 * static_cast<std::size_t>(y * image.width + x);
      const auto [low, high] = std::minmax({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
      sum += high - low;
    }
  return sum;
}

Picture mustRender(const Fragments& f, const EnergyField* energy, const PreviewParams& params) {
  auto image = renderPreview(f, energy, params, Exec{});
  EXPECT_TRUE(image.ok()) << image.error().text();
  return image.ok() ? *image : Picture{};
}

TEST(Preview, RefusesWhatItCannotDraw) {
  const Fragments f = test::slicedBox(2);
  EXPECT_EQ(renderPreview(Fragments{}, nullptr, small(), Exec{}).error().port, "pieces");
  const EnergyField none;
  EXPECT_EQ(renderPreview(f, &none, small(), Exec{}).error().port, "energy");
  PreviewParams params = small();
  params.width = 0;
  EXPECT_EQ(renderPreview(f, nullptr, params, Exec{}).error().port, "width");
  params = small();
  params.height = 1 << 20;
  EXPECT_EQ(renderPreview(f, nullptr, params, Exec{}).error().port, "height");
  params = small();
  params.samples = 0;
  EXPECT_EQ(renderPreview(f, nullptr, params, Exec{}).error().port, "samples");
  params = small();
  params.explode = std::nan("");
  EXPECT_EQ(renderPreview(f, nullptr, params, Exec{}).error().port, "explode");
}

TEST(Preview, PanelsShowBodyPiecesAndEnergy) {
  const Fragments f = test::slicedBox(3);
  const EnergyField energy = energyOn(f.tets->surface);
  const Picture two = mustRender(f, nullptr, small()), three = mustRender(f, &energy, small());
  ASSERT_EQ(two.rgb.size(), 3u * 240 * 96);
  ASSERT_EQ(three.rgb.size(), 3u * 240 * 96);
  EXPECT_GT(coloursIn(two, 0, 120), 50u);
  EXPECT_GT(coloursIn(three, 160, 240), 50u);
  // Clay is grey; pieces and energy are not.
  EXPECT_GT(colourfulness(two, 120, 240), 2 * colourfulness(two, 0, 120));
  EXPECT_GT(colourfulness(three, 80, 160), 2 * colourfulness(three, 0, 80));
  EXPECT_GT(colourfulness(three, 160, 240), 2 * colourfulness(three, 0, 80));
}

TEST(Preview, PiecesAloneFillThePicture) {
  const Fragments f = test::slicedBox(3);
  const EnergyField energy = energyOn(f.tets->surface);
  PreviewParams params = small();
  params.before = false;
  const Picture one = mustRender(f, nullptr, params), two = mustRender(f, &energy, params);
  const Picture both = mustRender(f, nullptr, small());
  // No half of it is grey, as the object before is.
  EXPECT_GT(colourfulness(one, 0, 120), 2 * colourfulness(both, 0, 120));
  EXPECT_GT(colourfulness(one, 120, 240), 2 * colourfulness(both, 0, 120));
  EXPECT_GT(colourfulness(two, 0, 120), 2 * colourfulness(both, 0, 120));
  EXPECT_GT(colourfulness(two, 120, 240), 2 * colourfulness(both, 0, 120));
}

TEST(Preview, UnbrokenBodyIsDrawn) {
  const Picture image = mustRender(test::slicedBox(1), nullptr, small());
  EXPECT_GT(coloursIn(image, 120, 240), 50u);
}

TEST(Preview, SizeAndPlaceOfTheBodyDoNotMatter) {
  const Vec3 size(2, 1, 1);
  const auto boxAt = [&](const Vec3& low, double scale) {
    return test::slices(test::boxMesh(low, low + scale * size), {low.x() + 0.75 * scale});
  };
  const Picture reference = mustRender(boxAt(Vec3::Zero(), 1), nullptr, small());
  for (const auto& [low, scale] :
       {std::pair(Vec3(1e-6, 0, 0), 1e-6), std::pair(Vec3(1e6, -1e6, 1e6), 1024.0)}) {
    const Picture image = mustRender(boxAt(low, scale), nullptr, small());
    ASSERT_EQ(image.rgb.size(), reference.rgb.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      differing += std::abs(image.rgb[i] - reference.rgb[i]) > 24;
    EXPECT_LT(differing, image.rgb.size() / 50);
  }
}

TEST(Preview, SameBytesForAnyNumberOfThreads) {
  const Fragments f = test::slicedBox(4);
  const EnergyField energy = energyOn(f.tets->surface);
  Picture images[2];
  for (int i = 0; i < 2; ++i) {
    setThreadLimit(i + 1);
    inArena([&] { images[i] = mustRender(f, &energy, small()); });
  }
  setThreadLimit(0);
  EXPECT_EQ(images[0].rgb, images[1].rgb);
}

TEST(Preview, CancelledIsAnError) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto image = renderPreview(test::slicedBox(2), nullptr, small(), exec);
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().kind, Error::Kind::Cancelled);
}

TEST(Preview, PngDecodesToTheSamePicture) {
  const Picture image = mustRender(test::slicedBox(2), nullptr, small());
  const fs::path root = fs::temp_directory_path() / ("sherd_preview_" + std::to_string(::getpid()));
  const std::string file = (root / "new" / "picture.png").string();
  ASSERT_TRUE(writePng(image, file).ok());
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&header, file.c_str()), 0);
  EXPECT_EQ(header.width, 240u);
  EXPECT_EQ(header.height, 96u);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> decoded(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, decoded.data(), 0, nullptr), 0);
  EXPECT_EQ(decoded, image.rgb);
  std::ofstream(root / "file") << "";
  EXPECT_FALSE(writePng(image, (root / "file" / "picture.png").string()).ok());
  EXPECT_FALSE(writePng(image, (root / "new").string()).ok());  // a directory is in the way
  fs::remove_all(root);
}

TEST(EnergyOnSurface, LinearDensityIsExact) {
  const auto surface = std::make_shared<const TriMesh>(test::boxMesh(Vec3(-1, 0, 1), Vec3(1, 1, 2)));
  EnergyField energy;
  const auto cage = test::gridCage(surface, 3);
  const std::vector<double> volumes = lumpedVolumes(*cage);
  const auto density = [](const Vec3& p) { return 5 + p.x() - 2 * p.y() + 0.5 * p.z(); };
  for (std::size_t n = 0; n < cage->nodes.size(); ++n)
    energy.nodeEnergy.push_back(volumes[n] * density(cage->nodes[n]));
  energy.tets = cage;
  const std::vector<double> found = surfaceEnergyDensity(energy);
  ASSERT_EQ(found.size(), surface->positions.size());
  for (std::size_t v = 0; v < found.size(); ++v) EXPECT_NEAR(found[v], density(surface->positions[v]), 1e-12);
}

TEST(EnergyScale, SpansTheDensitiesAndSurvivesNone) {
  EXPECT_EQ(energyScale({}).high, 0);
  EXPECT_EQ(energyScale({0, 0, 0}).place(0), 0);
  const EnergyScale one = energyScale({3, 3, 3});
  EXPECT_EQ(one.place(3), 1);
  const EnergyScale wide = energyScale({1e-30, 1, 10, 100, 1000});
  EXPECT_EQ(wide.place(0), 0);
  EXPECT_LT(wide.place(1), wide.place(10));
  EXPECT_LT(wide.place(10), wide.place(90));
  EXPECT_EQ(wide.place(1e9), 1);
}

TEST(Colours, NeighbouringPiecesDifferAndCracksArePale) {
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_GT((pieceColour(i) - pieceColour(i + 1)).norm(), 0.15f) << i;
    EXPECT_GT(crackColour(i).sum(), pieceColour(i).sum() + 0.3f) << i;
  }
}

TEST(Colours, EnergyGetsLighter) {
  const Eigen::Vector3f luminance(0.2126f, 0.7152f, 0.0722f);
  for (int i = 0; i < 50; ++i)
    EXPECT_LT(energyColour(static_cast<float>(i) / 50).dot(luminance),
              energyColour(static_cast<float>(i + 1) / 50).dot(luminance));
}

TEST(ShadingNormals, KeepCreasesAndTheArtists) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3::Ones());
  const std::vector<Vec3> artist = box.normals;
  EXPECT_EQ(shadingNormals(box), artist);
  box.normals.clear();
  const std::vector<Vec3> made = shadingNormals(box);
  for (std::size_t c = 0; c < made.size(); ++c) EXPECT_NEAR((made[c] - artist[c]).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace sherd
