#include "base/partial_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <memory>
#include <system_error>
#include <utility>

#include "base/hash.h"

namespace sherd {
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

void madeFile() {
  tIsMaking = 0;
  --gMaking;
}

constexpr std::string_view kEnding = ".partial";
constexpr std::size_t kDigits = 16;
constexpr std::time_t kDay = 86400;

/// Calls `act` if the process that wrote the file has died, with the file locked: its name may have been
/// given to a new one meanwhile, whose writer must not lose it.
template <class F>
void ifAbandoned(const std::string& path, F&& act) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return;
  struct stat info {};
  bool abandoned = ::fstat(file, &info) == 0 && S_ISREG(info.st_mode);
  if (abandoned && ::flock(file, LOCK_EX | LOCK_NB) != 0)
    abandoned = errno != EWOULDBLOCK && info.st_mtim.tv_sec + kDay < std::time(nullptr);
  else if (abandoned)
    abandoned = ::fstat(file, &info) == 0 && info.st_nlink > 0;
  if (abandoned) act();
  ::close(file);
}

/// Calls visit(path, target) for each, the target without its directory.
template <class F>
void eachAbandoned(const std::string& directory, const std::function<bool(const std::string&)>& isOurs,
                   F&& visit) {
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::opendir(directory.c_str()), &::closedir);
  if (stream == nullptr) return;
  while (const dirent* entry = ::readdir(stream.get())) {
    const std::string target = partialTarget(entry->d_name);
    if (target.empty() || !isOurs(target)) continue;
    const std::string path = directory + '/' + entry->d_name;
    ifAbandoned(path, [&] { visit(path, target); });
  }
}

std::pair<std::string, std::string> directoryAndName(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {path.substr(0, std::max<std::size_t>(slash, 1)), path.substr(slash + 1)};
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

MakingFile::MakingFile() {
  ++gMaking;
  tIsMaking = 1;
  if (!gEnding) return;
  madeFile();
  waitForTheEnd();
}

MakingFile::~MakingFile() { madeFile(); }

void removePartialFiles() noexcept {
  gEnding = true;
  // A thread that the signal interrupted makes nothing more. A file system that hangs is not waited for.
  const int own = tIsMaking;
  for (int waits = 0; gMaking > own && waits < kMostWaits; ++waits) ::poll(nullptr, 0, 1);
  for (const auto& partial : gPartial)
    if (const char* path = partial.load()) ::unlink(path);
}

std::string randomName() {
  std::uint64_t bits = 0;
  while (::getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) continue;
  return Digest{bits, 0}.hex().substr(0, kDigits);
}

std::string partialName(const std::string& path) { return path + '.' + randomName() + std::string(kEnding); }

std::string partialTarget(const std::string& path) {
  const std::size_t more = 1 + kDigits + kEnding.size();
  if (path.size() <= more || !path.ends_with(kEnding)) return {};
  const std::size_t dot = path.size() - more;
  const std::string_view digits = std::string_view(path).substr(dot + 1, kDigits);
  const bool isOne = path[dot] == '.' && path[dot - 1] != '/' &&
                     digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  return isOne ? path.substr(0, dot) : std::string();
}

Result<void> removeAbandoned(const std::string& directory,
                             const std::function<bool(const std::string&)>& isOurs) {
  Result<void> result;
  eachAbandoned(directory, isOurs, [&](const std::string& path, const std::string&) {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT)
      result = failure("cannot remove '" + path + "', which a run that was killed left half-written: " +
                           std::generic_category().message(errno),
                       "remove it by hand");
  });
  return result;
}

Result<void> removeAbandoned(const std::string& path) {
  const auto [directory, name] = directoryAndName(path);
  return removeAbandoned(directory, [&name = name](const std::string& target) { return target == name; });
}

bool AbandonedFiles::isBeside(const std::string& path) {
  const auto [directory, name] = directoryAndName(path);
  const auto [targets, isNew] = targets_.try_emplace(directory);
  if (isNew)
    eachAbandoned(
        directory, [](const std::string&) { return true; },
        [&](const std::string&, const std::string& target) { targets->second.insert(target); });
  return targets->second.contains(name);
}

}  // namespace sherd
