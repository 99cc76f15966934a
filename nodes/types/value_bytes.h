// What all types share in hashing, saving and loading: numbers by their bits, Eigen's matrices, and checks of
// what was loaded.
#pragma once

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/tri_mesh.h"
#include "types/vec.h"

namespace sherd {

/// A double, or a struct or matrix of fixed size made of nothing but doubles or 64-bit numbers.
template <class T>
concept Words = std::is_trivially_destructible_v<T> && sizeof(T) % 8 == 0 && !std::is_pointer_v<T>;

/// By their bits: −0 is not +0, since a value has to come back from the store as it was.
template <Words T>
void hashBits(Hasher& hasher, const T& words) {
  hasher.bytes(&words, sizeof words);
}
inline void hashBits(Hasher& hasher, const Eigen::MatrixXd& m) {
  hasher.add(m.rows()).add(m.cols()).bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
}

template <Words T>
void putBits(ArchiveWriter& to, const T& words) {
  to.raw(&words, sizeof words);
}
template <Words T>
void getBits(ArchiveReader& from, T& words) {
  from.raw(&words, sizeof words);
}

inline void putBits(ArchiveWriter& to, const Eigen::MatrixXd& m) {
  to.put(static_cast<std::int64_t>(m.rows()));
  to.put(static_cast<std::int64_t>(m.cols()));
  to.raw(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
}
/// Refuses columns without rows, since no bytes would bound their number.
inline void getBits(ArchiveReader& from, Eigen::MatrixXd& m) {
  const auto rows = from.get<std::int64_t>(), cols = from.get<std::int64_t>();
  const auto most = static_cast<std::int64_t>(from.remaining() / sizeof(double));
  constexpr auto kMostRows = std::numeric_limits<Index>::max();
  if (rows < 0 || cols < 0 || rows > (cols == 0 ? kMostRows : most / cols) || (rows == 0 && cols > 0))
    return from.fail();
  m.resize(rows, cols);
  from.raw(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
}

inline void hashBits(Hasher& hasher, const FileFrame& frame) {
  hashBits(hasher, frame.metresPerUnit);
  hasher.add(static_cast<int>(frame.up));
}
inline void putBits(ArchiveWriter& to, const FileFrame& frame) {
  to.put(frame.metresPerUnit);
  to.put(frame.up);
}
inline void getBits(ArchiveReader& from, FileFrame& frame) {
  from.get(frame.metresPerUnit);
  from.get(frame.up);
  if (frame.up != FileFrame::Up::Y && frame.up != FileFrame::Up::Z) from.fail();
}

/// A list of values that hold arrays themselves; `each` saves or loads one.
template <class T, class Each>
void putList(ArchiveWriter& to, const std::vector<T>& list, const Each& each) {
  to.put(static_cast<std::uint64_t>(list.size()));
  for (const T& item : list) each(item);
}
template <class T, class Each>
void getList(ArchiveReader& from, std::vector<T>& list, const Each& each) {
  // Grown one by one: a wrong length then costs no more memory than there are bytes.
  for (auto left = from.get<std::uint64_t>(); left > 0 && from.ok(); --left) each(list.emplace_back());
}

inline bool inRange(Index i, Index low, std::size_t end) {
  return i >= low && (i < 0 || static_cast<std::size_t>(i) < end);
}
/// Whether all of `indices`, or all corners of triangles and tetrahedra, lie in [low, end).
inline bool allInRange(const std::vector<Index>& indices, Index low, std::size_t end) {
  return std::all_of(indices.begin(), indices.end(), [&](Index i) { return inRange(i, low, end); });
}
template <std::size_t N>
bool allInRange(const std::vector<std::array<Index, N>>& tuples, Index low, std::size_t end) {
  return std::all_of(tuples.begin(), tuples.end(), [&](const auto& tuple) {
    return std::all_of(tuple.begin(), tuple.end(), [&](Index i) { return inRange(i, low, end); });
  });
}

}  // namespace sherd
