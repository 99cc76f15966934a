// Which files of an output directory are ours. A manifest in the directory lists them; an exporter replaces
// and removes what its last manifest lists and touches nothing else.
//
// Order of work, so that a run killed at any moment leaves no file that the next run would not know as its
// own: open() reads the manifest and refuses foreign files under names that will be written; claim() lists
// old and new names before the first is written; commit() removes what is no longer written and lists what is
// there.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/result.h"

namespace sherd {

class OwnedFiles {
 public:
  static constexpr const char* manifestName = "sherd_manifest.json";
  static constexpr const char* piecesManifest = "sherd_pieces_manifest.json";

  /// `directory` exists; `names` are what is going to be written into it (all of them canBeOurs). Exporters
  /// that may work in the same directory at the same time have manifests of different names, and files of
  /// different names.
  static Result<OwnedFiles> open(std::string directory, std::vector<std::string> names,
                                 std::string manifest = manifestName);

  Result<void> claim() const;
  /// Removes the file of that name, one of those given to open(), if it is there. After claim().
  Result<void> withdraw(const std::string& name) const;
  /// `digests` has one entry per name given to open(). Returns how many files were removed.
  Result<std::size_t> commit(const std::vector<Digest>& digests) const;
  std::string path(const std::string& name) const;

  /// Could a file of this name be one that an exporter writes? Anything else that a manifest lists is
  /// ignored, so that no manifest, however it came about, makes us remove a stranger's file.
  static bool canBeOurs(const std::string& name);

 private:
  Result<void> write(const std::map<std::string, std::string>& entries) const;

  std::string directory_, manifest_;
  std::vector<std::string> names_;
  std::map<std::string, std::string> listed_;  ///< the last manifest: name, digest
};

}  // namespace sherd
