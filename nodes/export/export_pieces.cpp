#include "export/export_pieces.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "export/glb_pieces.h"
#include "export/owned_files.h"

namespace sherd {
namespace {

constexpr const char* kFile = "pieces.glb";

Result<std::string> bytesOf(const Fragments& f, const ExportPiecesParams& params, const Exec& exec) {
  SHERD_ASSIGN(const CrackAttributes cracks,
               styledCracks(f, {params.crackNormals, params.textureDensity}, exec));
  SHERD_ASSIGN(const std::vector<Bond> bonds, findBonds(f, exec));
  SHERD_ASSIGN(const GlbScene scene, glbScene(f, cracks, bonds, exec));
  return writeGlb(scene);
}

Result<ExportPiecesReport> writeInto(const std::string& directory, const std::string& bytes,
                                     const Exec& exec) {
  SHERD_CHECK(makeDirectory(directory));
  SHERD_ASSIGN(const OwnedFiles files, OwnedFiles::open(directory, {kFile}, OwnedFiles::piecesManifest));
  if (exec.cancelled()) return cancelledError();
  SHERD_CHECK(files.claim());
  ExportPiecesReport report;
  report.file = files.path(kFile);
  SHERD_ASSIGN(const FileChange change, writeFileAtomically(report.file, bytes));
  SHERD_ASSIGN([[maybe_unused]] const std::size_t removed, files.commit({Hasher().add(bytes).digest()}));
  report.written = change == FileChange::Written;
  report.files = {report.file, files.path(OwnedFiles::piecesManifest)};
  return report;
}

}  // namespace

Result<ExportPiecesReport> exportPieces(const Fragments& f, const ExportPiecesParams& params,
                                        const Exec& exec) {
  if (!f.tets || !f.tets->surface || f.pieces.empty())
    return failure("there are no pieces to export", "wire Tessellate's `pieces`", "pieces");
  warnOfNames(*f.tets->surface, exec);
  SHERD_ASSIGN(const std::string bytes, bytesOf(f, params, exec));
  Result<ExportPiecesReport> report = writeInto(params.directory, bytes, exec);
  if (!report.ok()) {
    Error error = report.error();
    if (error.kind != Error::Kind::Cancelled) error.port = "directory";
    return error;
  }
  exec.info(fmt::format("{} piece{} in {}", f.pieces.size(), f.pieces.size() == 1 ? "" : "s", report->file));
  return report;
}

}  // namespace sherd
