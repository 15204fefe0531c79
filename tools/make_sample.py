#!/usr/bin/env python3
"""Writes samples/creature.obj: a small dragon of our own making, the sample model of Cagewright.

The body is a signed distance function: smooth unions of tapered capsules and ellipsoids. Surface
nets turn it into a closed mesh, which is then relaxed along the surface. Only one half is ever
computed and the other is its mirror image, so the model is exactly symmetric about x = 0.

Only + - * / and square roots are used, which IEEE 754 rounds in one way only: the file comes out
byte for byte the same on every machine. Needs nothing but Python 3.

    tools/make_sample.py [-o FILE]     writes the file (some ten seconds)
    tools/make_sample.py --check       fails unless samples/creature.obj is what would be written
"""

import argparse
import pathlib
import sys
from math import sqrt

CELL = 0.046  # edge of a grid cell; the creature is about 2.1 high
LOW = (-0.12, -1.6)  # lowest y and z of the grid; x begins at 0
HIGH = (1.05, 2.25, 0.95)  # highest x, y, z
RELAXATION_ROUNDS = 14

# ------------------------------------------------------------------ the shape


def capsule(a, b, radius_a, radius_b):
    """A rod from a to b with round ends, its radius going from radius_a to radius_b."""
    ax, ay, az = a
    dx, dy, dz = b[0] - ax, b[1] - ay, b[2] - az
    scale = 1 / (dx * dx + dy * dy + dz * dz)
    taper = radius_b - radius_a

    def distance(x, y, z):
        x, y, z = x - ax, y - ay, z - az
        t = (x * dx + y * dy + z * dz) * scale
        t = 0.0 if t < 0 else 1.0 if t > 1 else t
        x, y, z = x - t * dx, y - t * dy, z - t * dz
        return sqrt(x * x + y * y + z * z) - radius_a - t * taper

    return distance


def ellipsoid(center, radii):
    cx, cy, cz = center
    rx, ry, rz = 1 / radii[0], 1 / radii[1], 1 / radii[2]
    smallest = min(radii)

    def distance(x, y, z):
        x, y, z = (x - cx) * rx, (y - cy) * ry, (z - cz) * rz
        k0 = sqrt(x * x + y * y + z * z)
        x, y, z = x * rx, y * ry, z * rz
        k1 = sqrt(x * x + y * y + z * z)
        return k0 * (k0 - 1) / k1 if k1 > 0 else -smallest

    return distance


def smooth_curve(points, steps=4):
    """A Catmull-Rom curve through points of any dimension."""
    points = [tuple(2 * a - b for a, b in zip(points[0], points[1]))] + list(points)
    points.append(tuple(2 * a - b for a, b in zip(points[-1], points[-2])))
    curve = [points[1]]
    for p, q, r, s in zip(points, points[1:], points[2:], points[3:]):
        for n in range(1, steps + 1):
            t = n / steps
            curve.append(tuple(
                0.5 * (2 * b + t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))))
                for a, b, c, d in zip(p, q, r, s)))
    return curve


def limb(points, radii):
    """A bent rod of varying radius."""
    curve = smooth_curve([(*p, r) for p, r in zip(points, radii)])
    pieces = [capsule(a[:3], b[:3], a[3], b[3]) for a, b in zip(curve, curve[1:])]
    return lambda x, y, z: min([piece(x, y, z) for piece in pieces])


def mirrored(point):
    return (-point[0], point[1], point[2])


class Shape:
    """Parts joined one after the other, each with its own radius of blending. Parts off the plane
    of symmetry come in pairs."""

    def __init__(self):
        self.parts = []  # (distance function, blend; negative: carve instead of join)

    def limb(self, points, radii, blend):
        self.parts.append((limb(points, radii), blend))
        if any(p[0] != 0 for p in points):
            self.parts.append((limb([mirrored(p) for p in points], radii), blend))

    def rod(self, a, b, radius_a, radius_b, blend):
        self.parts.append((capsule(a, b, radius_a, radius_b), blend))
        if a[0] != 0 or b[0] != 0:
            self.parts.append((capsule(mirrored(a), mirrored(b), radius_a, radius_b), blend))

    def ball(self, center, radii, blend):
        self.parts.append((ellipsoid(center, radii), blend))
        if center[0] != 0:
            self.parts.append((ellipsoid(mirrored(center), radii), blend))

    def carve(self, points, radii, blend):
        self.limb(points, radii, -blend)

    def near(self, x, y, z, reach=0.5):
        """The parts that can matter within a small step of the point, as a shape."""
        result = Shape()
        distances = [part(x, y, z) for part, _ in self.parts]
        limit = min(distances) + reach
        result.parts = [p for p, d in zip(self.parts, distances) if d < limit]
        return result

    def distance(self, x, y, z):
        d = 1e9
        for part, blend in self.parts:
            e = part(x, y, z)
            if blend > 0:
                gap = blend - (d - e if d > e else e - d)
                d = d if d < e else e
                if gap > 0:
                    d -= gap * gap / (4 * blend)
            else:
                gap = -blend - (d + e if d + e > 0 else -d - e)
                d = d if d > -e else -e
                if gap > 0:
                    d += gap * gap / (-4 * blend)
        return d


