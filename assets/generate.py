#!/usr/bin/env python3
"""Makes the models of this folder: vase, mushroom, sphere, wall, table. Python 3 standard library only.

    python3 generate.py [DIRECTORY]      writes the .obj files there (default: beside this script)

Metres, y up, right-handed, standing on the plane y = 0. Every model is one closed, oriented 2-manifold surface
without self-intersections, with UVs and unit normals per corner. Positions are rounded to the nanometre and the
rest to 1e-6, so that the bytes do not depend on the last digit of a processor's sine.
"""

import math
import os
import sys


# ---- meshes ------------------------------------------------------------------------------------------------

class Mesh:
    """Vertices, and triangles whose corners are (vertex, uv, normal or None for smooth)."""

    def __init__(self, comment):
        self.comment = comment
        self.points = []
        self.triangles = []   # (material, ((vertex, uv, normal), ...) * 3)

    def point(self, x, y, z):
        self.points.append(tuple(round(c, 9) + 0.0 for c in (x, y, z)))
        return len(self.points) - 1

    def triangle(self, material, a, b, c):
        self.triangles.append((material, (a, b, c)))

    def quad(self, material, a, b, c, d, flip=False):
        """Two triangles; the diagonal runs from a to c, or from b to d when flipped."""
        if flip:
            a, b, c, d = b, c, d, a
        self.triangle(material, a, b, c)
        self.triangle(material, a, c, d)

    def smooth_normals(self):
        """Per vertex: the unit sum of the triangles' normals, each weighted by the triangle's angle there."""
        sums = [(0.0, 0.0, 0.0)] * len(self.points)
        for _, corners in self.triangles:
            p = [self.points[c[0]] for c in corners]
            normal = unit(cross(minus(p[1], p[0]), minus(p[2], p[0])))
            for i in range(3):
                e, f = unit(minus(p[(i + 1) % 3], p[i])), unit(minus(p[(i + 2) % 3], p[i]))
                angle = math.acos(max(-1.0, min(1.0, dot(e, f))))
                v = corners[i][0]
                sums[v] = plus(sums[v], scaled(normal, angle))
        return [unit(s) for s in sums]

    def write(self, path):
        smooth = self.smooth_normals()
        uvs, normals, lines, material = {}, {}, [], None
        faces = []
        for name, corners in self.triangles:
            if name != material:
                material = name
                faces.append("usemtl " + name)
            words = []
            for vertex, uv, normal in corners:
                uv = tuple(round(c, 6) + 0.0 for c in uv)
                normal = tuple(round(c, 6) + 0.0 for c in (normal or smooth[vertex]))
                t = uvs.setdefault(uv, len(uvs) + 1)
                n = normals.setdefault(normal, len(normals) + 1)
                words.append("%d/%d/%d" % (vertex + 1, t, n))
            faces.append("f " + " ".join(words))
        lines += ["# " + self.comment, "# metres, y up; made by generate.py; CC0 1.0"]
        lines += ["v %r %r %r" % p for p in self.points]
        lines += ["vt %r %r" % uv for uv in uvs]
        lines += ["vn %r %r %r" % n for n in normals]
        with open(path, "w", newline="\n") as out:
            out.write("\n".join(lines + faces) + "\n")


