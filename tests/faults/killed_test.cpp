// The process is killed, or interrupted, at random moments; running again is resuming.
#include <signal.h>

#include <algorithm>

#include "faults/program_process.h"
#include "support/sanitizers.h"

namespace sherd::faults {
namespace {

/// What a process that was ended leaves behind: whole files only, or at most what is being written.
void expectWholeFiles(const std::map<std::string, std::string>& files,
                      const std::map<std::string, std::string>& expected, const std::string& when) {
  for (const auto& [name, content] : files) {
    EXPECT_TRUE(expected.contains(name)) << name << " is stray, " << when;
    const bool isWhole =
        name.ends_with("sherd_manifest.json") || !expected.contains(name) || content == expected.at(name);
    EXPECT_TRUE(isWhole) << name << " differs, " << when;
  }
}

double secondsOfARun(const Weave& weave) {
  weave.startAnew();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(weave.runToEnd().exitCode, 0);
  return secondsSince(start);
}

void killAtRandomMoments(int rounds, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const Weave weave(scratch);
  const auto expected = weave.undisturbed();
  double length = secondsOfARun(weave);
  Random random(seed);
  int finishedBefore = 0;
  for (int round = 0; round < rounds; ++round) {
    weave.startAnew();
    std::set<std::string> finished;
    const std::size_t kills = 1 + random.below(3) / 2;
    for (std::size_t kill = 0; kill < kills; ++kill) {
      Process process(weave.run(), weave.root());
      sleepSeconds(random.unit() * length);
      process.signal(SIGKILL);
      finished.merge(namesIn(statesIn(process.wait().out), "run"));
    }
    finishedBefore += static_cast<int>(finished.size());
    if (finished.empty()) length *= 1.25;  // a machine that has more to do now than when a run was timed
    const std::string when = "round " + std::to_string(round);
    weave.forgetLog();
    const Ended again = weave.runToEnd();
    ASSERT_EQ(again.exitCode, 0) << again.out << again.err << when;
    EXPECT_EQ(again.err, "") << when;
    for (const std::string& name : weave.log())
      EXPECT_FALSE(finished.contains(name)) << name << " was finished and ran again, " << when;
    expectSameFiles(weave.outputs(), expected, when);
    ASSERT_EQ(runSherd({"cache", "gc", "--cache", weave.file("cache")}, weave.root()).exitCode, 0);
    EXPECT_TRUE(fs::is_empty(weave.file("cache/tmp"))) << when;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(finishedBefore, rounds);  // else the moments were badly chosen
}

/// The runs that are killed write more or fewer files than those that follow.
void killAndEdit(int rounds, std::uint64_t seed) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 1);
  const auto expected = weave.undisturbed();
  weave.startAnew();
  const double length = secondsOfARun(weave);
  Random random(seed);
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    if (random.below(2) == 0) weave.startAnew();  // else the files of the last run are there
    for (std::size_t kill = 0; kill < 2; ++kill) {
      const std::string count = std::to_string(1 + random.below(12)),
                        bytes = std::to_string(random.below(500'000));
      Process process(weave.run({"--set", "right.count=" + count, "--set", "left.size=" + bytes}),
                      weave.root());
      sleepSeconds(random.unit() * length);
      process.signal(SIGKILL);
      process.wait();
    }
    const Ended again = weave.runToEnd();
    EXPECT_EQ(again.exitCode, 0) << again.out << again.err;
    expectSameFiles(weave.outputs(), expected, "round " + std::to_string(round));
  }
}

TEST(Killed, AHalfWrittenFileBesideFilesThatAreKnownGoes) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {}, 1);
  EXPECT_EQ(weave.runToEnd().exitCode, 0);
  const auto expected = weave.outputs();
  for (const std::string target : {"out/right/sherd_manifest.json", "out/right/piece_2_crack.obj"}) {
    const std::string name = target + ".0123456789abcdef.partial";
    writeText(weave.file(name), "half");
    weave.forgetLog();
    EXPECT_EQ(weave.runToEnd().exitCode, 0);
    EXPECT_EQ(weave.log(), std::vector<std::string>{"right"});
    expectSameFiles(weave.outputs(), expected, name);
  }
}

