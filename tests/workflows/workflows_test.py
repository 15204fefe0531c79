"""Batches under engines that others have made, as docs/batch.md shows them: Snakemake and dask.distributed, with two
workers, killed in the middle and resumed; and one model from file to deformed result on every route, with the same bytes.

workflows_test.py PROGRAM FOLDER_OF_PYTHON_PACKAGE [unittest arguments]

With CAGEWRIGHT_MODELS the model of the routes is the Armadillo there, else the sample.
"""

import csv
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, PACKAGE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
SNAKEFILE = SOURCE / "examples" / "batch" / "Snakefile"
DASK = SOURCE / "examples" / "batch" / "dask_batch.py"
PYTHON = sys.executable
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PACKAGE), "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
QUICK = "--vertices 60 --rounds 1 --envelope-resolution 16"
QUICK_OPTIONS = ["--vertices", "60", "--option", "rounds=1", "--option", "envelope_resolution=16"]


def ring(thickness, around=24, across=12):
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 1 + thickness * math.cos(b)
            lines.append(f"v {r * math.cos(a)} {r * math.sin(a)} {thickness * math.sin(b)}")
    at = lambda i, j: i % around * across + j % across + 1  # noqa: E731
    lines += [f"f {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}" for i in range(around) for j in range(across)]
    return "\n".join(lines) + "\n"


def random_numbers(state=1):
    """From 0 to 1, the same each time."""
    while True:
        state = (1103515245 * state + 12345) % 2**31
        yield state / 2**31


def start_in(folder, *words):
    return subprocess.Popen([str(word) for word in words], cwd=folder, env=ENVIRONMENT, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)


def run_in(folder, *words, expect=0):
    child = start_in(folder, *words)
    said = child.communicate()[0]
    if child.returncode != expect:
        raise AssertionError(f"{' '.join(map(str, words))}\nexit code {child.returncode}\n{said}")
    return said


def snakemake(*words, **config):
    settings = [f"{name}={value}" for name, value in config.items()]
    return ["snakemake", "-s", SNAKEFILE, "--cores", 2, "--nolock", "--rerun-incomplete", *words, "--config", *settings]


