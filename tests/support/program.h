// Runs the program as a user does.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace sherd {

struct ProgramRun {
  int exitCode = -1;
  std::string output;  ///< standard output and error together
};

/// `arguments` as one would type them, quoted for a shell. Nothing is taken from or left in a cache, unless
/// they say --cache.
inline ProgramRun runProgram(const std::string& arguments, const std::string& environment = {}) {
  ProgramRun run;
  const bool evaluates = arguments.starts_with("run ") || arguments.starts_with("plan ");
  const bool isCached = !evaluates || arguments.find(" --cache ") != std::string::npos;
  const std::string command = environment + " '" SHERD_BINARY_DIR "/bin/sherd' " + arguments +
                              (isCached ? "" : " --no-cache") + " 2>&1 </dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return run;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) run.output.append(buffer, n);
  const int status = pclose(pipe);
  run.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

/// A directory of the running test's own, empty at the start and removed at the end.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("sherd_") + info->test_suite_name() + "_" + info->name();
    for (char& c : name)
      if (c == '/') c = '_';
    path_ = std::filesystem::path(testing::TempDir()) / (name + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchDirectory() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Every regular file below a directory, by relative name; programs may write there meanwhile, so that a
/// name may be gone before it is looked at: names are compared as they are spelled, not on the disk.
inline std::map<std::string, std::string> filesBelow(const std::string& directory) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(directory).string()] = contentOf(entry.path());
  return files;
}

}  // namespace sherd
