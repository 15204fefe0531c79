"""Cagewright by its shared library, through the Python package that the add-on carries."""

import warnings

from . import bindings
from .engine import Cage, Cancelled, Failure


def _said(call, *arguments, **named):
    """A call whose failures are ours."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", bindings.NotAsAsked)
            return call(*arguments, **named)
    except bindings.Cancelled:
        raise Cancelled() from None
    except (bindings.Error, ValueError) as error:
        raise Failure(str(error)) from None


class Engine:
    name = "library"
    has_all_kinds = True

    def describe(self):
        return f"Library {bindings.__version__}"

    def generate(self, vertices, faces, options, threads=None, progress=None, start=None):
        """A cage round a model. `options`: texts by their names on the command line. `start`: vertices and faces of a
        cage whose faces, and the order of whose vertices, are kept."""
        named = {name.replace("-", "_"): text for name, text in options.items()}
        if "vertices" in named:
            named["num_vertices"] = named.pop("vertices")
        if "faces" in named:
            named["num_faces"] = named.pop("faces")
        for name in ("quads", "registration"):
            if name in named:
                named[name] = named[name] == "on"
        if "max_gap" in named or "num_faces" in named:
            named.setdefault("num_vertices", None)
        made = _said(bindings.generate, vertices, faces, threads=threads, progress=progress, start=start, **named)
        return Cage(made.vertices.copy(), made.corners.copy(), made.offsets.copy(), made.report)

    def check(self, vertices, faces, cage_vertices, cage_faces, max_listed, threads=None, progress=None):
        """The report on a cage, as `cagewright check --json` has it."""
        verdict = _said(bindings.check, vertices, faces, cage_vertices, cage_faces, allow_pieces=True,
                        max_listed=max_listed, threads=threads, progress=progress)
        return dict(verdict.report, valid=bool(verdict))

    def deformer(self, vertices, faces, cage_vertices, cage_faces, kind, settings, threads=None, progress=None):
        """Something that is called with C cage vertices and returns P positions, a view."""
        return _said(bindings.Deformer, vertices, faces, cage_vertices, cage_faces, coordinates=kind, normals=False,
                     threads=threads, progress=progress, **settings)

    def weights(self, vertices, cage_vertices, cage_faces, kind, settings, threads=None, progress=None):
        """P x K weights, of which the first C are those of the cage's vertices."""
        return _said(bindings.coordinates, kind, vertices, cage_vertices, cage_faces, threads=threads,
                     progress=progress, **settings)
