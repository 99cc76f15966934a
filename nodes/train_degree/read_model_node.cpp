#include "graph/node_type.h"
#include "train_degree/model_file.h"

namespace sherd {

NodeType readModelNode() {
  return NodeBuilder<ModelFileParams>(
             "ReadModel", 1,
             "Reads what was learned from a file of WriteModel. It serves the same body, made into the same "
             "tetrahedra and embedding, of the same material, β, α and γ; PredictDegree says what differs.")
      .inputFile("file", &ModelFileParams::file, "the file, written by WriteModel")
      .output<DegreeModel>("model", "what was learned, for PredictDegree")
      .run([](const ModelFileParams& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(DegreeModel model, readModel(params, io.exec()));
        io.out("model", std::move(model));
        return {};
      });
}

}  // namespace sherd
