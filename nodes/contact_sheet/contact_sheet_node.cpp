#include "contact_sheet/contact_sheet.h"
#include "graph/node_type.h"
#include "pictures/png_file.h"

namespace sherd {

NodeType contactSheetNode() {
  using Params = ContactSheetParams;
  return NodeBuilder<Params>(
             "ContactSheet", 1,
             "Puts the pictures of all frames and wedges on one sheet, each with its frame and "
             "wedge written below it, and writes the sheet as one PNG.")
      .gatheredInput<Picture>("pictures", "the pictures, in the order of frames and wedges")
      .outputFile("file", &Params::file, "the PNG to write")
      .integer("columns", &Params::columns,
               {.unit = {},
                .min = 0,
                .max = 1000,
                .help = "pictures in a row; 0: as many as make the sheet nearly square"})
      .integer(
          "width", &Params::width,
          {.unit = "pixels",
           .min = 32,
           .max = 4096,
           .help = "width of a tile; larger pictures are scaled down to it, smaller ones keep their size"})
      .integer("margin", &Params::margin,
               {.unit = "pixels", .min = 0, .max = 256, .help = "room around and between the tiles"})
      .output<std::string>("file", "path of the PNG")
      .output<Picture>("picture", "the sheet itself")
      .writesFiles()
      .run([](const Params& params, NodeIo& io) -> Result<void> {
        std::vector<SheetPicture> pictures;
        for (auto& [picture, label] : io.all<Picture>("pictures")) pictures.push_back({picture, label});
        SHERD_ASSIGN(Picture sheet, contactSheet(pictures, params, io.exec()));
        SHERD_CHECK(writePng(sheet, params.file));
        io.wrote(params.file);
        io.out("file", params.file);
        io.out("picture", std::move(sheet));
        return {};
      });
}

}  // namespace sherd
