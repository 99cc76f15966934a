#include <fmt/format.h>

#include "graph/node_type.h"
#include "tessellate/tessellate.h"

namespace sherd {
namespace {

std::string parts(std::size_t count) { return count == 1 ? "1 part" : fmt::format("{} parts", count); }

/// The bound below which parts are merged, as the user set it.
std::string bound(const Fragments& f, const TessellateParams& params) {
  double volume = 0;
  for (const Piece& piece : f.pieces) volume += piece.volume;
  if (params.minVolumeAbsolute > params.minVolume * volume)
    return fmt::format("min_volume_absolute = {:.6g} m³", params.minVolumeAbsolute);
  return fmt::format("min_volume = {:.6g} ({:.3g} m³)", params.minVolume, params.minVolume * volume);
}

void report(const Fragments& f, const TessellateParams& params, const Exec& exec) {
  if (f.pieces.size() == 1 && f.counts.mergedParts > 0) {
    exec.warn(fmt::format(
        "{} of {} cells were cut, and all merged into one again, since they are below {}: the body "
        "stays one piece; lower it",
        parts(f.counts.mergedParts + 1), f.sites, bound(f, params)));
    return;
  }
  if (f.pieces.size() == 1) {
    exec.info("nothing was cut: the body stays one piece");
    return;
  }
  exec.info(fmt::format("{} pieces from {} cells; {} of {} tetrahedra and {} of {} surface triangles cut",
                        f.pieces.size(), f.sites, f.counts.cutTets, f.tets->tets.size(),
                        f.counts.cutSurfaceTriangles, f.tets->surface->triangles.size()));
  if (f.counts.detachedParts > 0)
    exec.info(fmt::format("{} detached from the rest of {}", parts(f.counts.detachedParts),
                          f.counts.detachedParts == 1 ? "its cell" : "their cells"));
  if (f.counts.mergedParts > 0)
    exec.info(fmt::format("{} below {} joined a neighbour", parts(f.counts.mergedParts), bound(f, params)));
  if (f.counts.forcedTriangles > 0)
    exec.warn(
        fmt::format("{} triangles came out flat or overlapping after rounding", f.counts.forcedTriangles));
}

}  // namespace

NodeType tessellateNode() {
  return NodeBuilder<TessellateParams>("Tessellate", 1,
                                       "Cuts the surface into closed pieces along the cells.")
      .input<Partition>("cells", "the cells to cut along, from CVD")
      .optionalInput<TriMesh>("mesh", "the surface to cut; must be the one that the tetrahedra were made for")
      .choice(
          "method", &TessellateParams::cells,
          {{"exact", CellMode::Exact}, {"canonical", CellMode::Canonical}},
          "exact: where each site is nearest; canonical: the paper's four schemes on the labels at the nodes")
      .choice(
          "surface", &TessellateParams::surface,
          {{"original", SurfaceMode::Original}, {"conforming", SurfaceMode::Conforming}},
          "original: the model's own surface is cut; conforming: the tetrahedral mesh's, a quick stand-in")
      .number(
          "min_volume", &TessellateParams::minVolume,
          {.min = 0,
           .max = 1,
           .openMax = true,
           .help =
               "parts smaller than this share of the body's volume join the neighbour that they touch most"})
      .number("min_volume_absolute", &TessellateParams::minVolumeAbsolute,
              {.unit = "m³", .min = 0, .help = "the same as a volume; the larger of the two counts"})
      .output<Fragments>("pieces", "closed pieces, each with its outer skin and its crack faces")
      .implementation(6)
      .run([](const TessellateParams& params, NodeIo& io) -> Result<void> {
        const auto cells = io.in<Partition>("cells");
        if (const auto mesh = io.in<TriMesh>("mesh")) {
          const TriMesh& own = *cells->embedding->tets->surface;
          if (mesh.get() != &own && (mesh->positions != own.positions || mesh->triangles != own.triangles))
            return failure("this mesh is not the one that the tetrahedra were made for",
                           "wire the same mesh to Tetrahedralize and to Tessellate, or leave this input out",
                           "mesh");
        }
        SHERD_ASSIGN(Fragments pieces, tessellate(*cells, params, io.exec()));
        report(pieces, params, io.exec());
        io.out("pieces", std::move(pieces));
        return {};
      });
}

}  // namespace sherd
