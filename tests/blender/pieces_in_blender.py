# Opens an exported fracture in Blender and measures what has arrived.
#   blender --background --factory-startup --python-exit-code 1 --python pieces_in_blender.py -- SOURCE.obj DIRECTORY
# The directory holds pieces.glb, pieces.json and the OBJ files of the same pieces, and ply/ the PLY files.
# Lengths in metres. Blender's z points up: glTF's (x, y, z) arrive as (x, -z, y), and so do OBJ's, unless told
# otherwise. The files of single pieces are in the source file's own unit and axes, which pieces.json tells.
import json
import os
import sys

import bpy
import numpy as np
from mathutils.kdtree import KDTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # leaves nothing beside the sources
import expectations
from expectations import expect, expect_near, faults

SOURCE, DIRECTORY = sys.argv[sys.argv.index("--") + 1:]
LEAST_SCALE = 0.9063  # of the generated UVs, as nodes/geometry/surface_charts.h promises


def turned(vectors):
    x, y, z = np.asarray(vectors, float).T
    return np.stack([x, -z, y], axis=-1)


def directions_in_world(vectors):
    """From the axes of the piece files to where the GLB file puts them in Blender."""
    return turned(vectors) if FRAME["up"] == "y" else np.asarray(vectors, float)


def in_world(points):
    return FRAME["metres_per_unit"] * directions_in_world(points)


class Obj:
    """Corners of an OBJ file's triangles, in the file's order."""

    def __init__(self, path):
        values = {"v": [], "vt": [], "vn": []}
        corners, self.materials, self.groups, material = [], [], [], None
        for line in open(path, encoding="utf-8"):
            key, *words = line.split() or [""]
            if key in values:
                values[key].append([float(word) for word in words])
            elif key == "usemtl":
                material = words[0]
            elif key == "g":
                self.groups.append(words[0])
            elif key == "f":
                corners.append([[int(i) - 1 for i in word.split("/")] for word in words])
                self.materials.append(material)
        index = np.array(corners).reshape(-1, 3, 3)
        self.positions = np.array(values["v"])[index[:, :, 0]]
        self.uvs = np.array(values["vt"])[index[:, :, 1]]
        self.normals = np.array(values["vn"])[index[:, :, 2]]
        self.materials = np.array(self.materials)


class Triangles:
    """Corners of a Blender object's triangles, in the world."""

    def __init__(self, thing):
        mesh = thing.data
        mesh.calc_normals_split()
        count = len(mesh.polygons)
        expect(all(len(p.vertices) == 3 for p in mesh.polygons), f"{thing.name}: not all faces are triangles")
        self.local = self.values(mesh.vertices, "co", 3)[self.ints(mesh.loops, "vertex_index")]
        self.local = self.local.reshape(count, 3, 3)
        matrix = np.array(thing.matrix_world)
        self.positions = self.local @ matrix[:3, :3].T + matrix[:3, 3]
        self.normals = self.values(mesh.loops, "normal", 3).reshape(count, 3, 3) @ matrix[:3, :3].T
        self.uvs = [self.values(layer.data, "uv", 2).reshape(count, 3, 2) for layer in mesh.uv_layers]
        names = np.array([material.name if material else "" for material in mesh.materials] or [""])
        self.materials = names[self.ints(mesh.polygons, "material_index")]

    @staticmethod
    def values(collection, name, width):
        flat = np.empty(len(collection) * width)
        collection.foreach_get(name, flat)
        return flat.reshape(-1, width)

    @staticmethod
    def ints(collection, name):
        flat = np.empty(len(collection), dtype=int)
        collection.foreach_get(name, flat)
        return flat

    def volume_and_centre(self):
        a, b, c = self.local.transpose(1, 0, 2)
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        return volumes.sum(), (volumes[:, None] * (a + b + c) / 4).sum(0) / volumes.sum()

    def area_times_radius(self):
        """What a shift of every vertex by one part may change the volume by, in parts."""
        a, b, c = self.local.transpose(1, 0, 2)
        return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 * np.abs(self.local).max()


