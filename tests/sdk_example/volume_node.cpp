// A node in a dozen lines: the volume that a closed surface encloses.
#include "plugin/plugin.h"
#include "types/tri_mesh.h"

struct VolumeParams {
  double density = 1000;
};

sherd::NodeType volumeNode() {
  return sherd::NodeBuilder<VolumeParams>("Volume", 1, "Volume and mass of what a closed surface encloses.")
      .input<sherd::TriMesh>("mesh", "a closed surface")
      .number("density", &VolumeParams::density, {.unit = "kg/m³", .min = 0, .help = "of the solid"})
      .output<double>("volume", "m³")
      .output<double>("mass", "kg")
      .run([](const VolumeParams& params, sherd::NodeIo& io) -> sherd::Result<void> {
        const auto mesh = io.in<sherd::TriMesh>("mesh");
        double volume = 0;
        for (const sherd::Triangle& t : mesh->triangles)
          volume += mesh->positions[t[0]].dot(mesh->positions[t[1]].cross(mesh->positions[t[2]])) / 6;
        io.exec().info(std::to_string(volume) + " m³");
        io.out("volume", volume);
        io.out("mass", volume * params.density);
        return {};
      });
}

SHERD_NODE_PACK(volumeNode)
