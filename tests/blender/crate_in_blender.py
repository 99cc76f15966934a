# Opens a broken crate in Blender: two UV sets, colours, materials with their textures, and the hulls of its pieces.
#   blender --background --factory-startup --python-exit-code 1 --python crate_in_blender.py -- DIRECTORY
# The crate is that of tests/support/textured_crate.h: 0.6 x 0.3 x 0.4 m, y up, a corner at the origin; its colours
# are red, green and blue by x, y and z, its UVs and normals by the side. The directory holds whole/ (pieces of the
# crate as GLB and OBJ, and hulls) and piece/ (pieces of its largest piece as GLB).
import json
import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # leaves nothing beside the sources
import expectations
from expectations import expect, expect_near, faults

(DIRECTORY,) = sys.argv[sys.argv.index("--") + 1:]
SIZE = np.array([0.6, 0.3, 0.4])
# The four corners of a side as it is laid out, by their number's bits x, y and z.
SIDES = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
PLANKS = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0]]  # rows from the top


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def values(collection, name, width, kind=float):
    flat = np.empty(len(collection) * width, dtype=kind)
    collection.foreach_get(name, flat)
    return flat.reshape(-1, width) if width > 1 else flat


def corner(number):
    return np.array([number & 1, number >> 1 & 1, number >> 2 & 1], float)


def side_of(normals, places):
    """The side of the crate that each triangle lies on, -1 for none."""
    side = np.full(len(normals), -1)
    for s in range(6):
        axis, high = s // 2, s % 2
        flat = np.abs(places[:, :, axis] - high).max(1) < 1e-5
        side[flat & ((normals[:, axis] > 0.9) if high else (normals[:, axis] < -0.9))] = s
    return side


def laid(s, places):
    """UVs of places (in parts of the crate) on side s, as Blender has them, v up."""
    origin = corner(SIDES[s][0])
    u, v = corner(SIDES[s][1]) - origin, corner(SIDES[s][3]) - origin
    return np.stack([(places - origin) @ u, (places - origin) @ v], axis=-1)


def image_behind(socket):
    """The image that feeds a socket, through whatever lies between."""
    todo = [link.from_node for link in socket.links]
    while todo:
        node = todo.pop()
        if node.type == "TEX_IMAGE":
            return node.image
        todo += [link.from_node for entry in node.inputs for link in entry.links]
    return None


def principled(material):
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def check_planks_image(image, what):
    if image is None:
        return expect(False, f"{what}: no image")
    expect(tuple(image.size) == (2, 2), f"{what}: image of {tuple(image.size)} pixels")
    pixels = np.array(image.pixels[:]).reshape(2, 2, 4)[::-1, :, :3].reshape(-1, 3)
    expect_near(pixels * 255, PLANKS, 0.5, f"{what}: pixels")


def check_materials(is_whole):
    materials = {m.name: m for m in bpy.data.materials}
    everything = {"planks", "lid", "inside"}  # a piece may have none of the lid
    expect(set(materials) | (set() if is_whole else {"lid"}) == everything, f"materials {sorted(materials)}")
    planks = materials.get("planks")
    if planks is None:
        return
    node = principled(planks)
    check_planks_image(image_behind(node.inputs["Base Color"]), "planks")
    dents = image_behind(node.inputs["Normal"])
    expect(dents is not None and tuple(dents.size) == (2, 1), "planks: normal map")
    expect_near(node.inputs["Metallic"].default_value, 0.25, 1e-6, "planks: metallic")
    expect_near(node.inputs["Roughness"].default_value, 0.75, 1e-6, "planks: roughness")
    expect(not planks.use_backface_culling, "planks: seen from one side")
    lid, stone = materials.get("lid"), materials.get("inside")
    expect(lid is None or lid.blend_method == "CLIP", f"lid: {lid and lid.blend_method}")
    if stone is None:
        return
    inside = principled(stone)
    expect_near(inside.inputs["Base Color"].default_value[:3], [0.55, 0.5, 0.45], 1e-6, "inside: colour")
    expect(image_behind(inside.inputs["Base Color"]) is None, "inside: has an image")
    expect(len(bpy.data.images) == 2, f"{len(bpy.data.images)} images, not one of each")