def creature():
    s = Shape()
    # trunk: a pear with a round belly
    s.ball((0, 0.55, 0.00), (0.30, 0.31, 0.29), 0.1)
    s.rod((0, 0.60, 0.00), (0, 0.88, -0.02), 0.27, 0.20, 0.12)
    s.ball((0, 0.55, 0.12), (0.23, 0.25, 0.21), 0.10)
    s.rod((0, 0.85, -0.02), (0, 1.10, 0.02), 0.19, 0.18, 0.08)
    # tail: down, back and up again, with a leaf at its end
    s.limb(
        [(0, 0.48, -0.14), (0, 0.31, -0.46), (0, 0.20, -0.78), (0, 0.23, -1.09), (0, 0.43, -1.30), (0, 0.68, -1.34)],
        [0.24, 0.185, 0.14, 0.11, 0.085, 0.07], 0.12)
    s.limb([(0, 0.70, -1.34), (0, 0.83, -1.33), (0, 0.97, -1.30), (0, 1.08, -1.25)], [0.06, 0.12, 0.09, 0.05], 0.05)
    s.limb([(0.03, 0.74, -1.335), (0.07, 0.83, -1.33), (0.05, 0.93, -1.31)], [0.06, 0.10, 0.065], 0.05)
    # legs
    s.limb([(0.17, 0.50, 0.00), (0.265, 0.30, 0.07), (0.28, 0.12, -0.01)], [0.20, 0.155, 0.115], 0.08)
    s.rod((0.28, 0.11, -0.02), (0.30, 0.10, 0.17), 0.115, 0.11, 0.05)
    s.rod((0.255, 0.085, 0.17), (0.205, 0.075, 0.275), 0.085, 0.068, 0.03)
    s.rod((0.305, 0.085, 0.18), (0.315, 0.075, 0.315), 0.085, 0.068, 0.03)
    s.rod((0.355, 0.085, 0.17), (0.425, 0.075, 0.265), 0.085, 0.066, 0.03)
    # arms, held away from the body, with a thumb and two fingers
    s.limb([(0.13, 0.90, -0.02), (0.40, 0.80, -0.04), (0.64, 0.61, 0.04)], [0.14, 0.10, 0.085], 0.08)
    s.ball((0.695, 0.565, 0.065), (0.105, 0.10, 0.10), 0.05)
    s.rod((0.72, 0.55, 0.04), (0.845, 0.45, 0.015), 0.070, 0.056, 0.025)
    s.rod((0.72, 0.55, 0.10), (0.815, 0.455, 0.175), 0.070, 0.056, 0.025)
    s.rod((0.67, 0.58, 0.12), (0.645, 0.55, 0.245), 0.064, 0.052, 0.025)
    # head: a broad skull, cheeks, a snout and a chin
    s.ball((0, 1.38, 0.02), (0.42, 0.36, 0.37), 0.08)
    s.ball((0.22, 1.24, 0.16), (0.20, 0.17, 0.19), 0.10)
    s.limb([(0, 1.27, 0.25), (0, 1.265, 0.45), (0, 1.27, 0.60)], [0.24, 0.205, 0.185], 0.10)
    s.rod((0.085, 1.335, 0.58), (0.10, 1.37, 0.68), 0.095, 0.078, 0.06)  # the nostrils' swelling
    s.rod((0, 1.16, 0.26), (0, 1.135, 0.51), 0.14, 0.13, 0.04)
    # a smile between snout and chin
    s.carve([(-0.17, 1.165, 0.69), (0, 1.145, 0.80), (0.17, 1.165, 0.69)], [0.045, 0.045, 0.045], 0.025)
    s.carve([(0.10, 1.15, 0.76), (0.22, 1.16, 0.60), (0.30, 1.18, 0.44), (0.405, 1.275, 0.33)],
            [0.045, 0.048, 0.046, 0.032], 0.025)
    s.carve([(0.115, 1.40, 0.74), (0.125, 1.41, 0.80)], [0.030, 0.040], 0.025)  # nostrils
    # eyes
    s.ball((0.22, 1.545, 0.285), (0.14, 0.16, 0.125), 0.02)
    # ears, then horns that sweep back and up
    s.limb([(0.36, 1.42, -0.04), (0.53, 1.47, -0.12), (0.66, 1.55, -0.19), (0.77, 1.66, -0.25)],
           [0.09, 0.125, 0.108, 0.055], 0.05)
    s.carve([(0.51, 1.475, 0.035), (0.64, 1.545, -0.045)], [0.060, 0.060], 0.05)
    s.limb([(0.18, 1.64, -0.06), (0.235, 1.81, -0.10), (0.27, 1.95, -0.21), (0.265, 2.05, -0.36)],
           [0.12, 0.098, 0.08, 0.057], 0.04)
    # a row of soft spines from the crown to the tail
    for y, z, dy, dz, size in (
        (1.69, -0.10, 0.13, -0.05, 0.085),
        (1.56, -0.27, 0.11, -0.12, 0.090),
        (1.30, -0.30, 0.04, -0.16, 0.090),
        (1.03, -0.15, 0.06, -0.15, 0.085),
        (0.80, -0.21, 0.07, -0.16, 0.095),
        (0.60, -0.32, 0.11, -0.15, 0.100),
        (0.46, -0.52, 0.15, -0.10, 0.092),
        (0.36, -0.76, 0.15, -0.03, 0.082),
        (0.33, -1.00, 0.13, 0.05, 0.070),
    ):
        s.rod((0, y, z), (0, y + dy, z + dz), size, 0.55 * size, 0.04)
    return s


