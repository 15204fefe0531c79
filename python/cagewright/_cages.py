"""Cages: made, judged, compared; and what can be said of a model without one."""

import ctypes
import difflib
import inspect
import json
import warnings
from collections import namedtuple

import numpy as np

from . import _arrays
from ._calls import run, whole_number
from ._library import Handle, MeshView, checked, lib, take_text
from ._meshes import Mesh, arrays_of
from .errors import InputError, NotAsAsked, error_of


class _Default(int):
    """A number that can be told from the same number given by the caller."""


_DEFAULT_VERTICES = _Default(100)


class Cage(Mesh):
    """A cage that is proved valid: ``vertices, faces = cage``.

    Attributes, beside those of Mesh:
        report: all figures as a dict, as `cagewright generate --json` writes them: report["cage"]["volume_ratio"],
            ["mean_distance"], ["max_distance"] (distances in diagonals of the model's box), report["symmetry"] with the
            mirror plane and the partner of each vertex, report["times"], report["remarks"].
        is_as_asked: whether all that was asked for holds; if not, `remarks` says what does not.
        remarks: sentences.
    """

    def __init__(self, report, is_as_asked, **arrays):
        super().__init__(**arrays)
        self.report = report
        self.is_as_asked = is_as_asked

    @property
    def remarks(self):
        return [remark["message"] for remark in self.report["remarks"]]


def _text(value):
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return str(int(number)) if number.is_integer() else repr(number)  # 60.0 vertices are 60
    return str(value)


def options():
    """The options of generate(): a list of dicts with "name", "help", "values", "default", "label", "group".

    Those that are no arguments of their own are given by name, with underscores for dashes: depth=4.
    """
    out = ctypes.c_void_p()
    checked(lib.cw_options_describe, ctypes.byref(out))
    return json.loads(take_text(out.value))


def _bytes_of(text):
    """Text as the library takes it. A NUL would cut it short."""
    return text.replace("\0", "\N{REPLACEMENT CHARACTER}").encode(errors="surrogateescape")


def _refuse_unknown(names):
    known = [option["name"].replace("-", "_") for option in options()]
    arguments = [name for name in inspect.signature(generate).parameters if name not in ("vertices", "faces", "options")]
    for name in names:
        if name.replace("-", "_") not in known:
            near = difflib.get_close_matches(name, arguments + known, 1)
            raise error_of("invalid_option", f"generate() has no option {name}"
                           + (f"; did you mean {near[0]}?" if near else "; cagewright.options() lists those there are"))


_ARGUMENTS = {"vertices": "num_vertices", "faces": "num_faces"}  # of options that have another name here


def _options(given):
    handle = Handle(lib.cw_options_new(), lib.cw_options_free)
    for name, value in given.items():
        name = name.replace("_", "-")
        try:
            checked(lib.cw_options_set, handle.pointer, _bytes_of(name), _bytes_of(_text(value)))
        except InputError as error:  # in the caller's words
            argument = _ARGUMENTS.get(name, name.replace("-", "_"))
            raise error_of(error.code, str(error).replace(f"{name}: ", f"{argument}: ", 1)) from None
    return handle


