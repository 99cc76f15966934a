// Several processes on one cache, one of which may be emptying it, or on one output directory.
#include <signal.h>
#include <stdlib.h>

#include "faults/program_process.h"

namespace sherd::faults {
namespace {

/// Edits of a few kinds, so that the processes often want the same result.
std::vector<std::string> randomEdits(Random& random) {
  std::vector<std::string> edits;
  for (const char* node : {"a0", "a2", "b1", "c1"})
    if (random.below(3) == 0)
      edits.insert(edits.end(), {"--set", std::string(node) + ".seed=" + std::to_string(random.below(3))});
  return edits;
}

/// What a run with these edits writes, found out once without a cache.
class Uncached {
 public:
  explicit Uncached(const Weave& weave) : weave_(weave) {}
  const std::map<std::string, std::string>& files(const std::vector<std::string>& edits) {
    auto& files = known_[edits];
    if (files.empty()) files = weave_.undisturbed(edits);
    return files;
  }

 private:
  const Weave& weave_;
  std::map<std::vector<std::string>, std::map<std::string, std::string>> known_;
};

/// One of the processes of a round, with outputs of its own.
struct Runner {
  std::string out;
  std::vector<std::string> edits;
  std::unique_ptr<Process> process;

  void start(const Weave& weave, Random& random) {
    edits = randomEdits(random);
    std::vector<std::string> words = edits;
    words.insert(words.end(), {"--var", "out=" + out});
    process = std::make_unique<Process>(weave.run(words), weave.root());
  }
  void expectRight(Uncached& uncached, const std::string& when) {
    const Ended ended = process->wait();
    ASSERT_EQ(ended.exitCode, 0) << ended.out << ended.err << when;
    EXPECT_EQ(ended.err, "") << when;
    expectSameFiles(filesBelow(out), uncached.files(edits), when);
  }
};

void runSideBySide(int rounds, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 2);
  Uncached uncached(weave);
  Random random(seed);
  Runner runners[2];
  for (int k = 0; k < 2; ++k) runners[k].out = weave.file("out" + std::to_string(k));
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    for (Runner& runner : runners) runner.start(weave, random);
    for (Runner& runner : runners) runner.expectRight(uncached, "round " + std::to_string(round));
  }
  const Ended verified = runSherd({"cache", "verify", "--cache", weave.file("cache")}, weave.root());
  EXPECT_EQ(verified.exitCode, 0);
  EXPECT_EQ(verified.out, "all is sound\n");
}

void runWhileEmptied(int rounds, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 2);
  Uncached uncached(weave);
  Random random(seed);
  Runner runner{weave.file("out"), {}, nullptr};
  int emptied = 0;
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    runner.start(weave, random);
    for (int k = 0; k < 6; ++k, ++emptied) {
      const Ended gc = runSherd({"cache", "gc", "--max", "0", "--cache", weave.file("cache")}, weave.root());
      ASSERT_EQ(gc.exitCode, 0) << gc.err;
    }
    runner.expectRight(uncached, "round " + std::to_string(round));
  }
  EXPECT_EQ(emptied, 6 * rounds);
}

/// Two processes, each with a cache of its own, write the same files; every other time one of them is killed.
void writeOneDirectory(int rounds, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 1);
  const auto expected = weave.undisturbed();
  Random random(seed);
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    const std::string when = "round " + std::to_string(round);
    weave.startAnew();
    fs::remove_all(weave.file("other"));
    Process killed(weave.run({}, "other"), weave.root());
    Process whole(weave.run(), weave.root());
    const bool isKilled = round % 2 == 1;
    if (isKilled) {
      sleepSeconds(0.15 * random.unit());
      killed.signal(SIGKILL);
    }
    const Ended first = killed.wait(), second = whole.wait();
    EXPECT_EQ(second.exitCode, 0) << second.out << second.err << when;
    EXPECT_EQ(first.exitCode, isKilled && first.exitCode != 0 ? 128 + SIGKILL : 0)
        << first.out << first.err << when;
    EXPECT_EQ(weave.runToEnd().exitCode, 0) << when;
    expectSameFiles(weave.outputs(), expected, when);
  }
}

std::uint64_t bytesBelow(const std::string& directory) {
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(directory))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

TEST(CacheSize, IsKeptToByOptionAndByVariable) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 2);
  const auto expected = weave.undisturbed();
  EXPECT_EQ(weave.runToEnd().exitCode, 0);
  EXPECT_GT(bytesBelow(weave.file("cache")), 1'000'000u);
  EXPECT_EQ(weave.runToEnd({"--set", "a0.seed=1", "--cache-size", "500K"}).exitCode, 0);
  EXPECT_LE(bytesBelow(weave.file("cache")), 500u << 10);
  EXPECT_GE(bytesBelow(weave.file("cache")), 300u << 10);
  const auto setSmall = [] { ::setenv("SHERD_CACHE_SIZE", "250K", 1); };
  EXPECT_EQ(runSherd(weave.run({"--set", "a0.seed=2"}), weave.root(), FAULT_PACK, setSmall).exitCode, 0);
  EXPECT_LE(bytesBelow(weave.file("cache")), 250u << 10);
  EXPECT_EQ(weave.runToEnd().exitCode, 0);
  expectSameFiles(weave.outputs(), expected);
  const Ended refused = weave.runToEnd({"--cache-size", "huge"});
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find("--cache-size: \"huge\" is no size"), std::string::npos) << refused.err;
}

TEST(SharedOutput, TwoProcessesMayWriteTheSameFiles) { writeOneDirectory(20, 5); }
TEST(SharedCache, TwoProcessesAgreeWithNone) { runSideBySide(8, 1); }
TEST(SharedCacheSlow, TwoProcessesAgreeWithNoneFor50Rounds) { runSideBySide(50, 2); }
TEST(SharedCache, MayBeEmptiedAtAnyMoment) { runWhileEmptied(8, 3); }
TEST(SharedCacheSlow, MayBeEmptiedAtAnyMomentFor50Rounds) { runWhileEmptied(50, 4); }

}  // namespace
}  // namespace sherd::faults
