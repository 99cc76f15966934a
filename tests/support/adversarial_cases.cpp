#include "support/adversarial_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/rng.h"
#include "support/fracture_check.h"
#include "support/surface_families.h"
#include "support/tet_families.h"

namespace sherd::test {
namespace {

using families::Cube;

/// Draws that read like sentences.
struct Draw {
  Rng rng;
  explicit Draw(std::uint64_t seed, std::uint64_t stream) : rng(seed, stream) {}
  int below(int n) { return static_cast<int>(rng.below(static_cast<std::uint64_t>(n))); }
  int from(int low, int high) { return low + below(high - low + 1); }
  bool oneIn(int n) { return below(n) == 0; }
  double uniform(double low, double high) { return low + (high - low) * rng.uniform(); }
  Vec3 inBox(const Box& box) {
    const Vec3 share(rng.uniform(), rng.uniform(), rng.uniform());
    return box.low + share.cwiseProduct(box.high - box.low);
  }
  template <class T>
  const T& oneOf(const std::vector<T>& values) {
    return values[static_cast<std::size_t>(below(static_cast<int>(values.size())))];
  }
};

// Surfaces, about the origin and two units large. Dyadic ones stand on multiples of 1/8.

TriMesh cubesSurface(const std::vector<Cube>& cubes, double edge, const Vec3& low) {
  TriMesh mesh = *families::fromCubes(cubes, Vec3::Constant(edge)).surface;
  for (Vec3& p : mesh.positions) p += low;
  return mesh;
}

TriMesh tetrahedronSurface() {
  TriMesh mesh;
  mesh.positions = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

/// Each triangle in four, at the middles of its edges.
TriMesh subdivided(const TriMesh& mesh) {
  TriMesh fine;
  fine.positions = mesh.positions;
  std::map<std::pair<Index, Index>, Index> middles;
  auto middle = [&](Index a, Index b) {
    const auto [found, isNew] =
        middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.positions.size()));
    if (isNew) fine.positions.push_back(0.5 * (mesh.positions[at(a)] + mesh.positions[at(b)]));
    return found->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const Index ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(),
                          {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
  }
  return fine;
}

/// Splits edges very close to one of their ends. On an axis-aligned dyadic surface every new vertex lies
/// exactly on its edge where that is parallel to an axis, and exactly in its plane otherwise.
void addSlivers(TriMesh& mesh, Draw& draw, int count) {
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::size_t>(draw.below(static_cast<int>(mesh.triangles.size())));
    const auto corner = static_cast<std::size_t>(draw.below(3));
    const Index a = mesh.triangles[first][corner], b = mesh.triangles[first][(corner + 1) % 3];
    const Vec3 pa = mesh.positions[at(a)], d = mesh.positions[at(b)] - pa;
    const double share = std::ldexp(1.0, -draw.from(2, 30));
    const Vec3 p = pa + share * d;
    if (p == pa || (p - pa) / share != d) continue;  // would not lie on the edge
    const auto made = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(p);
    const std::size_t before = mesh.triangles.size();
    for (std::size_t t = 0; t < before; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Triangle old = mesh.triangles[t];
        const Index from = old[c], to = old[(c + 1) % 3], apex = old[(c + 2) % 3];
        if (std::minmax(from, to) != std::minmax(a, b)) continue;
        mesh.triangles[t] = {from, made, apex};
        mesh.triangles.push_back({made, to, apex});
        break;
      }
  }
}

struct Body {
  std::string what;
  TriMesh surface;
  bool dyadic = true;
};

Body drawBody(Draw& draw) {
  auto all = [](int, int, int) { return true; };
  const Vec3 low(-1, -1, -1);
  const int kind = draw.below(11);
  switch (kind) {
    case 0:
      return {"box of 12 triangles", families::boxSurface(low, -low, 1, 1, 1)};
    case 1:
      return {"box", families::boxSurface(low, -low, 4, 4, 4)};
    case 2: {
      const double half = std::ldexp(1.0, -draw.from(3, 10));
      return {"thin plate", families::boxSurface(Vec3(-1, -1, -half), Vec3(1, 1, half), 4, 4, 1)};
    }
    case 3:
      return {"needle", families::boxSurface(Vec3(-1, -1, -1) / 16 - Vec3(0.9375, 0, 0),
                                             Vec3(1, 1, 1) / 16 + Vec3(0.9375, 0, 0), 8, 1, 1)};
    case 4: {
      TriMesh mesh = tetrahedronSurface();
      for (int i = draw.below(3); i > 0; --i) mesh = subdivided(mesh);
      return {"tetrahedron", std::move(mesh)};
    }
    case 5:
      return {"L", cubesSurface(families::cubesOf(4, 4, 2, [](int i, int j, int) { return i < 2 || j < 2; }),
                                0.5, Vec3(-1, -1, -0.5))};
    case 6: {
      TriMesh u = *families::uShape(1, 2, 4, 1, 0.5).surface;
      for (Vec3& p : u.positions) p -= Vec3(1, 1, 0.25);
      return {"U", std::move(u)};
    }
    case 7: {
      auto wall = [](int i, int j, int k) {
        return std::max({std::abs(2 * i - 3), std::abs(2 * j - 3), std::abs(2 * k - 3)}) > 1;
      };
      return {"hollow box", cubesSurface(families::cubesOf(4, 4, 4, wall), 0.5, low)};
    }
    case 8:
      return {
          "two boxes",
          families::joined(cubesSurface(families::cubesOf(1, 2, 2, all), 0.75, Vec3(-1, -0.75, -0.75)),
                           cubesSurface(families::cubesOf(1, 2, 2, all), 0.75, Vec3(0.25, -0.75, -0.75)))};
    case 9:
      return {"sphere", families::sphereSurface(Vec3::Zero(), 1, 12, 8), false};
    default:
      return {"torus", families::torusSurface(0.7, 0.3, 12, 8), false};
  }
}

// Cages.

/// `held` of every tetrahedron: triangles whose box comes within rounding of its own.
void holdSurface(TetMesh& cage) {
  const TriMesh& surface = *cage.surface;
  std::vector<Box> boxes(surface.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const Index v : surface.triangles[t]) boxes[t].add(surface.positions[at(v)]);
  const Box whole = boxOf(surface.positions);
  const Vec3 slack = Vec3::Constant(1e-10 * whole.diagonal() + 1e-15 * whole.high.cwiseAbs().maxCoeff());
  cage.held.clear();
  cage.heldBegin.assign(1, 0);
  for (const Tetra& tet : cage.tets) {
    Box box;
    for (const Index node : tet) box.add(cage.nodes[at(node)]);
    box.low -= slack;
    box.high += slack;
    for (std::size_t t = 0; t < boxes.size(); ++t)
      if (box.overlaps(boxes[t])) cage.held.push_back(static_cast<Index>(t));
    cage.heldBegin.push_back(static_cast<Index>(cage.held.size()));
  }
}

/// One tetrahedron around the ball of radius 2.
TetMesh singleTetrahedron() {
  TetMesh mesh;
  mesh.nodes = {{-4, -4, -4}, {16, -4, -4}, {-4, 16, -4}, {-4, -4, 16}};
  mesh.tets = {{0, 1, 2, 3}};
  connectTets(mesh);
  mesh.insideFraction = {1};
  return mesh;
}

/// Inner nodes moved: by a little, or so far that some tetrahedra are nearly flat.
void jitterInner(TetMesh& cage, Draw& draw, double amount) {
  std::vector<bool> outer(cage.nodes.size(), false);
  for (const Triangle& face : cage.boundary)
    for (const Index n : face) outer[at(n)] = true;
  std::vector<std::vector<std::size_t>> around(cage.nodes.size());
  for (std::size_t t = 0; t < cage.tets.size(); ++t)
    for (const Index n : cage.tets[t]) around[at(n)].push_back(t);
  for (std::size_t n = 0; n < cage.nodes.size(); ++n) {
    if (outer[n]) continue;
    const Vec3 old = cage.nodes[n];
    cage.nodes[n] +=
        Vec3(draw.uniform(-amount, amount), draw.uniform(-amount, amount), draw.uniform(-amount, amount));
    const bool valid = std::all_of(around[n].begin(), around[n].end(),
                                   [&](std::size_t t) { return tetVolume(cage, t) > 1e-9; });
    if (!valid) cage.nodes[n] = old;
  }
}

TetMesh drawCage(Draw& draw, std::string& what) {
  if (draw.oneIn(8)) {
    what += ", cage of one tetrahedron";
    return singleTetrahedron();
  }
  // With edges of ±2 and 4 or 8 cells the grid runs through the surface's faces; with ±1.75 and 3 it does
  // not.
  struct Grid {
    double half;
    int nx, ny, nz;
  };
  const Grid grid = draw.oneOf<Grid>(
      {{2, 4, 4, 4}, {2, 2, 2, 2}, {1.75, 3, 3, 3}, {1.5, 1, 1, 1}, {2, 1, 1, 8}, {1.25, 2, 3, 2}});
  what += fmt::format(", cage {}x{}x{} within {}", grid.nx, grid.ny, grid.nz, grid.half);
  TetMesh cage = families::box(grid.nx, grid.ny, grid.nz, Vec3::Constant(2 * grid.half));
  for (Vec3& p : cage.nodes) p -= Vec3::Constant(grid.half);
  if (draw.oneIn(4)) {
    const double amount =
        draw.oneOf<double>({1e-3, 0.1, 0.4}) * 2 * grid.half / std::max({grid.nx, grid.ny, grid.nz});
    what += ", inner nodes moved";
    jitterInner(cage, draw, amount);
  }
  return cage;
}

// Sites.

std::vector<Vec3> gridSites(Draw& draw, const Box& box) {
  const int nx = draw.from(1, 4), ny = draw.from(1, 3), nz = draw.from(1, 3);
  std::vector<Vec3> sites;
  const bool dyadic = draw.oneIn(2);
  const Vec3 step = dyadic ? Vec3::Constant(0.5) : Vec3((box.high - box.low).cwiseQuotient(Vec3(nx, ny, nz)));
  const Vec3 first = dyadic ? Vec3(-0.25 * Vec3(nx - 1, ny - 1, nz - 1)) : Vec3(box.low + 0.5 * step);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) sites.push_back(first + Vec3(i, j, k).cwiseProduct(step));
  return sites;
}

