#include "tessellate/coincident.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <tuple>

namespace sherd {
namespace {

/// A triangle as what lies above and below it, seen so that its ascending corners turn counter-clockwise from
/// above.
struct Layer {
  Triangle corners;  ///< ascending
  Index above, below;
  Index source;  ///< the surface triangle, −1 for a sheet's

  bool isSkin() const { return above == kOutsideCell || below == kOutsideCell; }
  friend bool operator<(const Layer& a, const Layer& b) {
    return std::tie(a.corners, a.source, a.above, a.below) < std::tie(b.corners, b.source, b.above, b.below);
  }
};

/// `front`: what lies where the corners turn counter-clockwise.
Layer layerOf(Triangle t, Index front, Index back, Index source) {
  const int inversions = (t[0] > t[1]) + (t[1] > t[2]) + (t[0] > t[2]);
  if (inversions % 2 == 1) std::swap(front, back);
  std::sort(t.begin(), t.end());
  return {t, front, back, source};
}

bool loseCorner(Triangle& t, std::span<const Index> same) {
  for (Index& v : t) v = same[at(v)];
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

std::vector<Layer> withoutPairs(std::span<const Layer> stack) {
  std::vector<Layer> left;
  for (const Layer& l : stack) {
    const auto opposite =
        std::ranges::find_if(left, [&](const Layer& o) { return o.below == l.above && o.above == l.below; });
    if (opposite == left.end())
      left.push_back(l);
    else
      left.erase(opposite);
  }
  return left;
}

/// The one layer that a stack amounts to, none where it amounts to nothing; where it is more, what is left
/// when layers that undo each other are taken away.
std::vector<Layer> combined(std::span<const Layer> stack) {
  std::map<Index, int> surplus;  // how often a cell lies below, less how often above
  for (const Layer& l : stack) ++surplus[l.below], --surplus[l.above];
  std::erase_if(surplus, [](const auto& s) { return s.second == 0; });
  if (surplus.empty()) return {};
  const auto [one, oneCount] = *surplus.begin();
  const auto [other, otherCount] = *surplus.rbegin();
  if (surplus.size() > 2 || std::abs(oneCount) > 1) return withoutPairs(stack);
  Layer result{stack[0].corners, oneCount > 0 ? other : one, oneCount > 0 ? one : other, -1};
  if (result.isSkin())
    for (const Layer& l : stack)
      if (l.source >= 0) result.source = l.source;
  return {result};
}

class LayerRemover {
 public:
  LayerRemover(const Arrangement& a, ClippedMeshes& meshes, std::vector<unsigned char>& isCut)
      : a_(a), meshes_(meshes), isCut_(isCut) {}

  void run() {
    // The surface's own vertices all stay.
    for (Index v = a_.firstCrack; at(v) < a_.same.size(); ++v) {
      if (a_.same[at(v)] == v) continue;
      tookIn_.resize(a_.same.size(), 0);
      tookIn_[at(a_.same[at(v)])] = 1;
    }
    if (tookIn_.empty()) return;
    std::erase_if(meshes_.skin.triangles, [&](SkinTriangle& t) { return loseCorner(t.corners, a_.same); });
    std::erase_if(meshes_.sheet.triangles, [&](SheetTriangle& t) { return loseCorner(t.corners, a_.same); });
    gather();
    std::sort(layers_.begin(), layers_.end());
    std::map<Triangle, std::vector<Layer>> replaced;
    for (std::size_t first = 0; first < layers_.size();) {
      std::size_t last = first + 1;
      while (last < layers_.size() && layers_[last].corners == layers_[first].corners) ++last;
      if (last - first > 1)
        if (auto left = combined(std::span(layers_).subspan(first, last - first)); left.size() < last - first)
          replaced[layers_[first].corners] = std::move(left);
      first = last;
    }
    if (!replaced.empty()) replace(replaced);
    meshes_.skin.split();
    meshes_.sheet.split();
  }

 private:
  bool mayCoincide(const Triangle& t) const {
    return tookIn_[at(t[0])] || tookIn_[at(t[1])] || tookIn_[at(t[2])];
  }

  void gather() {
    for (const SkinTriangle& t : meshes_.skin.triangles)
      if (mayCoincide(t.corners)) layers_.push_back(layerOf(t.corners, kOutsideCell, t.cell, t.source));
    for (const SheetTriangle& t : meshes_.sheet.triangles)
      if (mayCoincide(t.corners)) layers_.push_back(layerOf(t.corners, t.front, t.back, -1));
    for (std::size_t s = 0; s < a_.surface.size(); ++s)
      if (!isCut_[s] && mayCoincide(a_.surface[s]))
        layers_.push_back(layerOf(a_.surface[s], kOutsideCell, a_.surfaceLabel[at(a_.surface[s][0])],
                                  static_cast<Index>(s)));
  }

  void replace(const std::map<Triangle, std::vector<Layer>>& replaced) {
    const auto goes = [&](Triangle t) {
      if (!mayCoincide(t)) return false;
      std::sort(t.begin(), t.end());
      return replaced.contains(t);
    };
    std::erase_if(meshes_.skin.triangles, [&](const SkinTriangle& t) { return goes(t.corners); });
    std::erase_if(meshes_.sheet.triangles, [&](const SheetTriangle& t) { return goes(t.corners); });
    for (std::size_t s = 0; s < a_.surface.size(); ++s)
      if (!isCut_[s] && goes(a_.surface[s])) isCut_[s] = 1;
    for (const auto& [corners, layers] : replaced)
      for (const Layer& layer : layers) add(layer);
  }

  void add(const Layer& layer) {
    const Triangle& corners = layer.corners;
    const Triangle turned{corners[0], corners[2], corners[1]};
    if (!layer.isSkin())
      meshes_.sheet.triangles.push_back({corners, layer.above, layer.below});
    else if (layer.above == kOutsideCell)
      meshes_.skin.triangles.push_back({corners, layer.source, layer.below});
    else
      meshes_.skin.triangles.push_back({turned, layer.source, layer.above});
  }

  const Arrangement& a_;
  ClippedMeshes& meshes_;
  std::vector<unsigned char>& isCut_;
  std::vector<unsigned char> tookIn_;  ///< per vertex: others were put on it
  std::vector<Layer> layers_;
};

}  // namespace

void removeThinLayers(const Arrangement& arrangement, ClippedMeshes& meshes,
                      std::vector<unsigned char>& isCut) {
  LayerRemover(arrangement, meshes, isCut).run();
}

}  // namespace sherd
