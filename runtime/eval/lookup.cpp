#include "eval/lookup.h"

#include "base/atomic_file.h"

namespace sherd {

const WrittenFile* firstChanged(const ResultRecord& record) {
  // A run that was killed leaves a half-written file beside the old one: only the exporter may remove that.
  for (const WrittenFile& file : record.written)
    if (!file.identity.exists() || FileIdentity::of(file.path) != file.identity ||
        FileIdentity::of(partialName(file.path)).exists())
      return &file;
  return nullptr;
}

std::optional<Known> lookUp(const NodeType& type, const Digest& key, Cache& cache, const DiskStore* disk) {
  std::optional<Known> known;
  if (auto cached = cache.find(key)) {
    known = Known{std::move(cached->outputs), std::move(cached->record)};
  } else if (disk != nullptr) {
    auto record = disk->find(key);
    if (!record || record->outputs.size() != type.outputs.size()) return std::nullopt;
    known.emplace();
    known->outputs.reserve(record->outputs.size());
    for (const OutputRecord& output : record->outputs) known->outputs.push_back({{}, output.digest});
    known->record = std::move(*record);
  }
  if (known && type.writesFiles && firstChanged(known->record) != nullptr) return std::nullopt;
  return known;
}

}  // namespace sherd