def plus(a, b): return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
def minus(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def scaled(a, s): return (a[0] * s, a[1] * s, a[2] * s)
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return scaled(a, 1.0 / math.sqrt(dot(a, a)))
def lerp(a, b, t): return tuple((1 - t) * x + t * y for x, y in zip(a, b))


# ---- curves in the plane of radius and height --------------------------------------------------------------

def spline(controls, samples):
    """Uniform cubic B-spline from the axis (tangent across it) to the last control point, as points."""
    first, last = controls[1], controls[-1]
    before = (-first[0], first[1])
    after = tuple(2 * b - a for a, b in zip(controls[-2], last))
    p = [before] + list(controls) + [after]
    points = []
    for i in range(len(p) - 3):
        for k in range(samples + (i == len(p) - 4)):
            t = k / samples
            w = ((1 - t) ** 3, 3 * t ** 3 - 6 * t ** 2 + 4, -3 * t ** 3 + 3 * t ** 2 + 3 * t + 1, t ** 3)
            points.append(tuple(sum(w[j] * p[i + j][c] for j in range(4)) / 6 for c in range(2)))
    return points


class Curve:
    """A polyline by arc length."""

    def __init__(self, points):
        self.points = points
        self.lengths = [0.0]
        for a, b in zip(points, points[1:]):
            self.lengths.append(self.lengths[-1] + math.dist(a, b))
        self.length = self.lengths[-1]

    def at(self, s):
        low, high = 0, len(self.lengths) - 1
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.lengths[middle] <= s else (low, middle)
        t = (s - self.lengths[low]) / (self.lengths[high] - self.lengths[low])
        return lerp(self.points[low], self.points[high], t)

    def outward(self, s):
        """Unit normal to the right of the direction of travel: outward for a silhouette that runs upward."""
        h = 1e-3 * self.length
        a, b = self.at(max(0.0, s - h)), self.at(min(self.length, s + h))
        d = math.dist(a, b)
        return ((b[1] - a[1]) / d, -(b[0] - a[0]) / d)


# ---- vase --------------------------------------------------------------------------------------------------

class VaseShape:
    """The wall of revolution: a midline, thickened to both sides, closed by a round lip."""

    SEGMENTS = 56
    FOOT, LIP = 0.0105, 0.0085   # wall thickness (m) at the foot and at the lip
    MIDLINE = [(0.0, 0.0062), (0.02, 0.006), (0.042, 0.0035), (0.062, 0.007), (0.071, 0.032), (0.083, 0.07),
               (0.092, 0.105), (0.089, 0.142), (0.070, 0.180), (0.050, 0.212), (0.0435, 0.245),
               (0.048, 0.275), (0.0555, 0.2965)]

    def __init__(self):
        middle = Curve(spline(self.MIDLINE, 40))
        sides = {1: [], -1: []}
        for i, (r, y) in enumerate(middle.points):
            s = middle.lengths[i]
            n = middle.outward(s) if i else (0.0, -1.0)
            half = 0.5 * (self.FOOT + (self.LIP - self.FOOT) * s / middle.length)
            for side in sides:
                sides[side].append((r + side * half * n[0], y + side * half * n[1]))
        lift = -min(y for _, y in sides[1])   # the foot stands on y = 0
        outer, inner = ([(r, y + lift) for r, y in sides[side]] for side in (1, -1))
        self.outer, self.inner = Curve(outer), Curve(inner[::-1])
        a, b = outer[-1], inner[-1]
        centre, radius = lerp(a, b, 0.5), 0.5 * math.dist(a, b)
        start = math.atan2(a[1] - centre[1], a[0] - centre[0])
        self.lip = [(centre[0] + radius * math.cos(start + math.pi * k / 4),
                     centre[1] + radius * math.sin(start + math.pi * k / 4)) for k in (1, 2, 3)]

    def theta(self, column):
        """Column angles; 0, where the handle is, lies in the middle between two columns."""
        return 2 * math.pi * (column - self.SEGMENTS / 2 + 0.5) / self.SEGMENTS


class Attachment:
    """Where an end of the handle opens the outer wall: a patch of grid cells whose border becomes an ellipse."""

    def __init__(self, columns, row, rows, along, across, upward):
        self.columns, self.row, self.rows = columns, row, rows
        self.along, self.across = along, across   # half axes (m) up the wall and around it
        self.sign = 1 if upward else -1           # the border starts at the top or at the bottom

    def border(self):
        """(column offset from θ = 0, row offset from the patch's middle, angle φ) of each border vertex."""
        k, l = self.columns, self.rows
        count = 2 * (k + l)
        for j in range(count):
            p = j + 0.5
            if p <= k / 2: u, v = p, l / 2
            elif p <= k / 2 + l: u, v = k / 2, l / 2 - (p - k / 2)
            elif p <= 1.5 * k + l: u, v = k / 2 - (p - k / 2 - l), -l / 2
            elif p <= 1.5 * k + 2 * l: u, v = -k / 2, -l / 2 + (p - 1.5 * k - l)
            else: u, v = p - count, l / 2
            yield u, self.sign * v, 2 * math.pi * p / count


def vase():
    mesh = Mesh("thin-walled vase with a handle: one surface of genus 1, wall 8.5 to 10.5 mm")
    shape = VaseShape()
    n = shape.SEGMENTS
    outer_rows, inner_rows = 52, 36
    step = shape.outer.length / outer_rows
    arc = [i * step for i in range(outer_rows + 1)]
    upper = Attachment(columns=5, row=44, rows=3, along=0.0125, across=0.0125, upward=True)
    lower = Attachment(columns=3, row=26, rows=5, along=0.0135, across=0.0135, upward=False)

    # Grid of the wall: per row its (radius, height) and what share of the profile lies before it.
    profile = [shape.outer.at(s) for s in arc[1:]] + shape.lip
    profile += [shape.inner.at(shape.inner.length * i / inner_rows) for i in range(inner_rows)]
    total = Curve([(0.0, shape.outer.at(0)[1])] + profile + [shape.inner.at(shape.inner.length)])
    share = [s / total.length for s in total.lengths]
    moved, skipped = {}, set()
    for end in (upper, lower):
        middle = arc[end.row] + 0.5 * end.rows * step
        end.centre, end.normal = shape.outer.at(middle), shape.outer.outward(middle)
        for u, v, phi in end.border():
            column, row = round(u + n / 2 - 0.5), round(end.row + end.rows / 2 + v)
            s = middle + end.sign * end.along * math.cos(phi)
            moved[row, column] = (s, end.across * math.sin(phi) / shape.outer.at(s)[0])
        left = round(n / 2 - 0.5 - end.columns / 2)
        skipped |= {(row, column) for row in range(end.row, end.row + end.rows)
                    for column in range(left, left + end.columns)}

    bottom = mesh.point(0, shape.outer.at(0)[1], 0)
    grid, uv = {}, {}
    inside_hole = {(row, column) for row, column in skipped
                   if (row - 1, column) in skipped and (row, column - 1) in skipped}
    for i, (r, y) in enumerate(profile):
        row = i + 1
        for column in range(n):
            theta, v = shape.theta(column), share[row]
            if (row, column) in moved:
                s, theta = moved[row, column]
                r2, y2 = shape.outer.at(s)
                v = s / total.length
            else:
                r2, y2 = r, y
            uv[row, column] = (0.5 + theta / (2 * math.pi), 0.8 * v)
            if (row, column) not in inside_hole:
                grid[row, column] = mesh.point(r2 * math.cos(theta), y2, r2 * math.sin(theta))
        uv[row, n] = (uv[row, 0][0] + 1.0, uv[row, 0][1])
    top = mesh.point(0, shape.inner.at(shape.inner.length)[1], 0)

    def corner(row, column):
        return (grid[row, column % n], uv[row, column], None)

    last = len(profile)
    for c in range(n):
        middle = 0.5 * (uv[1, c][0] + uv[1, c + 1][0])
        mesh.triangle("clay", (bottom, (middle, 0.0), None), corner(1, c), corner(1, c + 1))
    for row in range(1, last):
        for c in range(n):
            if (row, c) in skipped: continue
            mesh.quad("clay", corner(row, c), corner(row + 1, c), corner(row + 1, c + 1), corner(row, c + 1),
                      flip=c >= n // 2)
    for c in range(n):
        middle = 0.5 * (uv[last, c][0] + uv[last, c + 1][0])
        mesh.triangle("clay", corner(last, c), (top, (middle, 0.8), None), corner(last, c + 1))
    handle(mesh, shape, upper, lower, lambda row, column: grid[row, column])
    return mesh


def handle(mesh, shape, upper, lower, vertex):
    """A tube from the upper opening to the lower one, whose first and last rings are the openings' borders."""
    n, rings, around = shape.SEGMENTS, 30, 2 * (upper.columns + upper.rows)
    radial, sideways, flare = 0.0075, 0.0095, 0.022   # half axes of the section, length of the fillets (m)
    a, d = upper.centre, lower.centre
    b = plus((a[0], a[1], 0), scaled((upper.normal[0], upper.normal[1], 0), 0.105))
    c = plus((d[0], d[1], 0), scaled((lower.normal[0], lower.normal[1], 0), 0.100))
    a, d = (a[0], a[1], 0.0), (d[0], d[1], 0.0)

    def bezier(t):
        s = 1 - t
        return tuple(s ** 3 * a[i] + 3 * s * s * t * b[i] + 3 * s * t * t * c[i] + t ** 3 * d[i] for i in range(2))

    centre = Curve([bezier(k / 400) for k in range(401)])
    ends = []
    for end in (upper, lower):
        border = [(vertex(round(end.row + end.rows / 2 + v), round(u + n / 2 - 0.5)), phi)
                  for u, v, phi in end.border()]
        ends.append(border)
    loops = [[v for v, _ in ends[0]]]
    for i in range(1, rings):
        s = centre.length * i / rings
        (x, y), across = centre.at(s), centre.outward(s)   # `outward` is to the right: the tube's up is its opposite
        nearest, border, end = ((s, ends[0], upper) if 2 * s < centre.length
                                else (centre.length - s, ends[1], lower))
        w = min(1.0, nearest / flare)
        w = w * w * (3 - 2 * w)
        loop = []
        for v, phi in border:
            up, side = radial * math.cos(phi), sideways * math.sin(phi)
            tube = (x - up * across[0], y - up * across[1], side)
            foot = plus(mesh.points[v], scaled((end.normal[0], end.normal[1], 0.0), nearest))
            loop.append(mesh.point(*lerp(foot, tube, w)))
        loops.append(loop)
    loops.append([v for v, _ in ends[1]])

    def corner(i, j):
        return (loops[i][j % around], (j / around, 0.85 + 0.15 * i / rings), None)

    for i in range(rings):
        for j in range(around):
            mesh.quad("clay", corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j), flip=j % 2 == 1)


# ---- mushroom ----------------------------------------------------------------------------------------------

def mushroom():
    """24 segments and 16 rings between two poles: 2 · 24 · 16 = 768 triangles, the paper's count."""
    mesh = Mesh("mushroom: surface of revolution, 768 triangles")
    n = 24
    stem = [(0.011, 0.0), (0.017, 0.003), (0.0175, 0.013), (0.0155, 0.027), (0.014, 0.042), (0.0135, 0.057),
            (0.0155, 0.066)]
    cap = [(0.027, 0.0675), (0.040, 0.0640), (0.0490, 0.0620), (0.0535, 0.0655), (0.0530, 0.0755), (0.0475, 0.0890),
           (0.0380, 0.1020), (0.0255, 0.1125), (0.0115, 0.1185)]
    profile = stem + cap
    curve = Curve([(0.0, 0.0)] + profile + [(0.0, 0.120)])
    share = [s / curve.length for s in curve.lengths]
    bottom = mesh.point(0, 0, 0)
    rings = [[mesh.point(r * math.cos(2 * math.pi * k / n), y, r * math.sin(2 * math.pi * k / n)) for k in range(n)]
             for r, y in profile]
    top = mesh.point(0, 0.120, 0)

    def corner(i, k):
        return (rings[i][k % n], (k / n, share[i + 1]), None)

    for k in range(n):
        mesh.triangle("stem", (bottom, ((k + 0.5) / n, 0.0), None), corner(0, k), corner(0, k + 1))
    for i in range(len(rings) - 1):
        material = "stem" if i < len(stem) else "cap"
        for k in range(n):
            mesh.quad(material, corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1),
                      flip=(i + k) % 2 == 1)
    for k in range(n):
        mesh.triangle("cap", corner(len(rings) - 1, k), (top, ((k + 0.5) / n, 1.0), None),
                      corner(len(rings) - 1, k + 1))
    return mesh


