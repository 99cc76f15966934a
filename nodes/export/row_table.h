// Distinct rows of numbers in order of first use: what turns per-corner values into indexed ones.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// Rows are equal when their bits are. Adding costs O(width) on average.
class RowTable {
 public:
  explicit RowTable(std::size_t width, std::size_t expected = 16) : width_(width) {
    slots_.assign(std::bit_ceil(2 * expected + 1), -1);
    values_.reserve(width * expected);
  }

  /// The row's number, in [0, size()).
  Index add(const double* row) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    std::size_t slot = hash(row) & (slots_.size() - 1);
    while (slots_[slot] >= 0) {
      if (std::memcmp(values_.data() + at(slots_[slot]) * width_, row, width_ * sizeof(double)) == 0)
        return slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    values_.insert(values_.end(), row, row + width_);
    return slots_[slot] = static_cast<Index>(count_++);
  }
  std::size_t size() const { return count_; }
  std::span<const double> row(std::size_t i) const { return {values_.data() + i * width_, width_}; }

 private:
  std::size_t hash(const double* row) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (std::size_t i = 0; i < width_; ++i) {
      h = (h ^ std::bit_cast<std::uint64_t>(row[i])) * 0xff51afd7ed558ccdu;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
  void grow() {
    slots_.assign(2 * slots_.size(), -1);
    for (std::size_t i = 0; i < count_; ++i) {
      std::size_t slot = hash(values_.data() + i * width_) & (slots_.size() - 1);
      while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<Index>(i);
    }
  }

  std::size_t width_, count_ = 0;
  std::vector<Index> slots_;  ///< open addressing, −1 for free
  std::vector<double> values_;
};

}  // namespace sherd
