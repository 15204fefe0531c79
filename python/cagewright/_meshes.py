"""Meshes from files and to files."""

import ctypes
import json

import numpy as np

from . import _arrays
from ._calls import run
from ._library import Handle, checked, lib, path_bytes

_POSES = {"shown": 0, "bind": 1}


class Mesh:
    """Vertices and faces: ``vertices, faces = mesh``.

    Attributes:
        vertices: float64, V x 3.
        faces: int32, F x 3 where all faces are triangles, F x 4 where all are quads; of mixed faces F x K, the
            shorter ones filled up with -1. Every function of this package takes that.
        triangles: int32, T x 3: the faces cut into triangles, as renderers want them.
        corners, offsets: int32 C and int64 F + 1: the corners of face f are corners[offsets[f]:offsets[f + 1]].
        colors: float32, V x 4: red, green, blue, opacity in [0, 1]; or None.
        group_names, face_groups: the objects and groups of the file, and which of them each face is in; or [], None.
        notes: what was read otherwise than it stands in the file, a dict of "code" and "message" each.
    """

    def __init__(self, vertices, corners, offsets, triangles, colors=None, group_names=(), face_groups=None, notes=()):
        self.vertices = vertices
        self.corners = corners
        self.offsets = offsets
        self.triangles = triangles
        self.colors = colors
        self.group_names = list(group_names)
        self.face_groups = face_groups
        self.notes = list(notes)

    @property
    def faces(self):
        counts = np.diff(self.offsets)
        if counts.size == 0:
            return np.empty((0, 3), np.int32)
        most = int(counts.max())
        if int(counts.min()) == most:
            return self.corners.reshape(-1, most)
        rows = np.full((counts.size, most), -1, np.int32)
        rows[np.arange(most) < counts[:, None]] = self.corners
        return rows

    def __iter__(self):
        return iter((self.vertices, self.faces))

    def __repr__(self):
        return f"<cagewright.{type(self).__name__} of {len(self.vertices)} vertices and {len(self.offsets) - 1} faces>"


def arrays_of(mesh, owner):
    """The arguments of Mesh, on the memory of a mesh of the library's."""
    vertices, faces = lib.cw_mesh_vertex_count(mesh), lib.cw_mesh_face_count(mesh)
    groups = lib.cw_mesh_face_groups(mesh)
    colors = lib.cw_mesh_colors(mesh)
    return {
        "vertices": _arrays.view(owner, lib.cw_mesh_positions(mesh), (vertices, 3), "<f8"),
        "corners": _arrays.view(owner, lib.cw_mesh_corners(mesh), (lib.cw_mesh_corner_count(mesh),), "<i4"),
        "offsets": _arrays.view(owner, lib.cw_mesh_offsets(mesh), (faces + 1,), "<i8"),
        "triangles": _arrays.view(owner, lib.cw_mesh_triangles(mesh), (lib.cw_mesh_triangle_count(mesh), 3), "<i4"),
        "colors": _arrays.view(owner, colors, (vertices, 4), "<f4") if colors else None,
        "group_names": [lib.cw_mesh_group_name(mesh, group).decode("utf-8", "replace")
                        for group in range(lib.cw_mesh_group_count(mesh))],
        "face_groups": _arrays.view(owner, groups, (faces,), "<i4") if groups else None,
        "notes": json.loads(lib.cw_mesh_notes(mesh).decode("utf-8", "replace")),
    }


def read_mesh(source, *, format=None, pose="shown"):
    """Reads an OBJ, PLY, STL, OFF, GLB or glTF file.

    Args:
        source: a path, the bytes of a file, or an open binary file.
        format: of bytes: "obj", "ply", "stl", "off" or "gltf"; None: told by the content.
        pose: of a rigged glTF model: "shown", as a viewer shows it, or "bind", as it was bound to its joints.

    Returns:
        A Mesh; ``vertices, faces = read_mesh(path)``. Vertices and faces keep the order of the file.

    Raises:
        FileError: the file cannot be read. InputError: it is damaged, or of another kind; the message has the line.

    >>> vertices, faces = cagewright.read_mesh("armadillo.off")
    """
    if pose not in _POSES:
        raise ValueError(f'pose: {pose!r} is neither "shown" nor "bind"')
    if format is not None and not isinstance(format, str):
        raise ValueError(f"format: {format!r} is none of obj, ply, stl, off and gltf")
    if hasattr(source, "read"):
        source = source.read()
        if isinstance(source, str):
            raise TypeError('a file that was opened as text; open it with "rb", or give its path')
    content = bytes(source) if isinstance(source, (bytes, bytearray, memoryview)) else None
    name = path_bytes(source) if content is None else None

    def work(_control):
        out = ctypes.c_void_p()
        if content is None:
            checked(lib.cw_read_mesh, name, _POSES[pose], ctypes.byref(out))
        else:
            checked(lib.cw_parse_mesh, content, len(content), None if format is None else format.encode(), None,
                    _POSES[pose], ctypes.byref(out))
        return Handle(out.value, lib.cw_mesh_free)

    owner = run(work, None, None)
    return Mesh(**arrays_of(owner.pointer, owner))


def write_mesh(path, vertices, faces=None):
    """Writes an OBJ, PLY, STL, OFF, GLB or glTF file, by the extension.

    Reading it gives the same doubles; but glTF holds floats, and triangles for all faces, and STL no vertices that triangles
    share.

    Args:
        path: where to. The file appears only when it is complete.
        vertices, faces: V x 3 and F x K, as for generate(); or one object that has both.

    Raises:
        FileError: it cannot be written. InputError: another extension, or faces that make no sense.

    >>> cagewright.write_mesh("cage.obj", *cage)
    """
    name = path_bytes(path)
    vertices, faces = _arrays.two_parts(vertices, faces, "the mesh")
    mesh = _arrays.mesh_view(vertices, faces, "the mesh")
    run(lambda _control: checked(lib.cw_write_mesh, ctypes.byref(mesh), name), None, None)
