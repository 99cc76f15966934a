// Shells, components and Euler characteristics of closed triangle surfaces.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// One connected part of a closed surface.
struct Shell {
  std::vector<Index> triangles;
  int euler = 0;      ///< vertices − edges + triangles = 2 − 2 · handles
  double volume = 0;  ///< signed; negative for the wall of a void
};

/// Splits a closed manifold surface into its shells, in the order of their first triangles. Fails on an edge
/// that is not in exactly two oppositely oriented triangles, on a vertex where several fans meet, on a
/// triangle that uses a vertex twice, naming the place. Cost O(n log n).
Result<std::vector<Shell>> splitShells(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Which shells a surface has, comparable between a surface and its cage: sorted (is a void, Euler
/// characteristic).
std::vector<std::pair<bool, int>> topologyOf(const std::vector<Shell>& shells);
/// Is `got` the topology of something that closely encloses a surface of topology `wanted`? With contacts
/// (contacts.h):
/// may each of them have joined two components or closed a handle.
bool enclosesTopology(const std::vector<std::pair<bool, int>>& got,
                      const std::vector<std::pair<bool, int>>& wanted, std::size_t contacts);
/// Fewer components?
bool joinsSome(const std::vector<std::pair<bool, int>>& got, const std::vector<std::pair<bool, int>>& wanted);
/// As many components, and no void filled?
bool joinsNoBodies(const std::vector<std::pair<bool, int>>& got,
                   const std::vector<std::pair<bool, int>>& wanted);
/// How many shells and handles there are too many or too few.
int topologyDifference(const std::vector<std::pair<bool, int>>& got,
                       const std::vector<std::pair<bool, int>>& wanted);
/// "2 components, 1 void, 3 handles" for messages.
std::string describeTopology(const std::vector<std::pair<bool, int>>& topology);
/// "(x, y, z)" with enough digits to find the place.
std::string placeText(const Vec3& place);

}  // namespace sherd
