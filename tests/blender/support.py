"""What the tests in Blender share: the add-on from its zip, models as objects, and our own program to compare with."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import bpy
import mathutils
import numpy as np

if not hasattr(np, "bool"):
    np.bool = bool  # the glTF importer of Debian's Blender 3.4 was written for an older numpy

ZIP, PROGRAM, MODELS, HOME = (pathlib.Path(argument) for argument in sys.argv[sys.argv.index("--") + 1:])
SAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "samples"


bpy.ops.preferences.addon_install(filepath=str(ZIP), overwrite=True)
bpy.ops.preferences.addon_enable(module="cagewright")

from cagewright import bindings, binding, engine, geometry, program_engine  # noqa: E402


def main():
    only = os.environ.get("ONLY")
    run = unittest.main(argv=["test"] + (["-k", only] if only else []), exit=False, verbosity=1)
    sys.stderr.flush()
    if not run.result.wasSuccessful():
        sys.exit(1)


def model_path(name):
    path = SAMPLES / name
    if not path.exists():
        path = MODELS / name
    if not path.exists():
        raise unittest.SkipTest(f"{name} is not here")
    return path


def empty():
    """A file with nothing in it."""
    bpy.ops.wm.read_homefile(use_empty=True)
    # As quick as can be: how good cages are is tested elsewhere.
    bpy.context.scene.cagewright.vertices = 60
    bpy.context.scene.cagewright.rounds = 0


def add_mesh(name, points, corners, offsets):
    obj = bpy.data.objects.new(name, geometry.new_mesh(name, np.asarray(points, float), corners, offsets))
    bpy.context.scene.collection.objects.link(obj)
    return obj


def add_model(name):
    """A model of a file as an object, its numbers as they are: read by our library, but for glTF."""
    path = model_path(name)
    if path.suffix == ".glb":
        before = set(bpy.data.objects)
        bpy.ops.import_scene.gltf(filepath=str(path))
        found = [obj for obj in set(bpy.data.objects) - before if obj.type == "MESH" and obj.vertex_groups]
        return found[0]
    mesh = bindings.read_mesh(path)
    return add_mesh(path.stem, mesh.vertices, mesh.corners, mesh.offsets)


def add_torus():
    """A small model."""
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=8)
    return bpy.context.object


def add_box(model, cuts=2, margin=0.1):
    """A cage of a box round what a model shows, of squares: quicker to have than a made one."""
    around = shown(model)
    low, high = around.min(axis=0), around.max(axis=0)
    size = np.linalg.norm(high - low)
    bpy.ops.mesh.primitive_cube_add(size=1)
    box = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=cuts)
    bpy.ops.object.mode_set(mode="OBJECT")
    set_points(box, (low + high) / 2 + points(box) * (high - low + 2 * margin * size))
    box.name = "Box"
    return box


def select(*objects):
    """These are selected, the last one is active."""
    for obj in bpy.context.view_layer.objects:
        obj.select_set(False)
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[-1]


def generate(*models):
    """A cage for a model by the operator."""
    select(*models)
    assert bpy.ops.cagewright.generate() == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def bind(*objects):
    select(*objects)
    assert bpy.ops.cagewright.bind() == {"FINISHED"}


def shown(obj, world=True):
    """P x 3: where the vertices are on the screen."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    with geometry.Evaluated(obj, depsgraph) as mesh:
        points = geometry.points_of(mesh)
    matrix = geometry.matrix_of(obj.evaluated_get(depsgraph).matrix_world)
    return geometry.transformed(points, matrix) if world else points


def points(obj):
    return geometry.points_of(obj.data)


def set_points(obj, values):
    obj.data.vertices.foreach_set("co", np.asarray(values, np.float32).ravel())
    obj.data.update()
    bpy.context.view_layer.update()


def diagonal(values):
    return np.linalg.norm(np.ptp(values, axis=0))


def bent(values):
    """A cage bent and twisted a little, which moves each of its vertices in its own way."""
    size = diagonal(values)
    middle = values.mean(axis=0)
    x, y, z = ((values - middle) / size).T
    return values + size * 0.2 * np.stack([0.5 * y * y + 0.2 * z, 0.3 * x * z, 0.4 * x * x - 0.2 * y], axis=1)


def by_program(model, model_faces, cage, cage_faces, posed, *options):
    """Where our own program puts the model, positions as doubles all the way."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program_engine.write_ply(folder / "model.ply", model, *model_faces)
        program_engine.write_ply(folder / "cage.ply", cage, *cage_faces)
        program_engine.write_ply(folder / "posed.ply", posed, *cage_faces)
        subprocess.run([PROGRAM, "deform", "model.ply", "cage.ply", "posed.ply", "-o", "out.ply", "--quiet", *options],
                       cwd=folder, check=True, stderr=subprocess.PIPE)
        return program_engine.read_ply(folder / "out.ply")[0]


class Test(unittest.TestCase):
    def setUp(self):
        empty()

    def assertNear(self, found, wanted, tolerance, size=None):
        """Points are as near as a part of the size."""
        worst = np.abs(np.asarray(found) - np.asarray(wanted)).max()
        self.assertLessEqual(worst, tolerance * (size or diagonal(np.asarray(wanted))))