/// Pairs mirrored at planes of surface faces and of grid planes.
std::vector<Vec3> mirroredSites(Draw& draw, const Box& box, const TriMesh& surface) {
  std::vector<Vec3> sites;
  for (int i = draw.from(1, 4); i > 0; --i) {
    const Vec3 p = draw.inBox(box);
    if (draw.oneIn(2)) {
      const int axis = draw.below(3);
      const double plane = draw.oneOf<double>({-1, -0.5, 0, 0.5, 1});
      Vec3 rounded = (p * 1024).array().round() / 1024, q = rounded;  // so that the mirror image is exact
      q[axis] = 2 * plane - rounded[axis];
      sites.insert(sites.end(), {rounded, q});
    } else {
      const Triangle& t = draw.oneOf(surface.triangles);
      const Vec3& a = surface.positions[at(t[0])];
      const Vec3 n = (surface.positions[at(t[1])] - a).cross(surface.positions[at(t[2])] - a);
      sites.insert(sites.end(), {p, Vec3(p - 2 * n.dot(p - a) / n.squaredNorm() * n)});
    }
  }
  return sites;
}

/// Equally far from one point: corners of a cube, an octahedron, a circle.
std::vector<Vec3> cosphericalSites(Draw& draw, const Box& box) {
  const Vec3 centre = draw.oneIn(2) ? Vec3::Zero() : Vec3((draw.inBox(box) * 8).array().round() / 8);
  const double r = draw.oneOf<double>({0.125, 0.5, 0.75});
  std::vector<Vec3> sites;
  switch (draw.below(3)) {
    case 0:
      for (int i = 0; i < 8; ++i)
        sites.push_back(centre + r * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
      break;
    case 1:
      for (int axis = 0; axis < 3; ++axis)
        for (const double s : {-r, r}) sites.push_back(centre + s * Vec3::Unit(axis));
      break;
    default:
      const int n = draw.from(3, 24);
      for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        sites.push_back(centre + r * Vec3(std::cos(a), std::sin(a), 0));
      }
  }
  if (draw.oneIn(3)) sites.push_back(centre);
  return sites;
}

