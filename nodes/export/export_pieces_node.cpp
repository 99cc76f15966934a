#include "export/export_pieces.h"
#include "graph/node_type.h"

namespace sherd {

NodeType exportPiecesNode() {
  using Params = ExportPiecesParams;
  return NodeBuilder<Params>("ExportPieces", 1,
                             "Writes all pieces as one GLB file, pieces.glb: an object for each with its "
                             "pivot at the centre of "
                             "mass, in metres, y up, with the artist's materials, normals, UVs and colours "
                             "outside and generated "
                             "ones inside; masses, volumes and neighbours as custom properties. Beside it "
                             "sherd_pieces_manifest.json, which tells the next run that the file is ours; "
                             "nothing else in the directory is touched.")
      .input<Fragments>("pieces", "the pieces to write")
      .outputDirectory("directory", &Params::directory, "where the file goes; created where it is missing")
      .choice("crack_normals", &Params::crackNormals,
              {{"smooth", CrackNormals::Smooth}, {"flat", CrackNormals::Flat}}, kCrackNormalsHelp)
      .number("texture_density", &Params::textureDensity,
              {.unit = "1/m", .min = 0, .openMin = true, .help = kTextureDensityHelp})
      .output<std::string>("file", "path of pieces.glb")
      .implementation(2)
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(ExportPiecesReport report, exportPieces(*io.in<Fragments>("pieces"), params, io.exec()));
        for (std::string& file : report.files) io.wrote(std::move(file));
        io.out("file", std::move(report.file));
        return {};
      });
}

}  // namespace sherd
