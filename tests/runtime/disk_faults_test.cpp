// The cache on disk under everything that goes wrong around it: never a wrong value, never a crash.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <map>

#include "runtime/disk_values.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

class DiskFaults : public ::testing::Test {
 protected:
  std::unique_ptr<DiskStore> open() {
    DiskStoreOptions options;
    options.onWarning = [this](const std::string& text) { warnings.push_back(text); };
    return openStore(root, options);
  }
  std::string cannotWrite(int error) const {
    return "the cache in '" + root.string() + "' can't be written: " + std::strerror(error) +
           "; results of this run are not kept";
  }

  TemporaryDirectory directory;
  fs::path root = directory.path() / "cache";
  std::vector<std::string> warnings;
};

TEST_F(DiskFaults, ADirectoryOfSomeoneElseIsRefusedByName) {
  fs::create_directories(root);
  writeFile(root / "thesis.txt", "precious");
  const auto refused = DiskStore::open(root.string());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().text(), "the directory '" + root.string() +
                                        "' holds something else than a cache of sherd; choose an empty "
                                        "directory, or one that doesn't exist yet");
  EXPECT_EQ(filesIn(root).size(), 1u);
  const auto file = DiskStore::open((root / "thesis.txt").string());
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().what.find("is a file"), std::string::npos) << file.error().what;
  const auto below = DiskStore::open((root / "thesis.txt/cache").string());
  ASSERT_FALSE(below.ok());
  EXPECT_NE(below.error().what.find("is a file"), std::string::npos) << below.error().what;
  EXPECT_FALSE(DiskStore::open("").ok());
}

TEST_F(DiskFaults, ADamagedMarkerIsRewrittenOnlyAmongOurOwnFolders) {
  open()->record(recordOf(1, 5));
  for (const std::string& damage : {std::string(), std::string("garbage"), std::string(100'000, 'x')}) {
    writeFile(root / "sherd-cache", damage);
    EXPECT_TRUE(open()->find(recordOf(1).key));
    EXPECT_NE(readFile(root / "sherd-cache"), damage);
  }
  writeFile(root / "sherd-cache", "garbage");
  writeFile(root / "thesis.txt", "precious");
  EXPECT_EQ(open(), nullptr);
}

TEST_F(DiskFaults, AKilledProcessLosesNoSlowResult) {
  Rng rng(3);
  std::uint64_t next = 0;
  std::vector<std::uint64_t> finished;
  for (int round = 0; round < 25; ++round) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      const auto store = openStore(root);
      for (std::uint64_t i = next; store != nullptr && i < next + 5000; ++i) {
        store->record(recordOf(i + 1'000'000, 0.1));
        store->record(recordOf(i, 5));
        const Value value = valueOf(leaf(i % 50, 300));
        store->save(value, value.digest(), 5);
        if (::write(ends[1], &i, sizeof i) != sizeof i) break;
      }
      ::_exit(0);
    }
    ASSERT_GT(child, 0);
    ::close(ends[1]);
    const std::uint64_t many = rng.below(60);
    std::uint64_t number = 0;
    for (std::uint64_t i = 0; ::read(ends[0], &number, sizeof number) == sizeof number; ++i) {
      finished.push_back(number);
      if (i == many) ::kill(child, SIGKILL);
    }
    ::close(ends[0]);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    next += 5000;
  }
  const auto store = open();
  EXPECT_GE(finished.size(), 25u);
  for (const std::uint64_t i : finished) {
    EXPECT_EQ(store->find(recordOf(i).key), recordOf(i, 5)) << i;
    const Value loaded = store->load(valueType<Leaf>(), valueOf(leaf(i % 50, 300)).digest());
    ASSERT_FALSE(loaded.empty()) << i;
    EXPECT_EQ(*loaded.as<Leaf>(), leaf(i % 50, 300));
  }
  store->collect(std::uint64_t{1} << 30);
  EXPECT_TRUE(filesIn(root / "tmp").empty());
  EXPECT_EQ(store->verify(), std::vector<std::string>{});
}