def generate(vertices, faces=None, *, num_vertices=_DEFAULT_VERTICES, num_faces=None, max_gap=None, quads=False,
             clearance=0.002, method="envelope", symmetry="auto", pieces="together", density=None, joints=None, start=None,
             threads=None, progress=None, **options):
    """Makes a valid cage round a model.

    A cage is a coarse closed mesh round a model; moving its vertices deforms the model (see Deformer). "Valid" is
    decided exactly, on the very doubles that are returned: closed, manifold, oriented outward, no self-intersection,
    every vertex of the model strictly inside, no face of the model touching it.

    Args:
        vertices: the model, V x 3 numbers (float64 is read where it is, without a copy); or one thing that has both
            vertices and faces: what read_mesh() returns, a mesh of trimesh, PyVista, Open3D or meshio, a tuple of two,
            a dict with "vertices" and "faces".
        faces: integers of any width, counted from 0, one of
              - F x 3 triangles, F x 4 quads; -1 fills up shorter faces,
              - a list of lists of corners,
              - a tuple of two arrays (corners, offsets): face f has corners[offsets[f]:offsets[f + 1]],
              - one row 3, a, b, c, 4, d, e, f, g, ... as in PyVista.
            The model may be open, inverted, self-intersecting, or in several pieces. Bent quads are enclosed whichever way
            they are cut into triangles.
        num_vertices: the cage has at most so many vertices: 100 unless told otherwise, or no limit where num_faces or max_gap
            is given instead.
        num_faces: it has at most so many faces, a quad being one.
        max_gap: makes the coarsest cage no point of which is farther from the model than this.
        quads: quads where they can be, as artists like to edit; the cage is valid along both diagonals of each.
        clearance: the least distance between cage and model.
        method: "envelope" (tight, any topology), "boxes" (the union of oriented boxes), or "boxes-improved".
        symmetry: "auto" (an exact mirror image of itself where the model nearly is), "off", "x", "y", "z", or "topology"
            (of a model in a pose: faces and vertices are paired left to right, and follow the pose).
        pieces: of a model in pieces: "together" in one cage, or "apart" in one each.
        density: V weights above 0: four times the weight makes edges half as long there.
        joints: J x 3 points where limbs bend, or J x 6 with the direction in which each limb goes on: a ring of edges goes
            round the limb at each.
        start: a cage of your own, made by hand or for an earlier state of the model: an object with vertices and faces,
            or a pair of them. Its vertices are moved until it is valid and tight; its faces and the order of its
            vertices stay. Only clearance and density are heeded then.
        threads: at most so many; None: all cores. The cage is the same on any number.
        progress: called with a fraction from 0 to 1 and the name of the step; stops the work by returning False.
        options: any other of options(), such as depth=4, rounds=3, envelope_resolution=80.

    Lengths are parts of the diagonal of the model's bounding box: 0.002 or "0.2%".

    Returns:
        A Cage; ``V, F = generate(...)`` has its vertices (float64, n x 3) and faces (int32, m x 3; with quads m x 4,
        triangles ending in -1). Its `report` has all figures. If not all that was asked for can be had (no valid cage
        has so few vertices, say), the nearest valid cage is returned with a warning, NotAsAsked.

    Raises:
        InputError (a ValueError): no cage can be made of such a model or with such options. NoValidCage: none was found.
        Cancelled: progress returned False. KeyboardInterrupt: within half a second, with nothing half done.

    One to four seconds for 100 vertices round 50,000 triangles on two cores; quads take a few times as long.

    >>> V, F = cagewright.read_mesh("armadillo.off")
    >>> cage = cagewright.generate(V, F, num_vertices=60, quads=True)
    >>> cage.report["cage"]["volume_ratio"], cage.remarks           # how tight it is; what is not as asked for
    >>> cagewright.write_mesh("cage.obj", cage)
    >>> moved = cagewright.Deformer(V, F, cage)(cage.vertices * [1, 1.2, 1])
    """
    vertices, faces = _arrays.two_parts(vertices, faces, "the model")
    model = _arrays.mesh_view(vertices, faces, "the model")
    _refuse_unknown(options)
    given = {name: value for name, value in options.items() if value is not None}
    quads = quads if isinstance(quads, str) else bool(quads)
    for name, value, initial in [("method", method, "envelope"), ("symmetry", symmetry, "auto"),
                                 ("pieces", pieces, "together"), ("quads", quads, False),
                                 ("clearance", clearance, 0.002), ("faces", num_faces, None),
                                 ("max-gap", max_gap, None)]:
        if value is not None and value != initial:
            given[name] = value
    if num_vertices is not None and num_vertices is not _DEFAULT_VERTICES:
        given["vertices"] = num_vertices
    asked = _options(given)
    if density is not None:
        weights, _keep = _arrays.array_of(density if isinstance(density, str) else np.ravel(density), "the density")
        checked(lib.cw_options_set_density, asked.pointer, ctypes.byref(weights))
    if joints is not None:
        rows = np.atleast_2d(np.asarray(joints, float))
        points, _keep_points = _arrays.array_of(np.ascontiguousarray(rows[:, :3]), "the joints")
        along, _keep_along = _arrays.array_of(np.ascontiguousarray(rows[:, 3:]), "the joints' directions")
        checked(lib.cw_options_set_joints, asked.pointer, ctypes.byref(points),
                ctypes.byref(along) if rows.shape[1] > 3 else None)
    if start is not None:
        pair = start if isinstance(start, (tuple, list)) and len(start) == 2 else (start, None)
        own = _arrays.mesh_view(*_arrays.two_parts(*pair, "start"), "start")
        checked(lib.cw_options_set_start, asked.pointer, ctypes.byref(own))

    def work(control):
        out = ctypes.c_void_p()
        checked(lib.cw_generate, ctypes.byref(model), asked.pointer, ctypes.byref(control), ctypes.byref(out))
        return Handle(out.value, lib.cw_cage_free)

    made = run(work, threads, progress)
    report = json.loads(lib.cw_cage_report(made.pointer).decode("utf-8", "replace"))
    is_as_asked = bool(lib.cw_cage_is_as_asked(made.pointer))
    if not is_as_asked:
        warnings.warn("a valid cage, but not as asked for: " + report["remarks"][0]["message"], NotAsAsked, stacklevel=2)
    return Cage(report, is_as_asked, **arrays_of(lib.cw_cage_mesh(made.pointer), made))


