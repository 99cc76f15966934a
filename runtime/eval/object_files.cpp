#include "eval/object_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <ctime>

#include "eval/worth.h"

namespace sherd::store {
namespace {

constexpr double kTouchSeconds = 60;

struct ObjectHead {
  static constexpr std::uint64_t kMagic = 0x6a62'6f64'7265'6873;  // "sherdobj"
  static constexpr std::uint32_t kFormat = 1;
  std::uint64_t magic = kMagic;
  std::uint32_t format = kFormat;
  std::int32_t version = 0;  ///< of the type's bytes
  Digest digest;             ///< of the value, as the file is named
  double ms = 0;             ///< that making it took
  std::uint64_t payload = 0;
  Digest payloadChecksum;
  std::uint64_t name = 0;      ///< bytes of the type's name, which follows
  std::uint64_t checksum = 0;  ///< of this head up to here, and of the name

  std::uint64_t sum(std::string_view typeName) const {
    return checksum64(this, offsetof(ObjectHead, checksum)) ^ checksum64(typeName.data(), typeName.size());
  }
};
static_assert(sizeof(ObjectHead) == 80);

double secondsSince(const timespec& time) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<double>(now.tv_sec - time.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec - time.tv_nsec);
}

/// Fails where the directory is read-only, where it serves nothing anyway.
void touchFile(int file, const struct stat& info) {
  if (secondsSince(info.st_mtim) > kTouchSeconds) ::futimens(file, nullptr);
}

/// The whole file. Null with errno = 0 where it isn't what a file of ours can be.
std::unique_ptr<char[]> readWhole(int file, std::size_t size) {
  auto bytes = std::make_unique_for_overwrite<char[]>(size);
  for (std::size_t have = 0; have < size;) {
    const ssize_t got = ::read(file, bytes.get() + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return nullptr;
    errno = 0;
    if (got == 0) return nullptr;
    have += static_cast<std::size_t>(got);
  }
  return bytes;
}

struct Parsed {
  ObjectHead head;
  std::string_view name, payload;
};

/// Empty problem: sound.
std::string parse(std::string_view bytes, Parsed& parsed) {
  ObjectHead& head = parsed.head;
  if (bytes.size() < sizeof head) return "truncated";
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.magic != ObjectHead::kMagic) return "not an object";
  if (head.format != ObjectHead::kFormat) return "of another format";
  bytes.remove_prefix(sizeof head);
  if (head.name > bytes.size()) return "head damaged";
  parsed.name = bytes.substr(0, head.name);
  if (head.checksum != head.sum(parsed.name)) return "head damaged";
  parsed.payload = bytes.substr(head.name);
  if (head.payload != parsed.payload.size()) return "truncated";
  if (head.payloadChecksum != checksum128(parsed.payload.data(), parsed.payload.size())) return "damaged";
  return {};
}

/// What making the value of this file took; 0 where its head is unsound.
double costOf(const std::string& path) {
  const Descriptor file = openToRead(path);
  const std::string bytes = file.isOpen() ? readFrom(file.number(), 0, sizeof(ObjectHead)) : std::string();
  ObjectHead head;
  if (bytes.size() != sizeof head) return 0;
  std::memcpy(&head, bytes.data(), sizeof head);
  return head.magic == ObjectHead::kMagic && head.ms > 0 && std::isfinite(head.ms) ? head.ms : 0;
}

/// Other names in the folder are not ours to delete.
bool isName(const std::string& name) {
  return name.size() == 32 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string ObjectFiles::pathOf(const Digest& digest) const {
  const std::string hex = digest.hex();
  return directory_.at("objects/" + hex.substr(0, 2) + '/' + hex);
}

bool ObjectFiles::has(const Digest& digest) const { return ::access(pathOf(digest).c_str(), F_OK) == 0; }

void ObjectFiles::remove(const Digest& digest) { ::unlink(pathOf(digest).c_str()); }

void ObjectFiles::touch(const Digest& digest) {
  const Descriptor file = openToRead(pathOf(digest));
  struct stat info {};
  if (file.isOpen() && ::fstat(file.number(), &info) == 0) touchFile(file.number(), info);
}

std::optional<ObjectBytes> ObjectFiles::read(const ValueType& type, const Digest& digest) {
  const std::string path = pathOf(digest);
  const Descriptor file = openToRead(path);
  struct stat info {};
  if (!file.isOpen() || ::fstat(file.number(), &info) != 0) return std::nullopt;
  ObjectBytes bytes;
  if (S_ISREG(info.st_mode)) {
    bytes.all = readWhole(file.number(), static_cast<std::size_t>(info.st_size));
    if (bytes.all == nullptr && errno != 0) return std::nullopt;  // the disk's trouble, not the file's
  }
  Parsed parsed;
  const bool sound = bytes.all != nullptr &&
                     parse({bytes.all.get(), static_cast<std::size_t>(info.st_size)}, parsed).empty() &&
                     parsed.head.digest == digest && parsed.head.version == type.archiveVersion &&
                     parsed.name == type.name;
  if (!sound) {
    ::unlink(path.c_str());
    return std::nullopt;
  }
  touchFile(file.number(), info);
  bytes.payload = parsed.payload;
  return bytes;
}

std::uint64_t ObjectFiles::write(const ValueType& type, const Digest& digest, double ms,
                                 std::string_view payload) {
  ObjectHead head;
  head.version = type.archiveVersion;
  head.digest = digest;
  head.ms = ms;
  head.payload = payload.size();
  head.payloadChecksum = checksum128(payload.data(), payload.size());
  head.name = type.name.size();
  head.checksum = head.sum(type.name);
  const std::string_view headBytes(reinterpret_cast<const char*>(&head), sizeof head);
  const std::string hex = digest.hex();
  if (!directory_.replace("objects/" + hex.substr(0, 2) + '/' + hex, {headBytes, type.name, payload}))
    return 0;
  return sizeof head + type.name.size() + payload.size();
}

std::vector<ObjectFile> ObjectFiles::list() const {
  std::vector<ObjectFile> files;
  const std::string root = directory_.at("objects");
  for (const std::string& folder : namesIn(root)) {
    for (const std::string& name : namesIn(root + '/' + folder)) {
      if (!isName(name) || !name.starts_with(folder)) continue;
      ObjectFile file{root + '/' + folder + '/' + name};
      struct stat info {};
      if (::lstat(file.path.c_str(), &info) != 0) continue;
      file.bytes = static_cast<std::uint64_t>(info.st_size);
      file.unused = std::max(0.0, secondsSince(info.st_mtim));
      files.push_back(std::move(file));
    }
  }
  return files;
}

std::uint64_t ObjectFiles::evict(std::uint64_t mostBytes) {
  const std::vector<ObjectFile> files = list();
  std::uint64_t left = 0, freed = 0;
  for (const ObjectFile& file : files) left += file.bytes;
  if (left <= mostBytes) return 0;
  struct Candidate {
    double worth;
    const ObjectFile* file;
  };
  std::vector<Candidate> candidates;
  candidates.reserve(files.size());
  for (const ObjectFile& file : files) {
    candidates.push_back({worth(costOf(file.path), file.bytes, file.unused), &file});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.worth < b.worth; });
  std::size_t last = 0;
  for (; last < candidates.size() && left > mostBytes; ++last) left -= candidates[last].file->bytes;
  // The last of them may have been far larger than what was missing: what fits in its place stays.
  for (; last > 0; --last) {
    const ObjectFile& file = *candidates[last - 1].file;
    if (left + file.bytes <= mostBytes)
      left += file.bytes;
    else if (::unlink(file.path.c_str()) == 0)
      freed += file.bytes;
  }
  return freed;
}

std::vector<std::string> ObjectFiles::verify() {
  std::vector<std::string> lines;
  for (const ObjectFile& object : list()) {
    const Descriptor file = openToRead(object.path);
    struct stat info {};
    if (!file.isOpen() || ::fstat(file.number(), &info) != 0) continue;
    const auto size = static_cast<std::size_t>(info.st_size);
    const auto bytes = S_ISREG(info.st_mode) ? readWhole(file.number(), size) : nullptr;
    Parsed parsed;
    std::string problem = bytes == nullptr ? "can't be read" : parse({bytes.get(), size}, parsed);
    if (problem.empty() && !object.path.ends_with('/' + parsed.head.digest.hex()))
      problem = "under another object's name";
    if (problem.empty()) continue;
    const std::string shown = object.path.substr(directory_.path().size() + 1);
    const bool gone = ::unlink(object.path.c_str()) == 0;
    lines.push_back(shown + ": " + problem + (gone ? ", deleted" : ", but can't be deleted"));
  }
  return lines;
}

void ObjectFiles::clear() {
  for (const ObjectFile& file : list()) ::unlink(file.path.c_str());
}

}  // namespace sherd::store
