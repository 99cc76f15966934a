#include "repair/repair.h"

#include "graph/node_type.h"

namespace sherd {

NodeType repairNode() {
  using Params = RepairParams;
  return NodeBuilder<Params>("Repair", 1,
                             "Makes a surface bound a solid: double and flat faces, cracks, holes, faces the "
                             "wrong way round, parts "
                             "that cross or lie in each other. The log names each defect and what was done; "
                             "warnings tell of what "
                             "can be seen. A sound surface passes as it is.")
      .input<TriMesh>("mesh", "any triangle surface")
      .choice("mode", &Params::mode,
              {{"auto", Params::Mode::Auto},
               {"strict", Params::Mode::Strict},
               {"rebuild", Params::Mode::Rebuild}},
              "auto: mends, in the end by a level set; strict: refuses what is not sound; rebuild: the level "
              "set at "
              "once")
      .choice(
          "inner_shells", &Params::innerShells,
          {{"solid", Params::InnerShells::Solid}, {"void", Params::InnerShells::Void}},
          "what a closed part within the solid that faces outward stands for: nothing (left out), or a void")
      .number("crack", &Params::crack,
              {.min = 0,
               .max = 1,
               .help = "open edges closer than this share of the object's diagonal are joined"})
      .number("small_hole", &Params::smallHole,
              {.min = 0,
               .max = 1,
               .help = "holes above this share of the diagonal are filled with a warning; stray sheets on "
                       "the solid, of less area than its square, are left out"})
      .number("leaf", &Params::leaf,
              {.min = 1e-6,
               .max = 1,
               .help = "thickness, as a share of the diagonal, given to parts without a solid behind them"})
      .integer("resolution", &Params::resolution,
               {.min = 8, .max = 2048, .help = "voxels along the diagonal, where a level set is needed"})
      // Only where a level set is the last resort. As in Tetrahedralize, which measured it.
      .uninterruptible("OpenVDB's meshToVolume", 1120)
      .implementation(2)
      .output<TriMesh>("mesh", "closed, facing outward, free of self-intersections")
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        const auto given = io.in<TriMesh>("mesh");
        SHERD_ASSIGN(Repaired repaired, repair(*given, params, io.exec()));
        if (repaired.report.stage == RepairStage::None)
          io.outShared("mesh", given);
        else
          io.out("mesh", std::move(repaired.mesh));
        return {};
      });
}

}  // namespace sherd
