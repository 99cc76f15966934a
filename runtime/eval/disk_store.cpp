#include "eval/disk_store.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <unordered_map>

#include "eval/history_files.h"
#include "eval/object_files.h"
#include "eval/record_log.h"
#include "eval/store_directory.h"

namespace sherd {
namespace {

constexpr std::uint64_t kRecordShare = 10, kHistoryShare = 100;  // parts of the bound on objects
constexpr std::int64_t kSettledNs = 50'000'000;

/// What bytes under a key count as.
const ValueType kPartType{"(part of a result)", nullptr, nullptr, 1};

/// Values that are alive in this process, so that none of them is loaded twice.
class LiveValues {
 public:
  std::shared_ptr<const void> find(const ValueType& type, const Digest& digest) const {
    const std::lock_guard lock(mutex_);
    const auto found = values_.find(digest);
    if (found == values_.end() || found->second.type != type.name) return nullptr;
    return found->second.data.lock();
  }
  void keep(const ValueType& type, const Digest& digest, const std::shared_ptr<const void>& data) {
    const std::lock_guard lock(mutex_);
    values_.insert_or_assign(digest, Live{type.name, data});
    if (values_.size() < sweepAt_) return;
    std::erase_if(values_, [](const auto& entry) { return entry.second.data.expired(); });
    sweepAt_ = std::max<std::size_t>(kLeast, 2 * values_.size());
  }

 private:
  static constexpr std::size_t kLeast = 256;
  struct Live {
    std::string type;
    std::weak_ptr<const void> data;
  };
  mutable std::mutex mutex_;
  std::unordered_map<Digest, Live> values_;
  std::size_t sweepAt_ = kLeast;
};

/// What an exception of a value's type says to a user; to be called where it is caught.
std::string caught() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an unknown exception";
  }
}

Digest pathKey(const std::string& path) {
  static const std::string kPrefix = "file:";
  return Hasher().add(kPrefix).add(path).digest();
}

}  // namespace

struct DiskStore::Impl {
  Impl(std::string path, DiskStoreOptions given)
      : directory(std::move(path), std::move(given.onWarning)), mostBytes(given.mostBytes) {}

  std::shared_ptr<const void> load(const ValueType& type, const Digest& digest);
  bool save(const ValueType& type, const std::shared_ptr<const void>& data, const Digest& digest, double ms);
  bool hasTooManyRecords() const;
  std::uint64_t collect(std::uint64_t most);
  void keepBound();

  store::Directory directory;
  const std::uint64_t mostBytes;
  store::RecordLog records{directory};
  store::ObjectFiles objects{directory};
  store::HistoryFiles histories{directory};
  LiveValues live;
  std::atomic<std::uint64_t> savedBytes{0};  ///< since the last collect
};

std::shared_ptr<const void> DiskStore::Impl::load(const ValueType& type, const Digest& digest) {
  if (type.load == nullptr) return nullptr;
  if (auto alive = live.find(type, digest)) return alive;
  const auto bytes = objects.read(type, digest);
  if (!bytes) return nullptr;
  bool partMissing = false;
  ArchiveReader reader(bytes->payload, [&](const ValueType& partType, const Digest& part) {
    auto value = load(partType, part);
    if (value == nullptr) partMissing = true;
    return value;
  });
  auto value = type.load(reader);
  if (value != nullptr)
    live.keep(type, digest, value);
  else if (!partMissing)  // a part may be saved again; bytes that make no value never will
    objects.remove(digest);
  return value;
}

bool DiskStore::Impl::save(const ValueType& type, const std::shared_ptr<const void>& data,
                           const Digest& digest, double ms) {
  if (type.save == nullptr || type.load == nullptr) return false;
  live.keep(type, digest, data);
  if (objects.has(digest)) {
    objects.touch(digest);
    return true;
  }
  if (!directory.writable()) return false;
  ArchiveWriter writer;
  type.save(writer, data.get());
  if (writer.bytes().size() > mostBytes) return false;
  for (const ArchivePart& part : writer.parts())
    if (!save(*part.type, part.data, part.digest, ms)) return false;
  const std::uint64_t written = objects.write(type, digest, ms, writer.bytes());
  savedBytes += written;
  return written > 0;
}

bool DiskStore::Impl::hasTooManyRecords() const { return records.bytesOnDisk() > mostBytes / kRecordShare; }

std::uint64_t DiskStore::Impl::collect(std::uint64_t most) {
  savedBytes = 0;
  std::uint64_t freed = directory.sweep() + histories.evict(most / kHistoryShare);
  const std::uint64_t mostOfRecords = most / kRecordShare;
  records.flush();
  freed += records.merge(mostOfRecords, records.bytesOnDisk() > mostOfRecords);
  const std::uint64_t others = records.bytesOnDisk() + histories.bytesOnDisk();
  return freed + objects.evict(most - std::min(others, most));
}

/// A run of days must not outgrow the bound until its end.
void DiskStore::Impl::keepBound() {
  if (savedBytes > mostBytes / 8 + (std::uint64_t{64} << 10)) collect(mostBytes);
}

Result<std::unique_ptr<DiskStore>> DiskStore::open(const std::string& directory, DiskStoreOptions options) {
  std::error_code problem;
  std::filesystem::path path = std::filesystem::absolute(directory, problem).lexically_normal();
  if (directory.empty() || problem) return failure("the cache has no directory", "give one");
  if (!path.has_filename()) path = path.parent_path();  // "cache/"
  auto impl = std::make_unique<Impl>(path.string(), std::move(options));
  SHERD_CHECK(impl->directory.open());
  impl->records.merge(impl->mostBytes / kRecordShare, false);  // what killed processes left
  impl->records.refresh();
  return std::unique_ptr<DiskStore>(new DiskStore(std::move(impl)));
}

