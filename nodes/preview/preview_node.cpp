#include "graph/node_type.h"
#include "pictures/png_file.h"
#include "preview/preview.h"

namespace sherd {

NodeType previewNode() {
  using Params = PreviewParams;
  return NodeBuilder<Params>(
             "Preview", 1,
             "Draws one PNG: the object before, its pieces moved apart with one colour each and pale "
             "crack faces, and what else is wired: strain energy and fragility on the surface, cells on the "
             "tetrahedra, which can be cut open.")
      .input<Fragments>("pieces", "the pieces to show")
      .optionalInput<EnergyField>("energy", "strain energy, shown in a panel of its own")
      .optionalInput<ScalarGrid>("beta", "painted fragility, shown in a panel of its own")
      .optionalInput<Partition>("cells",
                                "cells, shown on the tetrahedra in a panel of their own, a colour each")
      .outputFile("file", &Params::file, "the PNG to write")
      .integer("width", &Params::width,
               {.unit = "pixels", .min = 64, .max = 16384, .help = "width of the picture"})
      .integer("height", &Params::height,
               {.unit = "pixels", .min = 64, .max = 16384, .help = "height of the picture"})
      .integer("samples", &Params::samples,
               {.unit = {}, .min = 1, .max = 1024, .help = "rays per pixel; more is smoother and slower"})
      .number(
          "explode", &Params::explode,
          {.unit = {},
           .min = 0,
           .max = 4,
           .help = "how far apart: each piece moves by this share of its distance from the body's centre"})
      .boolean("before", &Params::before, "whether the object before it breaks has a panel, too")
      .choice("slice", &Params::slice,
              {{"none", Slice::None}, {"x", Slice::X}, {"y", Slice::Y}, {"z", Slice::Z}},
              "cuts the tetrahedra open across an axis, to show the cells and the energy inside")
      .number("slice_at", &Params::sliceAt,
              {.unit = {},
               .min = 0,
               .max = 1,
               .help = "where it cuts, in the body's bounding box; what lies beyond is taken away"})
      .output<std::string>("file", "path of the PNG")
      .output<Picture>("picture", "the picture itself, for a ContactSheet")
      .implementation(4)
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        const auto pieces = io.in<Fragments>("pieces");
        const auto energy = io.in<EnergyField>("energy");
        const auto beta = io.in<ScalarGrid>("beta");
        const auto cells = io.in<Partition>("cells");
        SHERD_ASSIGN(Picture picture,
                     renderPreview({pieces.get(), energy.get(), beta.get(), cells.get()}, params, io.exec()));
        SHERD_CHECK(writePng(picture, params.file));
        io.wrote(params.file);
        io.out("file", params.file);
        io.out("picture", std::move(picture));
        return {};
      });
}

}  // namespace sherd