# ---- sphere ------------------------------------------------------------------------------------------------

def sphere():
    """48 segments and 24 bands between two poles; convex to the nanometre."""
    mesh = Mesh("sphere: radius 0.1 m, 2208 triangles")
    n, bands, radius = 48, 24, 0.1

    def normal(i, k):
        phi, theta = math.pi * i / bands, 2 * math.pi * k / n
        return (math.sin(phi) * math.cos(theta), -math.cos(phi), math.sin(phi) * math.sin(theta))

    def place(i, k):
        return mesh.point(*plus((0.0, radius, 0.0), scaled(normal(i, k), radius)))

    bottom = mesh.point(0, 0, 0)
    rings = [[place(i, k) for k in range(n)] for i in range(1, bands)]
    top = mesh.point(0, 2 * radius, 0)

    def corner(i, k):
        return (rings[i - 1][k % n], (k / n, i / bands), normal(i, k % n))

    for k in range(n):
        mesh.triangle("stone", (bottom, ((k + 0.5) / n, 0.0), (0.0, -1.0, 0.0)), corner(1, k), corner(1, k + 1))
    for i in range(1, bands - 1):
        for k in range(n):
            mesh.quad("stone", corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1),
                      flip=(i + k) % 2 == 1)
    for k in range(n):
        mesh.triangle("stone", corner(bands - 1, k), (top, ((k + 0.5) / n, 1.0), (0.0, 1.0, 0.0)),
                      corner(bands - 1, k + 1))
    return mesh


