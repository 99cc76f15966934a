#include <array>

#include "beta/write_vdb.h"
#include "graph/node_type.h"

namespace sherd {

NodeType writeVdbNode() {
  using Params = WriteVdbParams;
  NodeBuilder<Params> node(
      "WriteVDB", 1,
      "Writes up to four painted fields into one OpenVDB file, as Blender, Houdini and ReadVDB "
      "read it, each as a grid of float or half under its own name.");
  node.uninterruptible("OpenVDB's grid writing", 1300);  // of 9 million voxels
  return node.input<ScalarGrid>("grid", "the field to write, from PaintBeta or ReadVDB")
      .optionalInput<ScalarGrid>("grid_2", "another one for the same file")
      .optionalInput<ScalarGrid>("grid_3", "another one for the same file")
      .optionalInput<ScalarGrid>("grid_4", "another one for the same file")
      .outputFile("file", &Params::file, "the .vdb file to write")
      .text("name", &Params::name, "of `grid` in the file; empty: the one that it has")
      .choice("precision", &Params::precision,
              {{"float", Params::Precision::Float}, {"half", Params::Precision::Half}},
              "half: half the size, three digits, values up to 65504")
      .choice("grid_class", &Params::gridClass,
              {{"same", Params::GridClass::Same},
               {"fog", Params::GridClass::Fog},
               {"level_set", Params::GridClass::LevelSet}},
              "what other programs take it for; same: what it was made as")
      .choice("up", &Params::up, {{"same", Params::Up::Same}, {"y", Params::Up::Y}, {"z", Params::Up::Z}},
              "the axis that points up in the file; same: that of the mesh or file that it came from; "
              "Blender's is z")
      .number("unit", &Params::unit,
              {.unit = "m", .min = 0, .help = "length of one unit in the file; 0: as it came"})
      .output<std::string>("file", "path of the file")
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        std::vector<ScalarGrid> grids;
        for (const char* port : {"grid", "grid_2", "grid_3", "grid_4"})
          if (const auto grid = io.in<ScalarGrid>(port)) grids.push_back(*grid);
        SHERD_CHECK(writeVdb(grids, params, io.exec()));
        io.wrote(params.file);
        io.out("file", params.file);
        return {};
      });
}

}  // namespace sherd
