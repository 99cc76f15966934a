#include "cvd/cvd.h"
#include "graph/node_type.h"

namespace sherd {

NodeType cvdNode() {
  return NodeBuilder<CvdParams>("CVD", 1,
                                "Places the cells that the body breaks into: small where the energy is.")
      .input<WeightField>("weights", "what each node weighs, from Weights")
      .input<Embedding>("embedding", "the distances to measure with, from Embed")
      .optionalInput<Sites>("sites",
                            "sites to start from, from PredictDegree or PinSites; left open: grown from one")
      .integer("degree", &CvdParams::degree,
               {.unit = "",
                .min = 0,
                .max = 1e6,
                .help = "number of sites; 0: as many as `sites` has. May be wired to PredictDegree.degree"})
      .integer("seed", &CvdParams::seed,
               {.unit = "",
                .help = "another seed gives other cells of the same number (where sites are grown here)"})
      .choice(
          "labels", &CvdParams::labels, {{"exact", Labels::Exact}, {"flood", Labels::Flood}},
          "exact: every node belongs to its nearest site; flood: the paper's flooding over the mesh, which "
          "depends on the order of visits and is slower here")
      .number("tolerance", &CvdParams::tolerance,
              {.unit = "",
               .min = 0,
               .max = 1,
               .help = "the iteration ends when no site moves farther, relative to the embedding's diameter"})
      .integer("max_iterations", &CvdParams::maxIterations,
               {.unit = "", .min = 1, .max = 1e6, .help = "passes of Lloyd's iteration at most"})
      .output<Partition>("cells", "every node's nearest site")
      .output<std::int64_t>("degree", "number of sites")
      .output<double>("energy", "E_D, J·m²")
      .implementation(4)
      .run([](const CvdParams& params, NodeIo& io) -> Result<void> {
        const auto sites = io.in<Sites>("sites");
        SHERD_ASSIGN(Partition cells, cvd(io.in<Embedding>("embedding"), *io.in<WeightField>("weights"),
                                          sites.get(), params, io.exec()));
        io.out("degree", static_cast<std::int64_t>(cells.siteCount()));
        io.out("energy", cells.energy);
        io.out("cells", std::move(cells));
        return {};
      });
}

}  // namespace sherd
