// Sorting what is keyed by small integers that are spread evenly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sherd {

/// As std::sort(list, less), where less orders by key(element) first, in [0, keys). Cost O(n) where about as
/// many elements have keys close to each other everywhere, else O(n log n).
template <class T, class Key, class Less>
void bucketSort(std::vector<T>& list, std::size_t keys, Key key, Less less) {
  int shift = 0;
  while (keys >> shift > 2 * list.size()) ++shift;
  const auto bucketOf = [&](const T& x) { return static_cast<std::size_t>(key(x)) >> shift; };
  std::vector<std::uint32_t> begin((keys >> shift) + 2, 0);
  for (const T& x : list) ++begin[bucketOf(x) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<T> sorted(list.size());
  std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
  for (const T& x : list) sorted[fill[bucketOf(x)]++] = x;
  for (std::size_t b = 0; b + 1 < begin.size(); ++b)
    std::sort(sorted.begin() + begin[b], sorted.begin() + begin[b + 1], less);
  list.swap(sorted);
}

}  // namespace sherd
