#include "support/fracture_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "base/rng.h"

namespace sherd::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point pointOf(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Per position, the first one (in an order of places) that stands on the same spot.
std::vector<Index> joinedByPlace(const std::vector<Vec3>& positions) {
  std::vector<Index> order(positions.size()), same(positions.size());
  std::iota(order.begin(), order.end(), 0);
  auto key = [&](Index i) {
    const Vec3& p = positions[at(i)];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    same[at(order[i])] = i > 0 && key(order[i]) == key(order[i - 1]) ? same[at(order[i - 1])] : order[i];
  return same;
}

std::vector<Triangle> renamed(std::span<const Triangle> triangles, const std::vector<Index>& same) {
  std::vector<Triangle> result(triangles.begin(), triangles.end());
  for (Triangle& t : result)
    for (Index& v : t) v = same[at(v)];
  return result;
}

bool collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

long double sixVolumes(const std::vector<Vec3>& p, const Triangle& t, const Vec3& o) {
  using Wide = Eigen::Matrix<long double, 3, 1>;
  const Wide a = (p[at(t[0])] - o).cast<long double>(), b = (p[at(t[1])] - o).cast<long double>(),
             c = (p[at(t[2])] - o).cast<long double>();
  return a.cross(b).dot(c);
}

long double areaOf(const std::vector<Vec3>& p, const Triangle& t) {
  using Wide = Eigen::Matrix<long double, 3, 1>;
  const Wide a = p[at(t[0])].cast<long double>();
  return (p[at(t[1])].cast<long double>() - a).cross(p[at(t[2])].cast<long double>() - a).norm() / 2;
}

/// A directed edge of a triangle.
struct EdgeUse {
  Index low, high;
  bool forward;
  std::size_t triangle;
  friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  }
};

std::vector<EdgeUse> edgeUses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(triangles[i][c], triangles[i][(c + 1) % 3]);
      if (low != high) uses.push_back({low, high, triangles[i][c] == low, i});
    }
  std::sort(uses.begin(), uses.end());
  return uses;
}

struct Roots {
  std::vector<std::size_t> parent;
  explicit Roots(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
};

/// Edges and shells of one piece.
void checkPiece(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles, const Vec3& origin,
                FractureCheck& check, long double& volumeSum) {
  for (const Triangle& t : triangles) check.degenerate += collapsed(t);
  const std::vector<EdgeUse> uses = edgeUses(triangles);
  Roots shells(triangles.size());
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t forward = 0, backward = 0;
    const std::size_t first = i;
    for (; i < uses.size() && uses[i].low == uses[first].low && uses[i].high == uses[first].high; ++i) {
      ++(uses[i].forward ? forward : backward);
      shells.parent[shells.find(uses[i].triangle)] = shells.find(uses[first].triangle);
    }
    check.openEdges += forward != backward;
    check.nonManifoldEdges += forward == backward && forward > 1;
  }
  std::vector<long double> volumes(triangles.size(), 0);
  long double volume = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const long double v = sixVolumes(p, triangles[i], origin);
    volumes[shells.find(i)] += v;
    volume += v;
  }
  check.severalParts +=
      std::count_if(volumes.begin(), volumes.end(), [](long double v) { return v > 0; }) != 1;
  check.notPositive += !(volume > 0);
  volumeSum += volume;
}

/// A crack triangle by its sorted corners.
struct CrackFace {
  Triangle sorted;
  bool odd;  ///< its direction against the sorted one
  Index piece, neighbour;
  /// Faces of one pair of pieces stand together: rounding may lay the faces of others on top of them.
  auto key() const { return std::tuple(sorted, std::min(piece, neighbour), std::max(piece, neighbour)); }
  friend bool operator<(const CrackFace& a, const CrackFace& b) { return a.key() < b.key(); }
};

CrackFace crackFace(const Triangle& t, Index piece, Index neighbour) {
  CrackFace face{t, ((t[0] > t[1]) + (t[1] > t[2]) + (t[0] > t[2])) % 2 != 0, piece, neighbour};
  std::sort(face.sorted.begin(), face.sorted.end());
  return face;
}

std::size_t lonelyAmong(std::vector<CrackFace> faces) {
  std::sort(faces.begin(), faces.end());
  std::size_t lonely = 0;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t n = i;
    while (n < faces.size() && faces[n].key() == faces[i].key()) ++n;
    const bool twins = n == i + 2 && faces[i].odd != faces[i + 1].odd &&
                       faces[i].piece == faces[i + 1].neighbour && faces[i].neighbour == faces[i + 1].piece &&
                       faces[i].piece != faces[i].neighbour;
    if (!twins) lonely += n - i;
    i = n;
  }
  return lonely;
}

double squaredDistance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length = (b - a).squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0;
  return (p - a - s * (b - a)).squaredNorm();
}