std::vector<Vec3> randomSites(Draw& draw, const Box& box, int count) {
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) sites.push_back(draw.inBox(box));
  return sites;
}

/// All with one coordinate the same, or two.
std::vector<Vec3> flatSites(Draw& draw, const Box& box) {
  std::vector<Vec3> sites = randomSites(draw, box, draw.from(2, 16));
  const int axis = draw.below(3);
  const bool line = draw.oneIn(2);
  for (Vec3& p : sites) {
    p[axis] = sites[0][axis];
    if (line) p[(axis + 1) % 3] = sites[0][(axis + 1) % 3];
  }
  return sites;
}

std::vector<Vec3> nodeSites(Draw& draw, const TetMesh& cage) {
  std::vector<Vec3> sites;
  for (int i = draw.from(2, 16); i > 0; --i) sites.push_back(draw.oneOf(cage.nodes));
  return sites;
}

std::vector<Vec3> drawSites(Draw& draw, const TetMesh& cage, std::string& what) {
  const Box box = boxOf(cage.surface->positions);
  std::vector<Vec3> sites;
  const int kind = draw.below(8);
  switch (kind) {
    case 0:
      sites = randomSites(draw, box, draw.oneOf<int>({1, 2, 3, 5, 9, 17, 40}));
      break;
    case 1:
      sites = gridSites(draw, box);
      break;
    case 2:
      sites = mirroredSites(draw, box, *cage.surface);
      break;
    case 3:
      sites = cosphericalSites(draw, box);
      break;
    case 4:
      sites = flatSites(draw, box);
      break;
    case 5:
      sites = nodeSites(draw, cage);
      break;
    case 6:  // in clusters of near or equal sites
      for (const Vec3& p : randomSites(draw, box, draw.from(1, 4)))
        sites.insert(sites.end(), static_cast<std::size_t>(draw.from(1, 4)), p);
      break;
    default: {
      sites = gridSites(draw, box);
      const std::vector<Vec3> more = mirroredSites(draw, box, *cage.surface);
      sites.insert(sites.end(), more.begin(), more.end());
    }
  }
  const char* names[] = {"random", "grid",     "mirrored", "cospherical",
                         "flat",   "at nodes", "clusters", "grid and mirrored"};
  what += fmt::format(", {} {} sites", sites.size(), names[kind]);
  if (draw.oneIn(2)) {
    const int digits = draw.from(3, 16);
    what += fmt::format(" moved by 1e-{}", digits);
    const double amount = std::pow(10.0, -digits);
    for (Vec3& p : sites)
      p += Vec3(draw.uniform(-amount, amount), draw.uniform(-amount, amount), draw.uniform(-amount, amount));
  }
  if (draw.oneIn(6)) {
    sites.push_back(draw.oneOf(sites));
    what += ", one twice";
  }
  return sites;
}

