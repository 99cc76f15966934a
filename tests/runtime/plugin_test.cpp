// Node packs: found, shaken hands with, and refused by name before anything in them is called.
#include <gtest/gtest.h>

#include "plugin/loader.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

std::string pack(const std::string& variant) {
  return std::string(SHERD_TEST_PACKS) + '/' + variant + '/' + variant + "_nodes.so";
}

std::string refusal(const std::string& variant) {
  Registry registry;
  const auto loaded = loadPack(pack(variant), registry);
  EXPECT_FALSE(loaded.ok());
  EXPECT_EQ(registry.all().size(), variant == "twice" ? 1u : 0u);
  return loaded.ok() ? "" : loaded.error().text();
}

TEST(Plugin, LoadsAPackWhoseNodesRun) {
  Registry registry;
  const auto loaded = loadPack(pack("good"), registry);
  ASSERT_TRUE(loaded.ok()) << loaded.error().text();
  const Graph graph = graphOf(R"("p": {"type": "Packed@1"})", registry);
  Cache cache;
  CancelToken token;
  const EvalReport report = evaluate(graph, {0}, cache, token);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(*report.outputs.at(0).at(0).value.as<std::int64_t>(), 42);
}

TEST(Plugin, RefusesPacksOfAnotherKindByName) {
  const std::string abi = refusal("other_abi");
  EXPECT_NE(abi.find("other_abi_nodes.so\" is built for ABI 5, this program has ABI 4; build it anew"),
            std::string::npos)
      << abi;
  const std::string build = refusal("other_build");
  EXPECT_NE(build.find("other_build_nodes.so\" is built with another compiler, this program with C++ "),
            std::string::npos)
      << build;
  const std::string layout = refusal("other_layout");
  EXPECT_NE(
      layout.find("other_layout_nodes.so\" is built against other headers than this program: ValueType has " +
                  std::to_string(sizeof(ValueType) + 8) + " bytes there, and ValueType " +
                  std::to_string(sizeof(ValueType)) + " here"),
      std::string::npos)
      << layout;
  EXPECT_NE(refusal("fewer_layouts")
                .find("fewer_layouts_nodes.so\" is built against other headers than this program;"),
            std::string::npos);
  const std::string version = refusal("other_version");
  EXPECT_NE(version.find("other_version_nodes.so\" is built for sherd 0.0.1, this is sherd " SHERD_VERSION),
            std::string::npos)
      << version;
  EXPECT_NE(refusal("no_handshake").find("no_handshake_nodes.so\" is no node pack"), std::string::npos);
  EXPECT_NE(refusal("twice").find("twice_nodes.so\": node type \"Packed@1\" is there already"),
            std::string::npos);
}

TEST(Plugin, RefusesValuesOfAnotherLayout) {
  Registry registry;
  ASSERT_TRUE(loadPack(pack("shape"), registry).ok());
  const auto second = loadPack(pack("other_shape"), registry);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().text().find("other_shape_nodes.so\": node type \"TakeShape\": its Shape has 16 "
                                       "bytes, that of \"MakeShape\" has "
                                       "24; build both node packs against the same headers"),
            std::string::npos)
      << second.error().text();
  Registry alone;
  EXPECT_TRUE(loadPack(pack("other_shape"), alone).ok());
}

// What a pack can be built with that makes it another, as words in the text that is compared.
TEST(Plugin, BuildIdentityNamesSanitizersAndVectors) {
  const std::string build = kHandshake.build;
#if defined(__SANITIZE_ADDRESS__)
  EXPECT_NE(build.find("address sanitizer"), std::string::npos) << build;
#elif defined(__SANITIZE_THREAD__)
  EXPECT_NE(build.find("thread sanitizer"), std::string::npos) << build;
#else
  EXPECT_EQ(build.find("sanitizer"), std::string::npos) << build;
#endif
#if defined(__x86_64__)
  EXPECT_EQ(build.find("AVX"), std::string::npos) << "sherd is built for any x86-64";
  const std::string avx = refusal("avx");
  EXPECT_NE(avx.find("avx_nodes.so\" is built with C++ "), std::string::npos) << avx;
  EXPECT_NE(avx.find(", AVX, this program with C++ "), std::string::npos) << avx;
#endif
}

TEST(Plugin, RefusesFilesThatAreNoLibraries) {
  const TemporaryDirectory directory;
  Registry registry;
  const auto text = loadPack(directory.write("text_nodes.so", "no library"), registry);
  ASSERT_FALSE(text.ok());
  EXPECT_NE(text.error().what.find("text_nodes.so\" can't be loaded"), std::string::npos);
  EXPECT_FALSE(loadPack(directory.path() / "missing.so", registry).ok());
}

TEST(Plugin, FindsPacksOnTheSearchPath) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path() / "bin");
  fs::create_directories(directory.path() / "lib");
  fs::create_directories(directory.path() / "more");
  const fs::path bin = directory.path() / "bin";
  const auto none = findPacks("", bin);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().text().find("lib/sherd_nodes.so\"; build the target sherd_nodes"),
            std::string::npos);
  const std::string own = directory.write("lib/sherd_nodes.so", "");
  EXPECT_EQ(*findPacks("", bin), std::vector<std::string>{own});
  const std::string b = directory.write("more/b_nodes.so", ""), a = directory.write("more/a_nodes.so", "");
  directory.write("more/libother.so", "");
  const std::string more = (directory.path() / "more").string();
  EXPECT_EQ(*findPacks(more, bin), (std::vector<std::string>{a, b, own}));
  EXPECT_EQ(*findPacks(":" + b + "::" + a, bin), (std::vector<std::string>{b, a, own}));
  const std::string shadow = directory.write("more/sherd_nodes.so", "");
  EXPECT_EQ(*findPacks(shadow, bin), std::vector<std::string>{shadow});
  const auto wrong = findPacks(more + "/gone", bin);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().what.find("gone\", which isn't there"), std::string::npos);
}

TEST(Plugin, FindsAssets) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path() / "build/bin");
  EXPECT_EQ(findAssets("", directory.path() / "build/bin"), fs::path());
  fs::create_directories(directory.path() / "assets");
  EXPECT_EQ(findAssets("", directory.path() / "build/bin"), directory.path() / "assets");
  fs::create_directories(directory.path() / "build/assets");
  EXPECT_EQ(findAssets("", directory.path() / "build/bin"), directory.path() / "build/assets");
  EXPECT_EQ(findAssets("/elsewhere", directory.path() / "build/bin"), fs::path("/elsewhere"));
}

}  // namespace
}  // namespace sherd::test
