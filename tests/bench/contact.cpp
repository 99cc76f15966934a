#include "bench/contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bench/marks.h"
#include "bench/measured_table.h"
#include "bench/or_exit.h"
#include "bench/plot.h"
#include "simulate/patch_load.h"
#include "simulate/simulate.h"
#include "simulate/statics.h"
#include "support/tet_families.h"

namespace sherd::bench {
namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr ElementOrder kOrders[] = {ElementOrder::Linear, ElementOrder::Quadratic};
constexpr double kRadii[] = {0.03, 0.06};
constexpr int kFinest = 16;  ///< cubes along an edge, of the quadratic elements that all are compared with
constexpr int kNearDefault = 9;   ///< the same, with about as many tetrahedra as Tetrahedralize's default
constexpr double kDrawn = 1e-11;  ///< where what has no error is drawn

const char* nameOf(ElementOrder order) { return order == ElementOrder::Linear ? "linear" : "quadratic"; }

Shared cubeOf(int n) { return families::shared(families::box(n, n, n, Vec3(0.2, 0.2, 0.2))); }

SimulateParams dropped() {
  SimulateParams params;
  params.orientation = Vec3(0, 0, 45);
  params.angularVelocity = Vec3(3, -7, 11);
  params.refine = false;  // what a mesh gives by itself
  return params;
}

double energyOf(const Shared& mesh, const SimulateParams& params) {
  return totalEnergy(orExit(simulate(mesh, params, Exec{})).energy);
}

/// Where finding the impact takes a time that depends on the step.
Plot steps(Table& table) {
  const Shared cube = cubeOf(8);
  SimulateParams params = dropped();
  params.timeStep = 1.0 / 15360;
  const double finest = energyOf(cube, params);
  Plot plot{
      "time step", "cpu ms to the impact", "error of the energy", {{"steps of 1/24 to 1/3840 s", {}, {}}}};
  for (const double perSecond : {24.0, 60.0, 240.0, 960.0, 3840.0}) {
    params.timeStep = 1 / perSecond;
    const double ms = leastProcessorMs(5, [&] { orExit(dropUntilImpact(*cube, params, Exec{})); });
    const double energy = energyOf(cube, params), error = std::abs(energy / finest - 1);
    const bool isDefault = params.timeStep == SimulateParams{}.timeStep;
    table.row({fmt::format("1/{:g}{}", perSecond, isDefault ? " (default)" : ""),
               fmt::format("{:.8g}", energy), scientific(error), number(ms)});
    plot.series[0].x.push_back(ms);
    plot.series[0].y.push_back(std::max(error, kDrawn));
    if (isDefault) plot.series.push_back(crossAt("the default: 1/240 s", ms, std::max(error, kDrawn)));
  }
  return plot;
}

/// Energies over meshes and elements, with patches of given size.
Plot meshes(Table& table) {
  Plot plot{"tetrahedra, elements and patch", "cpu ms", "error of the energy", {}};
  Series mark;
  for (const double radius : kRadii) {
    SimulateParams params = dropped();
    params.contactRadius = radius;
    params.elements = ElementOrder::Quadratic;
    const double finest = energyOf(cubeOf(kFinest), params);
    for (const ElementOrder order : kOrders) {
      params.elements = order;
      Series series{fmt::format("{}, patch {:g} m", nameOf(order), radius), {}, {}};
      for (const int n : {4, 6, 8, kNearDefault, 12, kFinest}) {
        if (order == ElementOrder::Quadratic && n == kFinest) continue;
        const Shared mesh = cubeOf(n);
        double energy = 0;
        const double ms = leastProcessorMs(n < 12 ? 3 : 1, [&] { energy = energyOf(mesh, params); });
        const double error = energy / finest - 1;
        table.row({fmt::format("{:g}", radius), nameOf(order), count(static_cast<std::size_t>(n)),
                   count(mesh->tets.size()), fmt::format("{:.5g}", energy),
                   fmt::format("{:+.1f} %", 100 * error), number(ms)});
        series.x.push_back(ms);
        series.y.push_back(std::abs(error));
        if (order == SimulateParams{}.elements && n == kNearDefault && radius == kRadii[0])
          mark = crossAt(fmt::format("the default: linear, here {} tetrahedra", mesh->tets.size()), ms,
                         std::abs(error));
      }
      plot.series.push_back(std::move(series));
    }
  }
  plot.series.push_back(std::move(mark));
  return plot;
}

/// Energy against the points of the patch's quadrature.
Plot quadrature(Table& table) {
  const Shared cube = cubeOf(8);
  SimulateParams params = dropped();
  params.contactRadius = kRadii[0];
  const Impact impact = orExit(dropUntilImpact(*cube, params, Exec{}));
  Plot plot{"quadrature of the patch", "points", "error of the energy", {}};
  Series mark;
  for (const ElementOrder order : kOrders) {
    const auto statics = std::make_shared<const Statics>(
        orExit(Statics::factor(cube, {params.body.poissonRatio, order}, Exec{})));
    const auto measured = [&](double piece) {
      const PatchLoader loader(statics->elements(), piece);
      std::vector<Vec3> force(statics->elements()->nodeCount(), Vec3::Zero());
      std::size_t points = 0;
      for (const Contact& c : impact.contacts) {
        const Vec3 peak = kHertzPeak / c.duration * c.impulse;
        points += loader.pointCount(c.point, peak, c.radius);
        if (const auto done = loader.add(c.point, peak, c.radius, force); !done.ok())
          fmt::print(stderr, "{}\n", done.error().text());
      }
      return std::pair(points, statics->solve(force, params.body.youngModulus).work);
    };
    const double finest = measured(1.0 / 64).second;
    plot.series.push_back({nameOf(order), {}, {}});
    for (const double piece : {2.0, 1.0, 0.5, kPatchPiece, 0.125, 0.0625}) {
      const auto [points, energy] = measured(piece);
      const double error = std::abs(energy / finest - 1);
      table.row({fmt::format("{:g}{}", piece, piece == kPatchPiece ? " (default)" : ""), nameOf(order),
                 count(points), fmt::format("{:.5g}", energy), scientific(error)});
      plot.series.back().x.push_back(static_cast<double>(points));
      plot.series.back().y.push_back(error);
      if (piece == kPatchPiece && order == SimulateParams{}.elements)
        mark = crossAt("the default: a quarter of the radius", static_cast<double>(points), error);
    }
  }
  plot.series.push_back(std::move(mark));
  return plot;
}

}  // namespace

