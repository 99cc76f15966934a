#include "graph/node_type.h"
#include "warp_rest/warp_rest.h"

namespace sherd {

NodeType warpRestNode() {
  using P = WarpRestParams;
  return NodeBuilder<P>(
             "WarpRest", 1,
             "Gives pieces a direction, and cracks waves and roughness: bends the shape that distances are "
             "taken from, never the body itself. Goes into `rest` of Embed.")
      .input<TetMesh>("tets", "the body, from Tetrahedralize")
      .optionalInput<RestShape>("rest", "a WarpRest to go on from; left open: the body as it is")
      .number(
          "elongation", &P::elongation,
          {.unit = "",
           .min = 0.01,
           .max = 100,
           .help =
               "4: pieces about four times as long along `axis` as across, like splinters; 0.25: a quarter "
               "as long, like plates; 1: as they are. Their number stays about the same"})
      .vector3("axis", &P::axis,
               {.unit = "", .help = "the direction along which pieces are long; any length"})
      .number("wave_amplitude", &P::waveAmplitude,
              {.unit = "m", .min = 0, .help = "how far waves displace a crack to either side; 0: no waves"})
      .number("wave_length", &P::waveLength,
              {.unit = "m", .min = 0, .help = "from crest to crest; 0: a quarter of the body's diagonal"})
      .vector3("wave_travel", &P::waveTravel,
               {.unit = "", .help = "the direction in which crest follows crest; any length"})
      .vector3("wave_shift", &P::waveShift,
               {.unit = "",
                .help = "the direction in which cracks are displaced; any length. Cracks across it show "
                        "the waves most"})
      .number("roughness", &P::roughness,
              {.unit = "m", .min = 0, .help = "how far cracks are displaced at random; 0: smooth"})
      .number("roughness_size", &P::roughnessSize,
              {.unit = "m",
               .min = 0,
               .help = "how coarse that is, from bump to bump; 0: a sixteenth of the body's diagonal"})
      .integer("seed", &P::seed, {.unit = "", .help = "another seed gives other roughness"})
      .output<RestShape>("rest", "a place for every node, for `rest` of Embed")
      .run([](const P& params, NodeIo& io) -> Result<void> {
        const auto from = io.in<RestShape>("rest");
        SHERD_ASSIGN(RestShape rest, warpRest(io.in<TetMesh>("tets"), from.get(), params, io.exec()));
        io.out("rest", std::move(rest));
        return {};
      });
}

}  // namespace sherd