/// Of a point from a triangle that it should lie on.
double distanceFrom(const Vec3& p, const std::vector<Vec3>& corners, const Triangle& t) {
  const Vec3 &a = corners[at(t[0])], &b = corners[at(t[1])], &c = corners[at(t[2])];
  const Vec3 n = (b - a).cross(c - a);
  const bool inside = n.squaredNorm() > 0 && n.cross(b - a).dot(p - a) >= 0 &&
                      n.cross(c - b).dot(p - b) >= 0 && n.cross(a - c).dot(p - c) >= 0;
  if (inside) return std::abs(n.dot(p - a)) / n.norm();
  return std::sqrt(std::min({squaredDistance(p, a, b), squaredDistance(p, b, c), squaredDistance(p, c, a)}));
}

/// The skin of a piece against the source triangles that it says it is made of.
void checkSkin(const Fragments& f, const Piece& piece, double size, FractureCheck& check) {
  const TriMesh& source = *f.tets->surface;
  for (std::size_t t = 0; t < piece.surface.size(); ++t) {
    const Triangle& from = source.triangles[at(piece.surfaceSource[t])];
    const Index cut = piece.surfaceCut[t];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = f.positions[at(piece.surface[t][c])];
      if (cut < 0) {
        check.changedSources += p != source.positions[at(from[c])];
        continue;
      }
      check.offSource = std::max(check.offSource, distanceFrom(p, source.positions, from) / size);
      const CornerWeights& w = f.cutCorners[at(cut)][c];
      Vec3 meant = Vec3::Zero();  // about the source's corner, so that it keeps digits far from the origin
      const Vec3& a = source.positions[at(from[0])];
      for (std::size_t k = 1; k < 3; ++k)
        meant += w[static_cast<Eigen::Index>(k)] * (source.positions[at(from[k])] - a);
      const double shares = std::abs(w.sum() - 1) + std::max(0.0, -w.minCoeff());
      check.weightError = std::max({check.weightError, (meant - (p - a)).norm() / size, shares});
    }
  }
}

/// Winding number of a closed surface about q by a ray towards +z. Exact; q in general position.
int windingNumber(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const Vec3& q) {
  int winding = 0;
  const Kernel::Point_2 flat(q.x(), q.y());
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    if (std::min({a.x(), b.x(), c.x()}) > q.x() || std::max({a.x(), b.x(), c.x()}) < q.x() ||
        std::min({a.y(), b.y(), c.y()}) > q.y() || std::max({a.y(), b.y(), c.y()}) < q.y() ||
        std::max({a.z(), b.z(), c.z()}) < q.z())
      continue;
    const Kernel::Point_2 corner[3] = {{a.x(), a.y()}, {b.x(), b.y()}, {c.x(), c.y()}};
    int turn = 0;
    for (int k = 0; k < 3; ++k) turn += CGAL::orientation(corner[k], corner[(k + 1) % 3], flat);
    if (std::abs(turn) != 3) continue;
    const bool above = CGAL::orientation(pointOf(a), pointOf(b), pointOf(c), pointOf(q)) * turn < 0;
    if (above) winding += turn > 0 ? 1 : -1;
  }
  return winding;
}

void samplePoints(const Fragments& f, const std::vector<std::vector<Triangle>>& solids, std::size_t points,
                  FractureCheck& check) {
  const TriMesh& source = *f.tets->surface;
  const Box box = boxOf(source.positions);
  std::vector<Box> boxes(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (const Triangle& t : solids[i])
      for (const Index v : t) boxes[i].add(f.positions[at(v)]);
  Rng random(20261125);
  for (std::size_t tries = 0; check.points < points && tries < 50 * points; ++tries) {
    const Vec3 share(random.uniform(), random.uniform(), random.uniform());
    const Vec3 q = box.low + share.cwiseProduct(box.high - box.low);
    const bool inside = windingNumber(source.positions, source.triangles, q) != 0;
    if (!inside && tries % 8 != 0) continue;
    ++check.points;
    Box here;
    here.add(q);
    int holders = 0;
    for (std::size_t i = 0; i < solids.size(); ++i)
      holders += boxes[i].overlaps(here) && windingNumber(f.positions, solids[i], q) != 0;
    check.pointsInNone += inside && holders == 0;
    check.pointsInMany += holders > 1;
    check.pointsOutside += !inside && holders > 0;
  }
}

using Triangle3 = Kernel::Triangle_3;

/// Do two triangles meet in more than the corners that they share by number?
bool meetBeyondCorners(const std::vector<Vec3>& positions, const Triangle& s, const Triangle& t) {
  auto p = [&](Index i) { return pointOf(positions[at(i)]); };
  std::vector<Index> shared, restS, restT;
  for (const Index v : s) (std::find(t.begin(), t.end(), v) != t.end() ? shared : restS).push_back(v);
  for (const Index v : t)
    if (std::find(s.begin(), s.end(), v) == s.end()) restT.push_back(v);
  const Triangle3 first(p(s[0]), p(s[1]), p(s[2])), second(p(t[0]), p(t[1]), p(t[2]));
  switch (shared.size()) {
    case 0:
      return CGAL::do_intersect(first, second);
    case 1:
      return CGAL::do_intersect(Kernel::Segment_3(p(restS[0]), p(restS[1])), second) ||
             CGAL::do_intersect(Kernel::Segment_3(p(restT[0]), p(restT[1])), first);
    case 2: {
      const Point a = p(shared[0]), b = p(shared[1]), c = p(restS[0]), d = p(restT[0]);
      return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

std::size_t flatAmong(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return CGAL::collinear(pointOf(positions[at(t[0])]), pointOf(positions[at(t[1])]),
                           pointOf(positions[at(t[2])]));
  }));
}

struct Found {};

}  // namespace

