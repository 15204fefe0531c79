"""Cages round 3D models, proved valid, and models that follow their cages.

    import cagewright

    V, F = cagewright.read_mesh("armadillo.off")
    cage = cagewright.generate(V, F, num_vertices=60)        # a valid cage, or an exception that says why not
    deformer = cagewright.Deformer(V, F, *cage)
    moved = deformer(cage.vertices * [1, 1.2, 1])            # the model follows its cage
    cagewright.write_mesh("moved.obj", moved, F)

Start with help(cagewright.generate). The same doubles as the command line program makes; the GIL is released while the
library works; Ctrl-C is answered within half a second.
"""

from ._cages import Cage, Verdict, Violation, check, compare, generate, info, options
from ._deformation import CSR, Deformer, coordinate_kinds, coordinates, deform_file
from ._library import lib as _lib
from ._meshes import Mesh, read_mesh, write_mesh
from ._pictures import render
from .errors import (Cancelled, Error, FileError, InputError, NotAsAsked, NotAvailable, NoValidCage, TooLarge)

__version__ = _lib.cw_version().decode()
features = tuple(_lib.cw_features().decode().split())
licence = _lib.cw_licence().decode()

__all__ = ["CSR", "Cage", "Cancelled", "Deformer", "Error", "FileError", "InputError", "Mesh", "NoValidCage",
           "NotAsAsked", "NotAvailable", "TooLarge", "Verdict", "Violation", "check", "compare",
           "coordinate_kinds", "coordinates", "deform_file", "features", "generate", "info", "licence", "options",
           "read_mesh", "render", "write_mesh"]

for _name in __all__:  # tracebacks and help() name what users see, not the file it is written in
    if getattr(globals()[_name], "__module__", "").startswith("cagewright."):
        globals()[_name].__module__ = "cagewright"
del _name
