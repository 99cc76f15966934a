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
  /// `most`: names that will be asked for, at most.
  explicit FirstNumbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 8), -1) {}

  /// `hash` is the same for equal names, and spread over all its low bits.
  Index numberOf(const Name& name, std::uint64_t hash) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>(hash) & mask;
    while (slots_[slot] >= 0 && !(names_[at(slots_[slot])] == name)) slot = (slot + 1) & mask;
    if (slots_[slot] < 0) {
      slots_[slot] = static_cast<Index>(names_.size());
      names_.push_back(name);
    }
    return slots_[slot];
  }
  std::size_t size() const { return names_.size(); }
  std::vector<Name> take() { return std::move(names_); }

 private:
  std::vector<Name> names_;
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
