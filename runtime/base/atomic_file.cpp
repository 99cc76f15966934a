#include "base/atomic_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace sherd {
namespace {

Error writeError(const std::string& path, int number) {
  const std::string what = "cannot write '" + path + "': " + std::generic_category().message(number);
  switch (number) {
    case ENOSPC:
    case EDQUOT:
      return failure(what, "free some space on that disk, or write to another one");
    case EACCES:
    case EPERM:
    case EROFS:
      return failure(what, "choose a directory that you may write to");
    case EISDIR:
    case ENOTDIR:
      return failure(what, "remove what stands in its place, or choose another directory");
    default:
      return failure(what, "check that disk, or write to another directory");
  }
}

/// Closes on destruction; close() tells of errors that only show then.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

}  // namespace

bool fileHolds(const std::string& path, std::string_view content) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return false;
  if (static_cast<std::size_t>(info.st_size) != content.size()) return false;
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  std::array<char, 1 << 16> block;
  while (!content.empty()) {
    const ssize_t got = ::read(file.number(), block.data(), std::min(block.size(), content.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0 || content.substr(0, static_cast<std::size_t>(got)) !=
                        std::string_view(block.data(), static_cast<std::size_t>(got)))
      return false;
    content.remove_prefix(static_cast<std::size_t>(got));
  }
  return true;
}

namespace {

/// Paths of files that are being written; null where a place is free.
constexpr std::size_t kMostPartial = 1024;
std::array<std::atomic<const char*>, kMostPartial> gPartial{};

constexpr int kMostWaits = 20;     // ms
std::atomic<bool> gEnding{false};  ///< removePartialFiles() was called
std::atomic<int> gMaking{0};       ///< threads that may be making a file just now
thread_local volatile std::sig_atomic_t tIsMaking = 0;

/// The process is about to end, by another thread: nothing more is to be done.
[[noreturn]] void waitForTheEnd() {
  while (true) ::pause();
}

/// While one of these is there, a file may appear. removePartialFiles() waits until there are none, and no
/// new ones come: else a file could appear behind its back.
class Making {
 public:
  Making() {
    ++gMaking;
    tIsMaking = 1;
    if (!gEnding) return;
    leave();
    waitForTheEnd();
  }
  ~Making() { leave(); }
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;

 private:
  static void leave() {
    tIsMaking = 0;
    --gMaking;
  }
};

Descriptor makeFile(const std::string& path) {
  const Making making;
  return Descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666));
}

/// 0, or the error number.
int writeAll(const std::string& path, std::string_view content) {
  Descriptor file = makeFile(path);
  if (file.number() < 0) return errno;
  while (!content.empty()) {
    const ssize_t put = ::write(file.number(), content.data(), content.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(put));
  }
  return file.close() ? 0 : errno;
}

}  // namespace

PartialFile::PartialFile(std::string path) : path_(std::move(path)) {
  for (std::size_t i = 0; i < kMostPartial; ++i) {
    const char* free = nullptr;
    if (!gPartial[i].compare_exchange_strong(free, path_.c_str())) continue;
    slot_ = static_cast<int>(i);
    return;
  }
}

PartialFile::~PartialFile() {
  if (slot_ >= 0) gPartial[static_cast<std::size_t>(slot_)] = nullptr;
  if (gEnding) waitForTheEnd();  // the path may be read just now
}

void removePartialFiles() noexcept {
  gEnding = true;
  // A thread that the signal interrupted makes nothing more. A file system that hangs is not waited for.
  const int own = tIsMaking;
  for (int waits = 0; gMaking > own && waits < kMostWaits; ++waits) ::poll(nullptr, 0, 1);
  for (const auto& partial : gPartial)
    if (const char* path = partial.load()) ::unlink(path);
}

std::string partialName(const std::string& path) { return path + ".partial"; }

Result<FileChange> writeFileAtomically(const std::string& path, std::string_view content) {
  const std::string partial = partialName(path);
  if (fileHolds(path, content)) {
    ::unlink(partial.c_str());  // of a run that was killed
    return FileChange::Kept;
  }
  const PartialFile known(partial);
  int error = writeAll(partial, content);
  if (error == 0 && ::rename(partial.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(partial.c_str());
    return writeError(path, error);
  }
  return FileChange::Written;
}

Result<void> makeDirectory(const std::string& directory) {
  std::error_code code;
  if (std::filesystem::is_directory(directory, code)) return {};
  if (std::filesystem::exists(directory, code))
    return failure("'" + directory + "' is a file, not a directory",
                   "remove it, or choose another directory");
  std::filesystem::create_directories(directory, code);
  if (code)
    return failure("cannot create the directory '" + directory + "': " + code.message(),
                   "choose a directory that can be created and written to");
  return {};
}

}  // namespace sherd