def files_of(name):
    parts = [Obj(f"{DIRECTORY}/{name}_surface.obj")]
    if os.path.exists(f"{DIRECTORY}/{name}_crack.obj"):
        parts.append(Obj(f"{DIRECTORY}/{name}_crack.obj"))
    return parts


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def check_attributes(name, found, obj, place=turned, direct=turned):
    """Positions, UVs and normals of each material against the piece's OBJ file, which lists them in that order."""
    size = SIZE if place is in_world else SIZE / FRAME["metres_per_unit"]
    for material in np.unique(obj.materials):
        here, there = found.materials == material, obj.materials == material
        expect(here.sum() == there.sum(), f"{name}: {here.sum()} triangles of {material}, not {there.sum()}")
        if here.sum() != there.sum():
            continue
        what = f"{name}, {material}"
        expect_near(found.positions[here], place(obj.positions[there].reshape(-1, 3)).reshape(-1, 3, 3),
                    1e-6 * size, f"{what}: positions")
        expect_near(found.uvs[0][here], obj.uvs[there], 1e-6, f"{what}: UVs")
        # Blender keeps normals as two angles of 16 bits, about others of its own.
        expect_near(found.normals[here], direct(obj.normals[there].reshape(-1, 3)).reshape(-1, 3, 3), 1e-2,
                    f"{what}: normals")


def check_density(name, triangles):
    """Singular values of the maps from triangles to UVs."""
    inside = triangles.materials == "inside"
    x, u = triangles.positions[inside], triangles.uvs[0][inside]
    a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    length = np.linalg.norm(a, axis=1)
    along = np.einsum("ij,ij->i", a, b) / length
    height = np.sqrt(np.maximum(0, (b * b).sum(1) - along**2))
    # Floats don't tell the shape of thinner ones; near 1, where glTF's v begins, their steps are 6e-8.
    longest = np.max([length, np.linalg.norm(b, axis=1), np.linalg.norm(b - a, axis=1)], axis=0)
    firm = length * height > max(1e-4 * SIZE, 3e-5) * longest
    expect(firm.any(), f"{name}: no crack triangle to measure")
    plane = np.zeros((firm.sum(), 2, 2))
    plane[:, 0, 0], plane[:, 0, 1], plane[:, 1, 1] = length[firm], along[firm], height[firm]
    texture = np.stack([u[firm, 1] - u[firm, 0], u[firm, 2] - u[firm, 0]], axis=-1)
    scales = np.linalg.svd(texture @ np.linalg.inv(plane), compute_uv=False)
    expect(scales.min() > LEAST_SCALE - 0.005, f"{name}: UVs are shrunk to {scales.min():.4f}")
    expect(scales.max() < 1.005, f"{name}: UVs are stretched to {scales.max():.4f}")


def check_piece(piece):
    name = piece["name"]
    thing = bpy.data.objects.get(name)
    if thing is None or thing.type != "MESH":
        return expect(False, f"there is no mesh {name}")
    expect(thing.parent is None and thing.data.name == name, f"{name}: has a parent, or its mesh another name")
    expect_near(thing.location, turned([piece["centre_of_mass"]])[0], 1e-6 * SIZE, f"{name}: pivot")
    expect_near(thing.scale, [1, 1, 1], 0, f"{name}: scale")
    expect_near(np.array(thing.matrix_world)[:3, :3], np.eye(3), 1e-7, f"{name}: rotation")
    triangles = Triangles(thing)
    volume, centre = triangles.volume_and_centre()
    expect_near(volume, piece["volume"], 1e-6 * triangles.area_times_radius(), f"{name}: volume")
    expect_near(centre, [0, 0, 0], 1e-4 * SIZE, f"{name}: centre of mass against the pivot")
    parts = files_of(name)
    expect(len(parts) == 2, f"{name}: no crack file")
    expect(set(triangles.materials) == {m for part in parts for m in part.materials}, f"{name}: materials")
    expect(len(triangles.uvs) == 1, f"{name}: {len(triangles.uvs)} UV layers")
    for part in parts:
        check_attributes(name, triangles, part, in_world, directions_in_world)
    check_density(name, triangles)
    for key in ("mass", "volume"):
        expect(thing.get(key) == piece[key], f"{name}: property {key}")
    neighbours = [n["name"] for n in thing.get("neighbours", [])]
    expect(neighbours == [n["name"] for n in piece["neighbours"]], f"{name}: neighbours {neighbours}")
    return triangles


