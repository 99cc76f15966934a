#include "support/read_watch.h"

#include <dirent.h>
#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>

namespace sherd::test {
namespace {

std::atomic<bool> gWatching{false};
std::mutex gMutex;
// Never destroyed: libraries still open files and read variables when the
// process ends.
std::set<std::string>& files() {
  static auto* const names = new std::set<std::string>;
  return *names;
}
std::set<std::string>& variables() {
  static auto* const names = new std::set<std::string>;
  return *names;
}

/// The path that a descriptor of a directory stands for; /proc tells without
/// opening anything.
std::string directoryOf(int descriptor) {
  char target[PATH_MAX];
  const ssize_t length =
      ::readlink(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), target, sizeof target);
  return length < 0 ? std::string() : std::string(target, static_cast<std::size_t>(length));
}

constexpr int kCurrentDirectory = -100;  // AT_FDCWD; the header that has it would declare open(), too

/// Takes down a path as it was opened; `directory` is what relative ones start from.
void noteFile(const char* path, int directory) {
  if (!gWatching || path == nullptr) return;
  const int error = errno;
  std::filesystem::path full(path);
  if (full.is_relative()) {
    std::error_code problem;
    const auto base = directory == kCurrentDirectory ? std::filesystem::current_path(problem)
                                                     : std::filesystem::path(directoryOf(directory));
    full = base / full;
  }
  {
    const std::lock_guard lock(gMutex);
    files().insert(full.lexically_normal().string());
  }
  errno = error;
}

void noteVariable(const char* name) {
  if (!gWatching || name == nullptr) return;
  const std::lock_guard lock(gMutex);
  variables().insert(name);
}

}  // namespace

ReadWatch::ReadWatch() {
  const std::lock_guard lock(gMutex);
  files().clear();
  variables().clear();
  gWatching = true;
}

ReadWatch::~ReadWatch() { gWatching = false; }

WatchedReads ReadWatch::stop() {
  gWatching = false;
  const std::lock_guard lock(gMutex);
  return {{files().begin(), files().end()}, {variables().begin(), variables().end()}};
}

}  // namespace sherd::test

namespace {

constexpr int kCreates = 0100;         // O_CREAT
constexpr int kTemporary = 020200000;  // O_TMPFILE

bool hasMode(int flags) { return (flags & kCreates) != 0 || (flags & kTemporary) == kTemporary; }

/// The function that this one stands in for.
template <class F>
F* next(const char* name) {
  return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

#define SHERD_MODE(flags)               \
  unsigned mode = 0;                    \
  if (hasMode(flags)) {                 \
    va_list arguments;                  \
    va_start(arguments, flags);         \
    mode = va_arg(arguments, unsigned); \
    va_end(arguments);                  \
  }

#define SHERD_OPEN(name)                                                    \
  int name(const char* path, int flags, ...) {                              \
    SHERD_MODE(flags)                                                       \
    sherd::test::noteFile(path, sherd::test::kCurrentDirectory);            \
    static auto* const real = next<int(const char*, int, unsigned)>(#name); \
    return real(path, flags, mode);                                         \
  }

#define SHERD_OPENAT(name)                                                       \
  int name(int directory, const char* path, int flags, ...) {                    \
    SHERD_MODE(flags)                                                            \
    sherd::test::noteFile(path, directory);                                      \
    static auto* const real = next<int(int, const char*, int, unsigned)>(#name); \
    return real(directory, path, flags, mode);                                   \
  }

// What a library calls instead that was built with checks (_FORTIFY_SOURCE).
#define SHERD_CHECKED_OPEN(name)                                  \
  int name(const char* path, int flags) {                         \
    sherd::test::noteFile(path, sherd::test::kCurrentDirectory);  \
    static auto* const real = next<int(const char*, int)>(#name); \
    return real(path, flags);                                     \
  }

#define SHERD_FOPEN(name)                                                   \
  FILE* name(const char* path, const char* mode) {                          \
    sherd::test::noteFile(path, sherd::test::kCurrentDirectory);            \
    static auto* const real = next<FILE*(const char*, const char*)>(#name); \
    return real(path, mode);                                                \
  }

#define SHERD_GETENV(name)                                     \
  char* name(const char* variable) noexcept {                  \
    sherd::test::noteVariable(variable);                       \
    static auto* const real = next<char*(const char*)>(#name); \
    return real(variable);                                     \
  }

extern "C" {
SHERD_OPEN(open)
SHERD_OPEN(open64)
SHERD_OPENAT(openat)
SHERD_OPENAT(openat64)
SHERD_CHECKED_OPEN(__open_2)
SHERD_CHECKED_OPEN(__open64_2)
SHERD_FOPEN(fopen)
SHERD_FOPEN(fopen64)
SHERD_GETENV(getenv)
SHERD_GETENV(secure_getenv)

DIR* opendir(const char* path) {
  sherd::test::noteFile(path, sherd::test::kCurrentDirectory);
  static auto* const real = next<DIR*(const char*)>("opendir");
  return real(path);
}
}
