// Nodes that fail in every way there is: the others finish, and the message names the culprit.
#include <signal.h>
#include <sys/resource.h>

#include "faults/program_process.h"

namespace sherd::faults {
namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// As much address space as the program needs, and no 100 GB.
void limitMemory() {
  const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
  ::setrlimit(RLIMIT_AS, &limit);
}

struct Culprit {
  const char *body, *message;
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
        Culprit{R"("type": "Allocate@1")", "out of memory; use a smaller model or a coarser resolution"}}) {
    const ScratchDirectory scratch;
    const Weave weave(scratch, {{"the culprit", culprit.body},
                                {"after it", R"("type": "Work@1", "in": {"a": "the culprit"})"}});
    const auto expected = weave.undisturbed({"--target", "files"});
    const Ended ended = runSherd(weave.run({"--keep-going"}), weave.root(), FAULT_PACK, limitMemory);
    EXPECT_EQ(ended.exitCode, 1) << ended.out;
    EXPECT_EQ(ended.err, weave.file("graph.json:16:5: the culprit: ") + culprit.message + '\n');
    expectSameFiles(weave.outputs(), expected);
    const auto states = statesIn(ended.out);
    EXPECT_EQ(namesIn(states, "failed"), std::set<std::string>{"the culprit"});
    EXPECT_EQ(namesIn(states, "skipped"), std::set<std::string>{"after it"});
    EXPECT_EQ(namesIn(states, "run").size(), 12u);
    // What finished is not done again.
    weave.forgetLog();
    EXPECT_EQ(runSherd(weave.run({"--keep-going"}), weave.root(), FAULT_PACK, limitMemory).exitCode, 1);
    EXPECT_EQ(weave.log(), std::vector<std::string>{});
  }
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