void contact(const Options& options, std::string& report) {
  Table bySteps({"time step, s", "energy, J", "against 1/15360 s", "cpu ms to the impact"});
  Table byMeshes({"patch radius, m", "elements", "cubes along an edge", "tets", "energy, J",
                  "against the finest", "cpu ms"});
  Table byPoints({"pieces, radii", "elements", "points", "energy, J", "against the finest"});
  const std::vector<Plot> plots{meshes(byMeshes), steps(bySteps), quadrature(byPoints)};
  bySteps.write(options.out / "contact_steps.csv");
  byMeshes.write(options.out / "contact_meshes.csv");
  byPoints.write(options.out / "contact_quadrature.csv");
  writePlots(options.out / "contact.svg", plots);
  report += fmt::format(
      "### Contact\n\nA cube of 0.2 m, dropped spinning; processor times are the least of a few runs.\n\n{}\n"
      "Over meshes, against quadratic elements on {} tetrahedra:\n\n{}\n"
      "The same on 3,072 tetrahedra with a patch of 0.03 m, over the quadrature of its pressure, against "
      "pieces "
      "of a 64th of the radius:\n\n{}\n",
      bySteps.markdown(), 6 * kFinest * kFinest * kFinest, byMeshes.markdown(), byPoints.markdown());
}

}  // namespace sherd::bench
