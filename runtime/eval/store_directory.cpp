#include "eval/store_directory.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <memory>
#include <system_error>

#include "base/atomic_file.h"
#include "base/partial_file.h"

namespace sherd::store {
namespace {

constexpr const char* kMarker = "sherd-cache";
constexpr std::string_view kMarkerText = "This directory is a cache of sherd, format 1.\n";
constexpr int kMostAttempts = 16;  // at what another process may get in the way of
constexpr std::array<const char*, 4> kFolders{"records", "objects", "history", "tmp"};
constexpr std::time_t kDay = 86400;

std::string messageOf(int error) { return std::generic_category().message(error); }

bool isOurs(const std::string& name) {
  return name == kMarker || std::find(kFolders.begin(), kFolders.end(), name) != kFolders.end();
}

}  // namespace

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

int writeAll(int descriptor, std::initializer_list<std::string_view> pieces) {
  std::vector<iovec> left;
  for (const std::string_view piece : pieces)
    if (!piece.empty()) left.push_back({const_cast<char*>(piece.data()), piece.size()});
  std::size_t first = 0;
  while (first < left.size()) {
    const ssize_t put = ::writev(descriptor, left.data() + first, static_cast<int>(left.size() - first));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    for (auto done = static_cast<std::size_t>(put); first < left.size();) {
      const std::size_t step = std::min(done, left[first].iov_len);
      left[first].iov_base = static_cast<char*>(left[first].iov_base) + step;
      left[first].iov_len -= step;
      done -= step;
      if (left[first].iov_len > 0) break;
      ++first;
    }
  }
  return 0;
}

std::string readFrom(int descriptor, std::uint64_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got =
        ::pread(descriptor, bytes.data() + have, size - have, static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::opendir(folder.c_str()), &::closedir);
  if (stream == nullptr) return names;
  while (const dirent* entry = ::readdir(stream.get())) {
    const std::string_view name(entry->d_name);
    if (name != "." && name != "..") names.emplace_back(name);
  }
  return names;
}

Descriptor openToRead(const std::string& path) {
  return Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
}

bool lockIfFree(const Descriptor& file) {
  struct stat info {};
  return file.isOpen() && ::flock(file.number(), LOCK_EX | LOCK_NB) == 0 &&
         ::fstat(file.number(), &info) == 0 && info.st_nlink > 0;
}

std::uint64_t fileBytes(const std::string& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0 ? static_cast<std::uint64_t>(info.st_size) : 0;
}

std::string Directory::at(std::string_view relative) const {
  std::string path;
  path.reserve(path_.size() + 1 + relative.size());
  return path.append(path_).append("/").append(relative);
}

Result<void> Directory::open() {
  SHERD_CHECK(claim());
  for (const char* folder : kFolders) {
    const std::string path = at(folder);
    if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
      writeFailed(errno);
      return {};
    }
    if (::faccessat(AT_FDCWD, path.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
      writeFailed(errno);
      return {};
    }
  }
  return {};
}

/// Makes sure that the directory is ours before anything is written or removed in it. The marker is the first
/// thing in a new one, so that another process that comes at the same moment finds nothing but our names.
Result<void> Directory::claim() {
  const std::string choose = "choose another directory for the cache";
  if (const std::size_t slash = path_.rfind('/'); slash != std::string::npos && slash > 0)
    SHERD_CHECK(makeDirectory(path_.substr(0, slash)));
  if (::mkdir(path_.c_str(), 0700) != 0 && errno != EEXIST)
    return failure("cannot make the directory '" + path_ + "' for the cache: " + messageOf(errno), choose);
  const Descriptor self(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!self.isOpen())
    return errno == ENOTDIR
               ? failure("'" + path_ + "' is a file, and can't hold the cache", choose)
               : failure("cannot read the cache's directory '" + path_ + "': " + messageOf(errno), choose);
  const std::string marker = at(kMarker);
  const Descriptor old = openToRead(marker);
  if (old.isOpen() && readFrom(old.number(), 0, kMarkerText.size() + 1) == kMarkerText) return {};
  const std::vector<std::string> names = namesIn(path_);
  const bool marked = std::find(names.begin(), names.end(), kMarker) != names.end();
  if (!std::all_of(names.begin(), names.end(), isOurs) || (!names.empty() && !marked))
    return failure("the directory '" + path_ + "' holds something else than a cache of sherd",
                   "choose an empty directory, or one that doesn't exist yet");
  const Descriptor file(::open(marker.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600));
  const int error = file.isOpen() ? writeAll(file.number(), {kMarkerText}) : errno;
  if (error != 0) writeFailed(error);
  return {};
}

void Directory::writeFailed(int error) {
  if (!writable_.exchange(false)) return;
  warn("the cache in '" + path_ + "' can't be written: " + messageOf(error) +
       "; results of this run are not kept");
}

void Directory::warn(const std::string& text) const {
  if (warn_) warn_(text);
}

OwnFile Directory::create(std::string_view folder, std::string_view prefix) const {
  OwnFile file;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    file.path = at(folder) + '/' + std::string(prefix) + randomName();
    file.descriptor = Descriptor(
        ::open(file.path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!file.descriptor.isOpen()) {
      file.error = errno;
      if (errno == EEXIST) continue;
      return file;
    }
    // Another process may take it for left behind until it is locked; without locks there is no such danger.
    const bool taken = ::flock(file.descriptor.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat info {};
    if (!taken && ::fstat(file.descriptor.number(), &info) == 0 && info.st_nlink > 0) {
      file.error = 0;
      return file;
    }
    file.error = EAGAIN;
  }
  file.descriptor.close();
  return file;
}

bool Directory::moveInto(const OwnFile& file, const std::string& relative) {
  const std::string path = at(relative);
  int error = ::rename(file.path.c_str(), path.c_str()) == 0 ? 0 : errno;
  // Another process that evicts may remove the folder, empty as it is, before the file is in it.
  for (int attempt = 0; attempt < kMostAttempts && error == ENOENT; ++attempt) {
    ::mkdir(path.substr(0, path.rfind('/')).c_str(), 0700);
    error = ::rename(file.path.c_str(), path.c_str()) == 0 ? 0 : errno;
  }
  if (error == 0) return true;
  ::unlink(file.path.c_str());
  writeFailed(error);
  return false;
}

bool Directory::replace(const std::string& relative, std::initializer_list<std::string_view> pieces) {
  if (!writable()) return false;
  const OwnFile file = create("tmp", "");
  if (file.error != 0) {
    writeFailed(file.error);
    return false;
  }
  const PartialFile known(file.path);
  if (const int error = writeAll(file.descriptor.number(), pieces); error != 0) {
    ::unlink(file.path.c_str());
    writeFailed(error);
    return false;
  }
  return moveInto(file, relative);
}

std::uint64_t Directory::sweep() {
  std::uint64_t freed = 0;
  for (const std::string& name : namesIn(at("tmp"))) {
    const std::string path = at("tmp") + '/' + name;
    const Descriptor file = openToRead(path);
    struct stat info {};
    if (!file.isOpen() || ::fstat(file.number(), &info) != 0) continue;
    const bool old = info.st_mtim.tv_sec + kDay < std::time(nullptr);
    if (!old && !lockIfFree(file)) continue;
    if (::unlink(path.c_str()) == 0) freed += static_cast<std::uint64_t>(info.st_size);
  }
  return freed;
}

}  // namespace sherd::store
