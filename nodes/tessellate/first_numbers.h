// Numbers for names, in the order in which they first come.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// A hash table of names that know ==, in flat arrays.
template <class Name>
class FirstNumbers {
 public:
  /// `likely`: about as many names as will come.
  explicit FirstNumbers(std::size_t likely) : slots_(std::bit_ceil(2 * likely + 8), -1) {}

  /// `hash` is the same for equal names, and spread over all its low bits.
  Index numberOf(const Name& name, std::uint64_t hash) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>(hash) & mask;
    for (; slots_[slot] >= 0; slot = (slot + 1) & mask)
      if (const std::size_t known = at(slots_[slot]); hashes_[known] == hash && names_[known] == name)
        return slots_[slot];
    const auto number = static_cast<Index>(names_.size());
    slots_[slot] = number;
    names_.push_back(name);
    hashes_.push_back(hash);
    if (2 * names_.size() > slots_.size()) grow();
    return number;
  }
  std::size_t size() const { return names_.size(); }
  std::vector<Name> take() { return std::move(names_); }
  std::vector<std::uint64_t> takeHashes() { return std::move(hashes_); }

 private:
  void grow() {
    slots_.assign(2 * slots_.size(), -1);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t number = 0; number < hashes_.size(); ++number) {
      std::size_t slot = static_cast<std::size_t>(hashes_[number]) & mask;
      while (slots_[slot] >= 0) slot = (slot + 1) & mask;
      slots_[slot] = static_cast<Index>(number);
    }
  }

  std::vector<Name> names_;
  std::vector<std::uint64_t> hashes_;
  std::vector<Index> slots_;
};

/// For the above.
template <class Range>
std::uint64_t hashOfIndices(const Range& indices, std::uint64_t hash = 0) {
  for (const Index i : indices)
    hash = (hash ^ static_cast<std::uint32_t>(i)) * 0x9E3779B97F4A7C15ULL, hash ^= hash >> 32;
  return hash;
}

}  // namespace sherd