TEST_F(DiskFaults, TwoProcessesOnOneCache) {
  const int lost = inChild([&] {
    for (std::uint64_t round = 0; round < 50; ++round) {
      const pid_t child = ::fork();
      const auto store = openStore(root);
      const std::uint64_t mine = 2 * round + (child == 0);
      const Value value = valueOf(leaf(round, 2000));
      store->record(recordOf(mine, 5));
      store->save(value, value.digest(), 5);
      if (child == 0) {
        store->collect(400'000);
        ::_exit(0);
      }
      int status = 0;
      if (::waitpid(child, &status, 0) != child || status != 0) return 1;
      store->refresh();
      for (std::uint64_t i = 0; i < 2 * round + 2; ++i)
        if (store->find(recordOf(i).key) != recordOf(i, 5)) return 2;
    }
    return 0;
  });
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(open()->verify(), std::vector<std::string>{});
}

TEST_F(DiskFaults, LeftBehindHalvesAreSweptButNotThoseInUse) {
  const auto store = open();
  writeFile(root / "tmp/dead", "half a value");
  EXPECT_GE(store->collect(1 << 20), 12u);
  EXPECT_TRUE(filesIn(root / "tmp").empty());
}

TEST_F(DiskFaults, ATornTailIsSkippedAndWhatFollowsIsRead) {
  open()->record(recordOf(1, 5));
  const fs::path segment = filesIn(root / "records").at(0);
  const std::string whole = readFile(segment);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    writeFile(segment, whole.substr(0, size));
    EXPECT_FALSE(open()->find(recordOf(1).key)) << size;
    if (!fs::exists(segment)) writeFile(segment, "");
  }
  writeFile(segment, whole.substr(0, 16) + std::string(80, '\x7f') + whole.substr(16));
  EXPECT_EQ(open()->find(recordOf(1).key), recordOf(1, 5));
}

TEST_F(DiskFaults, OtherFormatsAreMisses) {
  const Value value = valueOf(leaf(1));
  {
    const auto store = open();
    store->record(recordOf(1, 5));
    store->save(value, value.digest(), 5);
    store->setHistory("g", "h");
  }
  for (const char* folder : {"records", "objects", "history"})
    for (const fs::path& file : filesIn(root / folder)) {
      std::string bytes = readFile(file);
      ++bytes[8];  // the format stands behind eight bytes of magic
      writeFile(file, bytes);
    }
  const auto store = open();
  EXPECT_FALSE(store->find(recordOf(1).key));
  EXPECT_TRUE(store->load(value.type(), value.digest()).empty());
  EXPECT_EQ(store->history("g"), "");
  store->collect(1 << 20);
  EXPECT_TRUE(filesIn(root / "objects").empty());
  EXPECT_TRUE(filesIn(root / "history").empty());
  EXPECT_TRUE(filesIn(root / "records").empty());
}

TEST_F(DiskFaults, VerifyNamesAndRemovesWhatIsDamaged) {
  const Value value = valueOf(leaf(1)), other = valueOf(leaf(2));
  {
    const auto store = open();
    for (std::uint64_t i = 0; i < 20; ++i) store->record(recordOf(i, 5));
    store->save(value, value.digest(), 5);
    store->save(other, other.digest(), 5);
    store->setHistory("g", "h");
  }
  EXPECT_EQ(open()->verify(), std::vector<std::string>{});
  for (const fs::path& file :
       {objectPath(root, value.digest()), filesIn(root / "records").at(0), filesIn(root / "history").at(0)}) {
    std::string bytes = readFile(file);
    bytes[bytes.size() - 2] ^= 1;
    writeFile(file, bytes);
  }
  const std::vector<std::string> lines = open()->verify();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "objects/" + value.digest().hex().substr(0, 2) + '/' + value.digest().hex() +
                          ": damaged, deleted");
  EXPECT_NE(lines[1].find("bytes are damaged"), std::string::npos) << lines[1];
  EXPECT_NE(lines[2].find("history/"), std::string::npos) << lines[2];
  const auto store = open();
  EXPECT_EQ(store->verify(), std::vector<std::string>{});
  EXPECT_FALSE(store->hasObject(value.digest()));
  EXPECT_TRUE(store->hasObject(other.digest()));
  EXPECT_EQ(store->stats().records, 19u);
}

/// Flips, cuts, overwrites or lengthens.
std::string damaged(std::string bytes, Rng& rng) {
  const std::uint64_t kind = rng.below(5), at = rng.below(bytes.size() + 1);
  const std::uint64_t many = 1 + rng.below(40);
  if (kind == 0) return bytes.substr(0, at);
  if (kind == 1) return bytes + bytes.substr(at);
  if (kind == 2) return bytes.erase(at, many);
  for (std::uint64_t i = at; i < std::min<std::uint64_t>(bytes.size(), at + many); ++i)
    bytes[i] = kind == 3 ? static_cast<char>(rng.bits()) : '\0';
  if (kind == 4 && at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << rng.below(8)));
  return bytes;
}

