#include "tessellate/tessellate.h"

#include <algorithm>
#include <numeric>

#include "geometry/surface_links.h"
#include "tessellate/arrangement.h"
#include "tessellate/canonical.h"
#include "tessellate/clip.h"
#include "tessellate/pieces.h"

namespace sherd {
namespace {

struct Cut {
  Sheets sheets;
  Arrangement arrangement;
};

/// How far rounding may put vertices apart that are one: some units of the coordinates, and what the cells'
/// values bring along.
double spotOf(const TetMesh& tets) {
  const Box box = boxOf(tets.nodes);
  return 0x1p-48 * box.diagonal() + 0x1p-51 * box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff();
}

Result<Cut> cutExactly(const TetMesh& tets, const Partition& cells, const Exec& exec) {
  const SiteValues values(cells, exec);
  if (exec.cancelled()) return cancelledError();
  ExactSheets exact = exactSheets(tets, values, exec);
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.3);
  SHERD_ASSIGN(Arrangement arrangement, arrangeExact(tets, exact, values, spotOf(tets), exec));
  return Cut{std::move(exact.sheets), std::move(arrangement)};
}

Result<Cut> cutCanonically(const TetMesh& tets, const Partition& cells, const Exec& exec) {
  Cut cut{canonicalSheets(cells), {}};
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.1);
  SHERD_ASSIGN(cut.arrangement, arrangeRounded(tets, cells.label, cut.sheets, spotOf(tets), exec));
  return cut;
}

/// The cage with its own boundary as the surface, and per surface vertex its node.
struct OwnSurface {
  std::shared_ptr<const TetMesh> tets;
  std::vector<Index> nodeOf;
};

OwnSurface ownSurface(const TetMesh& cage) {
  OwnSurface own;
  std::vector<Index> vertexOf(cage.nodes.size(), -1);
  for (const Triangle& face : cage.boundary)
    for (const Index n : face) vertexOf[at(n)] = 0;
  auto surface = std::make_shared<TriMesh>();
  for (std::size_t n = 0; n < vertexOf.size(); ++n) {
    if (vertexOf[n] < 0) continue;
    vertexOf[n] = static_cast<Index>(own.nodeOf.size());
    own.nodeOf.push_back(static_cast<Index>(n));
    surface->positions.push_back(cage.nodes[n]);
  }
  for (const Triangle& f : cage.boundary)
    surface->triangles.push_back({vertexOf[at(f[0])], vertexOf[at(f[1])], vertexOf[at(f[2])]});
  surface->frame = cage.surface->frame;
  surface->source = cage.surface->source;
  surface->piece = cage.surface->piece;
  auto tets = std::make_shared<TetMesh>(cage);
  tets->surface = surface;
  tets->insideFraction.assign(cage.tets.size(), 1);
  tets->held.clear();
  tets->heldBegin.assign(cage.tets.size() + 1, 0);
  linkSurface(*tets, Exec{});
  own.tets = tets;
  return own;
}

double enclosedVolume(const TrianglePatches& patches) {
  return std::accumulate(patches.sums.begin(), patches.sums.end(), 0.0,
                         [](double sum, const SolidSums& s) { return sum + s.volume; });
}

Result<Cut> cutConforming(const OwnSurface& own, const Partition& cells, CellMode mode, const Exec& exec) {
  Cut cut;
  std::vector<Index> nodeCell = cells.label;
  if (mode == CellMode::Exact) {
    const SiteValues values(cells, exec);
    if (exec.cancelled()) return cancelledError();
    cut.sheets = exactSheets(*own.tets, values, exec).sheets;
    cut.sheets.connect();
    for (std::size_t n = 0; n < nodeCell.size(); ++n)
      nodeCell[n] = values.site(values.least(static_cast<Index>(n)));
  } else {
    cut.sheets = canonicalSheets(cells);
  }
  if (exec.cancelled()) return cancelledError();
  SHERD_ASSIGN(cut.arrangement,
               arrangeConforming(*own.tets, own.nodeOf, nodeCell, cut.sheets, spotOf(*own.tets)));
  return cut;
}

}  // namespace

Result<Fragments> tessellate(const Partition& cells, const TessellateParams& params, const Exec& exec) {
  OwnSurface own;
  std::shared_ptr<const TetMesh> tets = cells.embedding->tets;
  if (params.surface == SurfaceMode::Conforming) {
    own = ownSurface(*tets);
    tets = own.tets;
  } else if (tets->vertexTet.empty() || tets->patches.triangles.empty()) {
    auto linked = std::make_shared<TetMesh>(*tets);
    linkSurface(*linked, exec);
    tets = linked;
  }
  SHERD_ASSIGN(Cut cut, params.surface == SurfaceMode::Conforming
                            ? cutConforming(own, cells, params.cells, exec)
                        : params.cells == CellMode::Exact ? cutExactly(*tets, cells, exec)
                                                          : cutCanonically(*tets, cells, exec));
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.5);
  ClippedMeshes meshes = clip(cut.arrangement, cut.sheets, exec);
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.8);
  const AssembleParams assembly{
      .sites = cells.siteCount(),
      .minVolume = std::max(params.minVolume * enclosedVolume(tets->patches), params.minVolumeAbsolute),
      .density = cells.material.density};
  Fragments result =
      assemblePieces(*tets, cut.sheets, std::move(cut.arrangement), std::move(meshes), assembly, exec);
  if (exec.cancelled()) return cancelledError();
  if (const std::string& parent = tets->surface->piece; !parent.empty())
    for (Piece& piece : result.pieces)  // names grow with depth: piece_0003_0002
      piece.name.replace(0, std::string_view("piece").size(), parent);
  result.tets = tets;
  result.material = cells.material;
  result.sites = cells.siteCount();
  result.energy = cells.energy;
  result.gamma = cells.gamma;
  result.degreeGiven = cells.degreeGiven;
  result.counts.cutTets = cut.sheets.cutTets;
  result.counts.crackTriangles = cut.sheets.corners.size() - 2 * cut.sheets.polygons.size();
  return result;
}

}  // namespace sherd
