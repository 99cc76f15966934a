#include "geometry/inspect_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "geometry/edge_table.h"
#include "geometry/orient.h"
#include "geometry/self_intersections.h"
#include "geometry/vertex_fans.h"

namespace sherd {
namespace {

constexpr std::size_t kPairLimit = 1000;  ///< per block of triangles, to tell which parts meet

void note(Defect& defect, const TriMesh& mesh, const Vec3& place) {
  if (defect.count++ == 0) defect.place = mesh.frame.toFile(place);
}

Vec3 middleOf(const TriMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return mesh.positions[at(a)] / 3 + mesh.positions[at(b)] / 3 + mesh.positions[at(c)] / 3;
}

Vec3 middleOf(const TriMesh& mesh, const std::array<Index, 2>& edge) {
  return 0.5 * mesh.positions[at(edge[0])] + 0.5 * mesh.positions[at(edge[1])];
}

void inspectEdges(const TriMesh& mesh, const EdgeTable& edges, SurfaceReport& report) {
  std::vector<int> balance(edges.ends.size(), 0);  // uses forward minus uses backward
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int slot = 0; slot < 3; ++slot)
      balance[at(edges.ofTriangle[t][static_cast<std::size_t>(slot)])] +=
          edges.forward(mesh.triangles, static_cast<Index>(t), slot) ? 1 : -1;
  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const std::size_t uses = edges.trianglesOf(static_cast<Index>(e)).size();
    const Vec3 place = middleOf(mesh, edges.ends[e]);
    if (uses == 1) note(report.openEdges, mesh, place);
    if (uses > 2) note(report.nonManifoldEdges, mesh, place);
    if (uses == 2 && balance[e] != 0) note(report.incoherentEdges, mesh, place);
  }
}

void inspectVertices(const TriMesh& mesh, const EdgeTable& edges, SurfaceReport& report) {
  const std::vector<int> fans = countFans(mesh.triangles, mesh.positions.size(), edges);
  for (std::size_t v = 0; v < fans.size(); ++v)
    if (fans[v] > 1) note(report.nonManifoldVertices, mesh, mesh.positions[v]);
}

void inspectTriangles(const TriMesh& mesh, SurfaceReport& report) {
  std::vector<std::pair<Triangle, Index>> sorted(mesh.triangles.size());
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {mesh.triangles[t], static_cast<Index>(t)};
    std::sort(sorted[t].first.begin(), sorted[t].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> repeated;
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k].first == sorted[k - 1].first) repeated.push_back(sorted[k].second);
  std::sort(repeated.begin(), repeated.end());
  for (const Index t : repeated) note(report.duplicateTriangles, mesh, middleOf(mesh, at(t)));
  for (const Index t : zeroAreaTriangles(mesh.positions, mesh.triangles))
    note(report.zeroArea, mesh, middleOf(mesh, at(t)));
}

/// Which parts meet others; notes how many pairs do.
std::vector<bool> meetingParts(const TriMesh& mesh, const std::vector<SurfacePart>& parts,
                               SurfaceReport& report, const Exec& exec) {
  std::vector<bool> meets(parts.size(), false);
  if (!report.selfIntersections || parts.size() < 2) return meets;
  std::vector<std::size_t> partOf(mesh.triangles.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const Index t : parts[p].triangles) partOf[at(t)] = p;
  const IntersectingPairs met = intersectingPairs(mesh.positions, mesh.triangles, exec, kPairLimit);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [s, t] : met.pairs) {
    const auto [a, b] = std::minmax(partOf[at(s)], partOf[at(t)]);
    if (a == b || !pairs.emplace(a, b).second) continue;
    note(report.crossingParts, mesh, middleOf(mesh, at(s)));
    meets[a] = meets[b] = true;
  }
  report.crossingParts.more = met.more;
  return meets;
}

void inspectShells(const TriMesh& mesh, const EdgeTable& edges, SurfaceReport& report, const Exec& exec) {
  const std::vector<SurfacePart> shells = surfaceParts(mesh.triangles, edges);
  const Nesting nesting = nestShells(mesh, shells);
  const std::vector<bool> meets = meetingParts(mesh, shells, report, exec);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const SurfacePart& shell = shells[s];
    const bool manifold = shell.conflict < 0 || edges.trianglesOf(shell.conflict).size() == 2;
    if (!shell.orientable && manifold)
      note(report.nonOrientable, mesh, middleOf(mesh, edges.ends[at(shell.conflict)]));
    if (!shell.closed || !shell.orientable || !shell.odd.empty()) continue;
    double area = 0;
    Box box;
    for (const Index t : shell.triangles) {
      const auto& [a, b, c] = mesh.triangles[at(t)];
      const Vec3 &p = mesh.positions[at(a)], &q = mesh.positions[at(b)], &r = mesh.positions[at(c)];
      area += 0.5 * (q - p).cross(r - p).norm();
      for (const Vec3& corner : {p, q, r}) box.add(corner);
    }
    const double volume = nesting.volume[s];
    const Vec3 place = middleOf(mesh, at(shell.triangles[0]));
    if (!(std::abs(volume) > 1e-12 * area * box.diagonal()))
      note(report.noVolume, mesh, place);
    else if (!meets[s] && (volume < 0) != (nesting.depth[s] % 2 == 1))
      note(report.inverted, mesh, place);
  }
}