# ---- wall and table: boundaries of sets of cells of a grid ---------------------------------------------------

def rectilinear(mesh, material, cell, low, counts, filled):
    """The boundary of the cells (i, j, k) for which filled() holds; every face two triangles, UVs in units of
    the longest side, one normal per face."""
    low = tuple(low)
    longest = cell * max(counts)
    vertices = {}

    def vertex(index):
        if index not in vertices:
            vertices[index] = mesh.point(*(low[c] + cell * index[c] for c in range(3)))
        return vertices[index]

    def occupied(index):
        return all(0 <= index[c] < counts[c] for c in range(3)) and filled(*index)

    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            normal = tuple((1.0 if side else -1.0) if d == axis else 0.0 for d in range(3))
            for i in range(counts[0]):
                for j in range(counts[1]):
                    for k in range(counts[2]):
                        index = (i, j, k)
                        beyond = tuple(index[d] + (2 * side - 1) * (d == axis) for d in range(3))
                        if not occupied(index) or occupied(beyond): continue
                        corners = []
                        for db, dc in ((0, 0), (1, 0), (1, 1), (0, 1)):
                            at = [0, 0, 0]
                            at[axis], at[b], at[c] = index[axis] + side, index[b] + db, index[c] + dc
                            uv = (cell * at[b] / longest, cell * at[c] / longest)
                            corners.append((vertex(tuple(at)), uv, normal))
                        if side == 0: corners.reverse()
                        mesh.quad(material, *corners, flip=(i + j + k) % 2 == 1)


