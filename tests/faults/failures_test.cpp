// Nodes that fail in every way there is: the others finish, and the message names the culprit.
#include <signal.h>
#include <sys/resource.h>

#include "faults/program_process.h"
#include "support/sanitizers.h"

namespace sherd::faults {
namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Sanitizers take what address space they like, and end the program where there is no more.
constexpr bool kMemoryCanEnd = !test::kAddressSanitizer && !test::kThreadSanitizer;

/// As much address space as the program needs, and no 100 GB.
void limitMemory() {
  if (!kMemoryCanEnd) return;
  const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
  ::setrlimit(RLIMIT_AS, &limit);
}

struct Culprit {
  const char *body, *message;
  const char* after = R"("type": "Work@1", "in": {"a": "the culprit"})";
};

TEST(FailingNodes, OthersFinishAndTheMessageNamesTheNode) {
  for (const Culprit& culprit :
       {Culprit{R"("type": "Fail@1", "params": {"how": "error"})", "this never works; use another node"},
        Culprit{
            R"("type": "Fail@1", "params": {"how": "exception"})",
            "an exception that the node didn't catch: the bottom fell out; this is a mistake in Fail, please "
            "report it"},
        Culprit{
            R"("type": "Fail@1", "params": {"how": "number"})",
            "an unknown exception that the node didn't catch; this is a mistake in Fail, please report it"},
        Culprit{R"("type": "Allocate@1")", "out of memory; use a smaller model or a coarser resolution"},
        Culprit{R"("type": "MakeHeavy@1", "params": {"when": "hashed"})",
                "out of memory; use a smaller model or a coarser resolution",
                R"("type": "UseHeavy@1", "in": {"heavy": "the culprit"})"}}) {
    if (!kMemoryCanEnd && holds(culprit.message, "out of memory")) continue;
    const ScratchDirectory scratch;
    const Weave weave(scratch, {{"the culprit", culprit.body}, {"zz after it", culprit.after}});
    const auto expected = weave.undisturbed({"--target", "files"});
    const Ended ended = runSherd(weave.run({"--keep-going"}), weave.root(), FAULT_PACK, limitMemory);
    EXPECT_EQ(ended.exitCode, 1) << ended.out;
    EXPECT_EQ(ended.err, weave.file("graph.json:15:5: the culprit: ") + culprit.message + '\n');
    expectSameFiles(weave.outputs(), expected);
    const auto states = statesIn(ended.out);
    EXPECT_EQ(namesIn(states, "failed"), std::set<std::string>{"the culprit"});
    EXPECT_EQ(namesIn(states, "skipped"), std::set<std::string>{"zz after it"});
    EXPECT_EQ(namesIn(states, "run").size(), 12u);
    // What finished is not done again.
    weave.forgetLog();
    EXPECT_EQ(runSherd(weave.run({"--keep-going"}), weave.root(), FAULT_PACK, limitMemory).exitCode, 1);
    EXPECT_EQ(weave.log(), std::vector<std::string>{});
  }
}

TEST(FailingNodes, AValueTooBigToBeSavedIsNotKept) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {{"heavy", R"("type": "MakeHeavy@1", "params": {"when": "saved"})"},
                              {"user", R"("type": "UseHeavy@1", "in": {"heavy": "heavy"})"}});
  const auto expected = weave.undisturbed({"--target", "files"});
  const Ended first = weave.runToEnd();
  EXPECT_EQ(first.exitCode, 0) << first.out << first.err;
  EXPECT_EQ(first.err, "warning: a FaultHeavy is not kept in the cache: out of memory\n");
  expectSameFiles(weave.outputs(), expected);
  // It is made again when it is wanted.
  const Ended again = weave.runToEnd({"--set", "user.seed=1"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(namesIn(statesIn(again.out), "run"), (std::set<std::string>{"heavy", "user"}));
}

TEST(FailingNodes, AValueTooBigToBeLoadedIsMadeAgain) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {{"heavy", R"("type": "MakeHeavy@1", "params": {"when": "loaded"})"},
                              {"user", R"("type": "UseHeavy@1", "in": {"heavy": "heavy"})"}});
  EXPECT_EQ(weave.runToEnd().err, "");
  const Ended again = weave.runToEnd({"--set", "user.seed=1"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(again.err, "warning: a FaultHeavy can't be loaded from the cache: out of memory\n");
  EXPECT_EQ(namesIn(statesIn(again.out), "run"), (std::set<std::string>{"heavy", "user"}));
}

TEST(FailingNodes, AFailureStopsWhatCanBeStopped) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {{"hangs", R"("type": "Hang@1")"}, {"fails", R"("type": "Fail@1")"}});
  const Ended ended = weave.runToEnd({"--threads", "2"});
  EXPECT_EQ(ended.exitCode, 1) << ended.err;
  EXPECT_TRUE(holds(ended.err, ": fails: ")) << ended.err;
  EXPECT_FALSE(holds(ended.err, ": hangs: ")) << ended.err;
}

TEST(FailingNodes, AHangingNodeLetsOthersFinishUntilItIsCancelled) {
  const ScratchDirectory scratch;
  const Weave weave(scratch, {{"hangs", R"("type": "Hang@1", "params": {"name": "hangs", "log": ")" +
                                            scratch.file("hangs") + R"("})"}});
  const auto expected = weave.undisturbed({"--target", "files"});
  Process process(weave.run({"--keep-going", "--threads", "2"}), weave.root());
  EXPECT_TRUE(waitUntil([&] { return fs::exists(weave.file("out")) && weave.outputs() == expected; }));
  EXPECT_TRUE(waitUntil([&] { return linesOf(scratch.file("hangs")).size() == 1; }));
  sleepSeconds(0.1);  // records of the last files are on their way
  process.signal(SIGINT);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.exitCode, 130) << ended.err;
  const auto states = statesIn(ended.out);
  EXPECT_EQ(namesIn(states, "skipped"), std::set<std::string>{"hangs"});
  EXPECT_EQ(namesIn(states, "run").size(), 12u);
  weave.forgetLog();
  EXPECT_EQ(weave.runToEnd({"--target", "files"}).exitCode, 0);
  EXPECT_EQ(weave.log(), std::vector<std::string>{});
}

}  // namespace
}  // namespace sherd::faults
