#include "export/export_crack_surface.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "export/owned_files.h"
#include "export/piece_files.h"
#include "export/pieces_json.h"

namespace sherd {
namespace {

using Params = ExportCrackSurfaceParams;

constexpr const char* kDescription = "pieces.json";

/// What is made of the pieces before files are written.
struct Content {
  const Fragments& f;
  CrackAttributes cracks;
  std::vector<Bond> bonds;
};

std::string bytesOf(const Content& content, std::size_t p, bool crack, Params::Format format) {
  const Fragments& f = content.f;
  const Piece& piece = f.pieces[p];
  if (format == Params::Format::Obj)
    return crack ? crackObj(f, piece, content.cracks.pieces[p]) : surfaceObj(f, piece);
  return crack ? crackPly(f, piece, content.cracks.pieces[p]) : surfacePly(f, piece);
}

Result<void> checkInput(const Fragments& f) {
  if (!f.tets || !f.tets->surface || f.pieces.empty())
    return failure("there are no pieces to export", "wire Tessellate's `pieces`", "pieces");
  for (const Piece& piece : f.pieces)
    if (!OwnedFiles::canBeOurs(piece.name + "_surface.obj"))
      return failure("'" + piece.name + "' cannot be a piece's name", "it has to be like piece_0001",
                     "pieces");
  return {};
}

/// One file to be written: a piece's surface or crack.
struct Job {
  std::size_t piece;
  bool crack;
};

/// What writing one file gave.
struct Outcome {
  std::optional<Error> error;
  Digest digest;
  bool written = false;
};

/// Puts content under names. The description of an earlier run's pieces goes before the first file that
/// changes, so that it never stands beside pieces that it doesn't describe.
class Writer {
 public:
  explicit Writer(const OwnedFiles& files) : files_(files) {}

  /// Safe from several threads at once, under different names.
  Outcome put(const std::string& name, const std::string& bytes) {
    Outcome outcome;
    outcome.digest = Hasher().add(bytes).digest();
    const std::string path = files_.path(name);
    if (fileHolds(path, bytes)) return outcome;
    std::call_once(withdrawn_, [this] { withdrawal_ = files_.withdraw(kDescription); });
    if (!withdrawal_.ok()) {
      outcome.error = withdrawal_.error();
      return outcome;
    }
    const auto change = writeFileAtomically(path, bytes);
    if (change.ok())
      outcome.written = *change == FileChange::Written;
    else
      outcome.error = change.error();
    return outcome;
  }

 private:
  const OwnedFiles& files_;
  std::once_flag withdrawn_;
  Result<void> withdrawal_;
};

/// Writes all of the pieces' files, in parallel; stops early on cancel.
std::vector<Outcome> writePieces(const Content& content, Params::Format format, const std::vector<Job>& jobs,
                                 const std::vector<std::string>& names, Writer& writer, const Exec& exec) {
  std::vector<Outcome> outcomes(jobs.size());
  std::atomic<std::size_t> done{0};
  parallelFor(exec, jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      outcomes[i] = writer.put(names[i], bytesOf(content, jobs[i].piece, jobs[i].crack, format));
      exec.progress(static_cast<double>(++done) / static_cast<double>(jobs.size()));
    }
  });
  return outcomes;
}

void warnOfLosses(const TriMesh& source, const Params& params, const Exec& exec) {
  if (params.format != Params::Format::Obj) return;
  const std::size_t uvs = source.uvSets.size() > 1 ? source.uvSets.size() - 1 : 0;
  const std::size_t colours = source.colorSets.size();
  if (uvs + colours == 0) return;
  const auto count = [](std::size_t n, const char* what) {
    return n == 0 ? std::string() : fmt::format("{} {} set{}", n, what, n == 1 ? "" : "s");
  };
  exec.warn(fmt::format("OBJ holds {}{}{}: {}{}{} {} left out; format ply keeps {}",
                        uvs > 0 ? "the first UV set only" : "", uvs > 0 && colours > 0 ? ", and " : "",
                        colours > 0 ? "no colours" : "", count(uvs, "more UV"),
                        uvs > 0 && colours > 0 ? " and " : "", count(colours, "colour"),
                        uvs + colours == 1 ? "is" : "are", uvs + colours == 1 ? "it" : "them"));
}

