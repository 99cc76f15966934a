#include "eval/history_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "base/hash.h"

namespace sherd::store {
namespace {

struct HistoryHead {
  static constexpr std::uint64_t kMagic = 0x7369'6864'7265'6873;  // "sherdhis"
  static constexpr std::uint64_t kFormat = 1;
  std::uint64_t magic = kMagic, format = kFormat;
  Digest name;      ///< that of the file
  Digest checksum;  ///< of what follows
};
static_assert(sizeof(HistoryHead) == 48);

Digest digestOf(const std::string& name) { return checksum128(name.data(), name.size()); }

/// The content of the file, where it is whole and belongs to this name.
std::optional<std::string> contentOf(const std::string& path, const std::string& hex) {
  const Descriptor file = openToRead(path);
  if (!file.isOpen()) return std::nullopt;
  std::string bytes = readFrom(file.number(), 0, fileBytes(path));
  HistoryHead head;
  if (bytes.size() < sizeof head) return std::nullopt;
  std::memcpy(&head, bytes.data(), sizeof head);
  bytes.erase(0, sizeof head);
  if (head.magic != HistoryHead::kMagic || head.format != HistoryHead::kFormat || head.name.hex() != hex ||
      head.checksum != checksum128(bytes.data(), bytes.size()))
    return std::nullopt;
  return bytes;
}

bool isName(const std::string& name) {
  return name.size() == 32 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string HistoryFiles::read(const std::string& name) {
  const std::string hex = digestOf(name).hex(), path = directory_.at("history/" + hex);
  if (::access(path.c_str(), F_OK) != 0) return {};
  if (auto content = contentOf(path, hex)) return *std::move(content);
  ::unlink(path.c_str());
  return {};
}

void HistoryFiles::write(const std::string& name, std::string_view content) {
  HistoryHead head;
  head.name = digestOf(name);
  head.checksum = checksum128(content.data(), content.size());
  directory_.replace("history/" + head.name.hex(),
                     {{reinterpret_cast<const char*>(&head), sizeof head}, content});
}

std::uint64_t HistoryFiles::evict(std::uint64_t mostBytes) {
  struct File {
    std::int64_t modified;
    std::uint64_t bytes;
    std::string path;
  };
  std::vector<File> files;
  std::uint64_t left = 0, freed = 0;
  for (const std::string& name : namesIn(directory_.at("history"))) {
    struct stat info {};
    std::string path = directory_.at("history/" + name);
    if (!isName(name) || ::lstat(path.c_str(), &info) != 0) continue;
    files.push_back({info.st_mtim.tv_sec, static_cast<std::uint64_t>(info.st_size), std::move(path)});
    left += files.back().bytes;
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.modified < b.modified; });
  for (const File& file : files) {
    if (left <= mostBytes) break;
    if (::unlink(file.path.c_str()) != 0) continue;
    left -= file.bytes;
    freed += file.bytes;
  }
  return freed;
}

std::uint64_t HistoryFiles::bytesOnDisk() const {
  std::uint64_t bytes = 0;
  for (const std::string& name : namesIn(directory_.at("history")))
    if (isName(name)) bytes += fileBytes(directory_.at("history/" + name));
  return bytes;
}

std::vector<std::string> HistoryFiles::verify() {
  std::vector<std::string> lines;
  for (const std::string& name : namesIn(directory_.at("history"))) {
    const std::string path = directory_.at("history/" + name);
    if (!isName(name) || contentOf(path, name)) continue;
    const bool gone = ::unlink(path.c_str()) == 0;
    lines.push_back("history/" + name + ": damaged" + (gone ? ", deleted" : ", but can't be deleted"));
  }
  return lines;
}

void HistoryFiles::clear() {
  for (const std::string& name : namesIn(directory_.at("history")))
    if (isName(name)) ::unlink(directory_.at("history/" + name).c_str());
}

}  // namespace sherd::store
