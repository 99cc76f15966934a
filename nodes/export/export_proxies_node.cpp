#include "export/export_proxies.h"
#include "graph/node_type.h"

namespace sherd {

NodeType exportProxiesNode() {
  using Params = ExportProxiesParams;
  return NodeBuilder<Params>(
             "ExportProxies", 1,
             "Writes the pieces' convex hulls as OBJ, one object and group per hull, and proxies.json "
             "with masses, inertia, volume errors and overlaps. Beside them sherd_proxies_manifest.json, a "
             "list of "
             "what was written: the next run replaces or removes what is on it, and nothing else in the "
             "directory is touched. Keep it with the files; without it the next run takes them for yours and "
             "refuses to write over them.")
      .input<Proxies>("proxies", "the hulls to write, from ConvexProxies")
      .outputDirectory("directory", &Params::directory, "where the files go; created where it is missing")
      .choice(
          "files", &Params::files, {{"pieces", Params::Files::Pieces}, {"one", Params::Files::One}},
          "pieces: piece_0001_hulls.obj and so on, as Bullet's loaders take them; one: proxies.obj for all")
      .output<std::string>("manifest", "path of proxies.json")
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(ExportProxiesReport report,
                     exportProxies(*io.in<Proxies>("proxies"), params, io.exec()));
        for (std::string& file : report.files) io.wrote(std::move(file));
        io.out("manifest", std::move(report.description));
        return {};
      });
}

}  // namespace sherd
