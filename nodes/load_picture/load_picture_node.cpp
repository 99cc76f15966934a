#include "graph/node_type.h"
#include "load_picture/load_picture.h"

namespace sherd {

NodeType loadPictureNode() {
  using Params = LoadPictureParams;
  return NodeBuilder<Params>(
             "LoadPicture", 1,
             "Reads a PNG, such as the texture of a mesh that PaintBeta paints by. Values stay as "
             "they are in the file, eight bits each; transparency is left out.")
      .inputFile("file", &Params::file, "the PNG file")
      .output<Picture>("picture", "the picture")
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(Picture picture, loadPicture(params, io.exec()));
        io.out("picture", std::move(picture));
        return {};
      });
}

}  // namespace sherd
