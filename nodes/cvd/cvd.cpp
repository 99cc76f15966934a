#include "cvd/cvd.h"

#include <fmt/format.h>

namespace sherd {
namespace {

Result<void> checkStart(const Embedding& embedding, const Sites* start, const CvdParams& params) {
  if (start == nullptr) {
    if (params.degree > 0) return {};
    return failure("neither sites nor their number are given", "wire `sites`, or set `degree`", "degree");
  }
  SHERD_CHECK(checkSites(embedding, *start, "sites"));
  if (params.degree > 0 && params.degree < start->pinned)
    return failure(fmt::format("{} sites are pinned, but only {} are wanted", start->pinned, params.degree),
                   "ask for at least as many as are pinned, or pin fewer", "degree");
  return {};
}

Result<void> checkParams(const CvdParams& params) {
  if (params.degree < 0) return failure("the degree is negative", "it is 0 or the number of sites", "degree");
  if (!(params.tolerance >= 0)) return failure("the tolerance is negative or NaN", {}, "tolerance");
  if (params.maxIterations < 1)
    return failure("no iteration is allowed", "allow at least one", "max_iterations");
  return {};
}

std::string report(const Partition& cells) {
  const std::string threshold =
      !cells.degreeGiven
          ? fmt::format(" ({} γ = {:.6g})", cells.energy < cells.gamma ? "below" : "not below", cells.gamma)
          : std::string();
  return fmt::format("{} {}, E_D = {:.6g} J·m²{}, {} {} {}", cells.siteCount(),
                     cells.siteCount() == 1 ? "site" : "sites", cells.energy, threshold,
                     cells.converged ? "converged after" : "not converged after", cells.iterations,
                     cells.iterations == 1 ? "pass" : "passes");
}

/// Pins that no node is nearest to have no cell.
void warnOfEmptyPins(const Lloyd& lloyd, const Exec& exec) {
  std::vector<char> isEmpty(lloyd.pinnedCount(), 1);
  for (const Index site : lloyd.labels())
    if (at(site) < isEmpty.size()) isEmpty[at(site)] = 0;
  for (std::size_t j = 0; j < isEmpty.size(); ++j)
    if (isEmpty[j])
      exec.warn(fmt::format(
          "pin {} gets no cell: every node of the tetrahedral mesh is nearer to another site; refine "
          "it (Tetrahedralize.tets), or move the pins apart",
          j + 1));
}

/// Grows as many sites as are wanted and possible, and runs Lloyd's iteration to its end. One site stays put.
Result<Lloyd::End> settle(std::size_t degree, Lloyd& lloyd, const Embedding& embedding,
                          const WeightField& weights, const CvdParams& params, const LloydLimits& limits,
                          const Exec& exec) {
  if (lloyd.siteCount() > 1 && lloyd.siteCount() < degree) SHERD_CHECK(lloyd.run(limits, exec));
  while (lloyd.siteCount() < degree) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights, Growth::ByVolume, params.seed, exec));
    exec.progress(static_cast<double>(lloyd.siteCount()) / static_cast<double>(degree));
    if (grown) continue;
    exec.warn(
        fmt::format("{} sites were asked for, but the tetrahedral mesh has only nodes for {}; "
                    "refine it (Tetrahedralize.tets), or ask for fewer",
                    degree, lloyd.siteCount()));
    break;
  }
  if (exec.cancelled()) return cancelledError();
  if (lloyd.siteCount() == 1) return Lloyd::End{0, true};
  return params.labels == Labels::Flood ? lloyd.runFlood(limits, exec) : lloyd.run(limits, exec);
}

}  // namespace

Result<Partition> cvd(const std::shared_ptr<const Embedding>& embedding, const WeightField& weights,
                      const Sites* start, const CvdParams& params, const Exec& exec) {
  if (!embedding) return failure("there is no embedding", {}, "embedding");
  SHERD_CHECK(checkLloydInput(*embedding, weights));
  SHERD_CHECK(checkParams(params));
  SHERD_CHECK(checkStart(*embedding, start, params));

  const std::size_t given = start == nullptr ? 0 : static_cast<std::size_t>(start->positions.cols());
  const std::size_t degree = params.degree == 0 ? given : static_cast<std::size_t>(params.degree);
  const bool fromGiven = given > 0 && given <= degree && degree > 1;
  if (given > degree)
    exec.info(fmt::format("{} sites were given, {} are wanted: grown anew from {}", given, degree,
                          start->pinned > 0 ? "those pinned" : "one"));

  const LloydLimits limits{params.tolerance, params.maxIterations};
  Lloyd lloyd = fromGiven ? Lloyd(*embedding, weights, exec) : firstSites(*embedding, weights, start, exec);
  if (fromGiven) {
    for (Eigen::Index j = 0; j < start->positions.cols() && !exec.cancelled(); ++j)
      lloyd.addSite(start->positions.col(j), exec);
    if (exec.cancelled()) return cancelledError();
    lloyd.pin(static_cast<std::size_t>(start->pinned));
  }
  SHERD_ASSIGN(const Lloyd::End end, settle(degree, lloyd, *embedding, weights, params, limits, exec));
  if (exec.cancelled()) return cancelledError();
  warnOfEmptyPins(lloyd, exec);

  // Only as many sites as a search found by γ were found by it: another number of them is one asked for.
  const bool degreeGiven = start == nullptr || start->degreeGiven || given != degree;
  Partition cells{embedding,      weights.material, lloyd.sites(),
                  lloyd.labels(), lloyd.energy(),   start == nullptr ? 0.0 : start->gamma,
                  degreeGiven,    end.iterations,   end.converged};
  exec.info(report(cells));
  return cells;
}

}  // namespace sherd
