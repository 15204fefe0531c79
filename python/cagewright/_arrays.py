"""Arrays of the caller's as the library reads them, and arrays of the library's as the caller sees them."""

import os
from collections.abc import Mapping

import numpy as np

from ._library import Array, MeshView

_TYPES = {np.dtype(name): number for number, name in enumerate(
    ["float64", "float32", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"])}


class _Memory:
    """Numbers of the library's: numpy keeps this object, and this keeps their owner."""

    def __init__(self, owner, address, shape, kind, writable):
        self._owner = owner
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": kind, "data": (address, not writable)}


def view(owner, address, shape, kind, writable=True):
    """An array on memory of the library's, which lives as long as the array does."""
    if not address or 0 in shape:
        return np.empty(shape, kind)
    return np.asarray(_Memory(owner, address, shape, kind, writable))


def array_of(numbers, what, dtype=None):
    """An Array on the very memory of a numpy array where its type is one that the library reads, else on a copy.

    The second result is what has to stay alive as long as the first is used.
    """
    array = np.asarray(numbers)
    if array.dtype.kind not in "fiub":
        try:
            array = np.asarray(None if array.dtype.kind == "c" else numbers, dtype or np.float64)
            if array.ndim == 0:
                raise ValueError
        except (TypeError, ValueError):
            raise ValueError(f"{what}: no array of numbers can be made of this {type(numbers).__name__}") from None
    if dtype is not None and array.dtype.kind != np.dtype(dtype).kind:
        array = array.astype(dtype)
    if array.dtype not in _TYPES:  # half precision, long double, another byte order, bool
        array = array.astype(np.float64 if array.dtype.kind == "f" else np.int64)
    if array.ndim == 1:
        array = array.reshape(-1, 1) if array.size else array.reshape(0, 3)
    if array.ndim != 2:
        raise ValueError(f"{what}: an array of {array.ndim} dimensions, not of rows and columns")
    if array.size and not any(array.strides):  # one number for all: strides of 0 mean packed to the library
        array = array.copy()
    rows, columns = array.shape
    return Array(array.ctypes.data if array.size else None, _TYPES[array.dtype], rows, columns, *array.strides), array


def points(numbers, what):
    """N x 3 coordinates. Integers become doubles; doubles and floats stay where they are."""
    array, keep = array_of(numbers, what, np.float64)
    if keep.shape[1] == 1 and keep.size:
        raise ValueError(f"{what}: one row of {keep.size} numbers, not rows of x, y, z; reshape(-1, 3) makes rows of it")
    return array, keep


def finite_points(numbers, what):
    """The same where a coordinate that is nowhere would take a model with it for good."""
    array, keep = points(numbers, what)
    fine = np.isfinite(keep).all(axis=1)
    if not fine.all():
        raise ValueError(f"{what}: row {int(np.argmin(fine))} has a coordinate that is not a finite number")
    return array, keep


def _has(thing, *names):
    return all(hasattr(thing, name) for name in names)


def parts_of(mesh):
    """The vertices and faces of a pair, or of an object of another library; or None where it is no mesh."""
    if isinstance(mesh, np.ndarray):
        return None
    if isinstance(mesh, tuple):  # (vertices, faces); but a pair of rows is no mesh
        return mesh if len(mesh) == 2 and np.ndim(mesh[0]) == 2 else None
    if isinstance(mesh, Mapping):
        return (mesh["vertices"], mesh["faces"]) if "vertices" in mesh and "faces" in mesh else None
    if _has(mesh, "vertices", "corners", "offsets"):  # ours
        counts = np.diff(mesh.offsets)
        is_even = counts.size and (counts == counts[0]).all()
        return mesh.vertices, mesh.faces if is_even else (mesh.corners, mesh.offsets)
    for vertices, faces in [("vertices", "faces"), ("points", "faces"), ("vertices", "triangles")]:
        if _has(mesh, vertices, faces):  # trimesh; PyVista; Open3D
            return getattr(mesh, vertices), getattr(mesh, faces)
    if _has(mesh, "points", "cells") and isinstance(mesh.cells, list):  # meshio
        return mesh.points, _faces_of_cells(mesh.cells)
    return None


def _faces_of_cells(blocks):
    """The faces among cells of meshio's kinds: lines and points are none."""
    faces = []
    for block in blocks:
        if block.type in ("triangle", "quad", "polygon"):
            faces.extend(np.asarray(block.data).tolist())
        elif block.type not in ("vertex", "line"):
            raise TypeError(f"cells of the kind {block.type} are no surface; extract the surface first")
    return faces


def two_parts(vertices, faces, what):
    """Vertices and faces, given apart or as one object."""
    if faces is not None:
        return vertices, faces
    if isinstance(vertices, (str, bytes, os.PathLike)):
        raise TypeError(f"{what}: a path, not a mesh; read_mesh() reads the file")
    parts = parts_of(vertices)
    if parts is None:
        raise TypeError(f"{what}: faces are missing; give vertices and faces, or an object that has both")
    return parts


def four_parts(vertices, faces, cage_vertices, cage_faces):
    """A model and a cage, each given apart or as one object: f(model, cage), f(model, V, F), f(V, F, cage)..."""
    if cage_vertices is None and faces is not None and parts_of(faces) is not None:
        faces, cage_vertices = None, faces  # f(model, cage)
    elif cage_faces is None and faces is not None and cage_vertices is not None and parts_of(vertices) is not None \
            and parts_of(cage_vertices) is None:
        faces, cage_vertices, cage_faces = None, faces, cage_vertices  # f(model, V, F)
    if cage_vertices is None:
        raise TypeError("the cage is missing; give its vertices and faces, or an object that has both")
    return two_parts(vertices, faces, "the model") + two_parts(cage_vertices, cage_faces, "the cage")


def _runs(flat, what):
    """Corners and offsets of [3, a, b, c, 4, d, e, f, g, ...], the faces of VTK and PyVista."""
    sides = int(flat[0]) if flat.size else 3
    if sides >= 3 and flat.size % (sides + 1) == 0 and (flat[::sides + 1] == sides).all():
        return flat.reshape(-1, sides + 1)[:, 1:], None
    begins, at = [], 0
    while at < flat.size:
        begins.append(at)
        at += max(int(flat[at]), 0) + 1
    if at != flat.size:
        raise ValueError(f"{what}: one row of {flat.size} integers that are not a number of corners, the corners, and so "
                         "on; give rows of corners, or (corners, offsets)")
    begins = np.asarray(begins)
    is_corner = np.ones(flat.size, bool)
    is_corner[begins] = False
    return flat[is_corner], np.append(begins - np.arange(begins.size), flat.size - begins.size)


def _lists(rows, what):
    """Corners and offsets of lists of corners, each of its own length."""
    try:
        counts = [len(row) for row in rows]
    except TypeError:
        raise ValueError(f"{what}: neither rows of corners nor a list of lists") from None
    corners = np.fromiter((int(corner) for row in rows for corner in row), np.int64, sum(counts))
    return corners, np.concatenate([[0], np.cumsum(counts)])


def _are_corners_and_offsets(faces):
    """Whether a pair is (corners, offsets) rather than two faces."""
    if not isinstance(faces, tuple) or len(faces) != 2:
        return False
    if all(isinstance(part, np.ndarray) and part.ndim == 1 for part in faces):
        return True
    if not all(isinstance(part, (list, np.ndarray)) and np.ndim(part) == 1 and len(part) for part in faces):
        return False
    begins = np.asarray(faces[1])  # lists: only where they are what offsets must be
    return begins[0] == 0 and (np.diff(begins) >= 3).all() and begins[-1] <= len(faces[0])


def _faces(faces, what):
    """The Array of faces and that of offsets, and what must stay alive."""
    offsets = None
    if hasattr(faces, "__next__"):
        faces = list(faces)
    if _are_corners_and_offsets(faces):
        corners, offsets = map(np.asarray, faces)
    else:
        is_ragged = isinstance(faces, (list, tuple)) and len({len(row) for row in faces if hasattr(row, "__len__")}) > 1
        corners = None if is_ragged else np.asarray(faces)
        if is_ragged or corners.dtype == object:
            corners, offsets = _lists(faces, what)
        elif corners.ndim == 1 and corners.size:
            if corners.dtype.kind not in "iu":
                raise ValueError(f"{what}: indices are integers, not {corners.dtype}")
            corners, offsets = _runs(corners, what)
        elif corners.size == 0:
            corners = np.empty((0, 3), np.uint32)
    if corners.dtype.kind not in "iuf":
        raise ValueError(f"{what}: indices are integers, not {corners.dtype}")
    first, keep = array_of(corners, what)
    if offsets is None:
        return first, Array(None, _TYPES[np.dtype(np.uint64)], 0, 0, 0, 0), (keep,)
    second, keep_too = array_of(offsets, what)
    second.columns, second.rows = 1, keep_too.size
    first.columns, first.rows = 1, keep.size
    return first, second, (keep, keep_too)


def mesh_view(vertices, faces, what):
    """A MeshView, which keeps alive what it points to."""
    positions, keep = points(vertices, f"{what}'s vertices")
    corners, offsets, keep_too = _faces(faces, f"{what}'s faces")
    mesh = MeshView(positions, corners, offsets)
    mesh.keeps_alive = (keep, *keep_too)
    return mesh
