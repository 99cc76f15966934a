#include "geometry/crack_attributes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/crack_contacts.h"
#include "geometry/shelf_packing.h"
#include "geometry/surface_charts.h"

namespace sherd {
namespace {

constexpr double kFirmHeight = 1e-10;  // of the largest coordinate: rounding turns the normal by 10⁻⁶ at most
constexpr double kLargestTilt = 0.1736;  // cos 80°

/// One contact as a surface of its own, seen from the lower piece.
struct Sheet {
  std::vector<Index> vertices;  ///< in Fragments::positions, ascending
  std::vector<Triangle> triangles;
  std::vector<Vec3> areaVectors;  ///< per triangle, twice its area long
  std::vector<char> isFirm;       ///< per triangle: its plane is more than rounding

  Sheet(const Fragments& f, const CrackContact& contact) {
    const std::vector<Triangle>& crack = f.pieces[at(contact.low)].crack;
    for (const CrackTwin& twin : contact.twins)
      vertices.insert(vertices.end(), crack[at(twin.low)].begin(), crack[at(twin.low)].end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    double largest = 0;
    for (const Index v : vertices) largest = std::max(largest, f.positions[at(v)].cwiseAbs().maxCoeff());
    for (const CrackTwin& twin : contact.twins) add(f, crack[at(twin.low)], kFirmHeight * largest);
  }

 private:
  void add(const Fragments& f, const Triangle& corners, double leastHeight) {
    Triangle local;
    for (std::size_t c = 0; c < 3; ++c)
      local[c] = static_cast<Index>(std::lower_bound(vertices.begin(), vertices.end(), corners[c]) -
                                    vertices.begin());
    triangles.push_back(local);
    const Vec3 &a = f.positions[at(corners[0])], &b = f.positions[at(corners[1])],
               &c = f.positions[at(corners[2])];
    areaVectors.push_back((b - a).cross(c - a));
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    isFirm.push_back(areaVectors.back().norm() > leastHeight * longest);
  }
};

/// Unit vector along `v`, safe from underflow; `other` where v is 0.
Vec3 unitOr(const Vec3& v, const Vec3& other) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((v / largest).normalized()) : other;
}

/// Per corner, outward from the lower piece.
std::vector<Vec3> smoothNormals(const Fragments& f, const Sheet& sheet) {
  std::vector<Vec3> sums(sheet.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    if (!sheet.isFirm[t]) continue;
    const Vec3 normal = sheet.areaVectors[t].normalized();
    const auto corner = [&](std::size_t c) -> const Vec3& {
      return f.positions[at(sheet.vertices[at(sheet.triangles[t][c % 3])])];
    };
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 one = corner(c + 1) - corner(c), other = corner(c + 2) - corner(c);
      sums[at(sheet.triangles[t][c])] += std::atan2(one.cross(other).norm(), one.dot(other)) * normal;
    }
  }
  std::vector<Vec3> normals;
  normals.reserve(3 * sheet.triangles.size());
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Vec3 own = unitOr(sheet.areaVectors[t], Vec3::UnitY());
    for (const Index v : sheet.triangles[t]) {
      const Vec3 mean = unitOr(sums[at(v)], own);
      normals.push_back(sheet.isFirm[t] && mean.dot(own) < kLargestTilt ? own : mean);
    }
  }
  return normals;
}

/// The texture's two directions on a plane, orthonormal. They don't depend on which side the plane is seen
/// from.
struct TextureFrame {
  Vec3 u, v;
  explicit TextureFrame(Vec3 normal) {
    const bool isFlat = normal.y() * normal.y() >= 0.5;
    const double main = isFlat                                        ? normal.y()
                        : std::abs(normal.x()) > std::abs(normal.z()) ? normal.x()
                                                                      : normal.z();
    if (main < 0) normal = -normal;
    const Vec3 upward = isFlat ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    v = (upward - upward.dot(normal) * normal).normalized();
    u = v.cross(normal);
  }
};

/// The islands of one contact, each with its lower left corner at the origin.
struct Islands {
  std::vector<Index> of;  ///< per triangle
  std::vector<Vec2> uvs;  ///< per corner
  std::vector<Vec2> sizes;
};