def wall():
    """34 × 28 × 4 cells of 3 cm: 2 · (34·28 + 28·4 + 4·34) = 2400 squares, 4800 triangles, the paper's count."""
    mesh = Mesh("wall: box of 1.02 x 0.84 x 0.12 m, 4800 triangles")
    rectilinear(mesh, "brick", 0.03, (-0.51, 0.0, -0.06), (34, 28, 4), lambda i, j, k: True)
    return mesh


def table():
    """A top of 1.20 × 0.75 m, 3 cm thick, on four legs of 6 cm, set in by 3 cm; 0.72 m high."""
    mesh = Mesh("table: top and four legs as one surface, 1.20 x 0.72 x 0.75 m")
    nx, ny, nz = 40, 24, 25

    def filled(i, j, k):
        return j == ny - 1 or ((1 <= i <= 2 or nx - 3 <= i <= nx - 2) and (1 <= k <= 2 or nz - 3 <= k <= nz - 2))

    rectilinear(mesh, "wood", 0.03, (-0.60, 0.0, -0.375), (nx, ny, nz), filled)
    return mesh


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name, make in (("vase", vase), ("mushroom", mushroom), ("sphere", sphere), ("wall", wall), ("table", table)):
        mesh = make()
        mesh.write(os.path.join(folder, name + ".obj"))
        print("%s.obj: %d vertices, %d triangles" % (name, len(mesh.points), len(mesh.triangles)))


if __name__ == "__main__":
    main()
