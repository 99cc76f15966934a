#include "repair/arrangement.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <map>

#include "geometry/disjoint_sets.h"

namespace sherd {
namespace {

using Point3 = Exact::Point_3;
using Point2 = Exact::Point_2;
/// A vertex's number; -1 in those that CGAL makes where constraints cross.
struct Number {
  Index value = -1;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Exact>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Exact>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Exact, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_intersections_tag>;

struct ByCoordinates {
  bool operator()(const Point3& a, const Point3& b) const { return CGAL::compare_xyz(a, b) == CGAL::SMALLER; }
};

/// What two triangles have in common: a point, a segment, or a convex polygon.
using Common = std::vector<Point3>;

Common commonOf(const Exact::Triangle_3& s, const Exact::Triangle_3& t) {
  Common common;
  const auto found = CGAL::intersection(s, t);
  if (!found) return common;
  if (const auto* point = boost::get<Point3>(&*found)) return {*point};
  if (const auto* segment = boost::get<Exact::Segment_3>(&*found))
    return {segment->source(), segment->target()};
  if (const auto* triangle = boost::get<Exact::Triangle_3>(&*found))
    return {triangle->vertex(0), triangle->vertex(1), triangle->vertex(2)};
  return boost::get<std::vector<Point3>>(*found);
}

class Cutter {
 public:
  Cutter(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Exec& exec)
      : triangles_(triangles), exec_(exec) {
    result_.points.reserve(positions.size());
    for (const Vec3& p : positions) result_.points.emplace_back(p.x(), p.y(), p.z());
  }

  CutSurface cut(std::span<const std::array<Index, 2>> pairs) {
    intersect(pairs);
    std::map<std::size_t, std::vector<Index>> groups;
    for (const auto& [t, list] : common_) groups[coplanar_->find(at(t))].push_back(t);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (!common_.contains(static_cast<Index>(t)))
        result_.faces.push_back({triangles_[t], static_cast<Index>(t)});
    for (const auto& [root, members] : groups) {
      if (exec_.cancelled()) break;
      triangulate(members);
    }
    return std::move(result_);
  }

 private:
  Exact::Triangle_3 exact(Index t) const {
    const Triangle& v = triangles_[at(t)];
    return {result_.points[at(v[0])], result_.points[at(v[1])], result_.points[at(v[2])]};
  }

  void intersect(std::span<const std::array<Index, 2>> pairs) {
    coplanar_ = std::make_unique<DisjointSets>(triangles_.size());
    for (const auto& pair : pairs)
      for (const Index t : pair)
        for (const Index v : triangles_[at(t)]) number_.try_emplace(result_.points[at(v)], v);
    for (const auto& [s, t] : pairs) {
      if (exec_.cancelled()) return;
      Common common = commonOf(exact(s), exact(t));
      if (common.size() > 2) coplanar_->join(at(s), at(t));
      common_[s].push_back(common);
      common_[t].push_back(std::move(common));
    }
  }

  Index numberOf(const Point3& p) {
    const auto [it, isNew] = number_.try_emplace(p, static_cast<Index>(result_.points.size()));
    if (isNew) result_.points.push_back(p);
    return it->second;
  }

  /// The plane of a group of triangles, seen along an axis that it isn't parallel to.
  struct View {
    Exact::Plane_3 plane;
    int axis;
    Point2 flat(const Point3& p) const { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }
    Point3 lifted(const Point2& p) const {
      const Exact::FT normal[3] = {plane.a(), plane.b(), plane.c()};
      Exact::FT x[3];
      x[(axis + 1) % 3] = p.x();
      x[(axis + 2) % 3] = p.y();
      x[axis] = -(normal[(axis + 1) % 3] * p.x() + normal[(axis + 2) % 3] * p.y() + plane.d()) / normal[axis];
      return {x[0], x[1], x[2]};
    }
  };
  View viewOf(Index t) const {
    const Exact::Triangle_3 triangle = exact(t);
    View view{triangle.supporting_plane(), 0};
    double largest = -1;
    const Exact::FT normal[3] = {view.plane.a(), view.plane.b(), view.plane.c()};
    for (int k = 0; k < 3; ++k)
      if (const double size = std::abs(CGAL::to_double(normal[k])); size > largest)
        largest = size, view.axis = k;
    return view;
  }

  void triangulate(const std::vector<Index>& members) {
    const View view = viewOf(members[0]);
    Triangulation flat;
    const auto insert = [&](const Point3& p) {
      const auto vertex = flat.insert(view.flat(p));
      vertex->info().value = numberOf(p);
      return vertex;
    };
    for (const Index t : members) {
      std::array<Triangulation::Vertex_handle, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = insert(result_.points[at(triangles_[at(t)][c])]);
      for (std::size_t c = 0; c < 3; ++c) constrain(flat, corners[c], corners[(c + 1) % 3]);
    }
    for (const Index t : members)
      for (const Common& common : common_.at(t)) {
        std::vector<Triangulation::Vertex_handle> vertices;
        for (const Point3& p : common) vertices.push_back(insert(p));
        for (std::size_t k = 0; k + 1 < vertices.size(); ++k) constrain(flat, vertices[k], vertices[k + 1]);
        if (vertices.size() > 2) constrain(flat, vertices.back(), vertices[0]);
      }
    for (const auto vertex : flat.finite_vertex_handles())
      if (vertex->info().value < 0) vertex->info().value = numberOf(view.lifted(vertex->point()));
    for (const auto face : flat.finite_face_handles()) addFaces(flat, face, members, view);
  }

  static void constrain(Triangulation& flat, Triangulation::Vertex_handle a, Triangulation::Vertex_handle b) {
    if (a != b) flat.insert_constraint(a, b);
  }

  void addFaces(const Triangulation& flat, Triangulation::Face_handle face, const std::vector<Index>& members,
                const View& view) {
    const Triangle corners{face->vertex(0)->info().value, face->vertex(1)->info().value,
                           face->vertex(2)->info().value};
    const Point2 middle = CGAL::centroid(flat.triangle(face));
    for (const Index t : members) {
      std::array<Point2, 3> p;
      for (std::size_t c = 0; c < 3; ++c) p[c] = view.flat(result_.points[at(triangles_[at(t)][c])]);
      const auto turn = CGAL::orientation(p[0], p[1], p[2]);
      bool inside = true;
      for (std::size_t c = 0; inside && members.size() > 1 && c < 3; ++c)
        inside = CGAL::orientation(p[c], p[(c + 1) % 3], middle) == turn;
      if (!inside) continue;
      Triangle own = corners;
      if (turn == CGAL::RIGHT_TURN) std::swap(own[1], own[2]);
      result_.faces.push_back({own, t});
    }
  }

  std::span<const Triangle> triangles_;
  const Exec& exec_;
  CutSurface result_;
  std::map<Index, std::vector<Common>> common_;
  std::map<Point3, Index, ByCoordinates> number_;
  std::unique_ptr<DisjointSets> coplanar_;
};

}  // namespace

CutSurface arrange(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   std::span<const std::array<Index, 2>> pairs, const Exec& exec) {
  return Cutter(positions, triangles, exec).cut(pairs);
}

}  // namespace sherd
