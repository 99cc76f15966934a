// Every node type of the pack, held to the contract.
#include <cstdio>

#include "contract/pack.h"
#include "support/sanitizers.h"

namespace sherd::test {
namespace {

class PackContract : public testing::TestWithParam<std::string> {
 protected:
  const NodeType& type() const { return *pack().find(GetParam()); }
};

TEST_P(PackContract, IsDocumented) {
  expectNone(documentationFaults(type(), packExceptions()));
  expectNone(staleExceptions(type(), packExceptions()));
}

TEST_P(PackContract, EveryParameterChangesTheKey) {
  const TemporaryDirectory scratch;
  expectNone(keyFaults(type(), scratch.path().string()));
}

TEST_P(PackContract, BadValuesAreRejectedWithTheirPlace) { expectNone(badValueFaults(type(), pack())); }

TEST_P(PackContract, ReadsNothingThatItDoesNotDeclare) {
  const PackExamples examples;
  for (const Example& example : examples.of(GetParam()))
    expectNone(undeclaredReads(example, packExceptions()));
}

TEST_P(PackContract, IsTheSameForAnyNumberOfThreads) {
  const PackExamples examples;
  for (const Example& example : examples.of(GetParam())) expectNone(nondeterminism(example));
}

TEST_P(PackContract, OutputsComeBackFromTheDiskCache) {
  const PackExamples examples;
  for (const Example& example : examples.of(GetParam()))
    expectNone(roundTripFaults(example, examples.scratch()));
}

void expectQuickEnd(const Example& example, CancelTrial trial) {
  trial.mostMs *= kSlowdown;
  const CancelResult result = cancelling(example, trial);
  expectNone(result.faults);
  std::printf(
      "%s (%s): ends at most %.1f ms after it is cancelled, then at %.0f %% of its %.0f ms; %d of %d\n",
      example.type().name.c_str(), example.name().c_str(), result.longestMs, 100 * result.longestAt,
      result.usualMs, result.cancelled, trial.delays);
}

TEST_P(PackContract, EndsSoonAfterItIsCancelled) {
  const PackExamples examples;
  for (const Example& example : examples.of(GetParam())) expectQuickEnd(example, {});
}

INSTANTIATE_TEST_SUITE_P(Nodes, PackContract, testing::ValuesIn(packTypes()),
                         [](const auto& info) { return info.param; });

TEST(PackExamples, HoldEveryNodeType) {
  const PackExamples examples;
  ASSERT_NE(examples.get(), nullptr);
  EXPECT_GE(pack().all().size(), 12u);
  expectNone(examples.get()->missing(pack()));
}

/// The same as above at the size that users work with, where there is time to be late.
class SlowPackContract : public testing::TestWithParam<std::string> {};

TEST_P(SlowPackContract, EndsSoonAfterItIsCancelled) {
  const PackExamples examples(
      {"mesh=" SHERD_SOURCE_DIR "/assets/vase.obj", "tets=5000", "degree=40", "width=640", "samples=16"});
  for (const Example& example : examples.of(GetParam())) expectQuickEnd(example, {.delays = 10});
}

TEST_P(SlowPackContract, EndsSoonAfterItIsCancelledOnALargeMesh) {
  const std::string bunny = SHERD_SOURCE_DIR "/../shared/meshes/bunny.obj";
  if (!std::filesystem::exists(bunny)) GTEST_SKIP() << "there is no " << bunny;
  const PackExamples examples(
      {"mesh=" + bunny, "tets=20000", "degree=48", "gamma=2", "width=1280", "samples=16"});
  for (const Example& example : examples.of(GetParam())) expectQuickEnd(example, {.delays = 10});
}

INSTANTIATE_TEST_SUITE_P(Nodes, SlowPackContract, testing::ValuesIn(packTypes()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sherd::test
