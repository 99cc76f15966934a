#include "bench/cvd_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "base/rng.h"
#include "embed/embed.h"
#include "support/prepared_cells.h"

namespace sherd::bench {
namespace {

constexpr std::uint64_t kStream = 0x62656e63;

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_cvd: {}\n", result.error().text());
  std::exit(1);
}

/// Position along a Morton curve through the unit cube.
std::uint64_t mortonCode(const std::array<double, 3>& p) {
  std::uint64_t code = 0;
  for (unsigned bit = 20; bit-- > 0;)
    for (const double c : p) code = code << 1 | (static_cast<std::uint64_t>(c * (1 << 20)) >> bit & 1);
  return code;
}

}  // namespace

std::string PaperCase::path() const { return std::string(SHERD_SOURCE_DIR "/") + file; }

std::vector<PaperCase> paperCases() {
  return {
      {"horse", "../shared/meshes/horse.obj", 5256, 7, 1, 74},
      {"horse", "../shared/meshes/horse.obj", 5256, 67, 4, 74},
      {"bunny", "../shared/meshes/bunny.obj", 5301, 3, 1, 147},
      {"bunny", "../shared/meshes/bunny.obj", 5301, 48, 4, 147},
      {"mushroom", "assets/mushroom.obj", 1309, 5, 2, 250},
      {"mushroom", "assets/mushroom.obj", 1309, 81, 3, 250},
      {"wall", "assets/wall.obj", 1408, 3, 0.5, 3},
      {"wall", "assets/wall.obj", 1408, 18, 0.5, 3},
  };
}

Body bodyOf(const PaperCase& c) {
  const auto prepared =
      orExit(test::prepareCells(c.path(), {.tets = c.tets, .counts = {c.sites}}, test::defaultStore()));
  return {prepared.embedding, test::volumeWeights(prepared.embedding->tets)};
}

Body bodyInPaperDimensions(const PaperCase& c) {
  Body body = bodyOf(c);
  if (c.dimensions == 3) return body;
  const EmbedParams params{.metric = EmbedParams::Metric::Interior,
                           .source = EmbedParams::Source::Surface,
                           .filter = EmbedParams::Filter::Diffusion,
                           .extension = EmbedParams::Extension::MeanValue,
                           .dimensions = c.dimensions,
                           .tolerance = 0,
                           .time = 0.01};
  body.embedding = std::make_shared<const Embedding>(orExit(embed(body.embedding->tets, params, Exec{})));
  return body;
}

Body cloud(std::size_t nodes, Eigen::Index dimensions) {
  const Rng rng(7, kStream);
  std::vector<std::array<double, 3>> points(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    points[n] = {rng.uniformAt(3 * n), rng.uniformAt(3 * n + 1), rng.uniformAt(3 * n + 2)};
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return mortonCode(a) < mortonCode(b); });
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = std::make_shared<TetMesh>();
  embedding->coordinates.resize(dimensions, static_cast<Eigen::Index>(nodes));
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto& [x, y, z] = points[n];
    auto column = embedding->coordinates.col(static_cast<Eigen::Index>(n));
    column.head<5>() << x, y, z, 0.3 * std::sin(2 * x + z), 0.3 * y * z;
    for (Eigen::Index i = 5; i < dimensions; ++i)
      column[i] =
          0.5 / static_cast<double>(i) * std::sin(static_cast<double>(i) * (i % 2 == 0 ? x + y : y - z));
  }
  embedding->diameter = 2;
  Body body{embedding, {}};
  body.weights.weight.assign(nodes, 1.0);
  body.weights.volume.assign(nodes, 1.0);
  return body;
}

Lloyd drawnAtOnce(const Body& body, const std::vector<double>& amount, int count, std::uint64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  std::vector<double> sum(amount.size());
  std::partial_sum(amount.begin(), amount.end(), sum.begin());
  for (int k = 0; k < count; ++k) {
    const double target = sum.back() * Rng(seed, kStream).uniformAt(static_cast<std::uint64_t>(k));
    const auto n = std::min(std::upper_bound(sum.begin(), sum.end(), target), sum.end() - 1) - sum.begin();
    lloyd.addSite(body.embedding->coordinates.col(n), Exec{});
  }
  return lloyd;
}

Lloyd drawnApart(const Body& body, int count, std::int64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  lloyd.addSite(bodyCentroid(*body.embedding, body.weights), Exec{});
  for (int k = 1; k < count; ++k)
    if (const auto node = drawSite(lloyd, *body.embedding, body.weights, Growth::ByVolume, seed))
      lloyd.addSite(body.embedding->coordinates.col(*node), Exec{});
  return lloyd;
}

Outcome iterated(Lloyd lloyd, Labels labels, const LloydLimits& limits) {
  const auto end =
      orExit(labels == Labels::Exact ? lloyd.run(limits, Exec{}) : lloyd.runFlood(limits, Exec{}));
  return {lloyd.energy(), end.iterations, lloyd.labels()};
}

Outcome grown(const Body& body, int count, std::int64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  lloyd.addSite(bodyCentroid(*body.embedding, body.weights), Exec{});
  int steps = 0;
  while (static_cast<int>(lloyd.siteCount()) < count &&
         orExit(growSite(lloyd, *body.embedding, body.weights, Growth::ByVolume, seed, Exec{})))
    ++steps;
  return iterated(std::move(lloyd));
}

WeightField hitAtACorner(const WeightField& volumes) {
  WeightField field = volumes;
  const Box box = boxOf(volumes.tets->nodes);
  for (std::size_t n = 0; n < field.weight.size(); ++n) {
    const double r = (volumes.tets->nodes[n] - box.low).norm() / box.diagonal();
    field.weight[n] = volumes.volume[n] / std::pow(0.02 + r, 4);
  }
  return field;
}

double shareOfDifferent(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different += a[i] != b[i];
  return static_cast<double>(different) / static_cast<double>(a.size());
}

}  // namespace sherd::bench
