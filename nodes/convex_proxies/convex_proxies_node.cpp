#include "convex_proxies/convex_proxies.h"

#include "graph/node_type.h"

namespace sherd {

NodeType convexProxiesNode() {
  return NodeBuilder<ConvexProxiesParams>(
             "ConvexProxies", 1,
             "Makes convex hulls of the pieces, one or several each, for rigid-body "
             "engines; says how much larger they are and how far they overlap.")
      .input<Fragments>("pieces", "the pieces, from Tessellate")
      .integer("max_hulls", &ConvexProxiesParams::maxHulls,
               {.min = 1, .max = 64, .help = "hulls per piece at most; 1: the hull of the whole piece"})
      .number("tolerance", &ConvexProxiesParams::tolerance,
              {.min = 0,
               .max = 1e3,
               .help = "a piece gets no more hulls once they are larger than it by this share of its volume"})
      .output<Proxies>("proxies", "hulls, with volumes and errors; for ExportProxies")
      .implementation(2)
      // Of a piece with 12,000 vertices, half of them in one plane.
      .uninterruptible("CGAL's convex hull", 200)
      .run([](const ConvexProxiesParams& params, NodeIo& io) -> Result<void> {
        SHERD_ASSIGN(Proxies proxies, convexProxies(*io.in<Fragments>("pieces"), params, io.exec()));
        io.out("proxies", std::move(proxies));
        return {};
      });
}

}  // namespace sherd
