// Triangles in parts that hang together, each with its border: what is joined to other parts is the border
// alone.
#pragma once

#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// An edge of one triangle of its part, in its direction.
struct BorderEdge {
  Index from, to;  ///< vertices
  Index corner;    ///< of the sheets: it is the edge that begins there, from end to end; −1 for any other
};

/// T has `corners`.
template <class T>
struct PartedTriangles {
  std::vector<T> triangles;
  std::vector<Index> first, firstBorder;  ///< per part: its first triangle and border edge
  std::vector<BorderEdge> border;

  std::size_t parts() const { return first.size(); }
  std::size_t begin(std::size_t part) const { return at(first[part]); }
  std::size_t end(std::size_t part) const {
    return part + 1 < first.size() ? at(first[part + 1]) : triangles.size();
  }
  std::span<const T> of(std::size_t part) const {
    return std::span(triangles).subspan(begin(part), end(part) - begin(part));
  }
  std::span<const BorderEdge> borderOf(std::size_t part) const {
    const std::size_t from = at(firstBorder[part]);
    return std::span(border).subspan(
        from, (part + 1 < first.size() ? at(firstBorder[part + 1]) : border.size()) - from);
  }

  void startPart() {
    first.push_back(static_cast<Index>(triangles.size()));
    firstBorder.push_back(static_cast<Index>(border.size()));
  }
  /// Begins a part with this loop as its border.
  void startPart(std::span<const Index> loop) {
    startPart();
    for (std::size_t i = 0; i < loop.size(); ++i)
      border.push_back({loop[i], loop[(i + 1) % loop.size()], -1});
  }
  /// A part of its own.
  void addAlone(const T& t) {
    startPart(t.corners);
    triangles.push_back(t);
  }
  void append(const PartedTriangles& other) {
    const auto triangle = static_cast<Index>(triangles.size()), edge = static_cast<Index>(border.size());
    for (const Index i : other.first) first.push_back(triangle + i);
    for (const Index i : other.firstBorder) firstBorder.push_back(edge + i);
    triangles.insert(triangles.end(), other.triangles.begin(), other.triangles.end());
    border.insert(border.end(), other.border.begin(), other.border.end());
  }
  void reserve(std::size_t triangleCount, std::size_t partCount, std::size_t borderCount) {
    triangles.reserve(triangleCount);
    first.reserve(partCount);
    firstBorder.reserve(partCount);
    border.reserve(borderCount);
  }
  /// Makes every triangle a part of its own.
  void split() {
    first.clear(), firstBorder.clear(), border.clear();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      first.push_back(static_cast<Index>(t));
      firstBorder.push_back(static_cast<Index>(3 * t));
      for (std::size_t c = 0; c < 3; ++c)
        border.push_back({triangles[t].corners[c], triangles[t].corners[(c + 1) % 3], -1});
    }
  }
};

}  // namespace sherd
