#include "export/export_crack_surface.h"
#include "graph/node_type.h"

namespace sherd {

NodeType exportCrackSurfaceNode() {
  using Params = ExportCrackSurfaceParams;
  return NodeBuilder<Params>(
             "ExportCrackSurface", 1,
             "Writes every piece as two files, its outer skin and its crack faces, and pieces.json "
             "with masses, volumes, inertia, neighbours and bonds. Beside them sherd_manifest.json, a list "
             "of what "
             "was written: the next run replaces or removes what is on it, and nothing else in the directory "
             "is "
             "touched. Keep it with the files; without it the next run takes them for yours and refuses to "
             "write over them.")
      .input<Fragments>("pieces", "the pieces to write")
      .outputDirectory("directory", &Params::directory, "where the files go; created where it is missing")
      .choice(
          "format", &Params::format, {{"obj", Params::Format::Obj}, {"ply", Params::Format::Ply}},
          "obj (text; first UV set; pieces.mtl and its textures, where the mesh's materials are more than "
          "names) or ply (binary, double; all UV sets and colours; materials' names only)")
      .choice("crack_normals", &Params::crackNormals,
              {{"smooth", CrackNormals::Smooth}, {"flat", CrackNormals::Flat}}, kCrackNormalsHelp)
      .number("texture_density", &Params::textureDensity,
              {.unit = "1/m", .min = 0, .openMin = true, .help = kTextureDensityHelp})
      .output<std::string>("manifest", "path of pieces.json")
      .implementation(4)
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(ExportReport report, exportCrackSurface(*io.in<Fragments>("pieces"), params, io.exec()));
        for (std::string& file : report.files) io.wrote(std::move(file));
        io.out("manifest", std::move(report.description));
        return {};
      });
}

}  // namespace sherd