# ------------------------------------------------------------------ surface nets


def sample(shape):
    """Distances on the half grid. Column i is at x = (i - 1/2) CELL, so that column 0 mirrors
    column 1 and the cells between them straddle the plane of symmetry. Far from the surface only
    the sign is right."""
    counts = [int((HIGH[0] / CELL + 2)), int((HIGH[1] - LOW[0]) / CELL + 2), int((HIGH[2] - LOW[1]) / CELL + 2)]
    nx, ny, nz = counts
    values = [[[1.0] * nz for _ in range(ny)] for _ in range(nx)]
    step = 4
    reach = 1.8 * step * CELL
    for i0 in range(1, nx, step):
        for j0 in range(0, ny, step):
            for k0 in range(0, nz, step):
                center = position(i0 + 0.5 * (step - 1), j0 + 0.5 * (step - 1), k0 + 0.5 * (step - 1))
                d = shape.distance(*center)
                near = shape.near(*center) if -reach < d < reach else None
                for i in range(i0, min(i0 + step, nx)):
                    for j in range(j0, min(j0 + step, ny)):
                        row = values[i][j]
                        for k in range(k0, min(k0 + step, nz)):
                            row[k] = near.distance(*position(i, j, k)) if near else d
    fill_pinches(values)
    return values


def fill_pinches(values):
    """Surface nets give one vertex to a cell, so two sheets must not meet in one: fills corners
    until no face is a chessboard and no two opposite corners of a cell stand against the rest."""
    nx, ny, nz = len(values), len(values[0]), len(values[0][0])
    squares = [
        [(0, 0, 0), u, tuple(a + b for a, b in zip(u, v)), v]
        for u, v in (((1, 0, 0), (0, 1, 0)), ((0, 1, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0)))
    ]
    diagonals = [[(a, 0, c), (1 - a, 1, 1 - c)] for a in (0, 1) for c in (0, 1)]
    cube = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    changed = True
    while changed:
        changed = False
        values[0] = values[1]
        for i in range(nx - 1):
            for j in range(ny - 1):
                for k in range(nz - 1):
                    outside = {c for c in cube if values[i + c[0]][j + c[1]][k + c[2]] >= 0}
                    if not outside or len(outside) == 8:
                        continue
                    pinch = any(
                        [corner in outside for corner in square] in ([True, False] * 2, [False, True] * 2)
                        for square in squares
                    ) or any(
                        outside == set(pair) or set(cube) - outside == set(pair) for pair in diagonals
                    )
                    if pinch:
                        a, b, c = min(outside, key=lambda c: (values[i + c[0]][j + c[1]][k + c[2]], c))
                        values[max(i + a, 1)][j + b][k + c] = -0.02 * CELL
                        changed = True


def position(i, j, k):
    return ((i - 0.5) * CELL, LOW[0] + j * CELL, LOW[1] + k * CELL)


