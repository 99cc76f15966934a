#include "embed/embed.h"
#include "graph/node_type.h"

namespace sherd {

NodeType embedNode() {
  using P = EmbedParams;
  return NodeBuilder<P>("Embed", 1,
                        "Gives every node coordinates in which distances are those inside the body.")
      .input<TetMesh>("tets", "the body, from Tetrahedralize")
      .optionalInput<RestShape>("rest",
                                "a warped shape that distances are taken from, from WarpRest; left open: the "
                                "body as it is")
      .optionalInput<ScalarGrid>(
          "stretch",
          "by how much lengths count, painted by PaintBeta along curves that draw cracks: 1 as is, 5 five "
          "times as "
          "much; thick enough to go through a wall from side to side. Left open: 1 everywhere")
      .choice(
          "metric", &P::metric,
          {{"auto", P::Metric::Auto}, {"euclidean", P::Metric::Euclidean}, {"interior", P::Metric::Interior}},
          "auto: straight distances in a convex body, otherwise those inside; euclidean: straight ones, "
          "cells "
          "may reach across gaps; interior: always those inside")
      .choice("source", &P::source,
              {{"solid", P::Source::Solid}, {"surface", P::Source::Surface}, {"fine", P::Source::Fine}},
              "what the eigenmodes are taken of. solid: the tetrahedra, right for thin walls; surface: their "
              "boundary, as in Rustamov et al. 2009; fine: the model's own surface, which takes many times "
              "longer")
      .choice("filter", &P::filter,
              {{"unfolded", P::Filter::Unfolded},
               {"fitted", P::Filter::Fitted},
               {"diffusion", P::Filter::Diffusion}},
              "how modes become coordinates. unfolded: combined so that straight distances match ways inside "
              "best; "
              "fitted: each weighed on its own to the same end; diffusion: weighed by exp(−λ t), as in "
              "Rustamov et al. "
              "2009")
      .choice("extension", &P::extension,
              {{"harmonic", P::Extension::Harmonic}, {"mvc", P::Extension::MeanValue}},
              "how surface modes are carried inward, where source is surface or fine. mvc: mean value "
              "coordinates")
      .integer("dimensions", &P::dimensions,
               {.unit = "", .min = 1, .max = 1000, .help = "eigenmodes computed, at most"})
      .number("tolerance", &P::tolerance,
              {.unit = "",
               .min = 0,
               .max = 1,
               .openMax = true,
               .help = "modes that matter less, relative to the one that matters most, are left out"})
      .number(
          "time", &P::time,
          {.unit = "",
           .min = 0,
           .max = 100,
           .openMin = true,
           .help =
               "diffusion time in units of 1/λ_1, where filter is diffusion: short keeps local detail, long "
               "keeps the overall shape"})
      .output<Embedding>("embedding", "coordinates per node")
      .implementation(2)
      .run([](const P& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(Embedding embedding, embed(io.in<TetMesh>("tets"), params, io.exec(),
                                                {.rest = io.in<RestShape>("rest").get(),
                                                 .stretch = io.in<ScalarGrid>("stretch").get()}));
        io.out("embedding", std::move(embedding));
        return {};
      });
}

}  // namespace sherd
