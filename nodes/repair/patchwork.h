// A surface under repair, each corner of which knows where on the given surface its attributes come from.
#pragma once

#include <array>
#include <vector>

#include "types/tri_mesh.h"

namespace sherd {

/// A point of a triangle of the given surface.
struct CornerOrigin {
  Index triangle = -1;
  Vec3 weights = Vec3::Zero();  ///< barycentric, sum 1
};

struct Facet {
  std::array<CornerOrigin, 3> base;  ///< of the corners of the triangle that it is a part of
  std::array<Vec3, 3> corners{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};  ///< barycentric in that triangle
  Index from = -1;      ///< the triangle of the given surface that the material comes from
  bool turned = false;  ///< its corners run the other way round than there
  bool isNew = false;   ///< lies on no triangle of the given surface: a filled hole, the rim of a sheet
};

struct Patchwork {
  std::vector<Vec3> positions;      ///< m; identical positions are one vertex
  std::vector<Triangle> triangles;  ///< three different corners
  std::vector<Facet> facets;        ///< per triangle

  void add(const Triangle& triangle, const Facet& facet) {
    triangles.push_back(triangle);
    facets.push_back(facet);
  }
};

/// The whole of `mesh`, every corner its own origin.
Patchwork patchworkOf(const TriMesh& mesh);

/// Corner c (0 … 2) of triangle t of the given surface.
CornerOrigin cornerOrigin(Index t, int c);

/// Where corner c of the facet comes from; the nearest corner of its base where that isn't one triangle.
CornerOrigin originOf(const Facet& facet, std::size_t c);
/// The same for the point with the given barycentric weights in the facet.
CornerOrigin originAt(const Facet& facet, const Vec3& weights);

/// Turns the triangle round.
void turn(Patchwork& surface, std::size_t t);

/// Keeps the marked triangles, in their order.
void keepOnly(Patchwork& surface, const std::vector<bool>& keep);
/// Makes every position one vertex; leaves out triangles with two equal corners and vertices that none uses.
void joinEqual(Patchwork& surface);

/// The mesh with positions and triangles alone, for the checks of geometry/.
TriMesh bare(const Patchwork& surface);

/// The finished mesh: attributes are those of the corners' origins, copied where they are corners of the
/// given surface and interpolated elsewhere. Normals of new facets are the facets' own; those of turned ones
/// point to the front.
TriMesh finished(const Patchwork& surface, const TriMesh& given);

}  // namespace sherd
