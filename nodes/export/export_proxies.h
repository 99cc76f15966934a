// Writes convex hulls of the pieces for rigid-body engines.
//
// What is written into the directory
//   piece_0001_hulls.obj  the hulls of piece 1, one object and group each, piece_0001_hull_01 and so on: what
//                         Bullet's loaders take as one compound shape, and Blender and Houdini as objects and
//                         groups; or, as one file for all pieces,
//   proxies.obj           the same of all pieces
//   proxies.json          per piece its file, mass, centre of mass, inertia, and for its hulls volume, volume
//                         error and overlap with those of other pieces
//   sherd_proxies_manifest.json   which of the directory's files are ours (owned_files.h)
//
// Coordinates are those of the pieces that ExportCrackSurface writes: in the unit and axes of the file that
// the mesh came from, with as many digits as bring back the very double.
#pragma once

#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/proxies.h"

namespace sherd {

struct ExportProxiesParams {
  enum class Files {
    Pieces,  ///< one per piece
    One,     ///< one for all
  };
  std::string directory;  ///< created where it is missing
  Files files = Files::Pieces;
};

struct ExportProxiesReport {
  std::string description;         ///< path of proxies.json
  std::vector<std::string> files;  ///< paths of all files that now hold the result
  std::size_t written = 0, removed = 0;
};

/// "piece_0001_hull_01": of hull number `hull`, from 0.
std::string hullName(const std::string& piece, std::size_t hull);

/// Files of an earlier run are replaced or removed; nothing else is touched; a foreign file under one of our
/// names is an error before anything is written. proxies.json is removed before the first file that changes
/// is written, and comes last. Errors name the parameter `directory`. Cost O(vertices).
Result<ExportProxiesReport> exportProxies(const Proxies& proxies, const ExportProxiesParams& params,
                                          const Exec& exec);

}  // namespace sherd
