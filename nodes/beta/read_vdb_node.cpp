#include "beta/read_vdb.h"
#include "graph/node_type.h"

namespace sherd {

NodeType readVdbNode() {
  using Params = ReadVdbParams;
  return NodeBuilder<Params>(
             "ReadVDB", 1, "Reads a painted scalar field from an OpenVDB file: a float, half or double grid.")
      .inputFile("file", &Params::file, "the .vdb file")
      .text("grid", &Params::grid, "name of the grid; empty: the first one of floats or doubles")
      .number("unit", &Params::unit,
              {.unit = "m",
               .min = 0,
               .openMin = true,
               .help = "length of one unit of the grid's space; the same as the mesh's"})
      .choice("up", &Params::up, {{"y", FileFrame::Up::Y}, {"z", FileFrame::Up::Z}},
              "the axis that points up in the grid's space; the same as the mesh's")
      .output<ScalarGrid>("grid", "the field; its background outside of the painted voxels")
      .implementation(2)
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(ScalarGrid grid, readVdb(params, io.exec()));
        io.out("grid", std::move(grid));
        return {};
      });
}

}  // namespace sherd
