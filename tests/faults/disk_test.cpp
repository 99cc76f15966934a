// Disks that are full, read-only or gone, and caches with damaged bytes.
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "faults/program_process.h"

namespace sherd::faults {
namespace {

/// Something mounted at a directory, seen by this process and its children only.
class PrivateMount {
 public:
  static PrivateMount smallDisk(const std::string& directory) {
    return PrivateMount(directory, [&] { return ::mount("none", directory.c_str(), "tmpfs", 0, "size=1m"); });
  }
  /// The directory itself, read-only.
  static PrivateMount readOnly(const std::string& directory) {
    return PrivateMount(directory, [&] {
      const char* at = directory.c_str();
      return ::mount(at, at, nullptr, MS_BIND, nullptr) != 0
                 ? -1
                 : ::mount(nullptr, at, nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr);
    });
  }
  ~PrivateMount() {
    if (isThere_) ::umount2(directory_.c_str(), MNT_DETACH);
  }
  PrivateMount(const PrivateMount&) = delete;
  PrivateMount& operator=(const PrivateMount&) = delete;
  bool isThere() const { return isThere_; }

 private:
  PrivateMount(std::string directory, const std::function<int()>& mountIt)
      : directory_(std::move(directory)) {
    fs::create_directories(directory_);
    isThere_ = ::unshare(CLONE_NEWNS) == 0 &&
               ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 && mountIt() == 0;
  }
  std::string directory_;
  bool isThere_ = false;
};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(FullDisk, UnderTheCacheIsWarnedOfAndResultsAreRight) {
  const ScratchDirectory scratch;
  const Weave weave(scratch);
  const auto expected = weave.undisturbed();
  const PrivateMount disk = PrivateMount::smallDisk(weave.file("small"));
  if (!disk.isThere()) GTEST_SKIP() << "a small disk can't be mounted here";
  const std::string full = "warning: the cache in '" + weave.file("small") +
                           "' can't be written: No space left on device; results of this run are not kept\n";
  for (int round = 0; round < 3; ++round) {
    const Ended ended = weave.runToEnd({"--set", "a0.size=700000"}, "small");
    EXPECT_EQ(ended.exitCode, 0) << ended.err;
    EXPECT_TRUE(ended.err == full || (round > 0 && ended.err.empty())) << ended.err;
    const Ended plain = weave.runToEnd({}, "small");
    EXPECT_EQ(plain.exitCode, 0) << plain.err;
    expectSameFiles(weave.outputs(), expected);
  }
  EXPECT_TRUE(fs::is_empty(weave.file("small/tmp")));
}

TEST(FullDisk, UnderTheOutputIsACleanFailure) {
  const ScratchDirectory scratch;
  const Weave weave(scratch);
  const auto expected = weave.undisturbed();
  const PrivateMount disk = PrivateMount::smallDisk(weave.file("small"));
  if (!disk.isThere()) GTEST_SKIP() << "a small disk can't be mounted here";
  const std::vector<std::string> out{"--var", "out=" + weave.file("small")};
  std::vector<std::string> tooMuch = out;
  tooMuch.insert(tooMuch.end(), {"--keep-going", "--set", "right.size=300000"});
  const Ended full = weave.runToEnd(tooMuch);
  EXPECT_EQ(full.exitCode, 1) << full.out;
  EXPECT_TRUE(holds(full.err, weave.file("graph.json:")) && holds(full.err, "right: cannot write '"))
      << full.err;
  EXPECT_TRUE(
      holds(full.err, "No space left on device; free some space on that disk, or write to another one"))
      << full.err;
  for (const auto& [name, content] : filesBelow(weave.file("small")))
    EXPECT_FALSE(name.ends_with(".partial")) << name;
  // With less to write it fits, and all is as it would have been.
  const Ended again = weave.runToEnd(out);
  EXPECT_EQ(again.exitCode, 0) << again.err;
  expectSameFiles(filesBelow(weave.file("small")), expected);
}

TEST(ReadOnlyCache, IsReadAndWarnedOf) {
  const ScratchDirectory scratch;
  const Weave weave(scratch);
  const auto expected = weave.undisturbed();
  ASSERT_EQ(weave.runToEnd().exitCode, 0);
  const PrivateMount disk = PrivateMount::readOnly(weave.file("cache"));
  if (!disk.isThere()) GTEST_SKIP() << "a read-only disk can't be mounted here";
  weave.forgetLog();
  const Ended known = weave.runToEnd();
  EXPECT_EQ(known.exitCode, 0) << known.err;
  EXPECT_EQ(weave.log(), std::vector<std::string>{});
  const Ended edited = weave.runToEnd({"--set", "c1.seed=1"});
  EXPECT_EQ(edited.exitCode, 0) << edited.err;
  EXPECT_EQ(edited.err, "warning: the cache in '" + weave.file("cache") +
                            "' can't be written: Read-only file system; results of this run are not kept\n");
  EXPECT_EQ(weave.log(), (std::vector<std::string>{"c1", "d0", "right"}));
  expectSameFiles(weave.outputs(), weave.undisturbed({"--set", "c1.seed=1"}));
}

TEST(VanishedCache, MidRunLeavesResultsRight) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 30);
  const auto expected = weave.undisturbed();
  for (const std::size_t nodes : {1, 4, 6, 9}) {
    weave.startAnew();
    Process process(weave.run(), weave.root());
    ASSERT_TRUE(waitUntil([&] { return weave.log().size() >= nodes; }));
    EXPECT_TRUE(waitUntil([&] {  // new files may come while it goes
      std::error_code problem;
      fs::remove_all(weave.file("cache"), problem);
      return !fs::exists(weave.file("cache"));
    }));
    const Ended ended = process.wait();
    EXPECT_EQ(ended.exitCode, 0) << ended.out << ended.err;
    EXPECT_EQ(ended.err,
              "warning: the cache in '" + weave.file("cache") +
                  "' can't be written: No such file or directory; results of this run are not kept\n")
        << nodes;
    expectSameFiles(weave.outputs(), expected);
    const Ended again = weave.runToEnd();
    EXPECT_EQ(again.exitCode, 0) << again.out << again.err;
    EXPECT_EQ(again.err, "");
    expectSameFiles(weave.outputs(), expected);
  }
}

