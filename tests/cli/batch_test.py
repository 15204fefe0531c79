"""Batches: one failure stops nothing, what is made is not made again, and no half file is ever there.

batch_test.py PROGRAM [unittest arguments]
"""

import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DONE, BAD_INPUT, NOT_ALL, INTERRUPTED = 0, 2, 3, 130
QUICK = ["--method", "boxes", "--depth", "1", "--resolution", "12"]
SLOW = ["--vertices", "60", "--quads", "--threads", "1"]  # some seconds for a ring


def cube(x=0.0):
    corners = [(x + i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    return "".join(f"v {a} {b} {c}\n" for a, b, c in corners) + "".join(f"f {a} {b} {c} {d}\n" for a, b, c, d in faces)


def ring(around=24, across=12):
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 1 + 0.3 * math.cos(b)
            lines.append(f"v {r * math.cos(a)} {r * math.sin(a)} {0.3 * math.sin(b)}")
    at = lambda i, j: i % around * across + j % across + 1  # noqa: E731
    lines += [f"f {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}" for i in range(around) for j in range(across)]
    return "\n".join(lines) + "\n"


class Batch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.models, self.out = self.folder / "models", self.folder / "cages"

    def model(self, name, text=None):
        path = self.models / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(cube(len(name)) if text is None else text)
        return path

    def start(self, *words, **options):
        return subprocess.Popen([str(PROGRAM), "batch", *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, cwd=self.folder, **options)

    def run_batch(self, *words, expect=DONE, options=QUICK, text=None):
        child = self.start(*words, "-o", self.out, *options, stdin=subprocess.PIPE)
        said, complained = child.communicate(text)
        self.assertEqual(child.returncode, expect, said + complained)
        return said

    def table(self):
        with (self.out / "batch.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        entries = json.loads((self.out / "batch.json").read_text())["models"]
        self.assertEqual([row["model"] for row in rows], [entry["model"] for entry in entries])
        return {row["model"]: row for row in rows}

    def cages(self):
        return {str(path.relative_to(self.out)): path.read_bytes() for path in self.out.rglob("*.obj")}

    def assert_only_whole_files(self):
        for path in self.out.rglob("*"):
            self.assertNotIn(".part", path.name)
        for name in self.cages():
            self.assertEqual(subprocess.run([PROGRAM, "info", self.out / name], capture_output=True).returncode, 0, name)

    def made_now(self):
        return {name for name, row in self.table().items() if row["from_before"] == "no"}

    def wait_for_children(self, parent, count=1):
        """Their process ids, once there are so many."""
        while True:
            children = pathlib.Path(f"/proc/{parent.pid}/task/{parent.pid}/children").read_text().split()
            if len(children) >= count:
                return [int(child) for child in children]
            self.assertIsNone(parent.poll())
            time.sleep(0.01)


class OneFailureStopsNothing(Batch):
    def test_the_table_tells_what_became_of_each(self):
        self.model("a.obj")
        self.model("deep/er/b.obj")
        self.model("broken, really.obj", "v 0 0 0\nf 1 2 3\n")
        self.model("empty.ply", "")
        self.model("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
        said = self.run_batch(self.models, expect=NOT_ALL)
        self.assertIn("5 of 5 models: 2 cages; 3 failed", said)
        table = self.table()
        self.assertEqual({name: row["status"] for name, row in table.items()},
                         {"a.obj": "done", "deep/er/b.obj": "done", "broken, really.obj": "failed", "empty.ply": "failed",
                          "flat.obj": "failed"})
        self.assertEqual(table["broken, really.obj"]["reason"], "malformed")
        self.assertIn("broken, really.obj:2", table["broken, really.obj"]["message"])
        self.assertEqual(table["flat.obj"]["reason"], "unfit_model")
        self.assertGreater(float(table["a.obj"]["volume_ratio"]), 1)
        self.assertGreater(float(table["a.obj"]["seconds"]), 0)
        self.assertGreater(float(table["a.obj"]["peak_mb"]), 1)
        self.assertEqual(set(self.cages()), {"a.obj", "deep/er/b.obj"})
        self.assertEqual(json.loads((self.out / "a.json").read_text())["format"], "cagewright-generate")

    def test_crashes_and_kills(self):
        self.model("a.obj", ring())
        for sign, reason in [(signal.SIGSEGV, "crashed"), (signal.SIGKILL, "killed")]:
            batch = self.start(self.models, "-o", self.out, "--jobs", 1, *SLOW)
            child, = self.wait_for_children(batch)
            os.kill(child, sign)
            batch.communicate()
            self.assertEqual(batch.returncode, NOT_ALL)
            self.assertEqual(self.table()["a.obj"]["reason"], reason)
            (self.out / "batch.jsonl").unlink()

    def test_limits(self):
        self.model("a.obj", ring())
        self.run_batch(self.models, "--time-limit", "0.01", options=[], expect=NOT_ALL)
        self.assertEqual(self.table()["a.obj"]["reason"], "time_limit")
        before = (self.out / "batch.jsonl").read_text()
        self.run_batch(self.models, "--time-limit", "0.01", options=[], expect=NOT_ALL)
        self.assertEqual((self.out / "batch.jsonl").read_text(), before)
        self.run_batch(self.models, options=QUICK)  # other options, other limits
        self.run_batch(self.models, "--memory-limit", "5M", options=["--envelope-resolution", "200"], expect=NOT_ALL)
        self.assertIn(self.table()["a.obj"]["reason"], ("too_large", "killed"))

    def test_not_as_asked(self):
        self.model("a.obj", ring())
        self.run_batch(self.models, options=["--vertices", "4", "--envelope-resolution", "16", "--rounds", "1"], expect=NOT_ALL)
        row = self.table()["a.obj"]
        self.assertEqual((row["status"], row["reason"]), ("not_as_asked", "budget_not_reached"))
        self.assertIn("a.obj", self.cages())

    def test_refusals(self):
        self.model("a.obj")
        self.assertEqual(subprocess.run([PROGRAM, "batch", self.models, "-o", self.out, "--vertices", "x"],
                                        capture_output=True).returncode, BAD_INPUT)
        self.run_batch("nowhere", expect=BAD_INPUT)
        self.run_batch("nothing/*.obj", expect=BAD_INPUT)
        self.out.rename(self.folder / "other")
        self.out.write_text("a file\n")
        self.run_batch(self.models, expect=BAD_INPUT)


class WhichModels(Batch):
    def test_lists_patterns_and_files(self):
        for name in ("a.obj", "b.obj", "c.OFF", "d/a.obj", "notes.doc", ".hidden.obj"):
            self.model(name, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" if name == "c.OFF" else None)
        listed = self.models / "list.txt"
        listed.write_text("\ufeffb.obj\n")  # as editors of Windows write it
        self.run_batch(listed)
        self.assertEqual(set(self.table()), {"b.obj"})
        (self.out / "b.obj").unlink()
        listed.write_text("# models\n\na.obj  \r\nd/a.obj\nmissing.obj\n")
        self.run_batch(listed, expect=NOT_ALL)
        self.assertEqual(set(self.cages()), {"a.obj", "d/a.obj"})
        self.assertEqual(self.table()["missing.obj"]["reason"], "cannot_open")
        self.run_batch("models/?.obj", "models/b.obj")
        self.assertEqual(set(self.table()), {"a.obj", "b.obj"})
        self.run_batch("-", text="models/b.obj\n")
        self.assertEqual(set(self.table()), {"b.obj"})

    def test_names_that_meet(self):
        self.model("a.obj")
        self.model("a.ply", "ply\n")
        self.model("batch.obj")
        self.run_batch(self.models, expect=NOT_ALL)
        self.assertEqual(set(self.cages()), {"a.obj.obj", "batch.obj.obj"})
        self.assertEqual(self.table()["a.ply"]["status"], "done" if (self.out / "a.ply.obj").exists() else "failed")

    def test_cages_below_the_models_are_no_models(self):
        self.out = self.models / "cages"
        self.model("a.obj")
        for _ in range(2):
            self.run_batch(self.models)
            self.assertEqual(set(self.table()), {"a.obj"})

    def test_models_are_not_written_over(self):
        self.model("a.obj")
        self.out = self.models
        before = (self.models / "a.obj").read_bytes()
        self.run_batch(self.models / "a.obj", expect=BAD_INPUT)
        self.assertEqual((self.models / "a.obj").read_bytes(), before)

    def test_strange_names(self):
        names = ["-a.obj", "b c.obj", "d'e\"f.obj", "g*.obj", "ü.obj", "--quads.obj", "two\nlines.obj", "tab\tthere, and.obj",
                 "\x1b[31mred.obj", "back\\slash.obj", "$(touch made)`x`;.obj", "trailing .obj"]
        for name in names:
            self.model(name)
        self.run_batch(self.models)
        self.assertEqual(set(self.cages()), set(names))
        self.assertEqual(set(self.table()), set(names))


class Resuming(Batch):
    def test_makes_what_is_missing_or_has_changed(self):
        for name in ("a.obj", "b.obj", "c.obj", "bad.obj"):
            self.model(name, "v 0 0 0\n" if name == "bad.obj" else None)
        self.run_batch(self.models, expect=NOT_ALL)
        first = self.cages()
        self.run_batch(self.models, expect=NOT_ALL)
        self.assertEqual(self.made_now(), set())
        self.model("b.obj", cube(9))
        self.run_batch(self.models, expect=NOT_ALL)
        self.assertEqual(self.made_now(), {"b.obj"})
        (self.out / "a.obj").unlink()
        (self.out / "c.obj").write_bytes((self.out / "c.obj").read_bytes()[:-9])
        self.run_batch(self.models, expect=NOT_ALL)
        self.assertEqual(self.made_now(), {"a.obj", "c.obj"})
        self.run_batch(self.models, "--retry", expect=NOT_ALL)
        self.assertEqual(self.made_now(), {"bad.obj"})
        self.model("b.obj")
        self.model("bad.obj", cube())
        self.run_batch(self.models)
        self.assertEqual(self.made_now(), {"b.obj", "bad.obj"})
        self.assertEqual({name: self.cages()[name] for name in first}, first)
        self.run_batch(self.models, options=[*QUICK[:-1], "14"])
        self.assertEqual(len(self.made_now()), 4)

    def test_a_new_model_is_added(self):
        self.model("a.obj")
        self.run_batch(self.models)
        self.model("b.obj")
        said = self.run_batch(self.models)
        self.assertEqual(self.made_now(), {"b.obj"})
        self.assertIn("1 known from before", said)

    def test_buffers_of_gltf_count(self):
        import struct
        numbers = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                    "buffers": [{"uri": "a%20b.bin", "byteLength": 60}],
                    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                                   "min": [0, 0, 0], "max": [2, 1, 1]},
                                  {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}]}
        self.model("m.gltf", json.dumps(document))
        buffer = self.models / "a b.bin"
        buffer.write_bytes(numbers + bytes([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]))
        self.run_batch(self.models)
        buffer.write_bytes(buffer.read_bytes().replace(struct.pack("<f", 1), struct.pack("<f", 2), 1))
        self.run_batch(self.models)
        self.assertEqual(self.made_now(), {"m.gltf"})

    def expected(self, options):
        cages = {}
        for path in sorted(self.models.glob("*.obj")):
            out = self.folder / "alone.obj"
            subprocess.run([PROGRAM, "generate", path, "-o", out, *options], check=True, capture_output=True)
            cages[path.name] = out.read_bytes()
        return cages

    def test_killed_in_the_middle(self):
        for i in range(8):
            self.model(f"{i}.obj", cube(i))
        expected = self.expected(QUICK)
        batch = self.start(self.models, "-o", self.out, "--jobs", 2, *QUICK)
        for _ in range(3):
            batch.stdout.readline()
        batch.kill()  # as no program can prepare for
        batch.communicate()
        while any(pathlib.Path(f"/proc/{name}/cmdline").exists() and str(self.models).encode() in
                  pathlib.Path(f"/proc/{name}/cmdline").read_bytes() for name in os.listdir("/proc") if name.isdigit()):
            time.sleep(0.01)  # its children end by themselves
        self.assert_only_whole_files()
        with (self.out / "batch.jsonl").open("a") as journal:
            journal.write('{"model": "cut o')
        self.run_batch(self.models)
        before = [row for row in self.table().values() if row["from_before"] == "yes"]
        self.assertGreaterEqual(len(before), 3)
        self.assertEqual(self.cages(), expected)

    def test_stopped_again_and_again(self):
        """In every way, whenever it likes: in the end all is as if it had never been."""
        names = [f"{i}.obj" for i in range(8)]
        for i, name in enumerate(names):
            self.model(name, cube(i))
        for how in (signal.SIGKILL, signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
            batch = self.start(self.models, "-o", self.out, "--jobs", 3, *QUICK)
            batch.stdout.readline()  # one more is there
            batch.send_signal(how)
            batch.communicate()
            self.assert_only_whole_files()
        self.run_batch(self.models)
        self.assertEqual(self.cages(), self.expected(QUICK))
        self.assertEqual({name: row["status"] for name, row in self.table().items()}, dict.fromkeys(names, "done"))

    def test_stopped_by_ctrl_c(self):
        for i in range(3):
            self.model(f"{i}.obj", ring())
        batch = self.start(self.models, "-o", self.out, "--jobs", 2, *SLOW)
        self.wait_for_children(batch, 2)
        batch.send_signal(signal.SIGINT)
        said, complained = batch.communicate()
        self.assertEqual(batch.returncode, INTERRUPTED, said + complained)
        self.assertIn("goes on where this one was", complained)
        self.assert_only_whole_files()
        self.run_batch(self.models)
        self.assertEqual(len(self.cages()), 3)

    def test_one_batch_at_a_time(self):
        self.model("a.obj", ring())
        batch = self.start(self.models, "-o", self.out, "--jobs", 1, *SLOW)
        self.wait_for_children(batch)
        other = subprocess.run([PROGRAM, "batch", self.models, "-o", self.out, *SLOW], capture_output=True, text=True)
        self.assertEqual(other.returncode, BAD_INPUT)
        self.assertIn("another batch is at work", other.stderr)
        batch.send_signal(signal.SIGTERM)
        batch.communicate()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