TEST_F(DiskFaults, RandomDamageNeverGivesAWrongValue) {
  std::vector<Value> values;
  const FileIdentity identity{1, 2, 3, 4, 5};
  const auto part = std::make_shared<const Leaf>(leaf(99));
  for (std::uint64_t i = 0; i < 4; ++i) values.push_back(valueOf(leaf(i)));
  values.push_back(valueOf(Branch{"b", part, nullptr}));
  for (std::uint64_t i = 0; i < 12; ++i) openStore(root)->record(recordOf(i, 5));  // merged in part
  {
    const auto store = open();
    for (std::uint64_t i = 12; i < 40; ++i) store->record(recordOf(i, 5));
    for (const Value& value : values) store->save(value, value.digest(), 5);
    store->setHistory("g", "what it was");
    store->setFileDigest("/f", identity, digestOf(5));
  }
  std::map<fs::path, std::string> whole;
  for (const fs::path& file : filesIn(root)) whole[file] = readFile(file);
  ASSERT_GE(whole.size(), 10u);
  Rng rng(11);
  int missedRecords = 0, missedValues = 0;
  for (int round = 0; round < 1000; ++round) {
    auto victim = whole.begin();
    std::advance(victim, static_cast<long>(rng.below(whole.size())));
    writeFile(victim->first, damaged(victim->second, rng));
    {
      const auto store = open();
      ASSERT_NE(store, nullptr) << round;
      for (std::uint64_t i = 0; i < 40; ++i) {
        const auto found = store->find(recordOf(i).key);
        missedRecords += !found;
        ASSERT_TRUE(!found || found == recordOf(i, 5)) << round;
      }
      for (const Value& value : values) {
        const Value loaded = store->load(value.type(), value.digest());
        missedValues += loaded.empty();
        ASSERT_TRUE(loaded.empty() || loaded.digest() == value.digest()) << round;
      }
      const std::string history = store->history("g");
      ASSERT_TRUE(history.empty() || history == "what it was") << round;
      const auto digest = store->fileDigest("/f", identity);
      ASSERT_TRUE(!digest || digest == digestOf(5)) << round;
    }
    for (const fs::path& file : filesIn(root))
      if (!whole.contains(file)) fs::remove(file);
    for (const auto& [file, bytes] : whole)
      if (!fs::exists(file) || file == victim->first) writeFile(file, bytes);
  }
  EXPECT_GT(missedRecords, 100);
  EXPECT_GT(missedValues, 100);
  EXPECT_LT(missedValues, 1000);  // of 5,000: what is whole is found
  EXPECT_TRUE(warnings.empty());
}

