// The cache on disk: what is kept comes back, is shared, bounded and merged.
#include "eval/disk_store.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <thread>

#include "runtime/disk_values.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

class DiskStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<DiskStore> open(DiskStoreOptions options = {}) {
    options.onWarning = [this](const std::string& text) { warnings.push_back(text); };
    auto store = openStore(root, std::move(options));
    EXPECT_NE(store, nullptr);
    return store;
  }
  std::size_t segments(char kind) const {
    std::size_t count = 0;
    for (const auto& file : filesIn(root / "records")) count += file.filename().string()[0] == kind;
    return count;
  }
  /// As if last used some days ago.
  void age(const Digest& digest, double days) const {
    fs::last_write_time(objectPath(root, digest), fs::file_time_type::clock::now() -
                                                      std::chrono::seconds(static_cast<long>(days * 86400)));
  }
  /// Each in a segment of its own.
  void recordApart(std::uint64_t from, std::uint64_t to) {
    std::vector<std::unique_ptr<DiskStore>> stores;
    for (std::uint64_t i = from; i < to; ++i) {
      stores.push_back(open());
      stores.back()->record(recordOf(i, 5));
    }
    // The last to end merges; those before it see segments that are still held.
  }

  TemporaryDirectory directory;
  fs::path root = directory.path() / "cache";
  std::vector<std::string> warnings;
};