class Violation(namedtuple("Violation", ["kind", "elements", "place", "message", "remedy"])):
    """One thing that is wrong with a cage.

    kind: a word such as "open_edge". elements: numbers of vertices or faces, from 0, as the message says.
    place: a point of it. message, remedy: sentences.
    """


class Verdict:
    """What check() says. True where the cage is valid.

    Attributes:
        violations: a list of Violation, at most `max_listed` of each kind.
        counts: a dict: how many there are of each kind.
        figures: a dict: "volume_ratio", "clearance", "mean_distance", "max_distance", "webbing", "min_quality"...
        notes: sentences about what is no fault, such as split vertices.
        report: all of it as a dict, as `cagewright check --json` writes it.
    """

    def __init__(self, is_valid, report):
        self._is_valid = is_valid
        self.report = report
        self.violations = [Violation(item["kind"], tuple(item["elements"]), tuple(item["place"]), item["message"],
                                     item["remedy"]) for item in report["violations"]]
        self.counts = report["counts"]
        self.figures = report["cage"]
        self.notes = [note["message"] for note in report["notes"]]

    def __bool__(self):
        return self._is_valid

    def __str__(self):
        if self:
            return "valid"
        return "\n".join(["not valid"] + ["  " + violation.message for violation in self.violations])

    def __repr__(self):
        found = ", ".join(f"{count} {kind}" for kind, count in self.counts.items() if count)
        return f"<cagewright.Verdict: {'valid' if self else 'not valid: ' + found}>"


def check(vertices, faces=None, cage_vertices=None, cage_faces=None, *, allow_pieces=False, allow_inner_shells=False,
          ignore_specks=False, max_listed=20, threads=None, progress=None):
    """Judges a cage of a model, exactly: valid, or what is wrong with it and where.

    Args:
        vertices, faces: the model, as for generate().
        cage_vertices, cage_faces: the cage, likewise. Objects that have both may stand for either: check(model, cage).
        allow_pieces: accept several closed pieces.
        allow_inner_shells: accept closed pieces within others, oriented inward.
        ignore_specks: judge it for the model without tiny pieces far from the rest, and without vertices that no face
            uses, as generate(..., ignore_specks=True) makes one.
        max_listed: how many violations of each kind are listed, None for all; all are counted.
        threads, progress: as for generate().

    Returns:
        A Verdict: ``if not check(V, F, C, G): ...``; print it, or look at its violations.

    >>> verdict = cagewright.check(V, F, *cage)
    >>> bool(verdict), verdict.figures["volume_ratio"]
    """
    parts = _arrays.four_parts(vertices, faces, cage_vertices, cage_faces)
    model = _arrays.mesh_view(*parts[:2], "the model")
    cage = _arrays.mesh_view(*parts[2:], "the cage")
    max_listed = 2**31 - 1 if max_listed is None else whole_number(max_listed, "max_listed")
    flags = (1 if allow_pieces else 0) + (2 if allow_inner_shells else 0) + (4 if ignore_specks else 0)

    def work(control):
        out = ctypes.c_void_p()
        checked(lib.cw_check, ctypes.byref(model), ctypes.byref(cage), flags, max_listed, ctypes.byref(control),
                ctypes.byref(out))
        return Handle(out.value, lib.cw_verdict_free)

    verdict = run(work, threads, progress)
    return Verdict(bool(lib.cw_verdict_is_valid(verdict.pointer)),
                   json.loads(lib.cw_verdict_report(verdict.pointer).decode("utf-8", "replace")))


