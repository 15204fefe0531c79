"""Models that follow their cages."""

import ctypes
import json
import os
from collections import namedtuple

import numpy as np

from . import _arrays
from ._calls import control as quick_control
from ._calls import run
from ._library import Array, DeformerOptions, Handle, SequenceOptions, checked, lib, path_bytes, take_text

_STORAGES = {"single": 0, "full": 1, "compact": 2}


def _settings_text(settings):
    """quads="diagonal", poisson_ratio=0.3 -> b"quads=diagonal poisson-ratio=0.3"."""
    words = [f"{name.replace('_', '-')}={value}" for name, value in settings.items() if value is not None]
    return " ".join(words).encode() if words else None


def _kind_bytes(kind):
    if not isinstance(kind, str):
        raise ValueError(f"the kind of coordinates is a word, such as \"mean_value\", not {kind!r}")
    return kind.encode()


class CSR(namedtuple("CSR", ["data", "indices", "indptr", "shape"])):
    """A sparse matrix in the form of scipy's csr_matrix:
    ``scipy.sparse.csr_matrix((w.data, w.indices, w.indptr), shape=w.shape)``.
    """

    def toarray(self):
        """All of it, zeros included."""
        dense = np.zeros(self.shape)
        rows = np.repeat(np.arange(self.shape[0]), np.diff(self.indptr))
        dense[rows, self.indices] = self.data
        return dense


def coordinate_kinds():
    """The kinds that coordinates() and Deformer take: a list of dicts with "name", "idea" (a sentence), "reproduces",
    "outside", "cost" and more, and "options", each with "name", "help", "default" and "words", or "least" and "most".

    >>> cagewright.coordinate_kinds()[0]["name"]
    'mean_value'
    """
    out = ctypes.c_void_p()
    checked(lib.cw_coordinates_describe, ctypes.byref(out))
    return json.loads(take_text(out.value))["kinds"]


def coordinates(kind, points, cage_vertices, cage_faces=None, *, sparse=False, threads=None, progress=None, **settings):
    """How much each point follows each vertex of a cage.

    Args:
        kind: of coordinates, one of those of coordinate_kinds(): "mean_value" (defined everywhere, exact on the cage), "green"
            (bends and twists without shearing), and others.
        points: P x 3, in the cage's units.
        cage_vertices, cage_faces: a closed cage, as the model of generate(); or an object that has both.
        sparse: leave out zeros: a CSR instead of an array.
        threads, progress: as for generate().
        settings: of the kind: quads="center" (four triangles round the middle of each quad) or "diagonal" (two).

    Returns:
        float64, P x C weights W: rows sum to 1, and ``W @ cage_vertices`` gives the points; ``W @ moved_vertices``
        where they go. With sparse=True a CSR of the same. Kinds that follow more than the vertices have columns for
        that behind those of the vertices, as "green" has for the normals of faces: a Deformer knows how to apply them.

    Raises:
        InputError: the cage is open, or there is no such kind or setting.

    >>> W = cagewright.coordinates("mean_value", V, *cage)
    >>> moved = W @ posed_cage_vertices
    """
    cage_vertices, cage_faces = _arrays.two_parts(cage_vertices, cage_faces, "the cage")
    cage = _arrays.mesh_view(cage_vertices, cage_faces, "the cage")
    where, keep = _arrays.finite_points(points, "the points")
    kind, text = _kind_bytes(kind), _settings_text(settings)
    if sparse:
        return _sparse(kind, text, where, cage, threads, progress)
    columns = ctypes.c_size_t()
    checked(lib.cw_coordinate_columns, kind, text, ctypes.byref(cage), ctypes.byref(columns))

    def work(control):
        weights = np.empty((where.rows, columns.value))
        checked(lib.cw_coordinates, kind, text, ctypes.byref(where), ctypes.byref(cage),
                ctypes.byref(control), weights.ctypes.data, columns.value)
        return weights

    weights = run(work, threads, progress)
    del keep
    return weights


def _sparse(kind, settings, points, cage, threads, progress):
    """The weights that are not 0; the others are never in memory."""
    def work(control):
        out = ctypes.c_void_p()
        checked(lib.cw_coordinates_sparse, kind, settings, ctypes.byref(points), ctypes.byref(cage), ctypes.byref(control),
                ctypes.byref(out))
        return Handle(out.value, lib.cw_sparse_free)

    matrix = run(work, threads, progress)
    count, rows = lib.cw_sparse_value_count(matrix.pointer), lib.cw_sparse_row_count(matrix.pointer)
    return CSR(_arrays.view(matrix, lib.cw_sparse_values(matrix.pointer), (count,), "<f8"),
               _arrays.view(matrix, lib.cw_sparse_columns(matrix.pointer), (count,), "<i4"),
               _arrays.view(matrix, lib.cw_sparse_offsets(matrix.pointer), (rows + 1,), "<i8"),
               (rows, lib.cw_sparse_column_count(matrix.pointer)))