def surface_nets(values):
    """One vertex for each cell that the surface crosses, one quad for each grid edge that it
    crosses: the half with i >= 0. Vertices of the cells with i = 0 lie in the plane x = 0."""
    nx, ny, nz = len(values), len(values[0]), len(values[0][0])
    corners = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    edges = [(p, q) for p in corners for q in corners if p < q and sum(p) + 1 == sum(q)]
    edges = [(p, q) for p, q in edges if all(a <= b for a, b in zip(p, q))]
    vertex_of, positions = {}, []
    for i in range(nx - 1):
        for j in range(ny - 1):
            for k in range(nz - 1):
                inside = [values[i + a][j + b][k + c] < 0 for a, b, c in corners]
                if all(inside) or not any(inside):
                    continue
                total, count = [0.0, 0.0, 0.0], 0
                for p, q in edges:
                    u = values[i + p[0]][j + p[1]][k + p[2]]
                    v = values[i + q[0]][j + q[1]][k + q[2]]
                    if (u < 0) != (v < 0):
                        t = u / (u - v)
                        for axis in range(3):
                            total[axis] += p[axis] + t * (q[axis] - p[axis])
                        count += 1
                x, y, z = position(i + total[0] / count, j + total[1] / count, k + total[2] / count)
                vertex_of[i, j, k] = len(positions)
                positions.append([0.0 if i == 0 else x, y, z])
    quads = []
    for i in range(nx - 1):
        for j in range(1, ny - 1):
            for k in range(1, nz - 1):
                here = values[i][j][k] < 0
                for axis, (di, dj, dk) in enumerate(((1, 0, 0), (0, 1, 0), (0, 0, 1))):
                    if axis != 0 and i == 0:
                        continue  # the mirror image of column 1's
                    if here == (values[i + di][j + dj][k + dk] < 0):
                        continue
                    if axis == 0:
                        ring = [(i, j - 1, k - 1), (i, j, k - 1), (i, j, k), (i, j - 1, k)]
                    elif axis == 1:
                        ring = [(i - 1, j, k - 1), (i - 1, j, k), (i, j, k), (i, j, k - 1)]
                    else:
                        ring = [(i - 1, j - 1, k), (i, j - 1, k), (i, j, k), (i - 1, j, k)]
                    quad = [vertex_of[c] for c in ring]
                    quads.append(quad if here else quad[::-1])
    return positions, quads


# ------------------------------------------------------------------ nice triangles


def squared(p, q):
    return sum((a - b) * (a - b) for a, b in zip(p, q))


def split(positions, quads):
    """Each quad cut along its shorter diagonal."""
    triangles = []
    for a, b, c, d in quads:
        if squared(positions[a], positions[c]) <= squared(positions[b], positions[d]):
            triangles += [(a, b, c), (a, c, d)]
        else:
            triangles += [(a, b, d), (b, c, d)]
    return triangles


def flip_to_even_valence(positions, triangles, in_plane):
    """Flips edges while that brings the numbers of neighbours closer to six. Works on the half;
    its border, in the plane of symmetry, counts double."""
    valence = [0] * len(positions)
    faces = {}
    triangles = [list(t) for t in triangles]
    for f, t in enumerate(triangles):
        for n in range(3):
            valence[t[n]] += 2 if in_plane[t[n]] else 1
            faces[t[n], t[(n + 1) % 3]] = f
    for _ in range(4):
        flips = 0
        for f in range(len(triangles)):
            for n in range(3):
                a, b, c = (triangles[f][(n + m) % 3] for m in range(3))
                g = faces.get((b, a))
                if g is None:
                    continue
                d = next(v for v in triangles[g] if v not in (a, b))
                if (c, d) in faces or (d, c) in faces or any(in_plane[v] for v in (a, b, c, d)):
                    continue
                now = sum((valence[v] - 6) ** 2 for v in (a, b, c, d))
                then = sum((valence[v] - 7) ** 2 for v in (a, b)) + sum((valence[v] - 5) ** 2 for v in (c, d))
                if then >= now or squared(positions[c], positions[d]) > 2.2 * squared(positions[a], positions[b]):
                    continue
                del faces[a, b], faces[b, a]
                triangles[f], triangles[g] = [a, d, c], [d, b, c]
                for h in (f, g):
                    for m in range(3):
                        faces[triangles[h][m], triangles[h][(m + 1) % 3]] = h
                valence[a], valence[b], valence[c], valence[d] = (
                    valence[a] - 1, valence[b] - 1, valence[c] + 1, valence[d] + 1)
                flips += 1
                break
        if flips == 0:
            break
    return [tuple(t) for t in triangles]


def gradient(shape, p):
    step = 1e-4
    x, y, z = p
    return [
        (shape.distance(x + step, y, z) - shape.distance(x - step, y, z)) / (2 * step),
        (shape.distance(x, y + step, z) - shape.distance(x, y - step, z)) / (2 * step),
        (shape.distance(x, y, z + step) - shape.distance(x, y, z - step)) / (2 * step),
    ]


