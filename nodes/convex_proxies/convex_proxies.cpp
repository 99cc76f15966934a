#include "convex_proxies/convex_proxies.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "convex_proxies/decompose.h"
#include "convex_proxies/overlaps.h"

namespace sherd {
namespace {

Result<PieceProxy> proxyOf(const Fragments& f, const Piece& piece, const ConvexProxiesParams& params,
                           const Exec& exec) {
  std::vector<Index> used;
  for (const auto* list : {&piece.surface, &piece.crack})
    for (const Triangle& t : *list) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto number = [&](Index v) {
    return static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  };
  std::vector<Vec3> positions;
  for (const Index v : used) positions.push_back(f.positions[at(v)]);
  std::vector<Triangle> triangles;
  for (const auto* list : {&piece.surface, &piece.crack})
    for (const Triangle& t : *list) triangles.push_back({number(t[0]), number(t[1]), number(t[2])});
  PieceProxy proxy;
  proxy.name = piece.name;
  SHERD_ASSIGN(proxy.hulls, decompose(positions, triangles, piece.volume, params, exec));
  proxy.pieceVolume = piece.volume;
  for (const ConvexHull& hull : proxy.hulls) proxy.volume += hull.volume;
  proxy.error = piece.volume > 0 ? (proxy.volume - piece.volume) / piece.volume : 0;
  proxy.mass = f.material.density * piece.volume;
  proxy.centreOfMass = piece.centreOfMass;
  proxy.inertia = piece.inertia;
  return proxy;
}

double overlapShare(const PieceProxy& p) { return p.pieceVolume > 0 ? p.overlap / p.pieceVolume : 0; }

constexpr double kRounding = 1e-7;  ///< shares of a volume that are not told of

/// How much larger hulls are than what they stand for, in words.
std::string moreVolume(double share) {
  if (std::abs(share) < kRounding) return "as much volume as the pieces";
  return fmt::format("{:.3g} % {} volume than the pieces", 100 * std::abs(share),
                     share > 0 ? "more" : "less");
}

void sayOutcome(const Proxies& proxies, const Exec& exec) {
  std::size_t hulls = 0;
  double volume = 0, pieces = 0;
  const PieceProxy *worst = &proxies.pieces.front(), *deepest = worst;
  for (const PieceProxy& p : proxies.pieces) {
    hulls += p.hulls.size();
    volume += p.volume;
    pieces += p.pieceVolume;
    if (p.error > worst->error) worst = &p;
    if (overlapShare(p) > overlapShare(*deepest)) deepest = &p;
    if (std::any_of(p.hulls.begin(), p.hulls.end(), [](const ConvexHull& h) { return h.volume <= 0; }))
      exec.warn(p.name + " is flat: its hull has no volume, and engines may refuse it");
  }
  const std::string most = worst->error < kRounding
                               ? ""
                               : fmt::format(", {:.3g} % more at most ({})", 100 * worst->error, worst->name);
  exec.info(fmt::format("{} hull{} for {} piece{}; {}{}", hulls, hulls == 1 ? "" : "s", proxies.pieces.size(),
                        proxies.pieces.size() == 1 ? "" : "s",
                        moreVolume(pieces > 0 ? (volume - pieces) / pieces : 0), most));
  if (overlapShare(*deepest) > kRounding)
    exec.info(fmt::format("hulls of neighbours overlap by up to {:.3g} % of a piece ({})",
                          100 * overlapShare(*deepest), deepest->name));
}

}  // namespace

Result<Proxies> convexProxies(const Fragments& f, const ConvexProxiesParams& params, const Exec& exec) {
  if (!f.tets || !f.tets->surface || f.pieces.empty())
    return failure("there are no pieces to make hulls of", "wire Tessellate's `pieces`", "pieces");
  if (params.maxHulls < 1)
    return failure(fmt::format("max_hulls is {}", params.maxHulls), "1 is one hull per piece", "max_hulls");
  if (!(params.tolerance >= 0) || !std::isfinite(params.tolerance))
    return failure(fmt::format("tolerance is {}", params.tolerance), "0.05 is 5 % of a piece", "tolerance");
  Proxies proxies;
  proxies.frame = f.tets->surface->frame;
  std::vector<Result<PieceProxy>> made(f.pieces.size(), Result<PieceProxy>(PieceProxy{}));
  std::atomic<std::size_t> done{0};
  parallelFor(exec, f.pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      made[p] = proxyOf(f, f.pieces[p], params, exec);
      exec.progress(0.9 * static_cast<double>(++done) / static_cast<double>(f.pieces.size()));
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (Result<PieceProxy>& proxy : made) {
    if (!proxy.ok()) return proxy.error();
    proxies.pieces.push_back(std::move(proxy).value());
  }
  measureOverlaps(proxies.pieces, exec);
  if (exec.cancelled()) return cancelledError();
  sayOutcome(proxies, exec);
  return proxies;
}

}  // namespace sherd
