// `sherd cache`: what it says and does.
#include <gtest/gtest.h>

#include <sstream>

#include "cli/cache_size.h"
#include "cli/command_line.h"
#include "cli/verbs.h"
#include "runtime/disk_values.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

class CacheVerb : public ::testing::Test {
 protected:
  int run(const std::string& action, const std::string& max = "") {
    out.str("");
    err.str("");
    Console console{out, err, cancel, false, 80};
    return cacheVerb({action, root.string(), max}, environment(directory.path()), console);
  }
  void fill() {
    const auto store = openStore(root);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Value value = valueOf(leaf(i, 1000));
      store->save(value, value.digest(), 5);
      store->record(recordOf(i, 5));
    }
  }

  TemporaryDirectory directory;
  fs::path root = directory.path() / "cache";
  CancelToken cancel;
  std::ostringstream out, err;
};

TEST_F(CacheVerb, SaysWhenThereIsNone) {
  for (const char* action : {"stat", "gc", "verify", "clear"}) {
    EXPECT_EQ(run(action), kOk);
    EXPECT_EQ(out.str(), "there is no cache in " + shownPath(root.string()) + "\n");
  }
  EXPECT_FALSE(fs::exists(root));
}

TEST_F(CacheVerb, StatCounts) {
  fill();
  EXPECT_EQ(run("stat"), kOk) << err.str();
  EXPECT_EQ(out.str().find("cache in " + shownPath(root.string()) + "\n"), 0u) << out.str();
  EXPECT_NE(out.str().find("  values          20  158.0 KiB\n"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("  results         20  "), std::string::npos) << out.str();
  EXPECT_TRUE(out.str().ends_with(" KiB of at most 10.0 GiB\n")) << out.str();
}

TEST_F(CacheVerb, GcKeepsWithinMax) {
  fill();
  EXPECT_EQ(run("gc"), kOk);
  EXPECT_TRUE(out.str().starts_with("freed 0 bytes; 16") &&
              out.str().ends_with(" KiB are left of at most 10.0 GiB\n"))
      << out.str();
  EXPECT_EQ(run("gc", "100K"), kOk);
  EXPECT_TRUE(out.str().ends_with(" KiB are left of at most 100.0 KiB\n")) << out.str();
  const DiskStoreStats stats = openStore(root)->stats();
  EXPECT_GE(stats.objects, 11u);
  EXPECT_EQ(stats.records, 20u);
  EXPECT_LE(stats.bytes(), 100u << 10);
}

TEST_F(CacheVerb, VerifyListsWhatWasDamaged) {
  fill();
  EXPECT_EQ(run("verify"), kOk);
  EXPECT_EQ(out.str(), "all is sound\n");
  const fs::path victim = objectPath(root, valueOf(leaf(3, 1000)).digest());
  writeFile(victim, readFile(victim).substr(0, 500));
  EXPECT_EQ(run("verify"), kOk);
  EXPECT_EQ(out.str(), "objects/" + victim.parent_path().filename().string() + '/' +
                           victim.filename().string() +
                           ": truncated, deleted\n1 file of the cache was damaged; what is lost will be "
                           "computed again\n");
  EXPECT_EQ(run("verify"), kOk);
  EXPECT_EQ(out.str(), "all is sound\n");
}

TEST_F(CacheVerb, ClearRemovesTheResults) {
  fill();
  EXPECT_EQ(run("clear"), kOk);
  EXPECT_EQ(out.str(), "cleared the cache in " + shownPath(root.string()) + "\n");
  EXPECT_EQ(openStore(root)->stats().objects + openStore(root)->stats().records, 0u);
}

TEST_F(CacheVerb, RefusesWhatIsWrong) {
  EXPECT_EQ(run(""), kWrongInput);
  EXPECT_EQ(err.str(), "cache needs to know what to do; cache takes stat, gc, verify or clear\n");
  EXPECT_EQ(run("claer"), kWrongInput);
  EXPECT_EQ(err.str(),
            "cache can't \"claer\"; did you mean \"clear\"? cache takes stat, gc, verify or clear\n");
  EXPECT_EQ(run("gc", "10 apples"), kWrongInput);
  EXPECT_NE(err.str().find("\"10 apples\" is no size; write a number of bytes"), std::string::npos)
      << err.str();
  fs::create_directories(root);
  writeFile(root / "thesis.txt", "precious");
  for (const char* action : {"stat", "gc", "verify", "clear"}) {
    EXPECT_EQ(run(action), kWrongInput);
    EXPECT_NE(err.str().find("holds something else than a cache of sherd"), std::string::npos);
  }
  EXPECT_EQ(readFile(root / "thesis.txt"), "precious");
}

TEST_F(CacheVerb, NeedsADirectory) {
  root.clear();
  EXPECT_EQ(run("stat"), kWrongInput);
  EXPECT_EQ(err.str(),
            "there is no directory for the cache: none of the environment variables SHERD_CACHE, "
            "XDG_CACHE_HOME and HOME is set; name one with --cache\n");
}

TEST_F(CacheVerb, IsReachedFromTheCommandLine) {
  fill();
  Console console{out, err, cancel, false, 80};
  EXPECT_EQ(runCommandLine({"cache", "gc", "--cache", root.string(), "--max", "0"}, console), kOk)
      << err.str();
  EXPECT_NE(out.str().find(" are left of at most 0 bytes\n"), std::string::npos);
  EXPECT_EQ(openStore(root)->stats().objects, 0u);
  EXPECT_EQ(runCommandLine({"cache"}, console), kWrongInput);
  EXPECT_EQ(runCommandLine({"cache", "stat", "--cach", "x"}, console), kWrongInput);
  EXPECT_NE(err.str().find("did you mean \"--cache\"?"), std::string::npos) << err.str();
}

TEST(ParseSize, TakesPowersOf1024) {
  const std::vector<std::pair<std::string, std::uint64_t>> sizes{
      {"0", 0},          {"1000", 1000},       {"12B", 12},         {"1K", 1024},          {"1k", 1024},
      {"2.5M", 2621440}, {"1GiB", 1ULL << 30}, {"3GB", 3ULL << 30}, {"1T", 1099511627776}, {"1e3", 1000}};
  for (const auto& [text, bytes] : sizes) {
    ASSERT_TRUE(parseSize(text, "--max").ok()) << text;
    EXPECT_EQ(*parseSize(text, "--max"), bytes) << text;
  }
  for (const char* wrong :
       {"", "G", "x", "-1", "-1G", "1 G", "1X", "1GG", "1iB", "nan", "inf", "1e30", "1.2.3"})
    EXPECT_EQ(parseSize(wrong, "--max").error().port, "--max") << wrong;
}

TEST(CacheSize, IsTypedOrSetOrTheDefault) {
  Environment env = environment();
  EXPECT_EQ(*cacheSize("", "--cache-size", env), std::uint64_t{10} << 30);
  env.variable = [](const std::string& name) {
    return name == "SHERD_CACHE_SIZE" ? std::optional<std::string>("3M") : std::nullopt;
  };
  EXPECT_EQ(*cacheSize("", "--cache-size", env), 3u << 20);
  EXPECT_EQ(*cacheSize("5K", "--cache-size", env), 5u << 10);
  EXPECT_EQ(cacheSize("much", "--cache-size", env).error().port, "--cache-size");
  env.variable = [](const std::string&) { return std::optional<std::string>("plenty"); };
  EXPECT_EQ(cacheSize("", "--cache-size", env).error().what,
            "the environment variable SHERD_CACHE_SIZE is \"plenty\", which is no size");
}

}  // namespace
}  // namespace sherd::test
