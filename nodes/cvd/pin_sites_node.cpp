#include <cmath>

#include "cvd/pin_sites.h"
#include "graph/json.h"
#include "graph/node_type.h"

namespace sherd {
namespace {

/// From a JSON list of points: [[0, 0.4, 0.1], [0.1, 0.5, 0]].
Result<std::vector<Vec3>> readPoints(const std::string& json) {
  const char* remedy = "write \"points\": [[x, y, z], …] in metres";
  Diagnostics diagnostics;
  const auto list = parseJson(json, std::make_shared<const Source>(), diagnostics);
  if (!list || list->kind != JsonValue::Kind::Array)
    return failure("points would have to be a list", remedy, "points");
  std::vector<Vec3> points;
  for (const JsonValue& item : list->items) {
    bool isPoint = item.kind == JsonValue::Kind::Array && item.items.size() == 3;
    for (const JsonValue& number : item.items)
      isPoint = isPoint && number.isNumber() && std::isfinite(number.number);
    if (!isPoint)
      return failure("point " + std::to_string(points.size() + 1) + " isn't three numbers", remedy, "points");
    points.emplace_back(item.items[0].number, item.items[1].number, item.items[2].number);
  }
  return points;
}

}  // namespace

NodeType pinSitesNode() {
  return NodeBuilder<PinSitesParams>("PinSites", 1,
                                     "Puts sites by hand where a piece is wanted. To be wired to "
                                     "PredictDegree.pinned, which adds others as "
                                     "the energy asks, or to CVD.sites; these stay where they are.")
      .input<Embedding>("embedding", "the distances to measure with, from Embed")
      .list("points", &PinSitesParams::points, &readPoints,
            "places in the body, in metres, y up: [[x, y, z], …]; one outside takes the nearest node")
      .output<Sites>("sites", "the pinned sites, in the order of the points")
      .run([](const PinSitesParams& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(Sites sites, pinSites(*io.in<Embedding>("embedding"), params, io.exec()));
        io.out("sites", std::move(sites));
        return {};
      });
}

}  // namespace sherd