TEST_F(DiskFaults, AFullDiskIsSaidOnceAndTheRestGoesOn) {
  const int code = inChild([&] {
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
      return kSkipped;
    fs::create_directories(root);
    if (::mount("none", root.c_str(), "tmpfs", 0, "size=256k") != 0) return kSkipped;
    const Value first = valueOf(leaf(1, 1000)), big = valueOf(leaf(2, 50'000));
    {
      const auto store = open();
      if (store == nullptr) return 1;
      store->record(recordOf(1, 5));
      if (!store->save(first, first.digest(), 5)) return 2;
      if (store->save(big, big.digest(), 5)) return 3;
      store->record(recordOf(2, 5));
      if (!store->find(recordOf(2).key)) return 4;  // known to this run all the same
      store->setHistory("g", "h");
      if (!filesIn(root / "tmp").empty()) return 5;
      if (warnings != std::vector<std::string>{cannotWrite(ENOSPC)}) return 6;
    }
    const auto store = open();
    if (!store->find(recordOf(1).key) || store->find(recordOf(2).key)) return 7;
    if (store->load(first.type(), first.digest()).empty()) return 8;
    if (!store->verify().empty()) return 9;
    // Records alone fill it, too.
    for (std::uint64_t i = 10; i < 5000; ++i) store->record(recordOf(i, 5));
    if (warnings.size() != 2) return 10;
    const auto again = open();
    for (std::uint64_t i = 10; i < 5000; ++i) {
      const auto found = again->find(recordOf(i).key);
      if (found && found != recordOf(i, 5)) return 11;
    }
    return again->find(recordOf(10).key) ? 0 : 12;
  });
  if (code == kSkipped) GTEST_SKIP() << "mounting is not permitted here";
  EXPECT_EQ(code, 0);
}

TEST_F(DiskFaults, AFileTooLargeForTheSystemIsLikeAFullDisk) {
  const int code = inChild([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const auto store = open();
    const rlimit limit{4096, 4096};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return kSkipped;
    const Value big = valueOf(leaf(2, 50'000));
    store->record(recordOf(1, 5));
    if (store->save(big, big.digest(), 5)) return 1;
    if (store->hasObject(big.digest()) || !filesIn(root / "tmp").empty()) return 2;
    if (warnings != std::vector<std::string>{cannotWrite(EFBIG)}) return 3;
    if (store->load(big.type(), big.digest()).address() != big.address()) return 4;
    return 0;
  });
  if (code == kSkipped) GTEST_SKIP() << "limits can't be set here";
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(open()->find(recordOf(1).key));
}

TEST_F(DiskFaults, AReadOnlyMountIsReadAndWarnedOf) {
  const Value value = valueOf(leaf(1));
  {
    const auto store = open();
    store->record(recordOf(1, 5));
    store->save(value, value.digest(), 5);
  }
  const int code = inChild([&] {
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
      return kSkipped;
    if (::mount(root.c_str(), root.c_str(), nullptr, MS_BIND, nullptr) != 0) return kSkipped;
    if (::mount("none", root.c_str(), nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr) != 0)
      return kSkipped;
    const auto store = open();
    if (store == nullptr) return 1;
    if (warnings != std::vector<std::string>{cannotWrite(EROFS)}) return 2;
    if (!store->find(recordOf(1).key)) return 3;
    if (store->load(value.type(), value.digest()).empty()) return 4;
    if (store->save(valueOf(leaf(2)), valueOf(leaf(2)).digest(), 5)) return 5;
    store->record(recordOf(2, 5));
    store->setHistory("g", "h");
    if (store->collect(0) != 0) return 6;
    if (store->clear().ok()) return 7;
    return warnings.size() == 1 ? 0 : 8;
  });
  if (code == kSkipped) GTEST_SKIP() << "mounting is not permitted here";
  EXPECT_EQ(code, 0);
}

TEST_F(DiskFaults, ADirectoryWithoutPermissionToWriteIsRead) {
  const Value value = valueOf(leaf(1));
  {
    const auto store = open();
    store->record(recordOf(1, 5));
    store->save(value, value.digest(), 5);
  }
  const auto permit = [&](fs::perms folders, fs::perms files) {
    fs::permissions(root, folders);
    for (const auto& entry : fs::recursive_directory_iterator(root))
      fs::permissions(entry.path(), entry.is_directory() ? folders : files);
  };
  permit(fs::perms(0555), fs::perms(0444));
  fs::permissions(directory.path(), fs::perms(0755));
  const int code = inChild([&] {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return kSkipped;
    const auto store = open();
    if (store == nullptr) return 1;
    if (warnings != std::vector<std::string>{cannotWrite(EACCES)}) return 2;
    if (!store->find(recordOf(1).key)) return 3;
    if (store->load(value.type(), value.digest()).empty()) return 4;
    if (store->save(valueOf(leaf(2)), valueOf(leaf(2)).digest(), 5)) return 5;
    return 0;
  });
  permit(fs::perms(0700), fs::perms(0600));
  if (code == kSkipped) GTEST_SKIP() << "another user can't be had here";
  EXPECT_EQ(code, 0);
}

TEST_F(DiskFaults, ADirectoryThatMayNotBeReadIsRefused) {
  open();
  fs::permissions(directory.path(), fs::perms(0755));
  fs::permissions(root, fs::perms::none);
  const int code = inChild([&] {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return kSkipped;
    const auto refused = DiskStore::open(root.string());
    return !refused.ok() && refused.error().what.find(root.string()) != std::string::npos &&
                   refused.error().what.find("Permission denied") != std::string::npos
               ? 0
               : 1;
  });
  fs::permissions(root, fs::perms::owner_all);
  if (code == kSkipped) GTEST_SKIP() << "another user can't be had here";
  EXPECT_EQ(code, 0);
}

TEST_F(DiskFaults, ADirectoryThatVanishesIsNotMadeAgain) {
  const Value value = valueOf(leaf(1)), second = valueOf(leaf(2));
  for (const bool recordFirst : {true, false}) {
    warnings.clear();
    {
      const auto store = open();
      store->record(recordOf(1, 5));
      store->save(value, value.digest(), 5);
      fs::remove_all(root);
      if (recordFirst) store->record(recordOf(2, 5));
      EXPECT_FALSE(store->save(second, second.digest(), 5));
      store->record(recordOf(3, 5));
      store->refresh();
      EXPECT_TRUE(store->find(recordOf(1).key));
      EXPECT_TRUE(store->find(recordOf(3).key));
      EXPECT_EQ(store->load(second.type(), second.digest()).address(), second.address());
      EXPECT_TRUE(store->load(valueType<Leaf>(), digestOf(1)).empty());
      EXPECT_EQ(store->history("g"), "");
      EXPECT_EQ(store->stats().objects, 0u);
    }
    EXPECT_FALSE(fs::exists(root));
    EXPECT_EQ(warnings, std::vector<std::string>{cannotWrite(ENOENT)});
  }
}

}  // namespace
}  // namespace sherd::test