struct Entry {
  const Defect SurfaceReport::*defect;
  const char *one, *several;  ///< what it is called
  const char* remedy;
};

/// In the order in which they are best repaired.
const std::array<Entry, 12>& entries() {
  using R = SurfaceReport;
  static const char* const kHoles = "fill the holes (Blender: select all by trait > non manifold, then fill)";
  static const char* const kNonManifold = "separate or delete the parts that meet there";
  static const char* const kUnion =
      "make it one surface that doesn't cross itself (Blender: boolean union with self intersection, or "
      "remesh)";
  static const std::array<Entry, 12> list{{
      {&R::nonFinite, "vertex that is not finite", "vertices that are not finite",
       "export it again without NaN and infinite coordinates"},
      {&R::duplicateTriangles, "duplicate triangle", "duplicate triangles",
       "delete one of each pair of equal faces"},
      {&R::zeroArea, "triangle of no area", "triangles of no area",
       "dissolve degenerate faces (Blender: clean up > degenerate dissolve)"},
      {&R::openEdges, "open edge", "open edges", kHoles},
      {&R::nonManifoldEdges, "edge with more than two triangles", "edges with more than two triangles",
       kNonManifold},
      {&R::nonManifoldVertices, "vertex where separate parts touch", "vertices where separate parts touch",
       kNonManifold},
      {&R::nonOrientable, "one-sided part", "one-sided parts", "rebuild it with an inside and an outside"},
      {&R::incoherentEdges, "edge between faces of opposite sides", "edges between faces of opposite sides",
       "make the normals consistent (Blender: recalculate outside)"},
      {&R::selfIntersections, "pair of intersecting triangles", "pairs of intersecting triangles", kUnion},
      {&R::crossingParts, "pair of parts that cross or touch", "pairs of parts that cross or touch", kUnion},
      {&R::noVolume, "closed part of no volume", "closed parts of no volume",
       "delete it or give it thickness"},
      {&R::inverted, "part turned inside out", "parts turned inside out", "flip its normals"},
  }};
  return list;
}

std::string whereIs(const Defect& defect) {
  // Where a coordinate is no number, the place tells nothing.
  const bool isNumbered = defect.vertex >= 0;
  const std::string place =
      isNumbered ? "vertex " + std::to_string(defect.vertex + 1) + ", " + placeInFile(defect.place)
                 : "near " + placeInFile(defect.place);
  if (defect.count > 1) return " (the first " + std::string(isNumbered ? "is " : "") + place + ")";
  return (isNumbered ? ": " : " ") + place;
}

}  // namespace

bool SurfaceReport::sound() const {
  return !empty && std::none_of(entries().begin(), entries().end(),
                                [&](const Entry& e) { return static_cast<bool>(this->*e.defect); });
}

Defect nonFiniteVertices(const TriMesh& mesh) {
  Defect defect;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].allFinite()) continue;
    if (!defect) defect.vertex = static_cast<Index>(v);
    note(defect, mesh, mesh.positions[v]);
  }
  return defect;
}

SurfaceReport inspectSurface(const TriMesh& mesh, const Exec& exec) {
  SurfaceReport report;
  report.empty = mesh.triangles.empty();
  report.nonFinite = nonFiniteVertices(mesh);
  if (report.empty || report.nonFinite) return report;
  const EdgeTable edges = buildEdgeTable(mesh.triangles, mesh.positions.size());
  if (exec.cancelled()) return report;
  inspectEdges(mesh, edges, report);
  if (exec.cancelled()) return report;
  inspectVertices(mesh, edges, report);
  if (exec.cancelled()) return report;
  inspectTriangles(mesh, report);
  if (exec.cancelled()) return report;
  const SelfIntersections crossings = findSelfIntersections(mesh.positions, mesh.triangles, exec);
  if (exec.cancelled()) return report;
  if (crossings.pairs > 0) {
    note(report.selfIntersections, mesh, middleOf(mesh, at(crossings.first[0])));
    report.selfIntersections.count = crossings.pairs;
    report.selfIntersections.more = crossings.more;
  }
  inspectShells(mesh, edges, report, exec);
  return report;
}

std::optional<Error> refusal(const SurfaceReport& report, const std::string& file) {
  if (report.empty) return failure(file + " holds no triangles", "export a mesh with faces", "file");
  if (report.sound()) return std::nullopt;
  std::string what, remedy;
  for (const Entry& entry : entries()) {
    const Defect& defect = report.*entry.defect;
    if (!defect) continue;
    what += (what.empty() ? "" : ", ") + std::string(defect.more ? "at least " : "") +
            std::to_string(defect.count) + " " + (defect.count == 1 ? entry.one : entry.several) +
            whereIs(defect);
    if (remedy.find(entry.remedy) == std::string::npos)
      remedy += (remedy.empty() ? "" : "; ") + std::string(entry.remedy);
  }
  return failure(file + " does not bound a solid: " + what, remedy, "file");
}

std::string placeInFile(const Vec3& place) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", place.x(), place.y(), place.z());
  return text;
}

}  // namespace sherd