// Metrics: what the nodes' and the sites' places become in the embedding.

Eigen::VectorXd embedded(const Vec3& p, int metric) {
  switch (metric) {
    case 0:
      return p;
    case 1: {  // folded at x = 0: places on both sides share coordinates
      Eigen::VectorXd x(3);
      x << std::abs(p.x()), p.y(), p.z();
      return x;
    }
    case 2:
      return Eigen::VectorXd::Constant(1, p.x());  // flattened to a line
    case 3:
      return Eigen::Vector2d(p.x(), p.y());
    case 4:
      return Eigen::VectorXd::Zero(2);  // all places one
    default: {
      Eigen::VectorXd x(5);
      x << p.x(), p.y(), p.z(), 0.3 * std::sin(3 * p.x()), 0.3 * p.y() * p.z();
      return x;
    }
  }
}

int drawMetric(Draw& draw, std::string& what) {
  if (!draw.oneIn(4)) return 0;
  const int metric = draw.oneOf<int>({1, 1, 2, 3, 4, 5, 5, 5});
  const char* names[] = {"", "folded", "line", "flat", "constant", "five-dimensional"};
  what += fmt::format(", {} metric", names[metric]);
  return metric;
}

/// Nodes, surface and embedding times `scale`, moved by `shift`.
Partition placed(TetMesh cage, const std::vector<Vec3>& sites, int metric, double scale, const Vec3& shift,
                 bool aboutCentre) {
  auto place = [&](const Vec3& p) { return Vec3(scale * p + shift); };
  auto embedding = std::make_shared<Embedding>();
  const auto d = embedded(sites[0], metric).size();
  embedding->coordinates.resize(d, static_cast<Eigen::Index>(cage.nodes.size()));
  Partition cells;
  cells.sites.resize(d, static_cast<Eigen::Index>(sites.size()));
  // About the centre the coordinates keep their digits; elsewhere they are as coarse as the positions.
  const Eigen::VectorXd origin =
      aboutCentre || metric != 0 ? Eigen::VectorXd(Eigen::VectorXd::Zero(d)) : Eigen::VectorXd(shift);
  auto coordinate = [&](const Vec3& p) { return Eigen::VectorXd(scale * embedded(p, metric) + origin); };
  for (std::size_t n = 0; n < cage.nodes.size(); ++n)
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) = coordinate(cage.nodes[n]);
  for (std::size_t s = 0; s < sites.size(); ++s)
    cells.sites.col(static_cast<Eigen::Index>(s)) = coordinate(sites[s]);
  auto surface = std::make_shared<TriMesh>(*cage.surface);
  for (Vec3& p : surface->positions) p = place(p);
  for (Vec3& p : cage.nodes) p = place(p);
  cage.surface = surface;
  for (std::size_t t = 0; t < cage.tets.size(); ++t) cage.quality.cageVolume += tetVolume(cage, t);
  cage.insideFraction.assign(cage.tets.size(), 1);
  holdSurface(cage);
  embedding->metric = metric == 0 ? Embedding::Metric::Euclidean : Embedding::Metric::Interior;
  embedding->diameter =
      (embedding->coordinates.rowwise().maxCoeff() - embedding->coordinates.rowwise().minCoeff()).norm();
  embedding->tets = std::make_shared<const TetMesh>(std::move(cage));
  cells.embedding = embedding;
  labelByNearest(cells);
  return cells;
}

