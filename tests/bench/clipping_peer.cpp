#include "bench/clipping_peer.h"

#include <CGAL/Convex_hull_3/dual/halfspace_intersection_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include <boost/optional.hpp>
#include <chrono>
#include <ctime>
#include <exception>

namespace sherd::bench {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Mesh = CGAL::Surface_mesh<Point>;

Mesh meshOf(const TriMesh& surface) {
  Mesh mesh;
  for (const Vec3& p : surface.positions) mesh.add_vertex(Point(p.x(), p.y(), p.z()));
  for (const Triangle& t : surface.triangles)
    mesh.add_face(Mesh::Vertex_index(static_cast<unsigned>(t[0])),
                  Mesh::Vertex_index(static_cast<unsigned>(t[1])),
                  Mesh::Vertex_index(static_cast<unsigned>(t[2])));
  return mesh;
}

/// Bisectors towards all other sites, and a box around everything.
Mesh cellOf(std::size_t i, const std::vector<Vec3>& sites, const Box& box) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 n = Vec3::Unit(axis);
    planes.emplace_back(n.x(), n.y(), n.z(), -box.high[axis]);
    planes.emplace_back(-n.x(), -n.y(), -n.z(), box.low[axis]);
  }
  for (std::size_t j = 0; j < sites.size(); ++j) {
    const Vec3 n = sites[j] - sites[i];
    if (j != i) planes.emplace_back(n.x(), n.y(), n.z(), -n.dot(0.5 * (sites[j] + sites[i])));
  }
  Mesh cell;
  CGAL::halfspace_intersection_3(planes.begin(), planes.end(), cell,
                                 boost::make_optional(Point(sites[i].x(), sites[i].y(), sites[i].z())));
  PMP::triangulate_faces(cell);
  return cell;
}

}  // namespace

PeerCut cutByCorefinement(const TriMesh& surface, const std::vector<Vec3>& sites) {
  Box box = boxOf(surface.positions);
  for (const Vec3& s : sites) box.add(s);
  const Vec3 margin = Vec3::Constant(0.1 * box.diagonal());
  box.low -= margin;
  box.high += margin;
  const Mesh whole = meshOf(surface);
  PeerCut cut;
  double volume = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    Mesh cell = cellOf(i, sites, box);
    Mesh piece;
    bool made = false;
    const std::clock_t cpuStart = std::clock();
    const auto start = std::chrono::steady_clock::now();
    try {
      Mesh copy = whole;
      made = PMP::corefine_and_compute_intersection(copy, cell, piece);
    } catch (const std::exception&) {
      made = false;
    }
    cut.milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    cut.processorMilliseconds += 1000.0 * static_cast<double>(std::clock() - cpuStart) / CLOCKS_PER_SEC;
    cut.failed += !made;
    if (!made || piece.is_empty()) continue;
    ++cut.pieces;
    volume += PMP::volume(piece);
  }
  const double sum = PMP::volume(whole);
  cut.volumeError = std::abs(volume - sum) / sum;
  return cut;
}

}  // namespace sherd::bench
