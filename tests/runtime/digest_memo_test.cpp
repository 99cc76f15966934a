// Digests of shared values are computed once per object, and never taken from another one.
#include "base/digest_memo.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "base/parallel.h"
#include "base/value_type.h"

namespace sherd {
namespace {

/// Counts how often it is hashed.
struct Counted {
  static constexpr const char* typeName = "Counted";
  std::vector<double> numbers;
  static inline std::atomic<int> hashed = 0;
};

void hashValue(Hasher& hasher, const Counted& value) {
  ++Counted::hashed;
  hasher.add(value.numbers);
}
std::size_t byteSize(const Counted& value) { return value.numbers.size() * sizeof(double); }

/// Large enough to be remembered.
std::shared_ptr<const Counted> counted(double number) {
  return std::make_shared<const Counted>(Counted{std::vector<double>(1000, number)});
}

const ValueType& type() { return valueType<Counted>(); }

class DigestMemo : public testing::Test {
 protected:
  void SetUp() override { Counted::hashed = 0; }
};

TEST_F(DigestMemo, HashesAnObjectOnce) {
  const auto a = counted(1), b = counted(2), likeA = counted(1);
  const Digest first = sharedDigest(type(), a);
  EXPECT_EQ(first, type().digest(a.get()));
  Counted::hashed = 0;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(sharedDigest(type(), a), first);
  EXPECT_EQ(Counted::hashed, 0);
  EXPECT_NE(sharedDigest(type(), b), first);
  EXPECT_EQ(sharedDigest(type(), likeA), first);
  EXPECT_EQ(Counted::hashed, 2);
}

TEST_F(DigestMemo, SmallAndOwnerlessValuesAreHashedEachTime) {
  const auto small = std::make_shared<const Counted>(Counted{{1, 2, 3}});
  Counted outside{std::vector<double>(1000, 1)};
  const std::shared_ptr<const Counted> ownerless(std::shared_ptr<void>(), &outside);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(sharedDigest(type(), small), type().digest(small.get()));
    EXPECT_EQ(sharedDigest(type(), ownerless), type().digest(&outside));
    outside.numbers[0] = 5;  // nobody keeps it from changing
  }
  EXPECT_EQ(Counted::hashed, 8);
}

TEST_F(DigestMemo, AnAddressThatIsUsedAgainIsAnotherObject) {
  // Two owners of one address, one after the other: what a reused allocation looks like.
  alignas(Counted) static std::byte room[sizeof(Counted)];
  const auto at = [&](double number) {
    auto* made = new (room) Counted{std::vector<double>(1000, number)};
    return std::shared_ptr<const Counted>(made, [](const Counted* c) { c->~Counted(); });
  };
  auto value = at(1);
  const Digest one = sharedDigest(type(), value);
  value.reset();
  value = at(2);
  EXPECT_NE(sharedDigest(type(), value), one);
  EXPECT_EQ(sharedDigest(type(), value), type().digest(value.get()));
}

TEST_F(DigestMemo, ToldDigestsAreTaken) {
  const auto value = counted(3);
  const Digest told{17, 4};
  rememberDigest(type(), value, told);
  EXPECT_EQ(sharedDigest(type(), value), told);
  EXPECT_EQ(Counted::hashed, 0);
}

TEST_F(DigestMemo, ManyShortLivedObjects) {
  for (int i = 0; i < 3000; ++i) {
    const auto value = counted(i);
    ASSERT_EQ(sharedDigest(type(), value), type().digest(value.get())) << i;
  }
  EXPECT_EQ(Counted::hashed, 6000);
}

TEST_F(DigestMemo, ThreadsComputeItOnce) {
  std::vector<std::shared_ptr<const Counted>> values;
  for (int i = 0; i < 100; ++i) values.push_back(counted(i));
  std::vector<Digest> found(100 * values.size());
  parallelFor(Exec{}, found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = sharedDigest(type(), values[i % values.size()]);
  });
  EXPECT_EQ(Counted::hashed, 100);
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_EQ(found[i], type().digest(values[i % values.size()].get()));
}

TEST_F(DigestMemo, PartsAndNoPartAreHashedApart) {
  const auto digestOf = [](const std::shared_ptr<const Counted>& part) {
    Hasher hasher;
    hashPart(hasher, part);
    return hasher.digest();
  };
  const auto a = counted(1);
  EXPECT_NE(digestOf(a), digestOf(nullptr));
  EXPECT_NE(digestOf(a), digestOf(std::make_shared<const Counted>()));
  EXPECT_EQ(digestOf(a), digestOf(counted(1)));
}

TEST(ArchiveReaderBool, OnlyZeroAndOne) {
  const std::string bytes("\0\1\2", 3);
  ArchiveReader from(bytes, nullptr);
  EXPECT_FALSE(from.get<bool>());
  EXPECT_TRUE(from.get<bool>());
  EXPECT_TRUE(from.ok());
  EXPECT_FALSE(from.get<bool>());
  EXPECT_FALSE(from.ok());
}

}  // namespace
}  // namespace sherd
