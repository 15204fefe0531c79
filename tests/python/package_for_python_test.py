"""The Python package: arrays of all kinds in, views out, the same doubles as the command line, stops when asked.

package_for_python_test.py FOLDER_OF_PACKAGE PROGRAM [unittest arguments]
"""

import ast
import contextlib
import copy
import gc
import importlib.util
import inspect
import io
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock
import warnings

PACKAGE, PROGRAM = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PACKAGE))
try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed (Debian: python3-numpy)")
    sys.exit(77)

import cagewright  # noqa: E402
from cagewright import _arrays  # noqa: E402
from cagewright._library import lib  # noqa: E402

QUICK = {"num_vertices": 60, "envelope_resolution": 16, "rounds": 1, "symmetry": "off"}
QUICK_WORDS = ["--envelope-resolution", "16", "--rounds", "1", "--symmetry", "off"]
# Where any cage will do.
QUICKEST = {"method": "boxes", "depth": 1, "resolution": 12} if "boxes" in cagewright.features else QUICK


def ring(around=24, across=12):
    """A ring of quads, thicker on one side."""
    a, b = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    thickness = 0.3 + 0.1 * np.cos(a)
    V = np.stack([(1 + thickness * np.cos(b)) * np.cos(a), (1 + thickness * np.cos(b)) * np.sin(a),
                  thickness * np.sin(b)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    at = lambda i, j: (i % around) * across + j % across  # noqa: E731
    return V, np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], axis=-1).reshape(-1, 4)


def bent_ring(around=4, across=3, seed=1):
    """A ring of quads with corners in disorder, their middle here or there."""
    V, quads = ring(around, across)
    return V + np.random.default_rng(seed).random(V.shape) - 0.5, quads


V, QUADS = ring()
F = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
CAGE = cagewright.generate(V, F, **QUICK)


