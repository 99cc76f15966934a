// Where results are found by their keys: in memory, then on disk.
#pragma once

#include <optional>

#include "base/partial_file.h"
#include "eval/cache.h"
#include "eval/disk_store.h"
#include "graph/node_type.h"

namespace sherd {

/// What is known of a result. Outputs that are in memory have their values, the others digests only.
struct Known {
  Outputs outputs;
  ResultRecord record;
};

/// Where results, and what became of the files that they wrote, are looked for.
struct Places {
  Cache& cache;
  const DiskStore* disk;  ///< null: none
  AbandonedFiles& abandoned;
};

/// Nothing where no result is known, where the record doesn't fit the type's outputs, or where a file that
/// the node wrote is missing or has been changed (firstChanged).
std::optional<Known> lookUp(const NodeType& type, const Digest& key, const Places& places);

/// The first of the files that is not as it was written, or beside which a killed run left a half-written
/// one; null where there is none.
const WrittenFile* firstChanged(const ResultRecord& record, AbandonedFiles& abandoned);

}  // namespace sherd