/// Scale, place and metric, drawn.
AdversarialCase finish(Draw& draw, TetMesh cage, std::string what) {
  AdversarialCase made;
  const std::vector<Vec3> sites = drawSites(draw, cage, what);
  const int metric = drawMetric(draw, what);
  const double scale = draw.oneOf<double>({1, 1, 1e-6, 1e6});
  if (scale != 1) what += fmt::format(", scaled by {:g}", scale);
  const bool moved = draw.oneIn(4), aboutCentre = draw.oneIn(2);
  const Vec3 shift = moved ? Vec3(2e6 * scale * Vec3(1, -0.7, 0.3)) : Vec3(Vec3::Zero());
  if (moved) what += aboutCentre ? ", moved" : ", moved with its coordinates";
  made.minVolume = draw.oneOf<double>({1e-5, 1e-5, 1e-5, 1e-5, 0.01, 1e-3});
  made.cells = placed(std::move(cage), sites, metric, scale, shift, aboutCentre);
  made.what = std::move(what);
  return made;
}

/// Rounding may have folded a surface that was sound before it was turned, scaled and moved.
bool soundSurface(const TriMesh& surface) {
  std::vector<std::array<double, 3>> places;
  for (const Vec3& p : surface.positions) places.push_back({p.x(), p.y(), p.z()});
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end() &&
         !intersectsItself(surface.positions, surface.triangles);
}

