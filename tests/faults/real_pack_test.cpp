// The program with its own pack: exporters own their files, and a plan is what a run then does.
#include "faults/program_process.h"

namespace sherd::faults {
namespace {

const std::string kGraphs = SHERD_SOURCE_DIR "/graphs/";

using Words = std::vector<std::string>;

/// The mushroom in a few pieces, without a picture.
class Mushroom {
 public:
  explicit Mushroom(const ScratchDirectory& scratch) : scratch_(scratch) {}
  Ended run(int degree) const {
    return runSherd(
        {"run", kGraphs + "mushroom_drop.json", "--to", "crack", "--json", "--var",
         "degree=" + std::to_string(degree), "--var", "out=" + out(), "--cache", scratch_.file("cache")},
        scratch_.file(""), "");
  }
  std::string out() const { return scratch_.file("out"); }

 private:
  const ScratchDirectory& scratch_;
};

TEST(CrackSurface, OwnsTheFilesOfItsManifestAndNoOthers) {
  const ScratchDirectory scratch;
  const Mushroom mushroom(scratch);
  ASSERT_EQ(mushroom.run(4).exitCode, 0);
  auto four = filesBelow(mushroom.out());
  const Ended more = mushroom.run(7);
  ASSERT_EQ(more.exitCode, 0) << more.err;
  EXPECT_GT(filesBelow(mushroom.out()).size(), four.size());
  writeText(mushroom.out() + "/notes.txt", "mine");
  writeText(mushroom.out() + "/piece_0009_crack.obj.txt", "mine");
  fs::create_directories(mushroom.out() + "/piece_0001_surface.obj.d");
  writeText(mushroom.out() + "/piece_0001_surface.obj.d/deep", "mine");
  // Back to four, which are known: the export alone runs, and what is of seven alone goes.
  const Ended fewer = mushroom.run(4);
  ASSERT_EQ(fewer.exitCode, 0) << fewer.err;
  EXPECT_EQ(namesIn(statesIn(fewer.out), "run"), std::set<std::string>{"crack"});
  for (const char* name : {"notes.txt", "piece_0009_crack.obj.txt", "piece_0001_surface.obj.d/deep"})
    four[name] = "mine";
  expectSameFiles(filesBelow(mushroom.out()), four);
}

TEST(CrackSurface, MissingAndAlteredFilesComeBackThoughAllIsKnown) {
  const ScratchDirectory scratch;
  const Mushroom mushroom(scratch);
  ASSERT_EQ(mushroom.run(4).exitCode, 0);
  const auto files = filesBelow(mushroom.out());
  EXPECT_EQ(namesIn(statesIn(mushroom.run(4).out), "run"), std::set<std::string>{});
  for (const auto& [name, content] : files) {
    if (name == "sherd_manifest.json") continue;
    writeText(mushroom.out() + '/' + name, content.substr(0, content.size() / 2));
    const Ended altered = mushroom.run(4);
    EXPECT_EQ(altered.exitCode, 0) << altered.err;
    EXPECT_EQ(namesIn(statesIn(altered.out), "run"), std::set<std::string>{"crack"}) << name;
    expectSameFiles(filesBelow(mushroom.out()), files, name);
  }
  for (const auto& [name, content] : files)
    if (name != "sherd_manifest.json") fs::remove(mushroom.out() + '/' + name);
  EXPECT_EQ(mushroom.run(4).exitCode, 0);
  expectSameFiles(filesBelow(mushroom.out()), files);
  fs::remove_all(mushroom.out());
  EXPECT_EQ(mushroom.run(4).exitCode, 0);
  expectSameFiles(filesBelow(mushroom.out()), files);
}

TEST(CrackSurface, FilesThatNoManifestListsAreSomebodyElses) {
  const ScratchDirectory scratch;
  const Mushroom mushroom(scratch);
  ASSERT_EQ(mushroom.run(4).exitCode, 0);
  auto files = filesBelow(mushroom.out());
  fs::remove(mushroom.out() + "/sherd_manifest.json");
  files.erase("sherd_manifest.json");
  const Ended refused = mushroom.run(5);
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(
      refused.err.find("exists already and is not of an earlier export into this directory; move it away, or "
                       "choose another directory"),
      std::string::npos)
      << refused.err;
  expectSameFiles(filesBelow(mushroom.out()), files);
}

/// Plans and then runs the graph; every node that is planned as a hit is one, and every one to be run runs.
void expectPlanKept(const Words& words, const ScratchDirectory& scratch) {
  Words plan{"plan", "--json", "--cache", scratch.file("cache")},
      run{"run", "--json", "--cache", scratch.file("cache")};
  plan.insert(plan.end(), words.begin(), words.end());
  run.insert(run.end(), words.begin(), words.end());
  std::string edits;
  for (const std::string& word : words) edits += word + ' ';
  const Ended planned = runSherd(plan, scratch.file(""), ""), ran = runSherd(run, scratch.file(""), "");
  ASSERT_EQ(planned.exitCode, 0) << planned.err;
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const auto expected = statesIn(planned.out), states = statesIn(ran.out);
  for (const auto& [name, state] : expected) {
    const std::string became = states.contains(name) ? states.at(name) : "not needed";
    if (state == "follows")
      EXPECT_TRUE(became == "run" || became == "hit") << name << ": " << became << " by " << edits;
    else
      EXPECT_EQ(became, state) << name << " by " << edits;
  }
  EXPECT_EQ(namesIn(expected, "not needed").size() + states.size(), expected.size());
}

void expectPlansKept(const Words& base, const std::vector<Words>& edits) {
  const ScratchDirectory scratch;
  for (const Words& edit : edits) {
    Words words = base;
    words.insert(words.end(), {"--var", "out=" + scratch.file("out")});
    words.insert(words.end(), edit.begin(), edit.end());
    expectPlanKept(words, scratch);
  }
}

TEST(PlanAndRun, AgreeOnTheMushroomThroughEdits) {
  expectPlansKept({kGraphs + "mushroom_drop.json", "--to", "crack"},
                  {{"--var", "degree=4"},
                   {"--var", "degree=4"},
                   {"--var", "degree=5", "--set", "weights.alpha=0.5"},
                   {"--var", "degree=4"}});
}

TEST(PlanAndRunSlow, AgreeOnTheRecipeThroughEdits) {
  expectPlansKept({kGraphs + "recipe.json", "--set", "picture.width=64", "--set", "picture.height=64",
                   "--set", "picture.samples=1"},
                  {{"--var", "degree=4"},
                   {"--var", "degree=4"},
                   {"--var", "degree=4", "--set", "break.seed=8"},
                   {"--var", "degree=5", "--set", "tets.tets=600"},
                   {"--var", "degree=4", "--to", "crack"},
                   {"--var", "degree=4", "--set", "picture.width=80"},
                   {"--var", "degree=4", "--set", "break.alpha=0.5", "--to", "break"},
                   {"--var", "degree=4"}});
}

}  // namespace
}  // namespace sherd::faults
