#include "graph/node_type.h"
#include "load_mesh/load_mesh.h"

namespace sherd {

NodeType loadMeshNode() {
  using Params = LoadMeshParams;
  return NodeBuilder<Params>("LoadMesh", 1,
                             "Reads a triangle mesh (OBJ, PLY, STL, OFF, glTF, FBX and others), turns it to "
                             "metres and y up, and "
                             "makes sure that it bounds a solid.")
      .inputFile("file", &Params::file, "the mesh file")
      .choice("up", &Params::up, {{"auto", UpAxis::Auto}, {"y", UpAxis::Y}, {"z", UpAxis::Z}},
              "the axis that points up in the file; auto: as the file says, y where its format has no say")
      .number(
          "unit", &Params::unit,
          {.unit = "m",
           .min = 0,
           .help = "length of one unit of the file; 0: as the file says, 1 m where its format has no say"})
      .number(
          "length", &Params::length,
          {.unit = "m",
           .min = 0,
           .help = "real length of the longest side of the mesh's bounding box, instead of a unit; 0: off"})
      .choice("repair", &Params::repair, {{"auto", RepairMode::Auto}, {"strict", RepairMode::Strict}},
              "auto: mends what keeps the surface from bounding a solid and says what it did, as node Repair "
              "does; "
              "strict: refuses it, naming each defect and its place")
      // Only where a level set is the last resort. As in Tetrahedralize, which measured it.
      .uninterruptible("OpenVDB's meshToVolume", 1120)
      .output<TriMesh>("mesh", "the surface, facing outward, with its normals, UVs, colours and materials")
      .implementation(3)
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(TriMesh mesh, loadMesh(params, io.exec()));
        io.out("mesh", std::move(mesh));
        return {};
      });
}

}  // namespace sherd