class Deformer:
    """A model bound to a cage, for moving it again and again.

    Args:
        vertices, faces: the model, P vertices, as for generate().
        cage_vertices, cage_faces: its cage at rest, C vertices. Objects that have both may stand for either.
        coordinates: the kind, one of those of coordinate_kinds(), as for coordinates().
        storage: how weights are kept: "single" (floats), "full" (doubles), or "compact" (16 bits).
        normals: keep normals up to date.
        threads, progress: as for generate(). `threads` holds for later moves, too.
        settings: of the kind of coordinates.

    The arrays that `positions`, `normals` and `cage_positions` give are *views* of the deformer's memory: they are not
    copied, cannot be written to, and change whenever the cage moves. Copy what you want to keep.

    >>> deformer = cagewright.Deformer(V, F, *cage)
    >>> moved = deformer(posed_cage_vertices).copy()
    >>> deformer.move(7, [0.1, 2.0, 0.3])     # one vertex of the cage: quicker than all
    >>> deformer.positions, deformer.normals
    """

    def __init__(self, vertices, faces=None, cage_vertices=None, cage_faces=None, *, coordinates="mean_value",
                 storage="single", normals=True, threads=None, progress=None, **settings):
        if storage not in _STORAGES:
            raise ValueError(f'storage: {storage!r} is none of "single", "full" and "compact"')
        parts = _arrays.four_parts(vertices, faces, cage_vertices, cage_faces)
        model = _arrays.mesh_view(*parts[:2], "the model")
        cage = _arrays.mesh_view(*parts[2:], "the cage")
        options = DeformerOptions(size=ctypes.sizeof(DeformerOptions), coordinates=_kind_bytes(coordinates),
                                  settings=_settings_text(settings), storage=_STORAGES[storage],
                                  no_normals=int(not normals))

        def work(control):
            out = ctypes.c_void_p()
            checked(lib.cw_deformer_bind, ctypes.byref(model), ctypes.byref(cage), ctypes.byref(options),
                    ctypes.byref(control), ctypes.byref(out))
            return Handle(out.value, lib.cw_deformer_free)

        self._handle = run(work, threads, progress)
        self._control = quick_control(threads)
        pointer = self._handle.pointer
        self._points = (lib.cw_deformer_vertex_count(pointer), 3)
        self._cage_points = (lib.cw_deformer_cage_vertex_count(pointer), 3)

    def __reduce__(self):
        raise TypeError("a Deformer is memory of the library's, and cannot be copied or pickled; make another one of the same "
                        "model and cage")

    def __call__(self, cage_vertices):
        """Moves all vertices of the cage, and the model with them.

        Args:
            cage_vertices: C x 3; or an object that has them as vertices, such as another Cage.

        Returns:
            `positions`: a view, which the next move changes.
        """
        parts = _arrays.parts_of(cage_vertices)
        if parts is not None:
            cage_vertices = parts[0]
        to, keep = _arrays.finite_points(cage_vertices, "the cage's vertices")
        checked(lib.cw_deformer_set_cage, self._handle.pointer, ctypes.byref(to), ctypes.byref(self._control))
        del keep
        return self.positions

    def move(self, vertices, to):
        """Moves some vertices of the cage, and the model with them. Moving k costs k / C of moving all.

        Args:
            vertices: the number of a vertex, or k of them.
            to: x, y, z; or k x 3.

        Returns:
            `positions`: a view, which the next move changes.
        """
        vertices = np.atleast_1d(vertices)
        if vertices.size and vertices.dtype.kind not in "iu":
            raise ValueError(f"the numbers of vertices are integers, not {vertices.dtype}; of a mask numpy.flatnonzero() makes them")
        which, keep = _arrays.array_of(vertices, "the numbers of vertices", np.int64)
        if np.size(to) != 3 * np.size(vertices) or np.shape(to)[-1:] != (3,):
            raise ValueError(f"the positions: x, y, z for each of {np.size(vertices)} vertices, not numbers of the shape "
                             f"{np.shape(to)}")
        where, keep_too = _arrays.finite_points(np.reshape(to, (-1, 3)), "the positions")
        checked(lib.cw_deformer_move, self._handle.pointer, ctypes.byref(which), ctypes.byref(where),
                ctypes.byref(self._control))
        del keep, keep_too
        return self.positions

    @property
    def positions(self):
        """Where the model is now: float64, P x 3, a view."""
        return self._view(lib.cw_deformer_positions, self._points)

    @property
    def normals(self):
        """Unit normals of the model's vertices: float64, P x 3, a view; None without normals."""
        if not lib.cw_deformer_normals(self._handle.pointer):
            return None
        return self._view(lib.cw_deformer_normals, self._points)

    @property
    def cage_positions(self):
        """Where the cage is now: float64, C x 3, a view."""
        return self._view(lib.cw_deformer_cage_positions, self._cage_points)

    @property
    def unbound(self):
        """How many vertices of the model have no weights, and stay where they are."""
        return lib.cw_deformer_unbound_count(self._handle.pointer)

    @property
    def weight_bytes(self):
        """Memory of the weights."""
        return lib.cw_deformer_weight_bytes(self._handle.pointer)

    def _view(self, function, shape):
        return _arrays.view(self._handle, function(self._handle.pointer), shape, "<f8", writable=False)