class Engines(unittest.TestCase):
    """Eight rings and two files that are none."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.models = self.folder / "models"
        (self.models / "deep").mkdir(parents=True)
        self.names = [f"ring_{i}" for i in range(7)] + ["deep/ring"]
        for i, name in enumerate(self.names):
            (self.models / f"{name}.obj").write_text(ring(0.2 + 0.03 * i))
        (self.models / "damaged.obj").write_text("v 0 0 0\nf 1 2 9\n")
        (self.models / "same.ply").write_text("ply\n")

    def run_words(self, *words, **options):
        return run_in(self.folder, *words, **options)

    def table(self, out):
        with (out / "batch.csv").open() as file:
            return {row["model"]: row for row in csv.DictReader(file)}

    def assert_complete(self, out):
        table = self.table(out)
        self.assertEqual({name: row["status"] for name, row in table.items()},
                         {**{f"{name}.obj": "done" for name in self.names}, "damaged.obj": "failed", "same.ply": "failed"})
        self.assertTrue(table["damaged.obj"]["message"])
        self.assertEqual(list(out.rglob("*.part")), [])
        for name in self.names:
            rest = self.folder / "expected.obj"
            self.run_words(PROGRAM, "-q", "generate", self.models / f"{name}.obj", "-o", rest, *QUICK.split())
            self.assertEqual((out / f"{name}.obj").read_bytes(), rest.read_bytes(), name)

    def kill_in_the_middle(self, words, out):
        """Starts a batch, kills it without warning when some of its models are done, and tells which are."""
        child = start_in(self.folder, *words)
        try:
            deadline = time.monotonic() + 300  # for a batch that hangs
            while child.poll() is None and time.monotonic() < deadline:
                done = {path.name: path.stat().st_mtime_ns for path in out.rglob("ring*.json")}
                if len(done) >= 2:
                    break
                time.sleep(0.01)
        finally:
            os.killpg(child.pid, signal.SIGKILL)
            said = child.communicate()[0]
        self.assertEqual(child.returncode, -signal.SIGKILL, f"it was too quick to be killed: {said}")
        return done

    def assert_went_on(self, done, out):
        """What was complete when the batch was killed was not made again."""
        again = [name for name, when in done.items()
                 for path in out.rglob(name) if path.stat().st_mtime_ns != when]
        self.assertLessEqual(len(again), 2, "at most those under way were made again")

    def test_snakemake(self):
        out = self.folder / "cages"
        words = snakemake("--keep-going", "--quiet", models=self.models, out=out, options=QUICK)
        done = self.kill_in_the_middle(words, out)
        self.run_words(*words)
        self.assert_went_on(done, out)
        self.assert_complete(out)
        self.assertIn("Nothing to be done", self.run_words(*[word for word in words if word != "--quiet"]))

    def test_dask(self):
        out = self.folder / "cages"
        words = [PYTHON, DASK, self.models, "-o", out, "--workers", 2, *QUICK_OPTIONS]
        done = self.kill_in_the_middle(words, out)
        said = self.run_words(*words, expect=3)  # two are not models
        self.assert_went_on(done, out)
        self.assertNotIn("0 of 10 models are done already", said)
        self.assert_complete(out)
        self.assertIn("10 of 10 models are done already", self.run_words(*words, expect=3))
        (self.models / "ring_1.obj").write_text(ring(0.35))
        self.assertIn("9 of 10 models are done already", self.run_words(*words, expect=3))


class EveryRoute(unittest.TestCase):
    """From a file to a deformed result, by the command line, C++, C, Python, batch, Snakemake and dask: the same bytes."""

    @staticmethod
    def source(_folder):
        source = pathlib.Path(os.environ.get("CAGEWRIGHT_MODELS", "/nowhere")) / "armadillo.off"
        return source if source.exists() else SOURCE / "samples" / "creature.obj"

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        source = cls.source(cls.folder)
        cls.models, cls.poses = cls.folder / "models", cls.folder / "poses"
        cls.models.mkdir()
        cls.poses.mkdir()
        cls.model = cls.models / f"model{source.suffix}"
        shutil.copy(source, cls.model)
        # The cage that all are to make, and a pose of it: its upper half moved aside.
        cls.cage, cls.posed = cls.folder / "cage.obj", cls.poses / "model.obj"
        run_in(cls.folder, PROGRAM, "generate", cls.model, "-o", cls.cage, "--vertices", 60)
        sys.path.insert(0, str(PACKAGE))
        import cagewright
        cls.cagewright = cagewright
        vertices, faces = cagewright.read_mesh(cls.cage)
        moved = vertices.copy()
        middle = (vertices[:, 1].min() + vertices[:, 1].max()) / 2
        moved[vertices[:, 1] > middle, 0] += (vertices.max() - vertices.min()) / 4
        cagewright.write_mesh(cls.posed, moved, faces)
        cls.result = cls.folder / f"result{source.suffix}"
        run_in(cls.folder, PROGRAM, "deform", cls.model, cls.cage, cls.posed, "-o", cls.result)
        if cls.result.read_bytes() == cls.model.read_bytes():
            raise AssertionError("the model has not moved")

    def run_words(self, *words):
        return run_in(self.folder, *words)

    def assert_same(self, cage, result):
        self.assertEqual(cage.read_bytes(), self.cage.read_bytes())
        self.assertEqual(result.read_bytes(), self.result.read_bytes())

    def test_python(self):
        V, F = self.cagewright.read_mesh(self.model)
        cage, out = self.folder / "p.obj", self.folder / f"p-posed{self.model.suffix}"
        self.cagewright.write_mesh(cage, self.cagewright.generate(V, F, num_vertices=60))
        self.cagewright.deform_file(self.model, cage, self.posed, out)
        self.assert_same(cage, out)

    def test_c(self):
        source = SOURCE / "examples" / "from_file_to_pose.c"
        built, library = self.folder / "route_c", PACKAGE / "cagewright"
        self.run_words("gcc", "-std=c99", source, "-o", built, f"-I{SOURCE / 'include'}", f"-L{library}",
                       f"-Wl,-rpath,{library.resolve()}", f"-Wl,-rpath,{(library / 'libcagewright.so').resolve().parent}",
                       "-lcagewright")
        cage, out = self.folder / "c.obj", self.folder / f"c-posed{self.model.suffix}"
        self.run_words(built, self.model, 60, cage, self.posed, out)
        self.assert_same(cage, out)

    def test_cpp(self):
        program = PROGRAM.parent.parent / "examples" / "from_file_to_pose"
        if not program.exists():
            self.skipTest("the example is not built: target from_file_to_pose")
        cage, out = self.folder / "x.obj", self.folder / f"x-posed{self.model.suffix}"
        self.run_words(program, self.model, 60, cage, self.posed, out)
        self.assert_same(cage, out)

    def test_batch(self):
        out = self.folder / "batch"
        self.run_words(PROGRAM, "batch", self.models, "-o", out, "--vertices", 60)
        posed = self.folder / f"b-posed{self.model.suffix}"
        self.run_words(PROGRAM, "deform", self.model, out / "model.obj", self.posed, "-o", posed)
        self.assert_same(out / "model.obj", posed)

    def test_snakemake(self):
        out = self.folder / "snakemake"
        self.run_words(*snakemake(models=self.models, out=out, poses=self.poses, options="--vertices 60"))
        self.assert_same(out / "model.obj", out / f"model-posed{self.model.suffix}")

    def test_dask(self):
        out = self.folder / "dask"
        self.run_words(PYTHON, DASK, self.models, "-o", out, "--poses", self.poses, "--workers", 2, "--vertices", 60)
        self.assert_same(out / "model.obj", out / f"model-posed{self.model.suffix}")


class EveryRouteOfBentQuads(EveryRoute):
    """The same for a model whose quads are bent: all enclose it along both diagonals of each."""

    @staticmethod
    def source(folder):
        path, random = folder / "bent.obj", random_numbers()
        path.write_text("\n".join(" ".join(["v", *(str(float(c) + next(random) - 0.5) for c in line.split()[1:])])
                                  if line.startswith("v") else line for line in ring(0.3, 4, 3).splitlines()) + "\n")
        return path


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
