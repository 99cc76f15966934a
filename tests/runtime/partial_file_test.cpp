// Files that are being written: their names, whose they are, and that many may write one at once.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "base/atomic_file.h"
#include "base/partial_file.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

class PartialFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (directory.path() / name).string(); }
  /// As a process that was killed leaves it.
  std::string abandon(const std::string& target) const {
    const std::string partial = partialName(path(target));
    std::ofstream(partial) << "half";
    return partial;
  }
  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(directory.path()))
      found.insert(entry.path().filename().string());
    return found;
  }

  TemporaryDirectory directory;
};

TEST_F(PartialFiles, NamesTellTheirTarget) {
  for (const std::string target : {"/a/piece_0001_crack.obj", "x", "/ä b/c.partial"}) {
    EXPECT_EQ(partialTarget(partialName(target)), target);
    EXPECT_NE(partialName(target), partialName(target));
  }
  for (const char* other :
       {"", ".partial", "a.partial", ".0123456789abcdef.partial", "/a/.0123456789abcdef.partial",
        "a.0123456789abcdeg.partial", "a.0123456789ABCDEF.partial", "a0123456789abcdef0.partial",
        "a.0123456789abcdef.partial2", "a.0123456789abcdef"})
    EXPECT_EQ(partialTarget(other), "") << other;
}

TEST_F(PartialFiles, OnlyWhatIsOursAndAbandonedGoes) {
  abandon("ours");
  const std::string theirs = abandon("theirs"), busy = partialName(path("ours"));
  const int file = ::open(busy.c_str(), O_WRONLY | O_CREAT, 0666);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);  // as by a process that is still writing
  for (const char* stranger : {"ours.partial", "ours.tmp", "ours.0123.partial"})
    std::ofstream(path(stranger)) << "precious";
  fs::create_directory(partialName(path("ours")));
  fs::create_symlink(theirs, partialName(path("ours")));
  const std::size_t before = names().size();
  EXPECT_TRUE(removeAbandoned(path("ours")).ok());
  EXPECT_EQ(names().size(), before - 1);
  EXPECT_TRUE(fs::exists(theirs) && fs::exists(busy));
  ::close(file);
  EXPECT_TRUE(removeAbandoned(path("ours")).ok());
  EXPECT_FALSE(fs::exists(busy));
  EXPECT_EQ(names().size(), before - 2);
}

TEST_F(PartialFiles, AbandonedOnesAreSeenBesideTheirTargetOnly) {
  abandon("a");
  AbandonedFiles abandoned;
  EXPECT_TRUE(abandoned.isBeside(path("a")));
  EXPECT_FALSE(abandoned.isBeside(path("b")));
  EXPECT_FALSE(abandoned.isBeside(path("none/a")));
  EXPECT_TRUE(removeAbandoned(path("a")).ok());
  EXPECT_FALSE(AbandonedFiles().isBeside(path("a")));
}

TEST_F(PartialFiles, SaysWhatCannotBeRemoved) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may remove everything";
  const std::string left = abandon("a");
  fs::permissions(directory.path(), fs::perms::owner_read | fs::perms::owner_exec);
  const auto removed = removeAbandoned(path("a"));
  fs::permissions(directory.path(), fs::perms::owner_all);
  ASSERT_FALSE(removed.ok());
  EXPECT_NE(removed.error().what.find("cannot remove '" + left + "'"), std::string::npos);
}

TEST_F(PartialFiles, PermissionsOfAFileStayAsTheyAre) {
  const std::string target = path("private.json");
  std::ofstream(target) << "old";
  for (const fs::perms perms : {fs::perms::owner_read | fs::perms::owner_write, fs::perms::owner_read}) {
    fs::permissions(target, perms);
    EXPECT_TRUE(writeFileAtomically(target, "new " + std::to_string(static_cast<int>(perms))).ok());
    EXPECT_EQ(fs::status(target).permissions(), perms);
  }
}

TEST_F(PartialFiles, ManyThreadsWriteOneFileWhileOthersCleanUp) {
  const std::string target = path("file");
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 300; ++i) {
        const auto written =
            writeFileAtomically(target, std::string(1000, static_cast<char>('a' + t)) + std::to_string(i));
        EXPECT_TRUE(written.ok()) << written.error().what;
        EXPECT_TRUE(removeAbandoned(target).ok());
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(names(), std::set<std::string>{"file"});
  EXPECT_EQ(fs::file_size(target), 1003u);
}

}  // namespace
}  // namespace sherd::test