DiskStore::DiskStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

DiskStore::~DiskStore() {
  impl_->records.close();
  if (impl_->savedBytes > 0 || impl_->hasTooManyRecords())
    impl_->collect(impl_->mostBytes);
  else
    impl_->records.merge(impl_->mostBytes / kRecordShare, false);
}

std::optional<ResultRecord> DiskStore::find(const Digest& key) const {
  return impl_->records.find(key, [](store::Frame frame) -> std::optional<ResultRecord> {
    if (store::kindOf(frame) != store::FrameKind::Result) return std::nullopt;
    return store::readResult(frame);
  });
}

bool DiskStore::findOutputs(const Digest& key, std::vector<OutputRecord>& outputs) const {
  return impl_->records.find(key, [&](store::Frame frame) {
    if (store::kindOf(frame) != store::FrameKind::Result) return false;
    store::readOutputs(frame, outputs);
    return true;
  });
}

bool DiskStore::knowsRecipe(const Digest& recipe) const { return impl_->records.knowsRecipe(recipe); }

void DiskStore::record(const ResultRecord& record) { impl_->records.add(record, record.ms >= kSlowMs); }

void DiskStore::refresh() { impl_->records.refresh(); }

bool DiskStore::hasObject(const Digest& digest) const { return impl_->objects.has(digest); }

Value DiskStore::load(const ValueType& type, const Digest& digest) {
  try {
    auto data = impl_->load(type, digest);
    return data == nullptr ? Value() : Value(type, std::move(data));
  } catch (...) {
    impl_->directory.warn("a " + type.name + " can't be loaded from the cache: " + caught());
    return {};
  }
}

bool DiskStore::save(const Value& value, const Digest& digest, double ms) {
  if (value.empty()) return false;
  bool kept = false;
  try {
    kept = impl_->save(value.type(), value.data(), digest, ms);
  } catch (...) {
    impl_->directory.warn("a " + value.type().name + " is not kept in the cache: " + caught());
  }
  impl_->keepBound();
  return kept;
}

std::optional<std::string> DiskStore::part(const Digest& key) {
  try {
    const auto bytes = impl_->objects.read(kPartType, key);
    return bytes ? std::optional<std::string>(bytes->payload) : std::nullopt;
  } catch (...) {
    impl_->directory.warn("a part of a result can't be loaded from the cache: " + caught());
    return std::nullopt;
  }
}

bool DiskStore::savePart(const Digest& key, std::string_view bytes, double ms) {
  if (!impl_->directory.writable() || bytes.size() > impl_->mostBytes) return false;
  const std::uint64_t written = impl_->objects.write(kPartType, key, ms, bytes);
  impl_->savedBytes += written;
  impl_->keepBound();
  return written > 0;
}

std::optional<Digest> DiskStore::fileDigest(const std::string& path, const FileIdentity& identity) const {
  return impl_->records.find(pathKey(path), [&](store::Frame frame) -> std::optional<Digest> {
    if (store::kindOf(frame) != store::FrameKind::FileDigest || store::readIdentity(frame) != identity)
      return std::nullopt;
    return store::recipeOf(frame);
  });
}

void DiskStore::setFileDigest(const std::string& path, const FileIdentity& identity, const Digest& digest) {
  if (!identity.exists() || identity.changed + kSettledNs > store::RecordLog::now()) return;
  impl_->records.addFile(pathKey(path), identity, digest);
}

std::string DiskStore::history(const std::string& name) const { return impl_->histories.read(name); }

void DiskStore::setHistory(const std::string& name, std::string_view content) {
  impl_->histories.write(name, content);
}

void DiskStore::flush() { impl_->records.flush(); }

std::uint64_t DiskStore::collect(std::uint64_t mostBytes) { return impl_->collect(mostBytes); }

DiskStoreStats DiskStore::stats() const {
  DiskStoreStats stats;
  stats.mostBytes = impl_->mostBytes;
  for (const store::ObjectFile& file : impl_->objects.list()) {
    ++stats.objects;
    stats.objectBytes += file.bytes;
  }
  stats.records = impl_->records.count();
  stats.recordBytes = impl_->records.bytesOnDisk();
  stats.historyBytes = impl_->histories.bytesOnDisk();
  return stats;
}

std::vector<std::string> DiskStore::verify() {
  impl_->records.flush();
  std::vector<std::string> lines = impl_->objects.verify();
  const std::vector<std::string> segments = impl_->records.verify();
  // Merging copies what is sound and leaves out what isn't.
  if (!segments.empty()) impl_->records.merge(impl_->mostBytes / kRecordShare, true);
  for (const std::vector<std::string>& more : {segments, impl_->histories.verify()})
    lines.insert(lines.end(), more.begin(), more.end());
  return lines;
}

Result<void> DiskStore::clear() {
  if (!impl_->directory.writable())
    return failure("the cache in '" + impl_->directory.path() + "' can't be cleared: it can't be written to",
                   "make it writable, or choose another one with --cache");
  impl_->records.clear();
  impl_->objects.clear();
  impl_->histories.clear();
  impl_->directory.sweep();
  return {};
}

const std::string& DiskStore::directory() const { return impl_->directory.path(); }

std::string DiskStore::defaultDirectory(
    const std::function<std::optional<std::string>(const std::string&)>& environment) {
  const auto get = [&](const char* name) { return environment(name).value_or(""); };
  if (std::string own = get("SHERD_CACHE"); !own.empty()) return own;
  if (const std::string user = get("XDG_CACHE_HOME"); user.starts_with('/')) return user + "/sherd";
  if (const std::string home = get("HOME"); !home.empty()) return home + "/.cache/sherd";
  return {};
}

}  // namespace sherd
