#include "select_piece/select_piece.h"

#include <fmt/format.h>

#include "graph/node_type.h"

namespace sherd {

NodeType selectPieceNode() {
  return NodeBuilder<SelectPieceParams>(
             "SelectPiece", 1, "Takes one piece of a fracture as a body of its own, to be broken again.")
      .input<Fragments>("pieces", "the pieces to choose from, from Tessellate")
      .text("piece", &SelectPieceParams::piece, "its name, such as piece_0003; left empty: by `number`")
      .integer("number", &SelectPieceParams::number,
               {.min = 1, .max = 1e6, .help = "by size: 1 is the largest piece, 2 the next"})
      .output<TriMesh>("mesh", "its closed surface, crack faces in the material `inside`; for Tetrahedralize")
      .output<std::string>("name", "the piece's name")
      .output<double>("density", "the body's, for Simulate's `density`, kg/m³")
      .output<double>("young", "the body's, for Simulate's `young`, Pa")
      .output<double>("poisson", "the body's, for Simulate's `poisson`")
      .implementation(2)
      .run([](const SelectPieceParams& params, NodeIo& io) -> Result<void> {
        const auto pieces = io.in<Fragments>("pieces");
        SHERD_ASSIGN(SelectedPiece selected, selectPiece(*pieces, params, io.exec()));
        io.exec().info(fmt::format("{} of {}, {} triangles", selected.mesh.piece, pieces->pieces.size(),
                                   selected.mesh.triangles.size()));
        if (selected.touching > 0)
          io.exec().info(fmt::format("parts of it touch: {} vertices doubled", selected.touching));
        io.out("name", selected.mesh.piece);
        io.out("density", pieces->material.density);
        io.out("young", pieces->material.youngModulus);
        io.out("poisson", pieces->material.poissonRatio);
        io.out("mesh", std::move(selected.mesh));
        return {};
      });
}

}  // namespace sherd