TEST(Killed, AnotherRunThanTheKilledOneCleansUp) { killAndEdit(10, 5); }
TEST(KilledSlow, AnotherRunThanTheKilledOneCleansUpTwoHundredTimes) { killAndEdit(200, 6); }
TEST(Killed, AnyMomentResumes) { killAtRandomMoments(20, 1); }
TEST(KilledSlow, TwoHundredMomentsResume) { killAtRandomMoments(200, 2); }

struct Interrupts {
  int cancelled = 0;
  std::vector<double> seconds;
  double median() {
    std::sort(seconds.begin(), seconds.end());
    return seconds.empty() ? 0 : seconds[seconds.size() / 2];
  }
};

/// Interrupts runs of all nodes, and completes each for the files alone.
Interrupts interruptAtRandomMoments(const Weave& weave, int rounds, std::uint64_t seed) {
  const std::vector<std::string> complete{"--target", "files"};
  const auto expected = weave.undisturbed(complete);
  weave.startAnew();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(weave.runToEnd(complete).exitCode, 0);
  const double length = secondsSince(begin);
  Random random(seed);
  Interrupts interrupts;
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    const std::string when = "round " + std::to_string(round);
    weave.startAnew();
    Process process(weave.run({"--threads", "2"}), weave.root());
    sleepSeconds(random.unit() * length);
    const auto start = std::chrono::steady_clock::now();
    process.signal(SIGINT);
    const Ended ended = process.wait();
    interrupts.seconds.push_back(secondsSince(start));
    EXPECT_LT(interrupts.seconds.back(), test::kSlowdown) << when;
    const bool isDone = ended.out.find(R"("event":"done","ok":true)") != std::string::npos;
    EXPECT_EQ(ended.exitCode, isDone ? 0 : 130) << ended.out << ended.err << when;
    interrupts.cancelled += !isDone;
    if (fs::exists(weave.file("out"))) expectWholeFiles(weave.outputs(), expected, when);
    const std::set<std::string> finished = namesIn(statesIn(ended.out), "run");
    weave.forgetLog();
    const Ended again = weave.runToEnd(complete);
    EXPECT_EQ(again.exitCode, 0) << again.out << again.err << when;
    for (const std::string& name : weave.log())
      EXPECT_FALSE(finished.contains(name)) << name << " was finished and ran again, " << when;
    expectSameFiles(weave.outputs(), expected, when);
  }
  return interrupts;
}

void interrupt(int rounds, const std::map<std::string, std::string>& more) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, more);
  Interrupts interrupts = interruptAtRandomMoments(weave, rounds, 3);
  EXPECT_LT(interrupts.median(), 0.1 * test::kSlowdown);
  EXPECT_GT(interrupts.cancelled, rounds / 2);
  testing::Test::RecordProperty("median_ms", static_cast<int>(1000 * interrupts.median()));
}

const std::map<std::string, std::string> kDeaf{{"hard", R"("type": "Hang@1", "params": {"hard": true})"}};

TEST(Interrupted, EndsAtOnceAndResumes) { interrupt(10, {}); }
TEST(Interrupted, EndsAtOnceThoughANodeIsDeaf) { interrupt(10, kDeaf); }
TEST(InterruptedSlow, TwoHundredMoments) { interrupt(200, {}); }
TEST(InterruptedSlow, TwoHundredMomentsThoughANodeIsDeaf) { interrupt(200, kDeaf); }

TEST(Interrupted, EndsAtOnceThoughAFailureHasStoppedTheRunAlready) {
  const ScratchDirectory scratch;
  const std::string log = scratch.file("log");
  writeText(
      scratch.file("graph.json"),
      R"({"format": 1, "nodes": {"hard": {"type": "Hang@1", "params": {"hard": true, "name": "hard", "log": ")" +
          log + R"("}}, "slow": {"type": "Work@1", "params": {"ms": 300}},
  "fails": {"type": "Fail@1", "in": {"after": "slow"}, "params": {"name": "fails", "log": ")" +
          log + R"("}}}})");
  Process process({"run", scratch.file("graph.json"), "--no-cache", "--threads", "2"}, scratch.file(""));
  ASSERT_TRUE(waitUntil([&] { return linesOf(log).size() == 2; }));
  sleepSeconds(0.05);
  const auto start = std::chrono::steady_clock::now();
  process.signal(SIGINT);
  const Ended ended = process.wait(15);
  EXPECT_LT(secondsSince(start), test::kSlowdown);
  EXPECT_EQ(ended.exitCode, 130) << ended.err;
}

}  // namespace
}  // namespace sherd::faults
