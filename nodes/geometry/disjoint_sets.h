// Union-find with path halving; the root of a set is its least member, so that results do not depend on the
// order of joins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace sherd {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {  // fewer than 2³²
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = static_cast<std::uint32_t>(a);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace sherd
