#include "eval/lookup.h"

namespace sherd {

const WrittenFile* firstChanged(const ResultRecord& record, AbandonedFiles& abandoned) {
  // A run that was killed leaves a half-written file beside the old one: only the exporter may remove that.
  for (const WrittenFile& file : record.written)
    if (!file.identity.exists() || FileIdentity::of(file.path) != file.identity ||
        abandoned.isBeside(file.path))
      return &file;
  return nullptr;
}

std::optional<Known> lookUp(const NodeType& type, const Digest& key, const Places& places) {
  std::optional<Known> known;
  if (auto cached = places.cache.find(key)) {
    known = Known{std::move(cached->outputs), std::move(cached->record)};
  } else if (places.disk != nullptr) {
    auto record = places.disk->find(key);
    if (!record || record->outputs.size() != type.outputs.size()) return std::nullopt;
    known.emplace();
    known->outputs.reserve(record->outputs.size());
    for (const OutputRecord& output : record->outputs) known->outputs.push_back({{}, output.digest});
    known->record = std::move(*record);
  }
  if (known && type.writesFiles && firstChanged(known->record, places.abandoned) != nullptr)
    return std::nullopt;
  return known;
}

}  // namespace sherd
