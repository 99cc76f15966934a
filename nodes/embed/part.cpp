#include "embed/part.h"

#include "geometry/disjoint_sets.h"

namespace sherd {
namespace {

void addBorder(BodyPart& part) {
  std::vector<Index> vertexOf(part.positions.size(), -1);
  for (std::size_t t = 0; t < part.tets.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      if (part.neighbours[t][f] >= 0) continue;
      Triangle triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const Index n = part.tets[t][at(kTetraFace[f][c])];
        if (vertexOf[at(n)] < 0) {
          vertexOf[at(n)] = static_cast<Index>(part.borderNode.size());
          part.borderNode.push_back(n);
          part.borderPositions.push_back(part.positions[at(n)]);
          if (!part.stretch.empty()) part.borderStretch.push_back(part.stretch[at(n)]);
        }
        triangle[c] = vertexOf[at(n)];
      }
      part.borderTriangles.push_back(triangle);
    }
  DisjointSets shells(part.borderNode.size());
  for (const Triangle& triangle : part.borderTriangles)
    for (const Index v : {triangle[1], triangle[2]}) shells.join(at(triangle[0]), at(v));
  for (std::size_t v = 0; v < part.borderNode.size(); ++v) part.shells += shells.find(v) == v;
}

}  // namespace

std::vector<BodyPart> bodyParts(const TetMesh& mesh, const MetricNodes& metric) {
  DisjointSets groups(mesh.nodes.size());
  for (const Tetra& tet : mesh.tets)
    for (const Index n : tet) groups.join(at(tet[0]), at(n));

  std::vector<BodyPart> parts;
  std::vector<Index> partOf(mesh.nodes.size()), numberOf(mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const std::size_t first = groups.find(n);
    if (first == n) {
      partOf[n] = static_cast<Index>(parts.size());
      parts.emplace_back();
    } else {
      partOf[n] = partOf[first];
    }
    BodyPart& part = parts[at(partOf[n])];
    numberOf[n] = static_cast<Index>(part.node.size());
    part.node.push_back(static_cast<Index>(n));
    part.positions.push_back(metric.places[n]);
    if (!metric.stretch.empty()) part.stretch.push_back(metric.stretch[n]);
  }

  std::vector<Index> tetNumber(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    tetNumber[t] = static_cast<Index>(parts[at(partOf[at(mesh.tets[t][0])])].tets.size()),
    parts[at(partOf[at(mesh.tets[t][0])])].tets.push_back(mesh.tets[t]);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    BodyPart& part = parts[at(partOf[at(mesh.tets[t][0])])];
    Tetra near = mesh.neighbours[t];
    for (Index& other : near)
      if (other >= 0) other = tetNumber[at(other)];
    part.neighbours.push_back(near);
    part.volume.resize(part.node.size(), 0.0);
    for (Index& n : part.tets[at(tetNumber[t])]) {
      n = numberOf[at(n)];
      part.volume[at(n)] += 0.25 * tetVolume(mesh, t);
    }
  }
  for (BodyPart& part : parts) addBorder(part);
  return parts;
}

}  // namespace sherd
