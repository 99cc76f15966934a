// Values, records and child processes for the tests of the cache on disk.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "eval/disk_store.h"

namespace sherd::test {

struct Leaf {
  static constexpr const char* typeName = "Leaf";
  static constexpr int archiveVersion = 1;
  std::vector<double> numbers;
  friend bool operator==(const Leaf&, const Leaf&) = default;
};
inline void hashValue(Hasher& hasher, const Leaf& leaf) { hasher.add(leaf.numbers); }
inline std::size_t byteSize(const Leaf& leaf) { return sizeof leaf + leaf.numbers.size() * sizeof(double); }
inline void saveValue(ArchiveWriter& to, const Leaf& leaf) { to.array(leaf.numbers); }
inline std::optional<Leaf> loadValue(ArchiveReader& from, std::type_identity<Leaf>) {
  Leaf leaf;
  from.array(leaf.numbers);
  return leaf;
}

/// A later version of the same type.
struct NewLeaf : Leaf {
  static constexpr int archiveVersion = 2;
};
inline std::optional<NewLeaf> loadValue(ArchiveReader& from, std::type_identity<NewLeaf>) {
  return NewLeaf{*loadValue(from, std::type_identity<Leaf>())};
}

/// Two parts, either of which may be null.
struct Branch {
  static constexpr const char* typeName = "Branch";
  static constexpr int archiveVersion = 1;
  std::string name;
  std::shared_ptr<const Leaf> left, right;
};
inline void hashValue(Hasher& hasher, const Branch& branch) {
  hasher.add(std::string_view(branch.name));
  for (const auto& leaf : {branch.left, branch.right}) {
    hasher.add(leaf != nullptr);
    if (leaf != nullptr) hashValue(hasher, *leaf);
  }
}
inline std::size_t byteSize(const Branch&) { return sizeof(Branch); }
inline void saveValue(ArchiveWriter& to, const Branch& branch) {
  to.text(branch.name);
  to.part(branch.left);
  to.part(branch.right);
}
inline std::optional<Branch> loadValue(ArchiveReader& from, std::type_identity<Branch>) {
  Branch branch;
  branch.name = from.text();
  branch.left = from.part<Leaf>();
  branch.right = from.part<Leaf>();
  return branch;
}

/// A type that can't be kept.
struct Fleeting {
  static constexpr const char* typeName = "Fleeting";
};
inline void hashValue(Hasher&, const Fleeting&) {}
inline std::size_t byteSize(const Fleeting&) { return 1; }

template <class T>
Value valueOf(T content) {
  return Value::of(std::make_shared<const T>(std::move(content)));
}
/// `count` numbers that differ from seed to seed.
inline Leaf leaf(std::uint64_t seed, std::size_t count = 16) {
  Rng rng(seed);
  Leaf made;
  for (std::size_t i = 0; i < count; ++i) made.numbers.push_back(rng.uniform());
  return made;
}

inline Digest digestOf(std::uint64_t number) { return Hasher().add(number).digest(); }

/// Everything about it follows from `number`.
inline ResultRecord recordOf(std::uint64_t number, double ms = 0.01) {
  Rng rng(number);
  ResultRecord record{digestOf(number), digestOf(number + 1'000'000'000), ms, {}, {}, {}};
  for (std::uint64_t i = 0; i <= number % 3; ++i)
    record.outputs.push_back(i == 2 ? OutputRecord{} : OutputRecord{{rng.bits(), rng.bits()}, rng.bits()});
  if (number % 5 == 0) record.messages.push_back({LogLevel::Warning, "warning " + std::to_string(number)});
  if (number % 5 == 0) record.messages.push_back({LogLevel::Info, std::string(number % 11, 'x')});
  if (number % 7 == 0)
    record.written.push_back({"/out/" + std::to_string(number), {1, number + 1, 3, 4, -5}});
  return record;
}

inline std::unique_ptr<DiskStore> openStore(const std::filesystem::path& directory,
                                            DiskStoreOptions options = {}) {
  auto store = DiskStore::open(directory.string(), std::move(options));
  return store.ok() ? std::move(store).value() : nullptr;
}

inline std::filesystem::path objectPath(const std::filesystem::path& store, const Digest& digest) {
  return store / "objects" / digest.hex().substr(0, 2) / digest.hex();
}

inline std::vector<std::filesystem::path> filesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code problem;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory, problem))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
/// As a new file: cutting an old one to nothing makes some file systems wait for the disk.
inline void writeFile(const std::filesystem::path& path, const std::string& content) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

constexpr int kSkipped = 77;
/// Runs f in a child process and returns what it returns, or 128 + the signal that ended it.
inline int inChild(const std::function<int()>& f) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(f());
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace sherd::test
