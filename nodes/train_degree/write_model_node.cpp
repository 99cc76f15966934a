#include "graph/node_type.h"
#include "train_degree/model_file.h"

namespace sherd {

NodeType writeModelNode() {
  return NodeBuilder<ModelFileParams>("WriteModel", 1,
                                      "Writes what TrainDegree learned into a file, to be read by ReadModel "
                                      "in other shots or on other machines.")
      .input<DegreeModel>("model", "what was learned, from TrainDegree")
      .outputFile("file", &ModelFileParams::file, "the file to write, such as horse.model")
      .output<std::string>("file", "path of the file")
      .writesFiles()
      .run([](const ModelFileParams& params, NodeIo& io) -> Result<void> {
        SHERD_CHECK(writeModel(*io.in<DegreeModel>("model"), params, io.exec()));
        io.wrote(params.file);
        io.out("file", params.file);
        return {};
      });
}

}  // namespace sherd