def _parts_of_cage(cage):
    return _arrays.two_parts(cage, None, "the cage")


def compare(vertices, faces=None, *cages, names=None, poses=True, threads=None, progress=None):
    """Figures of several cages of a model, valid or not, and how well the model follows each through a standard bend
    and twist.

    Args:
        vertices, faces: the model, as for generate(); or an object that has both, then cages follow at once.
        cages: pairs (vertices, faces), or objects that have both.
        names: what the cages are called in the result; None: "cage 1", "cage 2"...
        poses: False leaves out the bend and the twist, which take longest on large models.
        threads, progress: as for generate().

    Returns:
        A list of dicts, one for each cage, as `cagewright compare --json` has them: "valid", "vertices", "faces",
        "volume_ratio", "clearance", "mean_distance", "max_distance", "webbing", "poses" and more. Lengths are in
        diagonals of the model's box.

    >>> coarse, fine = generate(V, F, num_vertices=50), generate(V, F, num_vertices=200)
    >>> for figures in cagewright.compare(V, F, coarse, fine): print(figures["vertices"], figures["mean_distance"])
    """
    if faces is not None and _arrays.parts_of(vertices) is not None:
        faces, cages = None, (faces, *cages)
    vertices, faces = _arrays.two_parts(vertices, faces, "the model")
    model = _arrays.mesh_view(vertices, faces, "the model")
    views = [_arrays.mesh_view(*_parts_of_cage(cage), f"cage {i}") for i, cage in enumerate(cages, 1)]
    if names is not None and len(names) != len(cages):
        raise ValueError(f"names: {len(names)} names for {len(cages)} cages")
    called = (ctypes.c_char_p * len(views))(*[str(name).encode() for name in names or
                                             [f"cage {i}" for i in range(1, len(views) + 1)]])
    block = (MeshView * len(views))(*views)

    def work(control):
        out = ctypes.c_void_p()
        checked(lib.cw_compare, ctypes.byref(model), block, called, len(views), int(bool(poses)),
                ctypes.byref(control), ctypes.byref(out))
        return take_text(out.value)

    result = json.loads(run(work, threads, progress))
    del views
    return result


def info(vertices, faces=None, *, resolution=64, threads=None, progress=None):
    """Describes a model: counts, topology, defects, sizes, boxes, mirror plane.

    Args:
        vertices, faces: the model, as for generate().
        resolution: voxels along the longest axis, for the box of vertices and voxels; 2 to 4096.
        threads, progress: as for generate().

    Returns:
        A dict as `cagewright info --json` writes it: "closed", "manifold", "oriented", "components", "genus",
        "boundary_edges", "self_intersecting_pairs", "volume", "diagonal", "boxes", "mirror_plane" and more.

    >>> cagewright.info(V, F)["genus"]
    """
    vertices, faces = _arrays.two_parts(vertices, faces, "the model")
    model = _arrays.mesh_view(vertices, faces, "the model")
    resolution = whole_number(resolution, "resolution", 1)

    def work(control):
        out = ctypes.c_void_p()
        checked(lib.cw_info, ctypes.byref(model), resolution, ctypes.byref(control), ctypes.byref(out))
        return take_text(out.value)

    return json.loads(run(work, threads, progress))