Islands layOut(const Fragments& f, const Sheet& sheet, const Exec& exec) {
  SurfaceCharts charts =
      growCharts({sheet.triangles, sheet.areaVectors, sheet.isFirm, sheet.vertices.size()}, exec);
  Islands islands;
  if (exec.cancelled()) return islands;
  // About a vertex of the sheet, so that a body far from the origin keeps its digits.
  const Vec3& origin = f.positions[at(sheet.vertices.front())];
  const std::vector<TextureFrame> frames(charts.axes.begin(), charts.axes.end());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<Vec2> low(frames.size(), Vec2(kFar, kFar)), high(frames.size(), Vec2(-kFar, -kFar));
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    for (const Index v : sheet.triangles[t]) {
      const std::size_t chart = at(charts.of[t]);
      const Vec3 x = f.positions[at(sheet.vertices[at(v)])] - origin;
      const Vec2 uv(frames[chart].u.dot(x), frames[chart].v.dot(x));
      islands.uvs.push_back(uv);
      low[chart] = low[chart].cwiseMin(uv);
      high[chart] = high[chart].cwiseMax(uv);
    }
  for (std::size_t i = 0; i < islands.uvs.size(); ++i) islands.uvs[i] -= low[at(charts.of[i / 3])];
  for (std::size_t i = 0; i < frames.size(); ++i) islands.sizes.push_back(high[i] - low[i]);
  islands.of = std::move(charts.of);
  return islands;
}

/// Hands what was computed for the lower piece's corners to both pieces: `give(piece, corner, i)` is called
/// for corner i of the contact seen from the lower piece, with the place of the corner at the same vertex.
template <class Give>
void giveToTwins(const Fragments& f, const CrackContact& contact, const Give& give) {
  for (std::size_t i = 0; i < contact.twins.size(); ++i) {
    const auto [low, high] = contact.twins[i];
    const Triangle &lowCorners = f.pieces[at(contact.low)].crack[at(low)],
                   &highCorners = f.pieces[at(contact.high)].crack[at(high)];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto other = static_cast<std::size_t>(
          std::find(highCorners.begin(), highCorners.end(), lowCorners[c]) - highCorners.begin());
      give(contact.low, 3 * at(low) + c, 3 * i + c);
      give(contact.high, 3 * at(high) + other, 3 * i + c);
    }
  }
}

void giveNormals(const Fragments& f, const CrackContact& contact, const std::vector<Vec3>& normals,
                 std::vector<std::vector<Vec3>>& pieces) {
  giveToTwins(f, contact, [&](Index piece, std::size_t corner, std::size_t i) {
    pieces[at(piece)][corner] = piece == contact.low ? normals[i] : Vec3(-normals[i]);
  });
}

std::vector<std::vector<Vec3>> emptyNormals(const Fragments& f) {
  std::vector<std::vector<Vec3>> normals;
  for (const Piece& piece : f.pieces) normals.emplace_back(3 * piece.crack.size());
  return normals;
}

/// Places all islands side by side and writes the UVs into the pieces.
void placeIslands(const Fragments& f, const std::vector<CrackContact>& contacts,
                  const std::vector<Islands>& islands, CrackAttributes& out) {
  std::vector<Vec2> sizes;
  std::vector<Index> first;
  for (const Islands& own : islands) {
    first.push_back(static_cast<Index>(sizes.size()));
    sizes.insert(sizes.end(), own.sizes.begin(), own.sizes.end());
  }
  const std::vector<Vec2> places = packShelves(sizes);
  out.islands = sizes.size();
  for (std::size_t i = 0; i < sizes.size(); ++i) out.extent = out.extent.cwiseMax(places[i] + sizes[i]);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    giveToTwins(f, contacts[k], [&](Index piece, std::size_t corner, std::size_t i) {
      const Index island = first[k] + islands[k].of[i / 3];
      out.pieces[at(piece)].uvs[corner] = places[at(island)] + islands[k].uvs[i];
      out.pieces[at(piece)].island[corner / 3] = island;
    });
}

}  // namespace

Result<std::vector<std::vector<Vec3>>> crackNormals(const Fragments& f, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<CrackContact> contacts, crackContacts(f, exec));
  std::vector<std::vector<Vec3>> normals = emptyNormals(f);
  parallelFor(exec, contacts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      giveNormals(f, contacts[k], smoothNormals(f, Sheet(f, contacts[k])), normals);
  });
  if (exec.cancelled()) return cancelledError();
  return normals;
}

Result<CrackAttributes> crackAttributes(const Fragments& f, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<CrackContact> contacts, crackContacts(f, exec));
  std::vector<std::vector<Vec3>> normals = emptyNormals(f);
  std::vector<Islands> islands(contacts.size());
  parallelFor(exec, contacts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Sheet sheet(f, contacts[k]);
      if (exec.cancelled()) return;
      giveNormals(f, contacts[k], smoothNormals(f, sheet), normals);
      if (exec.cancelled()) return;
      islands[k] = layOut(f, sheet, exec);
    }
  });
  if (exec.cancelled()) return cancelledError();
  CrackAttributes out;
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    out.pieces.push_back({std::move(normals[p]), std::vector<Vec2>(3 * f.pieces[p].crack.size()),
                          std::vector<Index>(f.pieces[p].crack.size())});
  placeIslands(f, contacts, islands, out);
  return out;
}

}  // namespace sherd
