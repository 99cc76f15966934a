#include "graph/node_type.h"
#include "protect/protect.h"

namespace sherd {

NodeType protectNode() {
  return NodeBuilder<ProtectParams>("Protect", 1,
                                    "Keeps painted regions whole: cracks run around them. Goes between Embed "
                                    "and what takes its embedding.")
      .input<Embedding>("embedding", "the distances to change, from Embed")
      .input<ScalarGrid>(
          "field",
          "what is protected, painted by PaintBeta or from ReadVDB: 1 where it must not break, "
          "with a background of 0")
      .number("threshold", &ProtectParams::threshold, {.unit = "", .help = "the field protects from here on"})
      .output<Embedding>("embedding", "with one place for each protected region, for PredictDegree and CVD")
      .run([](const ProtectParams& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(Embedding out,
                     protect(*io.in<Embedding>("embedding"), *io.in<ScalarGrid>("field"), params, io.exec()));
        io.out("embedding", std::move(out));
        return {};
      });
}

}  // namespace sherd
