#include "graph/node_type.h"
#include "weights/weights.h"

namespace sherd {

NodeType weightsNode() {
  return NodeBuilder<WeightsParams>(
             "Weights", 1,
             "Turns strain energy and painted toughness into the weights that decide where it breaks.")
      .implementation(3)
      .input<EnergyField>("energy", "strain energy, from Simulate")
      .optionalInput<ScalarGrid>(
          "beta",
          "painted fragility β, from PaintBeta or ReadVDB: 1 leaves as is, 4 breaks like four "
          "times the energy, 0 never breaks; left open: 1 everywhere")
      .number(
          "alpha", &WeightsParams::alpha,
          {.unit = "",
           .min = 0,
           .max = 4,
           .help =
               "how strongly pieces gather where the energy is: 0 not at all (even sizes), 1 as the energy "
               "is, more for small pieces at the impact and large ones elsewhere"})
      .output<WeightField>("weights", "one weight per node, J")
      .run([](const WeightsParams& params, NodeIo& io) -> Result<void> {
        const auto beta = io.in<ScalarGrid>("beta");
        SHERD_ASSIGN(WeightField field,
                     weights(*io.in<EnergyField>("energy"), beta.get(), params, io.exec()));
        io.out("weights", std::move(field));
        return {};
      });
}

}  // namespace sherd
