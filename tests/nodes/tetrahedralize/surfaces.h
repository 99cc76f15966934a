// Surfaces with known volume and topology, and what every cage must fulfil.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tetrahedralize/tetrahedralize.h"

namespace sherd::test {

TriMesh box(const Vec3& low, const Vec3& high, int cells = 1);
TriMesh sphere(const Vec3& centre, double radius, int rings = 24);
TriMesh torus(double major, double minor, int around = 48, int across = 24);
/// A block with a slit of the given width from its top to near its bottom.
TriMesh slitBlock(double slit);
TriMesh joined(const TriMesh& a, const TriMesh& b);
TriMesh insideOut(TriMesh mesh);
TriMesh mapped(TriMesh mesh, const std::function<Vec3(const Vec3&)>& map);
double volumeOf(const TriMesh& mesh);

std::shared_ptr<const TriMesh> shared(TriMesh mesh);

/// Checks all that TetMesh promises, each by a way of its own: orientation, neighbours, boundary, enclosure,
/// held triangles, fractions. Empty if all holds; else what does not.
std::string defectOf(const TetMesh& cage);

/// Is the point in a tetrahedron of the cage?
bool holds(const TetMesh& cage, const Vec3& point);

/// (components, Euler characteristic of the whole boundary)
std::pair<int, int> cageTopology(const TetMesh& cage);

Result<TetMesh> cageOf(TriMesh mesh, int tets = 400);
void expectGood(const Result<TetMesh>& cage, int components, int euler);

}  // namespace sherd::test