/// Makes a file other than it was.
void damage(const std::string& path, Random& random) {
  std::string bytes = contentOf(path);
  const std::size_t at = bytes.empty() ? 0 : random.below(bytes.size());
  switch (bytes.empty() ? 3 : random.below(5)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
      bytes.resize(at);
      break;
    case 2:
      for (std::size_t i = at; i < std::min(bytes.size(), at + 64); ++i)
        bytes[i] = static_cast<char>(random.below(256));
      break;
    case 3:
      bytes += "more than was written";
      break;
    default:
      bytes.erase(at, 1 + random.below(16));
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A graph of `count` nodes whose values are kept, in chains of four, the last of each written.
std::string manyValues(const std::string& root, int count) {
  std::string nodes;
  for (int i = 0; i < count; ++i) {
    const std::string name = "n" + std::to_string(i);
    const std::string in = i % 4 == 0 ? "" : R"("a": "n)" + std::to_string(i - 1) + '"';
    nodes += "\"" + name + R"(": {"type": "Work@1", "in": {)" + in + R"(}, "params": {"ms": 0.5, "name": ")" +
             name + "\"}},\n";
    if (i % 4 == 3)
      nodes += "\"w" + std::to_string(i) + R"(": {"type": "WriteFiles@1", "in": {"bytes": ")" + name +
               R"("}, "params": {"ms": 0, "count": 1, "size": 100, "directory": "${out}/)" + name + "\"}},\n";
  }
  writeText(root + "/graph.json", R"({"format": 1, "vars": {"out": "out"}, "nodes": {)" + nodes + "}}");
  return root + "/graph.json";
}

/// Damages about `each` files of the cache a round, and runs again to new outputs.
void damageAndRunAgain(int rounds, int each, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const std::string root = scratch.file(""), cache = scratch.file("cache");
  const std::string graph = manyValues(root, 280);
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"run", graph, "--quiet", "--var", "out=" + scratch.file(out)};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = runSherd(words, root);
    EXPECT_EQ(ended.exitCode, 0) << ended.out << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
    return filesBelow(scratch.file(out));
  };
  const auto expected = run("undisturbed", {"--no-cache"});
  EXPECT_EQ(expected.size(), 140u);
  expectSameFiles(run("first", {"--cache", cache}), expected);
  Random random(seed);
  int damaged = 0;
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(cache))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
    ASSERT_GT(files.size(), 280u);
    std::sort(files.begin(), files.end());
    for (int k = 0; k < each; ++k, ++damaged) damage(files[random.below(files.size())], random);
    // Records are few files of many entries: one more of them each time.
    for (const std::string& file : files)
      if (holds(file, "/records/")) damage(file, random);
    const std::string out = "again" + std::to_string(round);
    expectSameFiles(run(out, {"--cache", cache}), expected, "round " + std::to_string(round));
    fs::remove_all(scratch.file(out));
  }
  EXPECT_EQ(damaged, rounds * each);
}

TEST(DamagedCache, IsNeverAWrongResult) { damageAndRunAgain(2, 100, 1); }
TEST(DamagedCacheSlow, AThousandEntriesAreNeverAWrongResult) { damageAndRunAgain(10, 100, 2); }

}  // namespace
}  // namespace sherd::faults
