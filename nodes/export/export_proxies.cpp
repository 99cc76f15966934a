#include "export/export_proxies.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "export/owned_files.h"
#include "export/text_buffer.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;
using Params = ExportProxiesParams;

constexpr const char *kDescription = "proxies.json", *kAll = "proxies.obj";

/// One file's name and content.
struct File {
  std::string name, bytes;
};

std::string fileOf(const PieceProxy& piece, const Params& params) {
  return params.files == Params::Files::One ? kAll : piece.name + "_hulls.obj";
}

/// Appends the piece's hulls. `base`: vertices that the file holds already.
void addHulls(const PieceProxy& piece, const FileFrame& frame, std::size_t& base, TextBuffer& obj) {
  for (std::size_t h = 0; h < piece.hulls.size(); ++h) {
    const ConvexHull& hull = piece.hulls[h];
    const std::string name = hullName(piece.name, h);
    obj << "o " << name << "\ng " << name << '\n';
    for (const Vec3& p : hull.positions) obj.row<3>("v", frame.toFile(p));
    for (const Triangle& t : hull.triangles) {
      obj << 'f';
      for (const Index v : t) obj << ' ' << static_cast<std::int64_t>(base + at(v) + 1);
      obj << '\n';
    }
    base += hull.positions.size();
  }
}

std::vector<File> objFiles(const Proxies& proxies, const Params& params) {
  std::vector<File> files;
  TextBuffer obj;
  std::size_t base = 0;
  for (std::size_t p = 0; p < proxies.pieces.size(); ++p) {
    addHulls(proxies.pieces[p], proxies.frame, base, obj);
    if (params.files == Params::Files::One && p + 1 < proxies.pieces.size()) continue;
    files.push_back({fileOf(proxies.pieces[p], params), obj.take()});
    obj = {};
    base = 0;
  }
  return files;
}

Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json describe(const PieceProxy& p, const Params& params) {
  Json json;
  json["name"] = p.name;
  json["file"] = fileOf(p, params);
  json["mass"] = p.mass;
  json["centre_of_mass"] = vector(p.centreOfMass);
  json["inertia"] =
      Json::array({vector(p.inertia.row(0)), vector(p.inertia.row(1)), vector(p.inertia.row(2))});
  json["piece_volume"] = p.pieceVolume;
  json["volume"] = p.volume;
  json["volume_error"] = p.error;
  json["overlap"] = p.overlap;
  json["hulls"] = Json::array();
  for (std::size_t h = 0; h < p.hulls.size(); ++h)
    json["hulls"].push_back({{"name", hullName(p.name, h)},
                             {"volume", p.hulls[h].volume},
                             {"vertices", p.hulls[h].positions.size()},
                             {"triangles", p.hulls[h].triangles.size()}});
  return json;
}

std::string descriptionOf(const Proxies& proxies, const Params& params) {
  Json json;
  json["format"] = 1;
  json["about"] =
      "Convex hulls of the pieces of a fracture. mass kg, centre_of_mass m and inertia kg m^2 about it, of "
      "the "
      "piece; volumes m^3; volume_error: by which share of the piece its hulls are larger; overlap: volume "
      "that "
      "lies in other pieces' hulls too; right-handed axes, y up. Coordinates in the files are in the source "
      "file's own unit and axes, as files_frame tells.";
  json["files_frame"] = {{"metres_per_unit", proxies.frame.metresPerUnit},
                         {"up", proxies.frame.up == FileFrame::Up::Y ? "y" : "z"}};
  std::size_t hulls = 0;
  double error = 0, overlap = 0;
  for (const PieceProxy& p : proxies.pieces) {
    hulls += p.hulls.size();
    error = std::max(error, p.error);
    if (p.pieceVolume > 0) overlap = std::max(overlap, p.overlap / p.pieceVolume);
  }
  json["piece_count"] = proxies.pieces.size();
  json["hull_count"] = hulls;
  json["largest_volume_error"] = error;
  json["largest_overlap_share"] = overlap;
  json["pieces"] = Json::array();
  for (const PieceProxy& p : proxies.pieces) json["pieces"].push_back(describe(p, params));
  return json.dump(1) + "\n";
}

Result<ExportProxiesReport> write(const std::vector<File>& contents, const Params& params, const Exec& exec) {
  std::vector<std::string> names;
  for (const File& file : contents) names.push_back(file.name);
  SHERD_CHECK(makeDirectory(params.directory));
  SHERD_ASSIGN(const OwnedFiles files,
               OwnedFiles::open(params.directory, names, OwnedFiles::proxiesManifest));
  if (exec.cancelled()) return cancelledError();
  SHERD_CHECK(files.claim());
  const bool isSame = std::all_of(contents.begin(), contents.end(), [&](const File& file) {
    return fileHolds(files.path(file.name), file.bytes);
  });
  if (!isSame) SHERD_CHECK(files.withdraw(kDescription));
  ExportProxiesReport report;
  std::vector<Digest> digests;
  for (const File& file : contents) {
    if (exec.cancelled()) return cancelledError();
    SHERD_ASSIGN(const FileChange change, writeFileAtomically(files.path(file.name), file.bytes));
    report.written += change == FileChange::Written;
    digests.push_back(Hasher().add(file.bytes).digest());
    report.files.push_back(files.path(file.name));
  }
  SHERD_ASSIGN(report.removed, files.commit(digests));
  report.description = report.files.back();
  report.files.push_back(files.path(OwnedFiles::proxiesManifest));
  return report;
}

}  // namespace

std::string hullName(const std::string& piece, std::size_t hull) {
  return fmt::format("{}_hull_{:02}", piece, hull + 1);
}

Result<ExportProxiesReport> exportProxies(const Proxies& proxies, const Params& params, const Exec& exec) {
  if (proxies.pieces.empty())
    return failure("there are no hulls to export", "wire ConvexProxies' `proxies`", "proxies");
  std::vector<File> contents = objFiles(proxies, params);
  contents.push_back({kDescription, descriptionOf(proxies, params)});
  for (const File& file : contents)
    if (!OwnedFiles::canBeOurs(file.name))
      return failure("'" + file.name + "' cannot be a file of hulls", "pieces have names like piece_0001",
                     "proxies");
  Result<ExportProxiesReport> report = write(contents, params, exec);
  if (!report.ok()) {
    Error error = report.error();
    if (error.kind != Error::Kind::Cancelled) error.port = "directory";
    return error;
  }
  exec.info(fmt::format("hulls of {} piece{} in {}", proxies.pieces.size(),
                        proxies.pieces.size() == 1 ? "" : "s", params.directory));
  return report;
}

}  // namespace sherd