def relax(shape, positions, triangles, in_plane):
    """Moves every vertex along the surface to the middle of its neighbours, and back onto the
    surface."""
    neighbors = [[] for _ in positions]
    for t in triangles:
        for n in range(3):
            a, b = t[n], t[(n + 1) % 3]
            for v, w in ((a, b), (b, a)):
                if w not in neighbors[v]:
                    neighbors[v].append(w)
    near = [shape.near(*p, reach=0.35) for p in positions]
    for step in range(RELAXATION_ROUNDS):
        moved = []
        for v, p in enumerate(positions):
            middle, weight = [0.0, 0.0, 0.0], 0
            for w in neighbors[v]:
                q = positions[w]
                copies = 2 if in_plane[v] and not in_plane[w] else 1
                for axis in range(3):
                    middle[axis] += copies * q[axis]
                weight += copies
            delta = [m / weight - c for m, c in zip(middle, p)]
            g = gradient(near[v], p)
            length2 = sum(c * c for c in g)
            along = sum(d * c for d, c in zip(delta, g)) / length2
            q = [c + 0.6 * (d - along * n) for c, d, n in zip(p, delta, g)]
            off = near[v].distance(*q) / length2
            off = max(-0.3 * CELL, min(0.3 * CELL, off))
            q = [c - off * n for c, n in zip(q, g)]
            if in_plane[v]:
                q[0] = 0.0
            moved.append(q)
        positions = moved
    return positions


# ------------------------------------------------------------------ the other half, and the file


def both_halves(positions, triangles, in_plane):
    twin = {}
    result = [tuple(p) for p in positions]
    for v, p in enumerate(positions):
        twin[v] = v
        if not in_plane[v]:
            twin[v] = len(result)
            result.append((-p[0], p[1], p[2]))
    return result, triangles + [(twin[a], twin[c], twin[b]) for a, b, c in triangles]


def check(positions, triangles):
    """Fails unless every edge has two triangles, run through in opposite directions, the triangles
    at every vertex form one fan, and nothing is left unused."""
    directed = {}
    fan = {}
    for t in triangles:
        for n in range(3):
            a, b, c = t[n], t[(n + 1) % 3], t[(n + 2) % 3]
            assert (a, b) not in directed, "an edge has more than two triangles"
            directed[a, b] = c
            fan.setdefault(a, {})[b] = c
    assert all((b, a) in directed for a, b in directed), "the surface is open"
    assert len(fan) == len(positions), "a vertex is used by no triangle"
    for around in fan.values():
        first = v = next(iter(around))
        for n in range(len(around)):
            v = around[v]
            assert v != first or n == len(around) - 1, "a vertex joins two sheets"
    assert len(positions) - len(directed) // 2 + len(triangles) == 2, "the surface is not a sphere"


def decimal(c):
    text = format(c, ".5f").rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def obj_text(positions, triangles):
    lines = [
        "# Cagewright's sample model: a small dragon, symmetric about x = 0, y up, facing +z.",
        "# Made by tools/make_sample.py; under the license of the project.",
        f"# {len(positions)} vertices, {len(triangles)} triangles: closed, one piece, genus 0.",
        "o creature",
    ]
    lines += ["v " + " ".join(map(decimal, p)) for p in positions]
    lines += ["f " + " ".join(str(v + 1) for v in t) for t in triangles]
    return "\n".join(lines) + "\n"


def make():
    shape = creature()
    positions, quads = surface_nets(sample(shape))
    in_plane = [p[0] == 0 for p in positions]
    triangles = split(positions, quads)
    triangles = flip_to_even_valence(positions, triangles, in_plane)
    positions = relax(shape, positions, triangles, in_plane)
    positions, triangles = both_halves(positions, triangles, in_plane)
    check(positions, triangles)
    return obj_text(positions, triangles)


def main():
    committed = pathlib.Path(__file__).resolve().parent.parent / "samples" / "creature.obj"
    parser = argparse.ArgumentParser(description="Make the sample model.")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=committed)
    parser.add_argument("--check", action="store_true", help="compare with the file instead of writing it")
    options = parser.parse_args()
    text = make()
    if options.check:
        if options.output.read_text(encoding="ascii") != text:
            sys.exit(f"{options.output} is not what this script makes")
        print(f"{options.output} is what this script makes")
        return
    options.output.write_text(text, encoding="ascii")
    print("\n".join(text.splitlines()[:3]))


if __name__ == "__main__":
    main()
