#include "beta/paint_beta.h"
#include "beta/strokes_node.h"
#include "graph/node_type.h"

namespace sherd {
namespace {

using Params = PaintBetaParams;

void addSource(NodeBuilder<Params>& node) {
  node.choice("source", &Params::source,
              {{"none", PaintSource::None},
               {"colors", PaintSource::Colors},
               {"texture", PaintSource::Texture},
               {"noise", PaintSource::Noise}},
              "what is painted before the strokes: colors: the mesh's vertex colours, near its surface; "
              "texture: the "
              "picture wired to it, by the mesh's texture coordinates; noise")
      .choice("blend", &Params::blend,
              {{"replace", Blend::Replace},
               {"add", Blend::Add},
               {"multiply", Blend::Multiply},
               {"max", Blend::Max},
               {"min", Blend::Min}},
              "how `other` and the source meet what is there")
      .number("low", &Params::low,
              {.help = "what a colour or noise of 0 stands for, and what a threshold leaves below"})
      .number("high", &Params::high,
              {.help = "what a colour or noise of 1 stands for, and what a threshold leaves above"})
      .choice("channel", &Params::channel,
              {{"red", ColorChannel::Red},
               {"green", ColorChannel::Green},
               {"blue", ColorChannel::Blue},
               {"alpha", ColorChannel::Alpha}},
              "of the vertex colours or the texture (which has no alpha)")
      .text("color_set", &Params::colorSet, "name of the vertex colours; empty: the first")
      .text("uv_set", &Params::uvSet, "name of the texture coordinates; empty: the first")
      .text("material", &Params::material, "name of the material that the texture lies on; empty: on all")
      .number(
          "band", &Params::band,
          {.unit = "m",
           .min = 0,
           .help = "how far from the surface colours and texture reach; 0: a 32nd of the mesh's diagonal"})
      .number("noise_size", &Params::noiseSize,
              {.unit = "m",
               .min = 0,
               .help = "how coarse noise is; 0: an eighth of the diagonal of what it covers"})
      .integer("seed", &Params::seed, {.unit = "", .help = "another seed gives other noise"});
}

}  // namespace

NodeType paintBetaNode() {
  NodeBuilder<Params> node(
      "PaintBeta", 1,
      "Paints a field such as fragility β on a sparse grid: from strokes, vertex colours, a texture, noise "
      "and "
      "other grids. Does in this order what its parameters ask for: `grid` or the background, "
      "`other`, the source, strokes, smoothing, a threshold.");
  node.optionalInput<ScalarGrid>("grid", "what is painted on; left open: the background everywhere")
      .optionalInput<ScalarGrid>("other", "a field to combine with it, by `blend`")
      .optionalInput<TriMesh>("mesh",
                              "has the vertex colours; noise lies in it; a new grid has its axes and unit")
      .optionalInput<Picture>("texture", "the picture that source: texture paints by, from LoadPicture")
      .list("strokes", &Params::strokes, &readStrokes,
            "dabs and lines, in metres, y up, painted in their order: { \"points\": [[x, y, z], …], "
            "\"radius\": m, "
            "\"value\": number, \"falloff\": share of the radius over which it fades (0.5), \"blend\": "
            "\"replace\", \"add\", "
            "\"multiply\", \"max\" or \"min\" (\"replace\") }")
      .number("background", &Params::background,
              {.help = "the value where nothing is painted, without `grid`"})
      .number("voxel", &Params::voxel,
              {.unit = "m",
               .min = 0,
               .help = "edge of a new grid's voxels; 0: a quarter of the smallest radius, band and noise "
                       "size in use"});
  addSource(node);
  return node
      .number("smooth", &Params::smooth,
              {.unit = "m", .min = 0, .help = "standard deviation of a Gaussian; 0: none"})
      .number("threshold", &Params::threshold,
              {.help = "values from here on become `high`, those below `low`; 0: none"})
      .text("name", &Params::name, "of the field; empty: that of `grid`, else \"beta\"")
      .output<ScalarGrid>("grid", "the field; its background outside of the painted voxels")
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        const auto grid = io.in<ScalarGrid>("grid"), other = io.in<ScalarGrid>("other");
        const auto mesh = io.in<TriMesh>("mesh");
        const auto texture = io.in<Picture>("texture");
        SHERD_ASSIGN(ScalarGrid painted,
                     paintBeta({grid.get(), other.get(), mesh.get(), texture.get()}, params, io.exec()));
        io.out("grid", std::move(painted));
        return {};
      });
}

}  // namespace sherd