AdversarialCase drawnCase(std::uint64_t seed, std::uint64_t stream) {
  Draw draw(seed, stream);
  Body body = drawBody(draw);
  TetMesh cage = drawCage(draw, body.what);
  if (body.dyadic && draw.oneIn(4)) {
    addSlivers(body.surface, draw, draw.from(1, 12));
    body.what += ", slivers";
  } else if (draw.oneIn(3)) {
    const Mat3 turn = (Eigen::AngleAxisd(draw.uniform(0, 6), Vec3::UnitX()) *
                       Eigen::AngleAxisd(draw.uniform(0, 6), Vec3::UnitY()))
                          .toRotationMatrix();
    for (Vec3& p : body.surface.positions) p = turn * p * 0.625;  // stays within ±1.1
    body.what += ", turned";
  }
  cage.surface = std::make_shared<const TriMesh>(std::move(body.surface));
  return finish(draw, std::move(cage), std::move(body.what));
}

}  // namespace

void labelByNearest(Partition& cells) {
  const Eigen::MatrixXd& x = cells.embedding->coordinates;
  cells.label.clear();
  for (Eigen::Index n = 0; n < x.cols(); ++n) {
    Eigen::Index best = 0;
    for (Eigen::Index s = 1; s < cells.sites.cols(); ++s)
      if ((x.col(n) - cells.sites.col(s)).squaredNorm() < (x.col(n) - cells.sites.col(best)).squaredNorm())
        best = s;
    cells.label.push_back(static_cast<Index>(best));
  }
}

Partition withSitesRenamed(const Partition& cells, const std::vector<Index>& order) {
  Partition renamed = cells;
  for (std::size_t s = 0; s < order.size(); ++s)
    renamed.sites.col(order[s]) = cells.sites.col(static_cast<Eigen::Index>(s));
  for (Index& label : renamed.label) label = order[at(label)];
  return renamed;
}

AdversarialCase adversarialCase(std::uint64_t seed) {
  for (std::uint64_t stream = 1;; stream += 2) {
    AdversarialCase made = drawnCase(seed, stream);
    if (soundSurface(*made.cells.embedding->tets->surface)) return made;
  }
}

AdversarialCase conformingCase(std::uint64_t seed) {
  Draw draw(seed, 2);
  std::string what;
  TetMesh cage;
  switch (draw.below(4)) {
    case 0:
      what = "block", cage = families::box(draw.from(1, 4), draw.from(1, 3), draw.from(1, 3), Vec3(2, 2, 2));
      break;
    case 1:
      what = "U", cage = families::uShape(1, 2, 4, 1, 0.5);
      break;
    case 2:
      what = "two boxes", cage = families::twoBoxes(2, 1, 0.5);
      break;
    default:
      what = "hollow box", cage = families::hollowBox(4, 1, 0.5);
  }
  auto surface = std::make_shared<TriMesh>(*cage.surface);
  for (Vec3& p : surface->positions) p -= Vec3::Ones();
  for (Vec3& p : cage.nodes) p -= Vec3::Ones();
  if (draw.oneIn(3)) {
    what += ", inner nodes moved";
    jitterInner(cage, draw, draw.oneOf<double>({1e-3, 0.05, 0.2}));
  }
  cage.surface = surface;
  return finish(draw, std::move(cage), std::move(what));
}

}  // namespace sherd::test
