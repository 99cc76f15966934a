#include "graph/node_type.h"
#include "predict_degree/calibrate_toughness.h"

namespace sherd {

NodeType calibrateToughnessNode() {
  using Params = CalibrateToughnessParams;
  return NodeBuilder<Params>(
             "CalibrateToughness", 1,
             "Finds the toughness γ by example: the threshold at which this hit breaks the body into so many "
             "pieces. Other hits then break it with the same γ, harder ones into more.")
      .input<WeightField>("weights", "what each node weighs in the example, from Weights")
      .input<Embedding>("embedding", "the distances to measure with, from Embed")
      .integer(
          "pieces", &Params::pieces,
          {.unit = "",
           .min = 1,
           .max = 1e6,
           .help = "into how many cells the example breaks; 1: it just withstands a hit of nearly twice the "
                   "energy. Above PredictDegree.max_degree, raise that, too"})
      .integer("seed", &Params::seed,
               {.unit = "",
                .help = "that of the PredictDegree to come: it then breaks the example into exactly so many; "
                        "with another seed into about as many"})
      .output<double>("gamma", "the threshold γ, to be wired to PredictDegree.gamma, J·m²")
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        const auto pinned = io.in<Sites>("pinned");
        SHERD_ASSIGN(const double gamma,
                     calibrateToughness(*io.in<WeightField>("weights"), *io.in<Embedding>("embedding"),
                                        pinned.get(), params, io.exec()));
        io.out("gamma", gamma);
        return {};
      });
}

}  // namespace sherd
