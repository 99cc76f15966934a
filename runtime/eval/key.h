// What a result depends on, as one digest.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "base/hash.h"
#include "base/result.h"
#include "eval/cache.h"
#include "graph/node_type.h"

namespace sherd {

/// Digests of files by content; each file is read once in the life of the object. Thread-safe.
class FileDigests {
 public:
  /// O(size of the file). An Error where it can't be read.
  Result<Digest> of(const std::string& path);

 private:
  std::mutex mutex_;
  std::map<std::string, Digest> known_;
};

/// Node type with both versions, all parameters, the content and name (readers go by its ending) of input
/// files, and the digests of the inputs. `params` are as the node will see them, wired ones included.
Result<Digest> resultKey(const NodeType& type, const ParamValues& params, const Outputs& inputs,
                         FileDigests& files);

}  // namespace sherd