def _is_path(thing):
    return isinstance(thing, (str, bytes, os.PathLike))


def _listed(posed):
    """Poses of a cage, each a path, an array of C x 3, or an object with vertices."""
    if _is_path(posed) or _arrays.parts_of(posed) is not None:
        return [posed]
    try:
        posed = posed if isinstance(posed, np.ndarray) else list(posed)
    except TypeError:
        raise TypeError("posed: give the path or the vertices of the cage, or a list of them, not a "
                        f"{type(posed).__name__}") from None
    if len(posed) and not _is_path(posed[0]) and _arrays.parts_of(posed[0]) is None and np.ndim(posed[0]) == 1:
        return [posed]  # one array of C x 3
    return list(posed)


def _poses_of(posed):
    """The same as the library takes it: paths, or arrays; and what must stay alive."""
    poses = _listed(posed)
    if any(map(_is_path, poses)):
        if not all(map(_is_path, poses)):
            raise TypeError("posed: paths and arrays cannot be mixed; read the files with read_mesh()")
        return (ctypes.c_char_p * len(poses))(*map(path_bytes, poses)), None, len(poses), None
    pairs = []
    for i, pose in enumerate(poses):
        parts = _arrays.parts_of(pose)
        pairs.append(_arrays.finite_points(pose if parts is None else parts[0], f"pose {i}"))
    return None, (Array * len(poses))(*[array for array, _keep in pairs]), len(poses), pairs


def deform_file(model, cage, posed, out, *, coordinates="mean_value", fps=24, first_frame=1, threads=None, progress=None,
                **settings):
    """Moves the model in a file as its cage has moved, and writes it: the same file with other positions and normals,
    texture coordinates, materials, groups and all else as they were. Or a whole sequence at once.

    Args:
        model: path of the model: OBJ, PLY, STL, OFF, GLB or glTF.
        cage: path of its cage at rest, C vertices.
        posed: the cage with its vertices moved: a path, an array of C x 3, or an object with vertices. For a sequence a
            list of them, in the order of the frames, or an array of F x C x 3.
        out: path to write; none of the others. For a sequence one that holds the movement: a point cache (.pc2, .mdd)
            or an animated .glb (each frame a morph target); or a list of paths, one for each pose.
        coordinates: the kind, one of those of coordinate_kinds(), as for coordinates().
        fps, first_frame: frames a second, and the number of the first, of a movement in one file.
        threads, progress: as for generate().
        settings: of the kind of coordinates.

    Returns:
        Sentences about what was taken otherwise than it stands; usually none.

    Raises:
        FileError: a file cannot be read or written. InputError: cage and pose do not belong together, and the like.

    >>> cagewright.deform_file("hero.glb", "cage.obj", "cage_waving.obj", "hero_waving.glb")
    >>> frames = [cage.vertices + [0, 0.1 * i, 0] for i in range(24)]
    >>> cagewright.deform_file("hero.obj", "cage.obj", frames, "hero.pc2", fps=30)
    """
    paths, arrays, count, keep = _poses_of(posed)
    outs = [out] if _is_path(out) else list(out)
    names = (ctypes.c_char_p * len(outs))(*map(path_bytes, outs))
    model, cage = path_bytes(model), path_bytes(cage)
    try:
        options = SequenceOptions(size=ctypes.sizeof(SequenceOptions), coordinates=_kind_bytes(coordinates),
                                  settings=_settings_text(settings), frames_per_second=fps, first_frame=first_frame)
    except TypeError:
        raise ValueError(f"fps and first_frame are numbers, not {fps!r} and {first_frame!r}") from None
    if not fps > 0:
        raise ValueError(f"fps: {fps!r} is no number of frames a second; give one above 0")

    def work(control):
        notes = ctypes.c_void_p()
        checked(lib.cw_deform_sequence, model, cage, paths, arrays, count, names, len(outs), ctypes.byref(options),
                ctypes.byref(control), ctypes.byref(notes))
        return take_text(notes.value)

    said = run(work, threads, progress)
    del keep
    return [note["message"] for note in json.loads(said)]
