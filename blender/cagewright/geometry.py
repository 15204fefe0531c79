"""Objects as arrays, and arrays as objects.

Points are float64, N x 3; faces are a pair (corners, offsets): face f has corners[offsets[f]:offsets[f + 1]].
Matrices are 4 x 4 and act on columns, as Blender's.
"""

import bpy
import numpy as np

# Modifiers that keep the vertices they are given; others may make vertices of their own.
KEEPING = {"ARMATURE", "CAST", "CORRECTIVE_SMOOTH", "CURVE", "DATA_TRANSFER", "DISPLACE", "HOOK", "LAPLACIANDEFORM",
           "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "NORMAL_EDIT", "SHRINKWRAP",
           "SIMPLE_DEFORM", "SMOOTH", "SURFACE_DEFORM", "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT",
           "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY", "WARP", "WAVE", "WEIGHTED_NORMAL", "CLOTH", "COLLISION",
           "DYNAMIC_PAINT", "PARTICLE_SYSTEM", "SOFT_BODY"}
_SUBDIVIDING = {"SUBSURF", "MULTIRES"}


def points_of(mesh):
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def faces_of(mesh):
    """The polygons, as they are stored."""
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    offsets = np.empty(len(mesh.polygons) + 1, np.int32)
    mesh.polygons.foreach_get("loop_start", offsets[:-1])
    offsets[-1] = len(corners)
    return corners, offsets.astype(np.int64)


def triangles_of(mesh):
    """The triangles that Blender shows: polygons of more corners as it cuts them."""
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return corners, np.arange(0, len(corners) + 1, 3, dtype=np.int64)


def matrix_of(matrix):
    return np.array(matrix, np.float64)


def transformed(points, matrix):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def together(meshes):
    """One mesh of several (points, (corners, offsets))."""
    points, corners, offsets, first_point, first_corner = [], [], [np.zeros(1, np.int64)], 0, 0
    for some, (some_corners, some_offsets) in meshes:
        points.append(some)
        corners.append(some_corners + np.int32(first_point))
        offsets.append(some_offsets[1:] + first_corner)
        first_point += len(some)
        first_corner += len(some_corners)
    return np.concatenate(points), (np.concatenate(corners), np.concatenate(offsets))


class Evaluated:
    """The mesh of an object with all its modifiers, also in edit mode: `with Evaluated(obj, depsgraph) as mesh`."""

    def __init__(self, obj, depsgraph):
        self.object = obj.evaluated_get(depsgraph)

    def __enter__(self):
        return self.object.to_mesh()

    def __exit__(self, *_):
        self.object.to_mesh_clear()


class modifiers_off:
    """While it lasts, modifiers for which `is_off(modifier)` holds do nothing."""

    def __init__(self, obj, is_off):
        self._modifiers = [modifier for modifier in obj.modifiers if modifier.show_viewport and is_off(modifier)]

    def __enter__(self):
        for modifier in self._modifiers:
            modifier.show_viewport = False
        if self._modifiers:
            bpy.context.view_layer.update()

    def __exit__(self, *_):
        for modifier in self._modifiers:
            modifier.show_viewport = True
        if self._modifiers:
            bpy.context.view_layer.update()


def first_making(obj):
    """The place in the stack of the first modifier that may make vertices of its own; the number of all if there is
    none."""
    for place, modifier in enumerate(obj.modifiers):
        if modifier.type not in KEEPING and modifier.show_viewport and not modifier.name.startswith("Cagewright"):
            return place
    return len(obj.modifiers)


def own_points_shown(obj):
    """Where the object's own vertices are once what only moves them has: in its own space."""
    making = {modifier.name for modifier in obj.modifiers[first_making(obj):]}
    with modifiers_off(obj, lambda modifier: modifier.name in making):
        with Evaluated(obj, bpy.context.evaluated_depsgraph_get()) as mesh:
            points = points_of(mesh)
    return points if len(points) == len(obj.data.vertices) else points_of(obj.data)


def model_of(obj, as_shown):
    """The object as a model in the world: what the viewport shows, or the mesh as it is stored.

    Of a subdivided model the vertices that are edited and bound belong to it, too: they lie outside what is shown.
    """
    world = matrix_of(obj.matrix_world)
    if not as_shown:
        return transformed(points_of(obj.data), world), faces_of(obj.data)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    with Evaluated(obj, depsgraph) as mesh:
        shown = (transformed(points_of(mesh), world), triangles_of(mesh))
    if any(modifier.type in _SUBDIVIDING and modifier.show_viewport for modifier in obj.modifiers):
        own = (transformed(own_points_shown(obj), world), faces_of(obj.data))
        return together([shown, own])
    return shown


def new_mesh(name, points, corners, offsets):
    """A mesh datablock of the given polygons."""
    mesh = bpy.data.meshes.new(name)
    faces = [corners[begin:end].tolist() for begin, end in zip(offsets[:-1], offsets[1:])]
    mesh.from_pydata(points.tolist(), [], faces)
    mesh.update()
    return mesh