TEST_F(DiskStoreTest, AnEmptyStoreKnowsNothing) {
  const auto store = open();
  std::vector<OutputRecord> outputs;
  EXPECT_FALSE(store->find(digestOf(1)));
  EXPECT_FALSE(store->findOutputs(digestOf(1), outputs));
  EXPECT_FALSE(store->knowsRecipe(digestOf(1)));
  EXPECT_FALSE(store->hasObject(digestOf(1)));
  EXPECT_TRUE(store->load(valueType<Leaf>(), digestOf(1)).empty());
  EXPECT_EQ(store->history("g.json"), "");
  EXPECT_FALSE(store->fileDigest("/a", {1, 2, 3, 4, 5}));
  EXPECT_EQ(store->stats().records + store->stats().objects, 0u);
  EXPECT_EQ(store->collect(0), 0u);
  EXPECT_TRUE(store->verify().empty());
  EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST_F(DiskStoreTest, MakesItsDirectoryForTheUserAlone) {
  root = directory.path() / "a/b/cache";
  open();
  EXPECT_EQ(fs::status(root).permissions(), fs::perms::owner_all);
  EXPECT_TRUE(fs::exists(root / "sherd-cache"));
  EXPECT_EQ(openStore(root.string() + "/")->directory(), root.string());
}

TEST_F(DiskStoreTest, RecordsComeBackAtOnceAndLater) {
  const auto check = [](const DiskStore& store) {
    std::vector<OutputRecord> outputs{{{9, 9}, 9}};
    for (std::uint64_t i = 0; i < 300; ++i) {
      const ResultRecord wanted = recordOf(i, i % 10 == 0 ? 50 : 0.1);
      EXPECT_EQ(store.find(wanted.key), wanted) << i;
      EXPECT_TRUE(store.findOutputs(wanted.key, outputs));
      EXPECT_EQ(outputs, wanted.outputs);
      EXPECT_TRUE(store.knowsRecipe(wanted.recipe));
      EXPECT_FALSE(store.knowsRecipe(wanted.key));
    }
    EXPECT_FALSE(store.find(digestOf(300)));
    EXPECT_EQ(store.stats().records, 300u);
  };
  {
    const auto store = open();
    for (std::uint64_t i = 0; i < 300; ++i) store->record(recordOf(i, i % 10 == 0 ? 50 : 0.1));
    check(*store);
  }
  check(*open());
  {
    const auto store = open();
    store->collect(1 << 20);
    check(*store);
  }
}

TEST_F(DiskStoreTest, KeysMayBeAnything) {
  const std::vector<Digest> keys{{0, 0}, {0, 1}, {1, 0}, {~0ULL, ~0ULL}, {0, ~0ULL}, {1ULL << 63, 0}};
  {
    const auto store = open();
    for (std::size_t i = 0; i < keys.size(); ++i) store->record({keys[i], keys[i], 2, {{{i, i}, i}}, {}, {}});
  }
  for (const bool merged : {false, true}) {
    if (merged) recordApart(100, 120);
    EXPECT_EQ(segments('m') > 0, merged);
    const auto store = open();
    for (std::size_t i = 0; i < keys.size(); ++i) {
      ASSERT_TRUE(store->find(keys[i])) << i;
      EXPECT_EQ(store->find(keys[i])->outputs.front().bytes, i);
      EXPECT_TRUE(store->knowsRecipe(keys[i]));
    }
    EXPECT_FALSE(store->find({2, 0}));
    EXPECT_FALSE(store->knowsRecipe({2, 0}));
  }
}

TEST_F(DiskStoreTest, ALaterRecordReplacesAnEarlierOneAlsoAfterMerging) {
  ResultRecord record = recordOf(7, 5);
  {
    const auto store = open();
    store->record(record);
    record.written.at(0).identity.bytes = 99;
    store->record(record);
    EXPECT_EQ(store->find(record.key), record);
    EXPECT_EQ(store->stats().records, 1u);
  }
  EXPECT_EQ(open()->find(record.key), record);
  recordApart(10, 30);
  ASSERT_GE(segments('m'), 1u);
  EXPECT_EQ(open()->find(record.key), record);
  std::this_thread::sleep_for(std::chrono::milliseconds(10));  // two ticks of the coarse clock
  record.written.at(0).identity.bytes = 100;
  open()->record(record);
  EXPECT_EQ(open()->find(record.key), record);
  recordApart(40, 60);
  EXPECT_EQ(open()->find(record.key), record);
}

TEST_F(DiskStoreTest, StoresSeeEachOthersResultsAfterRefresh) {
  const auto a = open(), b = open();
  for (std::uint64_t round = 0; round < 50; ++round) {
    a->record(recordOf(2 * round, 5));
    b->record(recordOf(2 * round + 1, 0.1));
    b->flush();
    EXPECT_FALSE(a->find(recordOf(2 * round + 1).key));
    a->refresh();
    b->refresh();
    for (std::uint64_t i = 0; i < 2 * round + 2; ++i) {
      ASSERT_TRUE(a->find(recordOf(i).key)) << i;
      ASSERT_TRUE(b->find(recordOf(i).key)) << i;
    }
  }
  EXPECT_EQ(a->stats().records, 100u);
}

TEST_F(DiskStoreTest, MergesSegmentsThatNobodyHolds) {
  recordApart(0, 40);
  EXPECT_LE(segments('s'), 8u);
  EXPECT_GE(segments('m'), 1u);
  EXPECT_LE(segments('m'), 3u);
  const auto early = open();
  recordApart(40, 80);
  recordApart(80, 120);
  EXPECT_LE(segments('m'), 3u);
  early->refresh();
  const auto late = open();
  for (const DiskStore* store : {early.get(), late.get()})
    for (std::uint64_t i = 0; i < 120; ++i) EXPECT_EQ(store->find(recordOf(i).key), recordOf(i, 5)) << i;
  EXPECT_TRUE(filesIn(root / "tmp").empty());
}

TEST_F(DiskStoreTest, MergingManyTimesAtOnceLosesNothing) {
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t)
    threads.emplace_back([this, t] {
      for (std::uint64_t i = 0; i < 40; ++i) {
        const auto store = openStore(root);
        store->record(recordOf(100 * t + i, 5));
        if (i % 8 == 7) store->collect(std::uint64_t{1} << 30);
        for (std::uint64_t k = 0; k <= i; ++k)
          EXPECT_TRUE(store->find(recordOf(100 * t + k).key)) << t << ' ' << k << ' ' << i;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(open()->stats().records, 160u);
  EXPECT_TRUE(open()->verify().empty());
}

TEST_F(DiskStoreTest, RecordsAreBoundedByWhatTheyTookToMake) {
  {
    const auto store = open();
    for (std::uint64_t i = 0; i < 1000; ++i) store->record(recordOf(i, i % 10 == 0 ? 100 : 0.01));
  }
  for (int twice = 0; twice < 2; ++twice) {
    open()->collect(800'000);
    const auto stats = open()->stats();
    EXPECT_LE(stats.recordBytes, 80'000u);
    EXPECT_LT(stats.records, 700u);
    EXPECT_GE(stats.records, 250u);
  }
  const auto store = open();
  for (std::uint64_t i = 0; i < 1000; i += 10) EXPECT_TRUE(store->find(recordOf(i).key)) << i;
}

TEST_F(DiskStoreTest, RecordsAreBoundedThoughNoValueIsKept) {
  DiskStoreOptions options;
  options.mostBytes = 200'000;
  for (std::uint64_t round = 0; round < 5; ++round) {
    const auto store = open(options);
    for (std::uint64_t i = 0; i < 200; ++i) store->record(recordOf(200 * round + i));
  }
  EXPECT_LE(open(options)->stats().bytes(), 200'000u);
  EXPECT_GE(open(options)->stats().records, 50u);
  EXPECT_LT(open(options)->stats().records, 200u);
}

TEST_F(DiskStoreTest, ValuesComeBack) {
  const Value number = valueOf(2.5), whole = valueOf(std::int64_t{-3}),
              text = valueOf(std::string("a\0b", 3));
  const Value flag = valueOf(true), small = valueOf(leaf(1)), none = valueOf(Leaf{}),
              big = valueOf(leaf(2, 200'000));
  const std::vector<Value> values{number, whole, text, flag, small, none, big};
  std::vector<Digest> digests;
  {
    const auto store = open();
    for (const Value& value : values) {
      digests.push_back(value.digest());
      EXPECT_TRUE(store->save(value, value.digest(), 3));
      EXPECT_TRUE(store->hasObject(value.digest()));
      EXPECT_EQ(store->load(value.type(), value.digest()).address(), value.address());  // alive
    }
  }
  const auto store = open();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Value loaded = store->load(values[i].type(), digests[i]);
    ASSERT_FALSE(loaded.empty()) << i;
    EXPECT_NE(loaded.address(), values[i].address());
    EXPECT_EQ(loaded.digest(), digests[i]);
    EXPECT_EQ(loaded.bytes(), values[i].bytes());
  }
  EXPECT_EQ(*store->load(valueType<std::string>(), digests[2]).as<std::string>(), std::string("a\0b", 3));
  EXPECT_EQ(store->stats().objects, values.size());
}

TEST_F(DiskStoreTest, PartsAreKeptOnceAndShared) {
  const auto shared = std::make_shared<const Leaf>(leaf(1));
  const Value one = valueOf(Branch{"one", shared, shared}), two = valueOf(Branch{"two", nullptr, shared});
  {
    const auto store = open();
    EXPECT_TRUE(store->save(one, one.digest(), 5));
    EXPECT_TRUE(store->save(two, two.digest(), 5));
    EXPECT_EQ(store->stats().objects, 3u);
  }
  const auto store = open();
  const auto first = store->load(one.type(), one.digest()).as<Branch>();
  const auto second = store->load(two.type(), two.digest()).as<Branch>();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->name, "one");
  EXPECT_EQ(*first->left, *shared);
  EXPECT_EQ(first->left, first->right);
  EXPECT_EQ(first->right, second->right);
  EXPECT_EQ(second->left, nullptr);
  const Digest part = valueType<Leaf>().digest(shared.get());
  EXPECT_EQ(store->load(valueType<Leaf>(), part).address(), first->left.get());
}

TEST_F(DiskStoreTest, AValueWithoutItsPartIsAMissUntilThePartIsBack) {
  const Value branch = valueOf(Branch{"b", std::make_shared<const Leaf>(leaf(1)), nullptr});
  const Value part = Value::of(branch.as<Branch>()->left);
  open()->save(branch, branch.digest(), 5);
  fs::remove(objectPath(root, part.digest()));
  EXPECT_TRUE(open()->load(branch.type(), branch.digest()).empty());
  EXPECT_TRUE(open()->hasObject(branch.digest()));
  open()->save(part, part.digest(), 5);
  EXPECT_FALSE(open()->load(branch.type(), branch.digest()).empty());
}

TEST_F(DiskStoreTest, OtherVersionsAndTypesAreMissesAndGo) {
  const Value value = valueOf(leaf(1));
  open()->save(value, value.digest(), 5);
  EXPECT_TRUE(open()->load(valueType<NewLeaf>(), value.digest()).empty());
  EXPECT_FALSE(open()->hasObject(value.digest()));
  open()->save(value, value.digest(), 5);
  EXPECT_TRUE(open()->load(valueType<Branch>(), value.digest()).empty());
  EXPECT_FALSE(open()->hasObject(value.digest()));
  // Under a wrong name.
  open()->save(value, value.digest(), 5);
  fs::create_directories(objectPath(root, digestOf(5)).parent_path());
  fs::copy_file(objectPath(root, value.digest()), objectPath(root, digestOf(5)));
  EXPECT_TRUE(open()->load(valueType<Leaf>(), digestOf(5)).empty());
  EXPECT_FALSE(open()->load(valueType<Leaf>(), value.digest()).empty());
}

TEST_F(DiskStoreTest, WhatCannotBeKeptIsNot) {
  const Value fleeting = valueOf(Fleeting{}), big = valueOf(leaf(1, 1000));
  DiskStoreOptions options;
  options.mostBytes = 4000;
  const auto store = open(options);
  EXPECT_FALSE(store->save(fleeting, fleeting.digest(), 5));
  EXPECT_FALSE(store->save(Value(), digestOf(1), 5));
  EXPECT_FALSE(store->save(big, big.digest(), 5));
  EXPECT_TRUE(store->load(valueType<Fleeting>(), fleeting.digest()).empty());
  EXPECT_EQ(store->stats().objects, 0u);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST_F(DiskStoreTest, EvictsTheCheapAndTheLongUnusedFirst) {
  // All of one size; worth: time to make, halved for every two days without use.
  const std::vector<std::pair<double, double>> msAndDays{{1, 0}, {1000, 0}, {1000, 30}, {10, 1}, {100, 1}};
  const std::vector<std::size_t> order{2, 0, 3, 4, 1};
  std::vector<Value> values;
  {
    const auto store = open();
    for (std::size_t i = 0; i < msAndDays.size(); ++i) {
      values.push_back(valueOf(leaf(i, 1000)));
      store->save(values[i], values[i].digest(), msAndDays[i].first);
      age(values[i].digest(), msAndDays[i].second);
    }
  }
  const auto store = open();
  const std::uint64_t each = store->stats().objectBytes / values.size();
  for (std::size_t gone = 1; gone <= order.size(); ++gone) {
    EXPECT_EQ(store->collect((values.size() - gone) * each), each);
    for (std::size_t i = 0; i < order.size(); ++i)
      EXPECT_EQ(store->hasObject(values[order[i]].digest()), i >= gone) << gone << ' ' << i;
  }
}

TEST_F(DiskStoreTest, LoadingMarksAsUsed) {
  const Value a = valueOf(leaf(1, 1000)), b = valueOf(leaf(2, 1000));
  {
    const auto store = open();
    store->save(a, a.digest(), 5);
    store->save(b, b.digest(), 5);
  }
  age(a.digest(), 3);
  age(b.digest(), 2);
  const auto store = open();
  EXPECT_FALSE(store->load(a.type(), a.digest()).empty());
  store->collect(store->stats().objectBytes / 2);
  EXPECT_TRUE(store->hasObject(a.digest()));
  EXPECT_FALSE(store->hasObject(b.digest()));
}

TEST_F(DiskStoreTest, StaysWithinItsBound) {
  DiskStoreOptions options;
  options.mostBytes = 100'000;
  {
    const auto store = open(options);
    for (std::uint64_t i = 0; i < 400; ++i) {
      const Value value = valueOf(leaf(i, 1000));
      EXPECT_TRUE(store->save(value, value.digest(), 5));
      EXPECT_LT(i % 50 == 0 ? store->stats().objectBytes : 0, 200'000u);
    }
  }
  const auto stats = open(options)->stats();
  EXPECT_LE(stats.bytes(), 100'000u);
  EXPECT_GE(stats.objects, 10u);
  EXPECT_EQ(stats.mostBytes, 100'000u);
}

TEST_F(DiskStoreTest, EvictionWhileAnotherLoadsIsAMissAtWorst) {
  std::vector<Digest> digests;
  for (std::uint64_t i = 0; i < 20; ++i) digests.push_back(valueOf(leaf(i, 2000)).digest());
  open();
  std::atomic<bool> done{false};
  std::thread evicting([&] {
    const auto store = openStore(root);
    while (!done) store->collect(100'000);
  });
  const auto store = open();
  int hits = 0, misses = 0;
  for (std::uint64_t round = 0; round < 3000; ++round) {
    const std::uint64_t i = round / 2;  // twice each: the cycle alone always asks for what has just gone
    const Value loaded = store->load(valueType<Leaf>(), digests[i % 20]);
    if (loaded.empty()) {
      ++misses;
      EXPECT_TRUE(store->save(valueOf(leaf(i % 20, 2000)), digests[i % 20], 5));
    } else {
      ++hits;
      EXPECT_EQ(*loaded.as<Leaf>(), leaf(i % 20, 2000));
    }
  }
  done = true;
  evicting.join();
  EXPECT_GT(misses, 20);
  EXPECT_GT(hits, 0);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST_F(DiskStoreTest, ManyThreadsShareOneStore) {
  {
    const auto store = open();
    std::vector<std::thread> threads;
    for (std::uint64_t t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (std::uint64_t i = 0; i < 200; ++i) {
          store->record(recordOf(1000 * t + i, i % 20 == 0 ? 2 : 0.1));
          EXPECT_TRUE(store->find(recordOf(1000 * t + i).key));
          const Value value = valueOf(leaf(i % 10));
          EXPECT_TRUE(store->save(value, value.digest(), 1));
          EXPECT_FALSE(store->load(valueType<Leaf>(), value.digest()).empty());
          store->setHistory("g", std::string(i, 'h'));
          EXPECT_EQ(store->history("g").find_first_not_of('h'), std::string::npos);
          if (i % 50 == 0) store->refresh();
          if (i % 100 == 99) store->collect(std::uint64_t{1} << 20);
        }
      });
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(open()->stats().records, 800u);
  EXPECT_TRUE(filesIn(root / "tmp").empty());
}

TEST_F(DiskStoreTest, HistoryIsReplacedWhole) {
  const auto store = open();
  store->setHistory("/a/g.json", "one");
  store->setHistory("name with\nanything ä", std::string("\0\1", 2));
  EXPECT_EQ(store->history("/a/g.json"), "one");
  store->setHistory("/a/g.json", "");
  EXPECT_EQ(open()->history("/a/g.json"), "");
  EXPECT_EQ(open()->history("name with\nanything ä"), std::string("\0\1", 2));
  EXPECT_EQ(open()->history("/b/g.json"), "");
}

TEST_F(DiskStoreTest, HistoryIsBoundedOldestFirst) {
  const auto store = open();
  store->setHistory("old", std::string(1000, 'o'));
  for (const auto& file : filesIn(root / "history"))
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
  store->setHistory("new", std::string(1000, 'n'));
  EXPECT_GT(store->collect(150'000), 1000u);
  EXPECT_EQ(store->history("old"), "");
  EXPECT_EQ(store->history("new"), std::string(1000, 'n'));
}

TEST_F(DiskStoreTest, FileDigestsHoldForTheSameFileOnly) {
  const FileIdentity identity{1, 2, 3, 4, 5};
  open()->setFileDigest("/a/mesh.obj", identity, digestOf(1));
  const auto store = open();
  EXPECT_EQ(store->fileDigest("/a/mesh.obj", identity), digestOf(1));
  EXPECT_FALSE(store->fileDigest("/b/mesh.obj", identity));
  for (const FileIdentity& other :
       {FileIdentity{9, 2, 3, 4, 5}, FileIdentity{1, 9, 3, 4, 5}, FileIdentity{1, 2, 9, 4, 5},
        FileIdentity{1, 2, 3, 9, 5}, FileIdentity{1, 2, 3, 4, 9}})
    EXPECT_FALSE(store->fileDigest("/a/mesh.obj", other));
  const FileIdentity later{1, 2, 3, 4, 6};
  store->setFileDigest("/a/mesh.obj", later, digestOf(2));
  EXPECT_FALSE(store->fileDigest("/a/mesh.obj", identity));
  EXPECT_EQ(store->fileDigest("/a/mesh.obj", later), digestOf(2));
  store->setFileDigest("/none", {}, digestOf(2));
  EXPECT_FALSE(store->fileDigest("/none", {}));
  EXPECT_EQ(store->stats().records, 0u);  // not results
}

TEST_F(DiskStoreTest, FilesThatJustChangedAreNotTrusted) {
  const std::string path = directory.write("f.txt", "a");
  const auto store = open();
  const FileIdentity identity = FileIdentity::of(path);
  store->setFileDigest(path, identity, digestOf(1));
  EXPECT_FALSE(store->fileDigest(path, identity));
  std::this_thread::sleep_for(std::chrono::milliseconds(70));
  store->setFileDigest(path, identity, digestOf(1));
  EXPECT_EQ(store->fileDigest(path, identity), digestOf(1));
}

TEST(FileIdentityTest, ChangesWithTheFile) {
  const TemporaryDirectory directory;
  const std::string path = directory.write("f.txt", "abc");
  const FileIdentity before = FileIdentity::of(path);
  EXPECT_TRUE(before.exists());
  EXPECT_EQ(before.bytes, 3u);
  EXPECT_EQ(before, FileIdentity::of(path));
  EXPECT_FALSE(FileIdentity::of(path + "x").exists());
  EXPECT_EQ(FileIdentity::of(path + "x"), FileIdentity{});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  directory.write("f.txt", "abd");
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_NE(FileIdentity::of(path).changed, before.changed);
  fs::create_symlink(path, directory.path() / "link");
  EXPECT_EQ(FileIdentity::of((directory.path() / "link").string()), FileIdentity::of(path));
}

TEST_F(DiskStoreTest, ClearRemovesAllResultsAndNothingElse) {
  {
    const auto store = open();
    const Value value = valueOf(leaf(1));
    store->save(value, value.digest(), 5);
    store->setHistory("g", "h");
    writeFile(root / "note.txt", "mine");
    writeFile(root / "objects/note.txt", "mine");
    writeFile(root / "records/note.txt", "mine");
    const auto other = open();
    for (const auto& each : {store.get(), other.get()}) each->record(recordOf(1, 5));
    ASSERT_TRUE(store->clear().ok());
    EXPECT_FALSE(store->find(recordOf(1).key));
    EXPECT_FALSE(store->hasObject(value.digest()));
    EXPECT_EQ(store->history("g"), "");
    store->record(recordOf(2, 5));
    other->record(recordOf(3, 5));
  }
  const auto store = open();
  EXPECT_FALSE(store->find(recordOf(1).key));
  EXPECT_TRUE(store->find(recordOf(2).key));
  EXPECT_TRUE(store->find(recordOf(3).key));  // recorded after it, by another
  for (const char* note : {"note.txt", "objects/note.txt", "records/note.txt"})
    EXPECT_EQ(readFile(root / note), "mine") << note;
  EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST(DiskStoreDirectory, Defaults) {
  std::map<std::string, std::string> set;
  const auto directory = [&] {
    return DiskStore::defaultDirectory([&](const std::string& name) -> std::optional<std::string> {
      const auto found = set.find(name);
      if (found == set.end()) return std::nullopt;
      return found->second;
    });
  };
  EXPECT_EQ(directory(), "");
  set["HOME"] = "/home/a";
  EXPECT_EQ(directory(), "/home/a/.cache/sherd");
  set["XDG_CACHE_HOME"] = "relative";  // to be ignored, says its specification
  EXPECT_EQ(directory(), "/home/a/.cache/sherd");
  set["XDG_CACHE_HOME"] = "/x";
  EXPECT_EQ(directory(), "/x/sherd");
  set["SHERD_CACHE"] = "/mine";
  EXPECT_EQ(directory(), "/mine");
}

}  // namespace
}  // namespace sherd::test
