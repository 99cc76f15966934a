#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/partial_file.h"

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

constexpr int kMostAttempts = 16;  // at a name of its own

Descriptor makeFile(const std::string& path) {
  const MakingFile making;
  return Descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
}

/// False where another process that looks for abandoned files came between; a file system without locks has
/// no such danger.
bool lockNew(const Descriptor& file) {
  struct stat info {};
  const bool taken = ::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  return !taken && ::fstat(file.number(), &info) == 0 && info.st_nlink > 0;
}

/// 0, or the error number.
int writeAll(const Descriptor& file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t put = ::write(file.number(), content.data(), content.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(put));
  }
  // Some errors only show on closing; but the lock has to last until the file has its final name.
  Descriptor twin(::fcntl(file.number(), F_DUPFD_CLOEXEC, 0));
  return twin.number() >= 0 && twin.close() ? 0 : errno;
}

/// Gives the file those that the one at `path` has, if there is one. 0, or the error number.
int takePermissions(const Descriptor& file, const std::string& path) {
  constexpr mode_t kPermissions = 0777;
  struct stat old {
  }, now{};
  if (::lstat(path.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return 0;
  if (::fstat(file.number(), &now) != 0) return errno;
  if (((old.st_mode ^ now.st_mode) & kPermissions) == 0) return 0;  // all there is where files have none
  return ::fchmod(file.number(), old.st_mode & kPermissions) == 0 ? 0 : errno;
}

/// 0, EEXIST where the name was not to be had, or another error number.
int writeAs(const std::string& partial, const std::string& path, std::string_view content) {
  const PartialFile known(partial);
  const Descriptor file = makeFile(partial);
  if (file.number() < 0) return errno;
  int error = lockNew(file) ? writeAll(file, content) : EEXIST;
  if (error == 0) error = takePermissions(file, path);
  if (error == 0 && ::rename(partial.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) ::unlink(partial.c_str());
  return error;
}

}  // namespace

Result<FileChange> writeFileAtomically(const std::string& path, std::string_view content) {
  if (fileHolds(path, content)) return FileChange::Kept;
  int error = EEXIST;
  for (int attempt = 0; attempt < kMostAttempts && error == EEXIST; ++attempt)
    error = writeAs(partialName(path), path, content);
  if (error != 0) return writeError(path, error);
  return FileChange::Written;
}

Result<void> makeDirectory(const std::string& directory) {
  // Made first and looked at afterwards: another process may be making it at this very moment.
  std::error_code code, ignored;
  std::filesystem::create_directories(directory, code);
  if (std::filesystem::is_directory(directory, ignored)) return {};
  if (std::filesystem::exists(directory, ignored))
    return failure("'" + directory + "' is a file, not a directory",
                   "remove it, or choose another directory");
  return failure("cannot create the directory '" + directory + "': " + code.message(),
                 "choose a directory that can be created and written to");
}

}  // namespace sherd
