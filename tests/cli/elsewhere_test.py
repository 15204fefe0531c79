"""Cages from other programs: how `check` calls what is wrong with them, and that its remedies work when they are tried.

Called as: elsewhere_test.py PROGRAM [unittest arguments]
"""

import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DONE, FAULTS = 0, 1

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]

# No other way up the same.
SIZES = (4, 2, 1)


def box(factor=1.0, place=(0, 0, 0), faces=QUADS, start=0):
    points = [tuple(factor * s * c + p for s, c, p in zip(SIZES, corner, place)) for corner in CORNERS]
    return points, [tuple(v + start for v in face) for face in faces]


def joined(*meshes):
    points, faces = [], []
    for more, their in meshes:
        faces += [tuple(v + len(points) for v in face) for face in their]
        points += more
    return points, faces


def split(mesh):
    points, faces = mesh
    return ([points[v] for face in faces for v in face],
            [tuple(range(4 * i, 4 * i + len(face))) for i, face in enumerate(faces)])


def changed(mesh, change):
    return [change(*p) for p in mesh[0]], mesh[1]


def reversed_faces(mesh):
    return mesh[0], [face[::-1] for face in mesh[1]]


def obj(mesh):
    points, faces = mesh
    return "".join("v {!r} {!r} {!r}\n".format(*map(float, p)) for p in points) + \
        "".join("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)


CAGES = {
    "split": split(box(1.5)),
    "loose": joined(box(1.5), ([(9, 9, 9)], [])),
    "doubled corner": (box(1.5)[0] + [box(1.5)[0][0]], [(0, 2, 3, 1), (4, 5, 7, 6), (8, 1, 5, 4), *QUADS[3:]]),
    # An arrowhead's prism: its top and its bottom are concave.
    "concave": ([(x, y, z) for z in (-2, 2) for x, y in ((-30, -20), (0, -6), (30, -20), (0, 30))],
                [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]),
    "pieces": joined(box(1.5), box(1.5, (30, 0, 0))),
    "inner shell": joined(box(2), reversed_faces(box(0.2, (6.5, 0, 0)))),
    "in cm": changed(box(1.5), lambda x, y, z: (100 * x, 100 * y, 100 * z)),
    "y up": changed(box(1.5), lambda x, y, z: (x, z, -y)),
    "beside": box(1.5, (40, 3, 0)),
    "y up in mm": changed(box(1.5), lambda x, y, z: (1000 * x, 1000 * z, -1000 * y)),
    "tight": box(0.5),
}


class Elsewhere(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "the model.obj").write_text(obj(box()))

    def run_here(self, *arguments):
        return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=300,
                              check=False, cwd=self.folder)

    def check(self, mesh, *options):
        """The verdict in JSON, and all it says to people."""
        (self.folder / "a cage.obj").write_text(obj(mesh))
        ended = self.run_here("check", "the model.obj", "a cage.obj", "--json", "v.json", *options)
        self.assertIn(ended.returncode, (DONE, FAULTS), ended.stderr)
        verdict = json.loads((self.folder / "v.json").read_text())
        self.assertEqual(verdict["valid"], ended.returncode == DONE)
        return verdict, ended.stdout

    def test_each_remedy_that_is_a_command_helps(self):
        for name, mesh in CAGES.items():
            verdict, text = self.check(mesh)
            texts = [v["remedy"] for v in verdict["violations"]] + [n["message"] for n in verdict["notes"]]
            for sentence in sorted(set(texts)):
                self.assertIn(sentence, text)
                for command in re.findall(r"cagewright ((?:weld|check|generate) .*?)(?:$|; )", sentence):
                    with self.subTest(cage=name, command=command):
                        words = shlex.split(command)
                        tried = self.run_here(*words)
                        self.assertEqual(tried.returncode, DONE, tried.stdout + tried.stderr)
                        if words[0] == "weld":
                            again = self.run_here("check", "the model.obj", words[2], "--list", "0", "--json", "w.json")
                            after = json.loads((self.folder / "w.json").read_text())
                            self.assertTrue(after["valid"], again.stdout)
                            self.assertNotIn("cage_elsewhere", [n["code"] for n in after["notes"]])

    def test_split_vertices_are_merged_for_judging(self):
        verdict, text = self.check(CAGES["split"])
        self.assertTrue(verdict["valid"])
        self.assertEqual(verdict["merged_vertices"], 16)
        self.assertIn("16 vertices at the position of another", text)
        self.assertEqual(verdict["cage"]["vertices"], 8)

    def test_loose_vertices_are_left_out(self):
        verdict, text = self.check(CAGES["loose"])
        self.assertTrue(verdict["valid"])
        self.assertIn("1 vertex that no face uses", text)

    def test_inner_shells_are_called_so_and_accepted_where_asked(self):
        verdict, text = self.check(CAGES["inner shell"], "--allow-pieces")
        self.assertEqual(verdict["counts"]["nested_piece"], 1)
        self.assertIn("inner shell", text)
        self.assertTrue(self.check(CAGES["inner shell"], "--allow-inner-shells")[0]["valid"])
        outward = joined(box(2), box(0.2, (6.5, 0, 0)))
        self.assertEqual(self.check(outward, "--allow-inner-shells")[0]["counts"]["inverted_piece"], 1)

    def test_t_junctions_are_called_so(self):
        points, faces = box(1.5)
        faces = [f for f in faces if f != QUADS[1]] + [(4, 8, 9, 6), (8, 5, 7, 9)]
        points = points + [(0, -3, 1.5), (0, 3, 1.5)]
        verdict, text = self.check((points, faces))
        self.assertEqual(verdict["counts"]["t_junction"], 2)
        self.assertIn("T-junction", text)
        self.assertIn("vertex 8 on an edge of face 1", text)

    def test_concave_faces_are_called_so(self):
        verdict, text = self.check(CAGES["concave"])
        folded = [v["elements"] for v in verdict["violations"] if v["kind"] == "folded_face"]
        self.assertEqual(folded, [[0], [1]])
        self.assertIn("concave", text)
        self.assertFalse([v for v in verdict["violations"]
                          if v["kind"] == "self_intersection" and v["elements"][0] == v["elements"][-1]])

    def test_what_would_fit_is_said_whether_valid_or_not(self):
        for name, words in (("in cm", "scaled by 0.01"), ("y up", "turned by 90 degrees about the x axis"),
                            ("beside", "shifted by (-40, -3, 0)"), ("y up in mm", "scaled by 0.001")):
            verdict, text = self.check(CAGES[name])
            self.assertIn(words, text, name)
            self.assertEqual([n["code"] for n in verdict["notes"]], ["cage_elsewhere"])
            bound = self.run_here("bind", "the model.obj", "a cage.obj", "-o", "w.npz")
            self.assertIn(words, bound.stderr)
        for name in ("split", "pieces"):
            self.assertNotIn("would fit", self.check(CAGES[name])[1])

    def test_lists_are_as_long_as_asked(self):
        tight = changed(box(), lambda x, y, z: (0.3 * x, 0.3 * y, 0.3 * z))
        for count, listed in (("3", 3), ("all", 8), ("0", 0)):
            verdict, text = self.check(tight, "--list", count)
            self.assertEqual(verdict["counts"]["vertex_outside"], 8)
            outside = [v for v in verdict["violations"] if v["kind"] == "vertex_outside"]
            self.assertEqual(len(outside), listed)
            self.assertEqual("--list all" in text, listed < 8)
            for violation in outside:
                self.assertEqual(violation["file"], "the model.obj")
                self.assertEqual(len(violation["place"]), 3)
                self.assertTrue(violation["message"] and violation["remedy"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