bool intersectsItself(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  using Boxed = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Boxed> boxes;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const Point a = pointOf(positions[at(t[0])]), b = pointOf(positions[at(t[1])]),
                c = pointOf(positions[at(t[2])]);
    if (CGAL::collinear(a, b, c)) return true;
    boxes.emplace_back(a.bbox() + b.bbox() + c.bbox(), i);
  }
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Boxed& s, const Boxed& t) {
      if (meetBeyondCorners(positions, triangles[s.info()], triangles[t.info()])) throw Found{};
    });
  } catch (const Found&) {
    return true;
  }
  return false;
}

FractureCheck checkFracture(const Fragments& f, const FractureCheckParams& params) {
  FractureCheck check;
  check.pieces = f.pieces.size();
  check.areaLimit = params.areaLimit;
  const TriMesh& source = *f.tets->surface;
  const Vec3 origin = source.positions.front();
  const double size = boxOf(source.positions).diagonal();
  const std::vector<Index> same = joinedByPlace(f.positions);
  long double volume = 0, area = 0, wholeVolume = 0, wholeArea = 0;
  std::vector<CrackFace> cracks;
  std::vector<std::vector<Triangle>> solids;
  for (std::size_t i = 0; i < f.pieces.size(); ++i) {
    const Piece& piece = f.pieces[i];
    std::vector<Triangle> solid = renamed(piece.surface, same);
    for (const Triangle& t : solid) area += areaOf(f.positions, t);
    const std::vector<Triangle> crack = renamed(piece.crack, same);
    for (std::size_t t = 0; t < crack.size(); ++t)
      cracks.push_back(crackFace(crack[t], static_cast<Index>(i), piece.crackNeighbour[t]));
    solid.insert(solid.end(), crack.begin(), crack.end());
    check.triangles += solid.size();
    checkPiece(f.positions, solid, origin, check, volume);
    checkSkin(f, piece, size, check);
    if (params.selfIntersections) check.flat += flatAmong(f.positions, solid);
    if (params.selfIntersections) check.selfIntersecting += intersectsItself(f.positions, solid);
    solids.push_back(std::move(solid));
  }
  check.cracks = cracks.size();
  check.lonelyCracks = lonelyAmong(std::move(cracks));
  for (const Triangle& t : source.triangles) {
    wholeVolume += sixVolumes(source.positions, t, origin);
    wholeArea += areaOf(source.positions, t);
  }
  check.volumeError = static_cast<double>(std::abs(volume - wholeVolume) / std::abs(wholeVolume));
  check.areaError = static_cast<double>(std::abs(area - wholeArea) / wholeArea);
  const Box box = boxOf(source.positions);
  const double ulp = std::numeric_limits<double>::epsilon() *
                     std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  check.rounding = static_cast<double>(ulp * wholeArea / std::abs(wholeVolume));
  samplePoints(f, solids, params.points, check);
  return check;
}

bool FractureCheck::good() const {
  return pieces > 0 &&
         openEdges + degenerate + severalParts + notPositive + lonelyCracks + changedSources + pointsInNone +
                 pointsInMany + pointsOutside ==
             0 &&
         volumeError < std::max(1e-9, rounding) && areaError < areaLimit && offSource < 1e-9 &&
         weightError < 1e-7;
}

std::string FractureCheck::text() const {
  if (good()) return "good";
  std::string text = pieces == 0 ? "no pieces" : "";
  auto tell = [&](const char* what, std::size_t count) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  tell("open edges", openEdges);
  tell("degenerate triangles", degenerate);
  tell("pieces in several parts", severalParts);
  tell("pieces without volume", notPositive);
  tell("crack triangles without one twin", lonelyCracks);
  tell("changed source corners", changedSources);
  tell("points in no piece", pointsInNone);
  tell("points in several pieces", pointsInMany);
  tell("points outside the body in a piece", pointsOutside);
  auto exceeds = [&](const char* what, double value, double limit = 1e-9) {
    if (!(value < limit)) text += fmt::format("{}{} {:.2e}", text.empty() ? "" : ", ", what, value);
  };
  exceeds("volume error", volumeError, std::max(1e-9, rounding));
  exceeds("area error", areaError, areaLimit);
  exceeds("distance from the source", offSource);
  exceeds("error of weights at cuts", weightError, 1e-7);
  return text;
}

}  // namespace sherd::test
