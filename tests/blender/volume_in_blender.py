# Opens a painted VDB file in Blender and measures what has arrived.
#   blender --background --factory-startup --python-exit-code 1 --python volume_in_blender.py -- FILE.vdb
# The file is that of slow_volume_test.cpp: grids beta and mask in Blender's axes, z up, in metres.
import sys

import bpy

(FILE,) = sys.argv[sys.argv.index("--") + 1:]
faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


def near(found, wanted):
    return all(abs(f - w) < 1e-5 for f, w in zip(found, wanted))


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.object.volume_import(filepath=FILE)
volumes = [o for o in bpy.data.objects if o.type == "VOLUME"]
expect(len(volumes) == 1, f"{len(volumes)} volumes")
grids = volumes[0].data.grids
expect(grids.load(), f"the grids don't load: {grids.error_message}")
expect(grids.error_message == "", grids.error_message)
expect(sorted(g.name for g in grids) == ["beta", "mask"], f"names {[g.name for g in grids]}")
for grid in grids:
    expect(grid.data_type == "FLOAT", f"{grid.name} is of {grid.data_type}")
    expect(grid.channels == 1, f"{grid.name} has {grid.channels} channels")
    scale = 0.02 if grid.name == "beta" else 0.04
    matrix = grid.matrix_object
    expect(all(near(matrix.col[k].xyz, wanted) for k, wanted in
               enumerate([(scale, 0, 0), (0, 0, scale), (0, -scale, 0)])), f"{grid.name}: {matrix}")
    expect(grid.load(), f"{grid.name} doesn't load")
# The line of beta runs from y = 0 to 1, which is Blender's z, with a radius of 0.1.
depsgraph = bpy.context.evaluated_depsgraph_get()
corners = [tuple(c) for c in volumes[0].evaluated_get(depsgraph).bound_box]
low = [min(c[k] for c in corners) for k in range(3)]
high = [max(c[k] for c in corners) for k in range(3)]
expect(low[2] < 0.05 and low[2] > -0.3, f"low corner {low}")
expect(high[2] > 0.95 and high[2] < 1.3, f"high corner {high}")
expect(high[0] < 0.4 and low[0] > -0.4, f"corners {low} {high}")
print(f"{len(faults)} faults")
for fault in faults:
    print("FAULT", fault)
sys.exit(1 if faults else 0)