class Thing:
    def __init__(self, **members):
        self.__dict__.update(members)


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words):
        done = subprocess.run([str(PROGRAM), *map(str, words)], capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        return done


class ArraysIn(unittest.TestCase):
    def setUp(self):
        self.expected = cagewright.info(V, F, resolution=8)

    def assert_same(self, *mesh):
        self.assertEqual(cagewright.info(*mesh, resolution=8), self.expected)

    def test_integers_of_any_width(self):
        for kind in ("int16", "uint16", "int32", "uint32", "int64", "uint64", ">i4", ">i8"):
            with self.subTest(kind=kind):
                self.assert_same(V, F.astype(kind))
        small = F[(F < 100).all(axis=1)]
        self.assertEqual(cagewright.info(V, small.astype("uint8"), resolution=8), cagewright.info(V, small, resolution=8))

    def test_forms_of_faces(self):
        rows = np.column_stack([np.full(len(F), 3), F])
        self.assert_same(V, F.tolist())
        self.assert_same(V, [tuple(face) for face in F])
        self.assert_same(V, (F.ravel(), 3 * np.arange(len(F) + 1)))
        self.assert_same(V, (F.ravel().astype("uint16"), 3 * np.arange(len(F), dtype="int16")))
        self.assert_same(V, np.column_stack([F, np.full(len(F), -1)]))
        self.assert_same(V, rows.ravel())

    def test_mixed_faces(self):
        mixed = [list(face) for face in QUADS[:100]] + [list(face) for face in F[100:288]] + [list(f) for f in F[388:]]
        expected = cagewright.info(V, mixed, resolution=8)
        self.assertEqual(expected["faces_by_sides"], {"3": 376, "4": 100})
        padded = np.array([face + [-1] * (4 - len(face)) for face in mixed])
        runs = np.array([number for face in mixed for number in [len(face), *face]])
        ragged = np.empty(len(mixed), object)
        ragged[:] = mixed
        for faces in (padded, runs, ragged):
            self.assertEqual(cagewright.info(V, faces, resolution=8), expected)

    def test_coordinates_of_any_layout(self):
        padded = np.zeros((len(V), 7))
        padded[:, ::3] = V
        for points in (np.asfortranarray(V), padded[:, ::3], V[::-1][::-1], V.tolist(), V.astype(">f8"),
                       V.astype(np.longdouble)):
            self.assert_same(points, F)
        floats = V.astype("float32")
        self.assertEqual(cagewright.info(floats, F, resolution=8), cagewright.info(floats.astype(float), F, resolution=8))
        integers = np.round(V * 100).astype(int)
        self.assertEqual(cagewright.info(integers, F, resolution=8), cagewright.info(integers * 1.0, F, resolution=8))
        with self.assertRaises(cagewright.Error):  # one number for all, with strides of 0
            cagewright.generate(np.broadcast_to(1.0, V.shape), F)

    def test_objects_of_other_libraries(self):
        self.assert_same(Thing(vertices=V, faces=F))                                                # trimesh
        self.assert_same(Thing(points=V, faces=np.column_stack([np.full(len(F), 3), F]).ravel()))   # PyVista
        self.assert_same(Thing(vertices=V.tolist(), triangles=F.tolist()))                          # Open3D
        model = Thing(vertices=V, faces=F)
        for arguments in [(V, F, CAGE.vertices, CAGE.faces), (model, CAGE), (V, F, CAGE), (model, None, CAGE),
                          (model, CAGE.vertices, CAGE.faces)]:
            self.assertTrue(cagewright.check(*arguments))

    def test_pairs_and_whole_meshes(self):
        cells = [Thing(type="line", data=np.array([[0, 1]])), Thing(type="triangle", data=F)]
        for mesh in ((V, F), (V.tolist(), F.tolist()), {"vertices": V, "faces": F}, Thing(points=V, cells=cells)):  # meshio
            self.assert_same(mesh)
            self.assertTrue(cagewright.check(mesh, CAGE))
            self.assertTrue(cagewright.check(mesh, tuple(CAGE)))
        self.assert_same(V, iter(F.tolist()))
        self.assert_same(V, (F.ravel().tolist(), list(range(0, F.size + 1, 3))))
        self.assert_same(V, (F.ravel().tolist(), 3 * np.arange(len(F))))
        two = [[0, 12, 13], [0, 13, 1]]  # not corners and offsets
        expected = cagewright.info(V, np.array(two), resolution=8)
        for faces in (two, tuple(two), tuple(map(tuple, two))):
            self.assertEqual(cagewright.info(V, faces, resolution=8), expected)
        with self.assertRaisesRegex(TypeError, "tetra are no surface"):
            cagewright.info(Thing(points=V, cells=[Thing(type="tetra", data=F)]))

    def test_are_not_copied(self):
        # That the library does not copy what it is pointed to is tested in C++: tests/c/arrays_test.cpp.
        for kind in ("int32", "uint32"):
            faces = F.astype(kind)
            mesh = _arrays.mesh_view(V, faces, "the model")
            self.assertEqual(mesh.positions.data, V.ctypes.data)
            self.assertEqual(mesh.faces.data, faces.ctypes.data)
        columns = np.asfortranarray(V)
        self.assertEqual(_arrays.mesh_view(columns, F, "the model").positions.data, columns.ctypes.data)
        mesh = _arrays.mesh_view(*_arrays.parts_of(CAGE), "the cage")
        self.assertEqual(mesh.positions.data, CAGE.vertices.ctypes.data)
        self.assertEqual(mesh.faces.data, CAGE.corners.ctypes.data)

    def test_are_left_as_they_are(self):
        points, faces = V.copy(), F.copy()
        points.flags.writeable = faces.flags.writeable = False
        cagewright.Deformer(points, faces, *CAGE)(CAGE.vertices * 2)
        self.assertTrue((points == V).all() and (faces == F).all())

    def test_refusals_are_sentences(self):
        wrong = F.copy()
        wrong[7, 1] = 9999
        for arguments, words in [
            ((V, wrong), "row 7 refers to vertex 9999, but there are 288"),
            ((V, F * 1.0), "integers"),
            ((V[:, :2], F), "2 columns"),
            ((V, F[:, :2]), "2 corners"),
            ((V, np.arange(10)), "corners, offsets"),
            (("model.obj", F), "no array of numbers"),
            ((V * 1j, F), "no array of numbers"),
            ((np.zeros((2, 3, 4)), F), "3 dimensions"),
            ((V[:0], F[:0]), ""),
        ]:
            with self.subTest(words=words), self.assertRaises(ValueError) as raised:
                cagewright.generate(*arguments)
            self.assertIn(words, str(raised.exception))
        with self.assertRaisesRegex(TypeError, "faces are missing"):
            cagewright.generate(V)
        deformer = cagewright.Deformer(V, F, CAGE)
        for wrong, words in [
            (lambda: cagewright.generate("model.obj"), "read_mesh"),
            (lambda: cagewright.generate(V.ravel(), F), "reshape"),
            (lambda: cagewright.generate(V, F, num_vertice=60), "did you mean num_vertices"),
            (lambda: cagewright.generate(V, F, num_vertices=-3), "^num_vertices: "),
            (lambda: cagewright.generate(V, F, num_faces=2.5), "^num_faces: "),
            (lambda: cagewright.generate(V, F, max_gap=-1), "^max_gap: "),
            (lambda: cagewright.generate(V, F, density="file.npy"), "the density: .* this str"),
            (lambda: cagewright.generate(V, F, depth="1\0"), "depth: "),
            (lambda: copy.deepcopy(deformer), "cannot be copied"),
            (lambda: pickle.dumps(deformer), "cannot be copied or pickled"),
            (lambda: cagewright.generate(V, F, depth="\udc80"), "depth: "),
            (lambda: cagewright.generate(V, F, progress=3), "progress: 3 cannot be called"),
            (lambda: cagewright.info(V, F, resolution=8.0), "resolution: 8.0 is not a whole number"),
            (lambda: cagewright.check(V, F, CAGE, max_listed=-1), "max_listed: -1"),
            (lambda: cagewright.coordinates("mean_value", V[0], CAGE), "reshape"),
            (lambda: cagewright.coordinates("mean_value", [[0, 0, float("nan")]], CAGE), "row 0 .* not a finite"),
            (lambda: cagewright.coordinates("mean_value", V, CAGE, teapot=3), "^teapot: "),
            (lambda: deformer.move(1, [0, 0]), "x, y, z for each"),
            (lambda: deformer.move(1, None), "x, y, z for each"),
            (lambda: cagewright.read_mesh(b"v 0 0 0", format=3), "format: 3"),
            (lambda: cagewright.read_mesh(io.StringIO("v 0 0 0")), "rb"),
            (lambda: cagewright.write_mesh(V, F, "cage.obj"), "PathLike"),
            (lambda: cagewright.render(V, F, views=None), "views: None"),
            (lambda: cagewright.render(V, F, views=(float("nan"), 0)), "views: "),
        ]:
            with self.subTest(words=words), self.assertRaisesRegex((ValueError, TypeError), words):
                wrong()
        with self.assertRaisesRegex(TypeError, "the cage is missing"):
            cagewright.check(V, F)


class ArraysOut(unittest.TestCase):
    def test_are_views_of_the_librarys_memory(self):
        cage = cagewright.generate(V, F, **QUICKEST)
        vertices = cage.vertices
        owner = vertices.base._owner
        self.assertEqual(vertices.ctypes.data, lib.cw_mesh_positions(lib.cw_cage_mesh(owner.pointer)))
        self.assertEqual(cage.faces.ctypes.data, lib.cw_mesh_corners(lib.cw_cage_mesh(owner.pointer)))
        before = vertices.copy()
        del cage, owner
        gc.collect()
        self.assertTrue((vertices == before).all())  # the memory lives as long as the view
        vertices += 1  # and is the caller's

    def test_unpack(self):
        vertices, faces = CAGE
        self.assertEqual((vertices.dtype, vertices.shape), (np.float64, (len(CAGE.vertices), 3)))
        self.assertEqual((faces.dtype, faces.shape[1]), (np.int32, 3))

    def test_quads(self):
        cage = cagewright.generate(V, F, quads=True, **QUICKEST)
        self.assertEqual(cage.faces.shape[1], 4)
        self.assertEqual((cage.faces[:, 3] >= 0).sum(), cage.report["quads"]["quads"])
        self.assertEqual(len(cage.triangles), (cage.faces >= 0).sum() - 2 * len(cage.faces))
        self.assertTrue(cagewright.check(V, F, *cage))  # as rows filled up with -1
        self.assertTrue(cagewright.check(V, F, cage))   # as corners and offsets

    def test_pickle(self):
        again = pickle.loads(pickle.dumps(CAGE))
        self.assertTrue((again.vertices == CAGE.vertices).all() and (again.faces == CAGE.faces).all())
        self.assertEqual(again.report, CAGE.report)


class Generate(InAFolder):
    def test_same_doubles_as_the_program(self):
        model, cage = self.folder / "model.obj", self.folder / "cage.obj"
        cagewright.write_mesh(model, V, QUADS)
        density = 1 + (V[:, 0] > 0) * 15.0
        np.save(self.folder / "density.npy", density)
        for given, words in [
            ({"num_vertices": 0, "num_faces": 110, "density": density, "clearance": "0.5%"},
             ["--vertices", 0, "--faces", 110, "--density", self.folder / "density.npy", "--clearance", "0.5%"]),
            ({"method": "boxes", "depth": 2, "resolution": 16, "quads": True},
             ["--method", "boxes", "--depth", 2, "--resolution", 16, "--quads"]),
        ]:
            if given.get("method") == "boxes" and "boxes" not in cagewright.features:
                continue
            with self.subTest(words=words):
                self.run_program("generate", model, "-o", cage, *QUICK_WORDS, *words)
                expected = cagewright.read_mesh(cage)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    quick = {name: value for name, value in QUICK.items() if name != "num_vertices"}
                    made = cagewright.generate(V, QUADS, **{**quick, **given})
                self.assertEqual(made.vertices.tobytes(), expected.vertices.tobytes())
                self.assertEqual(made.corners.tolist(), expected.corners.tolist())

    def test_bent_quads_are_enclosed_however_they_are_cut(self):
        """As by the program, and whichever way the quads are given; one way to cut them would not do."""
        points, quads = bent_ring()
        quick = {"num_vertices": 40, "envelope_resolution": 16, "rounds": 0, "symmetry": "off", "clearance": 0.001}
        model, cage = self.folder / "model.obj", self.folder / "cage.obj"
        cagewright.write_mesh(model, points, quads)
        self.run_program("generate", model, "-o", cage, "--vertices", 40, "--envelope-resolution", 16, "--rounds", 0,
                         "--symmetry", "off", "--clearance", "0.1%")
        expected = cagewright.read_mesh(cage)
        for faces in (quads, (quads.ravel().astype("uint8"), 4 * np.arange(len(quads) + 1))):
            made = cagewright.generate(points, faces, **quick)
            self.assertEqual(made.vertices.tobytes(), expected.vertices.tobytes())
        for cut in ([[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]):
            self.assertTrue(cagewright.check(points, quads[:, cut].reshape(-1, 3), made))
        of_triangles = cagewright.generate(points, quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3), **quick)
        self.assertFalse(cagewright.check(points, quads, of_triangles), "this model does not show what it is for")

    def test_kinds_of_coordinates_are_told(self):
        kinds = cagewright.coordinate_kinds()
        self.assertEqual(kinds[0]["name"], "mean_value")
        for kind in kinds:
            self.assertTrue(kind["idea"])
            for option in kind["options"]:
                self.assertTrue(option["help"])
                self.assertTrue(option.get("words") or option["least"] < option["most"], option)

    def test_defaults_are_those_of_the_program(self):
        defaults = {item["name"]: item["default"] for item in cagewright.options()}
        signature = inspect.signature(cagewright.generate).parameters
        for argument, option in [("method", "method"), ("symmetry", "symmetry"), ("pieces", "pieces")]:
            self.assertEqual(signature[argument].default, defaults[option])
        self.assertEqual(signature["clearance"].default, float(defaults["clearance"].rstrip("%")) /
                         (100 if "%" in defaults["clearance"] else 1))
        self.assertEqual(repr(signature["num_vertices"].default), "100")
        self.assertEqual(list(signature), ["vertices", "faces", "num_vertices", "num_faces", "max_gap", "quads", "clearance",
                                           "method", "symmetry", "pieces", "density", "joints", "start", "threads", "progress",
                                           "options"])

    def test_begins_with_a_cage_of_ones_own(self):
        small = (CAGE.vertices - CAGE.vertices.mean(0)) * 0.8 + CAGE.vertices.mean(0)
        self.assertFalse(cagewright.check(V, F, small, CAGE.faces))
        made = cagewright.generate(V, F, start=(small, CAGE.faces))
        self.assertTrue(cagewright.check(V, F, made))
        self.assertEqual(made.faces.tolist(), CAGE.faces.tolist())
        self.assertEqual(cagewright.generate(V, F, start=CAGE).corners.tolist(), CAGE.corners.tolist())
        with self.assertRaisesRegex(ValueError, "it is open"):
            cagewright.generate(V, F, start=(small, CAGE.faces[1:]))
        with self.assertRaisesRegex(TypeError, "start: faces are missing"):
            cagewright.generate(V, F, start=small)

    def test_same_on_any_number_of_threads(self):
        cage = cagewright.generate(V, F, threads=1, **QUICK)
        self.assertEqual(cage.vertices.tobytes(), CAGE.vertices.tobytes())
        for threads in (0, 1.5, "2"):
            with self.assertRaisesRegex(ValueError, "threads"):
                cagewright.generate(V, F, threads=threads)

    def test_more_threads_than_cores_make_no_difference_and_no_noise(self):
        said = subprocess.run([sys.executable, "-c", """
import sys
sys.path.insert(0, sys.argv[1])
import cagewright
box = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3]]
for threads in (1, 1000, 10**9):
    cagewright.info(box, resolution=8, threads=threads)
"""  , str(PACKAGE)], capture_output=True, text=True, check=True)
        self.assertEqual(said.stdout + said.stderr, "")

    def test_takes_what_means_the_same(self):
        for same in ({"num_vertices": 60.0}, {"symmetry": False},
                     {"quads": 0}, {"pieces": None}):
            with self.subTest(**same):
                self.assertEqual(cagewright.generate(V, F, **{**QUICK, **same}).vertices.tobytes(), CAGE.vertices.tobytes())

    def test_a_shortfall_has_a_reason(self):
        box = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        with self.assertWarnsRegex(cagewright.NotAsAsked, "not as asked for: [a-z]"):
            cagewright.generate(box, faces, num_vertices=8, envelope_resolution=8, rounds=1, quads=True)

    def test_warns_of_what_is_not_as_asked(self):
        with self.assertWarnsRegex(cagewright.NotAsAsked, "not as asked for: "):
            cage = cagewright.generate(V, F, **{**QUICK, "num_vertices": 4})
        self.assertFalse(cage.is_as_asked)
        self.assertTrue(cage.remarks)
        self.assertTrue(cagewright.check(V, F, cage))

    def test_errors_have_the_librarys_sentences(self):
        for options, words in [({"depth": 99}, "depth"), ({"max_gap": -1}, "max_gap"), ({"clearance": "lots"}, "lots"),
                               ({"teapots": 3}, "teapots"), ({"method": "magic"}, "magic")]:
            with self.assertRaises(cagewright.InputError) as raised:
                cagewright.generate(V, F, **options)
            self.assertEqual(raised.exception.code, "invalid_option")
            self.assertIn(words, str(raised.exception))
        flat = np.zeros_like(V)
        with self.assertRaises(ValueError) as raised:
            cagewright.generate(flat, F)
        self.assertEqual(raised.exception.code, "unfit_model")
        with self.assertRaises(cagewright.InputError) as raised:
            cagewright.generate(V, F, density=np.ones(3))
        self.assertIn("3 weights", str(raised.exception))

    def test_progress(self):
        seen = []

        def progress(fraction, step):
            seen.append((fraction, step, threading.current_thread()))
        cagewright.generate(V, F, progress=progress, **QUICKEST)
        fractions = [fraction for fraction, _, _ in seen]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1)
        self.assertEqual({thread for _, _, thread in seen}, {threading.current_thread()})
        with self.assertRaises(cagewright.Cancelled):
            cagewright.generate(V, F, progress=lambda fraction, step: False, **QUICK)
        with self.assertRaises(ZeroDivisionError):
            cagewright.generate(V, F, progress=lambda fraction, step: 1 / 0, **QUICK)

    def test_releases_the_interpreter(self):
        """While the library works on this thread's behalf another goes on counting."""
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
        for work in (lambda: cagewright.generate(V, F, **QUICKEST), lambda: cagewright.check(V, F, *CAGE)):
            stop.clear()
            counted[0] = 0
            counter = threading.Thread(target=count)
            counter.start()
            while counted[0] == 0:  # it has begun
                pass
            before = counted[0]
            work()
            after = counted[0]
            stop.set()
            counter.join()
            self.assertGreater(after - before, 1000)

    def interrupt(self, work):
        """Sends Ctrl-C to a script that does `work`, once it has told progress, and sees how it ends."""
        script, model = self.folder / "script.py", self.folder / "model.npz"
        np.savez(model, V=np.concatenate([V * s for s in np.linspace(1, 1.001, 200)]),
                 F=np.concatenate([F + i * len(V) for i in range(200)]), C=CAGE.vertices, G=CAGE.faces)
        script.write_text(f"""
import sys, threading, time
sys.path.insert(0, sys.argv[1])
import cagewright, numpy
data = numpy.load(sys.argv[2])
V, F, C, G = (data[name] for name in "VFCG")
def progress(fraction, step):
    print("at work", flush=True)
    time.sleep(0.001)
try:
    while True:  # however quick the machine is
        {work}
except KeyboardInterrupt:
    print("stopped", flush=True)
""")
        child = subprocess.Popen([sys.executable, str(script), str(PACKAGE), str(model)], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "at work\n")
        child.send_signal(signal.SIGINT)
        said, errors = child.communicate(timeout=60)
        self.assertIn("stopped", said.split("\n"), errors)
        self.assertEqual(child.returncode, 0, errors)

    def test_interrupt_of_generate(self):
        self.interrupt("cagewright.generate(V[:288], F[:576], num_vertices=60, quads=True, progress=progress)")

    def test_interrupt_of_binding(self):
        self.interrupt("cagewright.Deformer(V, F, C * 2, G, progress=progress)")

    def test_interrupt_of_reading_and_writing(self):
        for work in (lambda: cagewright.read_mesh("model.obj"), lambda: cagewright.read_mesh(b"v 0 0 0"),
                     lambda: cagewright.write_mesh(self.folder / "cage.obj", CAGE)):
            began, goes_on = threading.Event(), threading.Event()

            def slow_disk(*_):
                began.set()
                goes_on.wait()

            def interrupt():
                began.wait()
                os.kill(os.getpid(), signal.SIGINT)

            threading.Thread(target=interrupt).start()
            with unittest.mock.patch("cagewright._meshes.checked", slow_disk), self.assertRaises(KeyboardInterrupt):
                work()
            goes_on.set()