def check_object(thing):
    mesh = thing.data
    mesh.calc_normals_split()
    name, count = thing.name, len(mesh.polygons)
    expect([layer.name for layer in mesh.uv_layers] == ["UVMap", "UVMap.001"],
           f"{name}: UV layers {[layer.name for layer in mesh.uv_layers]}")
    expect(len(mesh.color_attributes) == 1, f"{name}: {len(mesh.color_attributes)} colour layers")
    if len(mesh.uv_layers) != 2 or len(mesh.color_attributes) != 1:
        return 0
    names = np.array([m.name for m in mesh.materials])
    outside = names[values(mesh.polygons, "material_index", 1, int)] != "inside"
    world = values(mesh.vertices, "co", 3)[values(mesh.loops, "vertex_index", 1, int)] + np.array(thing.location)
    x, y, z = world.T
    places = (np.stack([x, z, -y], axis=-1) / SIZE).reshape(count, 3, 3)
    a, b, c = values(mesh.loops, "normal", 3).T
    normals = np.stack([a, c, -b], axis=-1).reshape(count, 3, 3).mean(1)
    uvs = [values(layer.data, "uv", 2).reshape(count, 3, 2) for layer in mesh.uv_layers]
    side = side_of(normals, places)
    expect((side[outside] >= 0).all(), f"{name}: outer triangles that lie on no side")
    for s in range(6):
        here = outside & (side == s)
        if not here.any():
            continue
        wanted = laid(s, places[here])
        expect_near(uvs[0][here], wanted, 1e-5, f"{name}, side {s}: first UVs")
        second = np.stack([0.5 * wanted[..., 0], 1 - (0.25 + 0.5 * (1 - wanted[..., 1]))], axis=-1)
        expect_near(uvs[1][here], second, 1e-5, f"{name}, side {s}: second UVs")
    # Crack faces have their generated UVs in both, and are white.
    expect_near(uvs[0][~outside], uvs[1][~outside], 1e-6, f"{name}: UVs inside")
    colours = mesh.color_attributes[0]
    expect(colours.domain == "CORNER", f"{name}: colours by {colours.domain}")
    rgba = values(colours.data, "color", 4).reshape(count, 3, 4)
    expect_near(rgba[outside][..., :3], places[outside].clip(0, 1), 0.006, f"{name}: colours")
    expect_near(rgba[~outside], 1, 1e-3, f"{name}: colours inside")
    return int(outside.sum())


def check_glb(folder):
    clear()
    bpy.ops.import_scene.gltf(filepath=f"{DIRECTORY}/{folder}/pieces.glb")
    check_materials(folder == "whole")
    objects = [o for o in bpy.data.objects if o.type == "MESH"]
    expect(len(objects) >= 3, f"{folder}: {len(objects)} objects")
    expect(sum(check_object(thing) for thing in objects) >= 12, f"{folder}: too few outer triangles")


def check_obj():
    clear()
    names = [piece["name"] for piece in json.load(open(f"{DIRECTORY}/whole/pieces.json"))["pieces"]]
    for name in names:
        bpy.ops.wm.obj_import(filepath=f"{DIRECTORY}/whole/{name}_surface.obj")
    planks = bpy.data.materials.get("planks")
    if planks is None:
        return expect(False, "OBJ: no material planks")
    image = image_behind(principled(planks).inputs["Base Color"])
    check_planks_image(image, "OBJ, planks")
    expect(image is not None and os.path.dirname(bpy.path.abspath(image.filepath)) == f"{DIRECTORY}/whole",
           "OBJ: the image is not that beside the file")
    expect_near(principled(planks).inputs["Roughness"].default_value, 0.75, 1e-5, "OBJ, planks: roughness")


def check_hull(thing, wanted):
    mesh = thing.data
    points = values(mesh.vertices, "co", 3)
    expect(all(len(p.vertices) == 3 for p in mesh.polygons), f"{thing.name}: not all faces are triangles")
    triangles = np.array([tuple(p.vertices) for p in mesh.polygons])
    expect(len(points) == wanted["vertices"] and len(triangles) == wanted["triangles"], f"{thing.name}: counts")
    a, b, c = points[triangles].transpose(1, 0, 2)
    out = np.cross(b - a, c - a)
    expect_near(np.einsum("ij,ij->", a, np.cross(b, c)) / 6, wanted["volume"], 1e-6 * wanted["volume"] + 1e-9,
                f"{thing.name}: volume")
    # No vertex stands out of a face that is large enough for floats to tell.
    length = np.linalg.norm(out, axis=1)
    firm = length > 1e-6
    heights = np.einsum("fpk,fk->fp", points[None] - a[firm][:, None], out[firm] / length[firm][:, None])
    expect(heights.max() < 1e-5, f"{thing.name}: {heights.max():.3g} m beyond a face")


def check_hulls():
    clear()
    description = json.load(open(f"{DIRECTORY}/whole/proxies.json"))
    bpy.ops.wm.obj_import(filepath=f"{DIRECTORY}/whole/proxies.obj")
    found = {o.name: o for o in bpy.data.objects}
    wanted = {hull["name"]: hull for piece in description["pieces"] for hull in piece["hulls"]}
    expect(set(found) == set(wanted), f"hulls {sorted(found)}, not {sorted(wanted)}")
    for name in set(found) & set(wanted):
        check_hull(found[name], wanted[name])


check_glb("whole")
check_glb("piece")
check_obj()
check_hulls()
print(f"{expectations.checks} checks, {len(faults)} faults")
for fault in faults[:50]:
    print("FAULT", fault)
sys.exit(1 if faults or expectations.checks < 150 else 0)
