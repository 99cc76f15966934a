#include "graph/node_type.h"
#include "tetrahedralize/tetrahedralize.h"

namespace sherd {

NodeType tetrahedralizeNode() {
  return NodeBuilder<TetrahedralizeParams>(
             "Tetrahedralize", 1,
             "Fills the surface with a moderate tetrahedral mesh that strictly "
             "encloses it and has its topology, but for holes smaller than its edges; "
             "statics, distances and cells are computed on it.")
      .input<TriMesh>("mesh", "closed, manifold surface")
      .integer("tets", &TetrahedralizeParams::tets,
               {.min = 20,
                .max = 5e6,
                .help = "number of tetrahedra aimed at; narrow gaps and thin parts may need more"})
      .number("edge_length", &TetrahedralizeParams::edgeLength,
              {.unit = "m",
               .min = 0,
               .help = "mean edge length aimed at instead; 0: from the number of tetrahedra"})
      // It asks whether to go on only after each layer of voxels. Processor time of the longest one, for the
      // bunny's 163,582 triangles; half of that passes on two idle cores.
      .uninterruptible("OpenVDB's meshToVolume", 1120)
      .output<TetMesh>("tets", "the cage, with what of the surface each tetrahedron holds")
      .implementation(4)
      .run([](const TetrahedralizeParams& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(TetMesh cage, tetrahedralize(io.in<TriMesh>("mesh"), params, io.exec()));
        io.out("tets", std::move(cage));
        return {};
      });
}

}  // namespace sherd