/// E_D and γ in words.
std::string verdict(const Fragments& f) {
  if (f.degreeGiven) return fmt::format("E_D = {:.4g} J·m², degree given", f.energy);
  return fmt::format("E_D = {:.4g} J·m² is {} γ = {:.4g} J·m²", f.energy,
                     f.energy < f.gamma ? "below" : "not below", f.gamma);
}

void sayOutcome(const Fragments& f, const std::string& directory, const ExportReport& report,
                const Exec& exec) {
  if (f.sites == 1 && f.pieces.size() == 1)
    exec.info(
        fmt::format("nothing broke: {}; one whole piece, without crack faces, in {}", verdict(f), directory));
  else
    exec.info(fmt::format("{} piece{} from {} sites ({}) in {}", f.pieces.size(),
                          f.pieces.size() == 1 ? "" : "s", f.sites, verdict(f), directory));
  if (report.removed > 0)
    exec.info(
        fmt::format("removed {} file{} of an earlier run", report.removed, report.removed == 1 ? "" : "s"));
}

/// What is going to be written, the description last.
struct Plan {
  std::vector<Job> jobs;
  std::vector<std::string> names;  ///< one per job, and the description's
  std::vector<PieceFileNames> pieceFiles;
};

Plan plan(const Fragments& f, const Params& params) {
  const char* extension = params.format == Params::Format::Obj ? ".obj" : ".ply";
  Plan plan;
  plan.pieceFiles.resize(f.pieces.size());
  for (std::size_t p = 0; p < f.pieces.size(); ++p) {
    plan.jobs.push_back({p, false});
    plan.names.push_back(plan.pieceFiles[p].surface = f.pieces[p].name + "_surface" + extension);
    if (f.pieces[p].crack.empty()) continue;
    plan.jobs.push_back({p, true});
    plan.names.push_back(plan.pieceFiles[p].crack = f.pieces[p].name + "_crack" + extension);
  }
  plan.names.push_back(kDescription);
  return plan;
}

Result<ExportReport> writeInto(const Content& content, const Params& params, const Exec& exec) {
  const Fragments& f = content.f;
  const auto [jobs, names, pieceFiles] = plan(f, params);
  SHERD_CHECK(makeDirectory(params.directory));
  SHERD_ASSIGN(const OwnedFiles files, OwnedFiles::open(params.directory, names));
  warnOfLosses(*f.tets->surface, params, exec);
  warnOfNames(*f.tets->surface, exec);
  if (exec.cancelled()) return cancelledError();
  SHERD_CHECK(files.claim());
  Writer writer(files);
  std::vector<Outcome> outcomes = writePieces(content, params.format, jobs, names, writer, exec);
  if (exec.cancelled()) return cancelledError();
  for (const Outcome& outcome : outcomes)
    if (outcome.error) return *outcome.error;
  outcomes.push_back(writer.put(kDescription, piecesJson(f, content.bonds, pieceFiles)));
  if (outcomes.back().error) return *outcomes.back().error;

  ExportReport report;
  std::vector<Digest> digests;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    digests.push_back(outcomes[i].digest);
    report.files.push_back(files.path(names[i]));
    ++(outcomes[i].written ? report.written : report.kept);
  }
  SHERD_ASSIGN(report.removed, files.commit(digests));
  report.files.push_back(files.path(OwnedFiles::manifestName));
  report.description = files.path(kDescription);
  sayOutcome(f, params.directory, report, exec);
  return report;
}

}  // namespace

Result<ExportReport> exportCrackSurface(const Fragments& f, const Params& params, const Exec& exec) {
  SHERD_CHECK(checkInput(f));
  SHERD_ASSIGN(CrackAttributes cracks, styledCracks(f, {params.crackNormals, params.textureDensity}, exec));
  SHERD_ASSIGN(std::vector<Bond> bonds, findBonds(f, exec));
  const Content content{f, std::move(cracks), std::move(bonds)};
  Result<ExportReport> report = writeInto(content, params, exec);
  if (report.ok() || report.error().kind == Error::Kind::Cancelled) return report;
  Error error = report.error();
  error.port = "directory";
  return error;
}

}  // namespace sherd
