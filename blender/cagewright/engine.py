"""The door to Cagewright: its library where it can be loaded, else its program.

Both engines have the same functions, take and return numpy arrays, and raise Failure with a sentence for people. They
may be called from any thread.
"""

import json
import pathlib

HERE = pathlib.Path(__file__).parent


class Failure(Exception):
    """What Cagewright, or this add-on, says when something cannot be had."""


class Cancelled(Exception):
    """The user asked to stop."""


class Cage:
    """A cage that was made: C vertices, and faces as corners and offsets (F + 1)."""

    def __init__(self, vertices, corners, offsets, report):
        self.vertices = vertices
        self.corners = corners
        self.offsets = offsets
        self.report = report

    @property
    def remarks(self):
        return [remark["message"] for remark in self.report.get("remarks", [])]


_engine = None
_why_no_library = ""


def get():
    """The engine: the library, or the program named in the preferences. Failure: there is neither."""
    global _engine, _why_no_library
    if _engine is None:
        try:
            from . import library_engine
            _engine = library_engine.Engine()
        except (ImportError, OSError, AttributeError) as error:
            _why_no_library = str(error)
    if _engine is not None:
        return _engine
    from . import program_engine
    return program_engine.Engine(why_no_library=_why_no_library)


def use(engine):
    """Another engine from now on; None: the one that is found."""
    global _engine
    _engine = engine


def _described(name):
    """What the library says of its options, written into the add-on when it was packed."""
    return json.loads((HERE / name).read_text(encoding="utf-8"))


def options():
    """The options of generating, as the command line has them."""
    return _described("options.json")


def kinds():
    """The kinds of coordinates, and the options of each."""
    return _described("coordinates.json")["kinds"]