class Others(InAFolder):
    def test_check(self):
        verdict = cagewright.check(V, F, *CAGE)
        self.assertTrue(verdict)
        self.assertEqual(str(verdict), "valid")
        self.assertEqual(verdict.violations, [])
        self.assertGreater(verdict.figures["volume_ratio"], 1)
        opened = cagewright.check(V, F, CAGE.vertices, CAGE.faces[1:])
        self.assertFalse(opened)
        self.assertEqual(opened.counts["open_edge"], 3)
        first = opened.violations[0]
        self.assertEqual((first.kind, len(first.elements), len(first.place)), ("open_edge", 2, 3))
        self.assertIn("edge", first.message)
        self.assertIn("open_edge", repr(opened))
        self.assertEqual(len(cagewright.check(V, F, V * 0.5, F, max_listed=2).violations) % 2, 0)

    def test_same_verdict_as_the_program(self):
        import json
        model, cage, said = (self.folder / name for name in ("model.obj", "cage.obj", "said.json"))
        cagewright.write_mesh(model, V, F)
        cagewright.write_mesh(cage, *CAGE)
        self.run_program("check", model, cage, "--json", said)
        self.assertEqual(json.loads(said.read_text()), cagewright.check(V, F, *CAGE).report)
        self.run_program("info", model, "--json", said)
        self.assertEqual(json.loads(said.read_text()), {**cagewright.info(V, F), "notes": []})
        self.run_program("compare", model, cage, "--json", said)
        figures = cagewright.compare(V, F, CAGE, names=[str(cage)])
        self.assertEqual(json.loads(said.read_text())["cages"], figures)

    def test_compare(self):
        for cages in ([CAGE, (V * 3, F)], [tuple(CAGE), Thing(vertices=V * 3, faces=F)]):
            ours, other = cagewright.compare(V, F, *cages, poses=False)
            self.assertTrue(ours["valid"])
            self.assertEqual(ours["vertices"], len(CAGE.vertices))
            self.assertIsNone(ours["poses"])
        self.assertEqual(len(cagewright.compare(Thing(vertices=V, faces=F), CAGE, poses=False)), 1)
        with self.assertRaisesRegex(ValueError, "1 names for 2 cages"):
            cagewright.compare(V, F, CAGE, CAGE, names=["one"])

    def test_files(self):
        for name in ("mesh.obj", "mesh.ply", "mesh.off"):
            path = self.folder / name
            cagewright.write_mesh(path, V, QUADS)
            mesh = cagewright.read_mesh(path)
            self.assertEqual(mesh.vertices.tobytes(), V.tobytes())
            self.assertEqual(mesh.faces.tolist(), QUADS.tolist())
            again = cagewright.read_mesh(path.read_bytes(), format=name[-3:])
            self.assertEqual(again.vertices.tobytes(), V.tobytes())
        for name in ("mesh.glb", "mesh.gltf"):  # floats, and triangles
            cagewright.write_mesh(self.folder / name, V, QUADS)
            mesh = cagewright.read_mesh(self.folder / name)
            self.assertLess(abs(mesh.vertices - V).max(), 1e-6)
            self.assertEqual(len(mesh.faces), 2 * len(QUADS))
        with (self.folder / "mesh.ply").open("rb") as file:
            self.assertEqual(cagewright.read_mesh(file).vertices.tobytes(), V.tobytes())
        self.assertEqual(len(cagewright.read_mesh(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").vertices), 3)
        colored = cagewright.read_mesh(b"o part\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n")
        self.assertEqual(colored.colors.tolist()[0], [1, 0, 0, 1])
        self.assertEqual((colored.group_names, colored.face_groups.tolist()), (["part"], [0]))
        for source, kind, words in [("/nowhere.obj", OSError, "/nowhere.obj"), (b"ply\n", ValueError, "the bytes"),
                                    (self.folder / "x\0y", ValueError, "NUL")]:
            with self.assertRaisesRegex(kind, words):
                cagewright.read_mesh(source)
        with self.assertRaisesRegex(ValueError, "xyz"):
            cagewright.write_mesh(self.folder / "mesh.xyz", V, F)

    def test_coordinates(self):
        W = cagewright.coordinates("mean_value", V, *CAGE)
        self.assertEqual(W.shape, (len(V), len(CAGE.vertices)))
        self.assertLess(abs(W.sum(axis=1) - 1).max(), 1e-12)
        self.assertLess(abs(W @ CAGE.vertices - V).max(), 1e-12)
        sparse = cagewright.coordinates("mean_value", CAGE.vertices, CAGE, sparse=True)
        self.assertTrue((sparse.toarray() == np.eye(len(CAGE.vertices))).all())
        self.assertEqual(len(sparse.indptr), sparse.shape[0] + 1)
        with self.assertRaisesRegex(ValueError, "teapot"):
            cagewright.coordinates("teapot", V, CAGE)
        with self.assertRaises(cagewright.InputError):
            cagewright.coordinates("mean_value", V, CAGE.vertices, CAGE.faces[1:])

    def test_every_kind_of_coordinates(self):
        box = np.array([[x, y, z] for x in (-2, 2) for y in (-2, 2) for z in (-2, 2)], float)
        faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
        for kind in [each["name"] for each in cagewright.coordinate_kinds()]:
            with self.subTest(kind=kind):
                weights = cagewright.coordinates(kind, V, box, faces)
                self.assertEqual(len(weights), len(V))
                self.assertGreaterEqual(weights.shape[1], len(box))
                self.assertTrue(np.isfinite(weights).all())
                sparse = cagewright.coordinates(kind, V, box, faces, sparse=True)
                self.assertTrue((sparse.toarray() == weights).all())
                deformer = cagewright.Deformer(V, F, box, faces, coordinates=kind, storage="full")
                self.assertEqual(deformer.positions.tobytes(), V.tobytes())
                self.assertLess(abs(deformer(box + [1, 2, 3]) - V - [1, 2, 3]).max(), 1e-6)
                self.assertTrue(np.isfinite(deformer(box * [1, 1.3, 1])).all())
        self.assertEqual(cagewright.coordinate_kinds()[0]["name"], "mean_value")

    def test_bounds_of_what_is_written(self):
        """The library is told how wide a row is, and refuses where the weights do not fit."""
        import ctypes
        from cagewright import _library
        mesh, where = _arrays.mesh_view(*CAGE, "the cage"), _arrays.points(V, "the points")[0]
        room = np.full((len(V), 3), 7.0)
        with self.assertRaisesRegex(cagewright.InputError, "does not fit"):
            _library.checked(lib.cw_coordinates, b"mean_value", None, ctypes.byref(where), ctypes.byref(mesh), None,
                             room.ctypes.data, 3)
        self.assertTrue((room == 7).all())

    def test_deformer(self):
        deformer = cagewright.Deformer(V, F, *CAGE, storage="full")
        self.assertEqual(deformer.positions.tobytes(), V.tobytes())
        W = cagewright.coordinates("mean_value", V, CAGE)
        target = CAGE.vertices * [1, 1.5, 1] + [0, 0, 2]
        moved = deformer(target)
        self.assertLess(abs(moved - W @ target).max(), 1e-12)
        self.assertLess(abs((deformer.normals ** 2).sum(axis=1) - 1).max(), 1e-12)
        self.assertEqual(deformer.cage_positions.tobytes(), target.tobytes())
        target[[3, 5]] += 0.5
        deformer.move([3, 5], target[[3, 5]])
        self.assertLess(abs(deformer.positions - W @ target).max(), 1e-12)
        target[7] -= 0.5
        deformer.move(7, target[7])
        self.assertLess(abs(deformer.positions - W @ target).max(), 1e-12)
        self.assertEqual(deformer.unbound, 0)
        self.assertIsNone(cagewright.Deformer(V, F, CAGE, normals=False).normals)
        single = cagewright.Deformer(V, F, CAGE)
        self.assertEqual(single.weight_bytes * 2, deformer.weight_bytes)
        for wrong in (lambda: deformer(target[1:]), lambda: deformer.move(99, [0, 0, 0]), lambda: deformer.move(-1, [0, 0, 0]),
                      lambda: cagewright.Deformer(V, F, CAGE, storage="none"), lambda: deformer.move([1, 2], [0, 0, 0]),
                      lambda: cagewright.Deformer(V, F, CAGE, coordinates="teapot")):
            with self.assertRaises(ValueError):
                wrong()

    def test_a_move_that_makes_no_sense_moves_nothing(self):
        deformer = cagewright.Deformer(V, F, CAGE)
        nowhere = CAGE.vertices.copy()
        nowhere[5, 1] = np.nan
        for wrong, words in [(lambda: deformer(nowhere), "row 5 .* not a finite number"),
                             (lambda: deformer.move(1, [0, np.inf, 0]), "not a finite number"),
                             (lambda: deformer.move(1.5, [0, 0, 0]), "integers, not float64"),
                             (lambda: deformer.move(np.ones(len(nowhere), bool), nowhere), "flatnonzero")]:
            with self.assertRaisesRegex(ValueError, words):
                wrong()
        self.assertEqual(deformer.positions.tobytes(), V.tobytes())
        self.assertEqual(deformer(Thing(vertices=CAGE.vertices, faces=CAGE.faces)).tobytes(), V.tobytes())

    def test_views_of_a_deformer_change_with_it(self):
        deformer = cagewright.Deformer(V, F, *CAGE)
        view, kept = deformer.positions, deformer.positions.copy()
        address = view.ctypes.data
        moved = deformer(CAGE.vertices + 1)
        self.assertEqual((moved.ctypes.data, deformer.positions.ctypes.data), (address, address))
        self.assertLess(abs(view - kept - 1).max(), 1e-6)
        with self.assertRaises(ValueError):
            view[0] = 0
        del deformer, moved
        gc.collect()
        self.assertLess(abs(view - kept - 1).max(), 1e-6)  # the memory is still there

    def test_deform_file_writes_what_the_program_writes(self):
        model, rest, posed, one, two = (self.folder / name for name in
                                        ("model.obj", "rest.obj", "posed.obj", "one.obj", "two.obj"))
        lines = ["# a comment", "mtllib m.mtl"] + [f"v {x} {y} {z}" for x, y, z in V.tolist()] + ["vt 0 0", "usemtl red"]
        model.write_text("\n".join(lines + ["f " + " ".join(f"{c + 1}/1" for c in face) for face in QUADS]) + "\n")
        cagewright.write_mesh(rest, *CAGE)
        cagewright.write_mesh(posed, CAGE.vertices * [1, 2, 1], CAGE.faces)
        self.assertEqual(cagewright.deform_file(model, rest, posed, one), [])
        self.run_program("deform", model, rest, posed, "-o", two)
        self.assertEqual(one.read_bytes(), two.read_bytes())
        self.assertIn("usemtl red", one.read_text())
        with self.assertRaisesRegex(OSError, "written over"):
            cagewright.deform_file(model, rest, posed, model)

    def test_sequences(self):
        """Many poses, of files or of arrays, into a point cache, an animation or files: as the program writes them."""
        model, rest = self.folder / "model.obj", self.folder / "rest.obj"
        cagewright.write_mesh(model, V, QUADS)
        cagewright.write_mesh(rest, CAGE)
        frames = [CAGE.vertices * [1, 1 + 0.1 * i, 1] for i in range(3)]
        poses = [self.folder / f"pose_{i}.obj" for i in range(3)]
        for path, frame in zip(poses, frames):
            cagewright.write_mesh(path, frame, CAGE.faces)
        ours, theirs = self.folder / "ours", self.folder / "theirs"
        ours.mkdir()
        theirs.mkdir()
        for name in ("moved.pc2", "moved.mdd", "moved.glb"):  # a GLB has its name within
            self.run_program("deform", model, rest, *poses, "-o", theirs / name, "--fps", 30, "--first-frame", 7)
            for posed in (frames, np.array(frames), poses, [Thing(vertices=frame, faces=CAGE.faces) for frame in frames]):
                with self.subTest(name=name, posed=type(posed)):
                    self.assertEqual(cagewright.deform_file(model, rest, posed, ours / name, fps=30, first_frame=7), [])
                    self.assertEqual((ours / name).read_bytes(), (theirs / name).read_bytes())
        outs = [ours / f"moved_{i}.obj" for i in range(3)]
        cagewright.deform_file(model, rest, frames, outs, coordinates="green")
        for pose, out in zip(poses, outs):
            self.run_program("deform", model, rest, pose, "-o", theirs / out.name, "--coordinates", "green")
            self.assertEqual(out.read_bytes(), (theirs / out.name).read_bytes())
        one = cagewright.deform_file(model, rest, frames[1].tolist(), ours / "one.obj", coordinates="green")
        self.assertEqual((one, (ours / "one.obj").read_bytes()), ([], outs[1].read_bytes()))
        for posed, out, words in [(frames, "x.obj", "holds one pose"), (frames, ["a.obj", "b.obj"], "3 poses, but 2 files"),
                                  ([], "x.pc2", "no pose"), (frames[0][1:], "x.obj", "pose 0 has"), (frames[:2], ["a.obj"] * 2, "two poses"),
                                  ([frames[0] * np.nan], "x.pc2", "pose 0: row 0"), (poses, poses[0], "holds one pose"),
                                  (poses[0], poses[0], "written over")]:
            outs = self.folder / out if isinstance(out, str) else [self.folder / name for name in out] if isinstance(out, list) else out
            with self.subTest(words=words), self.assertRaisesRegex((ValueError, OSError), words):
                cagewright.deform_file(model, rest, posed, outs)
        for posed, words in [(3, "not a int"), ([poses[0], frames[0]], "cannot be mixed")]:
            with self.assertRaisesRegex(TypeError, words):
                cagewright.deform_file(model, rest, posed, self.folder / "x.pc2")
        with self.assertRaisesRegex(ValueError, "fps"):
            cagewright.deform_file(model, rest, frames, self.folder / "x.pc2", fps=0)

    @unittest.skipUnless("render" in cagewright.features, "built without pictures")
    def test_render(self):
        try:
            image = cagewright.render(V, F, size=(80, 60))
        except cagewright.NotAvailable as error:
            self.skipTest(str(error))
        self.assertEqual((image.shape, image.dtype), ((60, 80, 4), np.uint8))
        with_cage = cagewright.render(V, F, CAGE, size=(80, 60), views=["front", (90, 10)], background="white")
        self.assertEqual(with_cage.shape, (60, 160, 4))
        self.assertEqual(with_cage[0, 0].tolist(), [255, 255, 255, 255])
        one_view = cagewright.render(Thing(vertices=V, faces=F), CAGE, size=(80, 60), views=(35, 15), up="z")
        self.assertEqual(one_view.shape, (60, 80, 4))
        for wrong in ({"views": "inside"}, {"background": "plaid"}, {"up": "x"}, {"size": (0, -5)}, {"size": 100}):
            with self.assertRaises(ValueError):
                cagewright.render(V, F, **wrong)

    def test_many_threads_at_once(self):
        results = [None] * 4

        def work(i):
            results[i] = cagewright.check(V, F, *CAGE, threads=1).report
        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(all(result == results[0] for result in results))


class Words(unittest.TestCase):
    def test_help_answers_a_newcomer(self):
        for name in cagewright.__all__:
            thing = getattr(cagewright, name)
            if inspect.isfunction(thing):
                self.assertIn(">>>" if name != "options" else "generate", thing.__doc__, name)
                for argument in inspect.signature(thing).parameters:
                    self.assertIn(argument, thing.__doc__, f"{name}: {argument}")
            if inspect.isclass(thing) and thing.__module__ == "cagewright":
                self.assertTrue(thing.__doc__, name)
        text = cagewright.generate.__doc__
        for question in ("V x 3", "F x 3", "Returns", "Raises", "diagonal", "Deformer", "options()"):
            self.assertIn(question, text)

    def test_stubs_are_what_is_there(self):
        stubs = ast.parse((PACKAGE / "cagewright" / "__init__.pyi").read_text())
        found = {}
        for node in stubs.body:
            if isinstance(node, ast.FunctionDef):
                found[node.name] = node
            elif isinstance(node, ast.ClassDef):
                found.update({f"{node.name}.{item.name}": item for item in node.body
                              if isinstance(item, ast.FunctionDef) and item.name in ("__init__", "__call__", "move")})
                found[node.name] = node
        self.assertLessEqual({name for name in cagewright.__all__ if callable(getattr(cagewright, name))}, set(found))
        for name, node in found.items():
            thing = cagewright
            for part in name.split("."):
                thing = getattr(thing, part)
            if isinstance(node, ast.FunctionDef) and inspect.isfunction(thing) and not name.startswith(("Mesh", "Cage", "Verd")):
                arguments = node.args
                names = [a.arg for a in arguments.posonlyargs + arguments.args]
                names += [arguments.vararg.arg] if arguments.vararg else []
                names += [a.arg for a in arguments.kwonlyargs] + ([arguments.kwarg.arg] if arguments.kwarg else [])
                self.assertEqual(names, list(inspect.signature(thing).parameters), name)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_stubs_are_what_mypy_finds_there(self):
        said = subprocess.run([sys.executable, "-m", "mypy.stubtest", "cagewright", "--ignore-missing-stub"], capture_output=True,
                              text=True, env={**os.environ, "PYTHONPATH": str(PACKAGE), "MYPYPATH": str(PACKAGE)}).stdout
        self.assertIn("modules", said)
        self.assertEqual(re.findall(r"^error: cagewright\.[^_].*", said, re.M), [])

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_mypy_agrees_with_what_the_documentation_does(self):
        blocks = re.findall(r"```python\n(.*?)```", (SOURCE / "docs" / "python.md").read_text(), re.S)
        checks = ["cagewright.coordinates('green', V, cage, sparse=True).toarray().sum()",
                  "cagewright.generate((V, F), max_gap='2%', threads=2).report['cage']",
                  "reveal_type(cagewright.render(V, F, cage, views=['front', (30, 10)]))"]
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "script.py"
            script.write_text("\n".join(blocks + checks) + "\n")
            done = subprocess.run([sys.executable, "-m", "mypy", "--check-untyped-defs", "--cache-dir", folder, script], text=True,
                                  capture_output=True, cwd=folder, env={**os.environ, "MYPYPATH": str(PACKAGE)})
        self.assertEqual(re.findall(r"^.*error:.*", done.stdout, re.M), [])
        self.assertIn("ndarray", done.stdout)

    def test_the_documentation_runs(self):
        text = (SOURCE / "docs" / "python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.S)
        self.assertGreater(len(blocks), 5)
        names = {}
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()) as said:
            cagewright.write_mesh("armadillo.off", V, F)
            for block in blocks:
                if "render" in cagewright.features or "render" not in block:
                    exec(block.replace("num_vertices", "rounds=1, envelope_resolution=16, num_vertices"), names)
        self.assertIn("malformed the model's faces: row", said.getvalue())

    def test_version(self):
        version = subprocess.run([str(PROGRAM), "--version"], capture_output=True, text=True).stdout
        self.assertIn(cagewright.__version__, version)
        self.assertIn(cagewright.licence, version)


if __name__ == "__main__":
    with contextlib.suppress(AttributeError):
        unittest.TestCase.maxDiff = 2000
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