def check_twins(found):
    """Every crack vertex has one at its place in another piece."""
    corners = [(p, x) for p, t in enumerate(found) for x in t.positions[t.materials == "inside"].reshape(-1, 3)]
    tree = KDTree(len(corners))
    for i, (_, x) in enumerate(corners):
        tree.insert(x, i)
    tree.balance()
    for p, x in corners:
        near = tree.find_range(x, 1e-6 * SIZE)
        expect(any(corners[i][0] != p for _, i, _ in near), f"a crack vertex of piece {p + 1} has no twin at {x}")


def check_glb(pieces):
    clear()
    bpy.ops.import_scene.gltf(filepath=f"{DIRECTORY}/pieces.glb")
    expect({o.name for o in bpy.data.objects} == {p["name"] for p in pieces}, "names of objects")
    expect({m.name for m in bpy.data.materials} >= {"cap", "stem", "inside"}, "names of materials")
    expect(not any(m.name.startswith("outside") for m in bpy.data.materials), "the artist's materials are there")
    found = [check_piece(piece) for piece in pieces]
    if None in found:
        return
    everything = np.concatenate([t.positions.reshape(-1, 3) for t in found])
    source = in_world(SOURCE_POSITIONS)
    expect_near(everything.min(0), source.min(0), 1e-6 * SIZE, "bounding box, low")
    expect_near(everything.max(0), source.max(0), 1e-6 * SIZE, "bounding box, high")
    check_twins(found)


def check_obj(piece):
    name = piece["name"]
    for part, suffix in zip(files_of(name), ("_surface", "_crack")):
        clear()
        bpy.ops.wm.obj_import(filepath=f"{DIRECTORY}/{name}{suffix}.obj", import_vertex_groups=True)
        thing = bpy.data.objects.get(name + suffix)
        if thing is None:
            expect(False, f"there is no object {name}{suffix} in its OBJ file")
            continue
        groups = [group.name for group in thing.vertex_groups]
        expect(sorted(groups) == sorted(set(part.groups)), f"{name}{suffix}: groups {groups}")
        found = Triangles(thing)
        expect(set(found.materials) == set(part.materials), f"{name}{suffix}: materials")
        check_attributes(name + suffix, found, part)


def check_ply(piece):
    name = piece["name"]
    for part, suffix in zip(files_of(name), ("_surface", "_crack")):
        clear()
        bpy.ops.import_mesh.ply(filepath=f"{DIRECTORY}/ply/{name}{suffix}.ply")
        found = Triangles(bpy.data.objects[f"{name}{suffix}"])
        expect(len(found.uvs) == 1, f"{name}{suffix}.ply: UV layers")
        size = SIZE / FRAME["metres_per_unit"]
        there = np.concatenate([found.positions / size, found.uvs[0]], axis=-1)
        here = np.concatenate([part.positions / size, part.uvs], axis=-1)
        # The importer may begin a triangle at another corner.
        errors = [np.abs(np.roll(there, turn, axis=1) - here).max((1, 2)) for turn in range(3)]
        expect_near(np.min(errors, axis=0), 0, 1e-6, f"{name}{suffix}.ply: positions and UVs")


SOURCE_POSITIONS = np.array([line.split()[1:4] for line in open(SOURCE) if line.startswith("v ")], float)
DESCRIPTION = json.load(open(f"{DIRECTORY}/pieces.json"))
PIECES, FRAME = DESCRIPTION["pieces"], DESCRIPTION["files_frame"]
SIZE = np.linalg.norm(SOURCE_POSITIONS.max(0) - SOURCE_POSITIONS.min(0)) * FRAME["metres_per_unit"]
expect(len(PIECES) > 5, "too few pieces")
check_glb(PIECES)
for piece_ in PIECES[:3] + PIECES[-1:]:
    check_obj(piece_)
    check_ply(piece_)
print(f"{expectations.checks} checks, {len(faults)} faults")
for fault in faults[:50]:
    print("FAULT", fault)
sys.exit(1 if faults or expectations.checks < 500 else 0)
