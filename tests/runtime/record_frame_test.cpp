// Records as bytes: what using one changes, and what it is worth.
#include "eval/record_frame.h"

#include <gtest/gtest.h>

#include "eval/record_log.h"
#include "eval/worth.h"
#include "runtime/disk_values.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

TEST(RecordFrame, UsingChangesTheTimeOfUseOnly) {
  ResultRecord record = recordOf(3, 12.5);
  record.messages.push_back({LogLevel::Warning, "careful"});
  record.written.push_back({"/out/ä.png", FileIdentity{1, 2, 3, 4, 5}});
  const std::size_t size = store::frameSize(record);
  std::string first(size, '\0'), used(size, '\0');
  store::writeFrame(record, 1000, size, first.data());
  EXPECT_EQ(store::usedOf(first.data()), 1000);
  EXPECT_EQ(store::costOf(first.data()), 12.5);
  store::writeUsed(first.data(), 5000, used.data());
  EXPECT_EQ(store::soundFrameAt(used), size);
  EXPECT_EQ(store::usedOf(used.data()), 5000);
  EXPECT_EQ(store::timeOf(used.data()), 1000);
  EXPECT_EQ(store::readResult(used.data()), record);
}

TEST(RecordFrame, ADigestOfAFileCostsReadingIt) {
  std::string frame(store::kFileFrameSize, '\0');
  store::writeFileFrame(digestOf(1), FileIdentity{1, 2, 3'000'000, 4, 5}, digestOf(2), 1, frame.data());
  EXPECT_DOUBLE_EQ(store::costOf(frame.data()), 3);
}

/// A segment as a process left it ten days ago.
void writeOldSegment(const fs::path& file, std::uint64_t count) {
  constexpr std::int64_t kTenDays = std::int64_t{10} * 86400 * 1'000'000'000;
  std::string bytes(store::youngHead());
  for (std::uint64_t i = 0; i < count; ++i) {
    const ResultRecord record = recordOf(i, 1);
    std::string frame(store::frameSize(record), '\0');
    store::writeFrame(record, store::RecordLog::now() - kTenDays, frame.size(), frame.data());
    bytes += frame;
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(RecordFrame, WhatIsUsedStaysWhenTheRestGoes) {
  const TemporaryDirectory directory;
  const fs::path root = directory.path() / "cache";
  openStore(root);
  writeOldSegment(root / "records" / "s-0123456789abcdef", 1000);
  const auto first = openStore(root);
  for (std::uint64_t i = 0; i < 1000; i += 10) EXPECT_TRUE(first->find(recordOf(i).key));
  const auto second = openStore(root);
  first->collect(600'000);
  second->refresh();
  const auto third = openStore(root);
  EXPECT_LT(third->stats().records, 400u);
  for (const DiskStore* store : {first.get(), second.get(), third.get()})
    for (std::uint64_t i = 0; i < 1000; i += 10) EXPECT_EQ(store->find(recordOf(i).key), recordOf(i, 1)) << i;
}

TEST(Worth, IsTimePerByteHalvedWithoutUse) {
  const double base = store::worth(100, 1000, 0);
  EXPECT_NEAR(store::worth(200, 1000, 0), base + 1, 1e-3);
  EXPECT_NEAR(store::worth(100, 2001, 0), base - 1, 1e-3);
  EXPECT_NEAR(store::worth(100, 1000, store::kHalfLife), base - 1, 1e-12);
  EXPECT_LT(store::worth(0, 1, 0), store::worth(1, 1, 0));
}

}  // namespace
}  // namespace sherd::test
