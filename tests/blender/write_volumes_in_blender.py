# Writes volumes from Blender, to be read by another program.
#   blender --background --factory-startup --python-exit-code 1 --python write_volumes_in_blender.py -- DIRECTORY
# cube.vdb: a cube of 1 m about (1, 0.5, 2), filled with 2.5, by the modifier Mesh to Volume.
# smoke/data/fluid_data_0002.vdb: a cache of a fluid, halves in many grids; density.txt has what Blender itself
# holds for it: the resolution, then the density of every cell, x fastest.
import os
import sys

import bpy

(DIRECTORY,) = sys.argv[sys.argv.index("--") + 1:]


def write_cube():
    bpy.ops.mesh.primitive_cube_add(size=1, location=(1, 0.5, 2))
    cube = bpy.context.object
    volume = bpy.data.objects.new("cube", bpy.data.volumes.new("cube"))
    bpy.context.collection.objects.link(volume)
    modifier = volume.modifiers.new("Mesh to Volume", "MESH_TO_VOLUME")
    modifier.object = cube
    modifier.resolution_mode = "VOXEL_SIZE"
    modifier.voxel_size = 0.05
    modifier.use_fill_volume = True
    modifier.exterior_band_width = 0.1
    modifier.density = 2.5
    evaluated = volume.evaluated_get(bpy.context.evaluated_depsgraph_get())
    grids = evaluated.data.grids
    assert grids.load() and len(grids) == 1, grids.error_message
    assert grids.save(filepath=os.path.join(DIRECTORY, "cube.vdb"))


def write_smoke():
    # The source has to be there before the domain is.
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, location=(1, 2, 2.6))
    source = bpy.context.object.modifiers.new("Fluid", "FLUID")
    source.fluid_type = "FLOW"
    source.flow_settings.flow_type = "SMOKE"
    source.flow_settings.flow_behavior = "INFLOW"
    bpy.ops.mesh.primitive_cube_add(size=2, location=(1, 2, 3))
    domain = bpy.context.object
    modifier = domain.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    settings = modifier.domain_settings
    settings.domain_type = "GAS"
    settings.resolution_max = 24
    settings.cache_type = "MODULAR"
    settings.cache_data_format = "OPENVDB"
    settings.openvdb_data_depth = "16"
    settings.cache_directory = os.path.join(DIRECTORY, "smoke")
    settings.cache_frame_start, settings.cache_frame_end = 1, 2
    with bpy.context.temp_override(object=domain, active_object=domain, selected_objects=[domain]):
        assert bpy.ops.fluid.bake_data() == {"FINISHED"}
    bpy.context.scene.frame_set(2)
    held = domain.evaluated_get(bpy.context.evaluated_depsgraph_get()).modifiers["Fluid"].domain_settings
    with open(os.path.join(DIRECTORY, "density.txt"), "w") as file:
        print(*held.domain_resolution, file=file)
        for value in held.density_grid:
            print(value, file=file)


bpy.ops.wm.read_factory_settings(use_empty=True)
write_cube()
write_smoke()
print("volumes written")
