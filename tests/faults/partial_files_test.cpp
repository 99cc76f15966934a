// What a process that ends in a signal's handler leaves of the files that its threads are writing.
#include <unistd.h>

#include <thread>

#include "base/atomic_file.h"
#include "base/partial_file.h"
#include "faults/program_process.h"
#include "support/sanitizers.h"

namespace sherd::faults {
namespace {

/// Writes small files without end, from several threads, until the process ends as onAlarm ends it.
[[noreturn]] void writeAndEnd(const std::string& directory, double seconds) {
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&directory, k] {
      for (int i = 0;; ++i) {
        const std::string path = directory + "/f" + std::to_string(k) + '_' + std::to_string(i % 50);
        static_cast<void>(writeFileAtomically(path, "content " + std::to_string(i)));
      }
    });
  sleepSeconds(seconds);
  removePartialFiles();
  sleepSeconds(0.002);  // the others go on for as long as the end takes
  ::_exit(0);
}

TEST(PartialFiles, NoneIsLeftWhileThreadsGoOnWriting) {
  if (test::kThreadSanitizer) GTEST_SKIP() << "the thread sanitizer starts no threads after a fork";
  const ScratchDirectory scratch;
  Random random(1);
  std::size_t written = 0;
  for (int round = 0; round < 50; ++round) {
    const std::string directory = scratch.file(std::to_string(round));
    fs::create_directories(directory);
    const double seconds = 0.002 + 0.008 * random.unit();
    const pid_t child = ::fork();
    if (child == 0) writeAndEnd(directory, seconds);
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    for (const auto& [name, content] : filesBelow(directory)) {
      EXPECT_FALSE(name.ends_with(".partial")) << name;
      EXPECT_TRUE(content.starts_with("content ")) << name;
      ++written;
    }
  }
  EXPECT_GT(written, 50u);
}

}  // namespace
}  // namespace sherd::faults
