"""Cages within a budget, near the model, finer where asked, in pieces; and cages compared.

Called as: budget_test.py PROGRAM [unittest arguments]
"""

import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DONE, COULD_NOT, BAD_INPUT, NOT_AS_ASKED = 0, 1, 2, 3


def torus(around=32, across=16, tube=0.3, offset=(0, 0, 0), scale=1.0, first=1):
    """Vertices and faces (from `first`) of a torus about the z axis."""
    vertices, faces = [], []
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(across):
            b = 2 * math.pi * j / across
            r = 1 + tube * math.cos(b)
            p = (r * math.cos(a), r * math.sin(a), tube * math.sin(b))
            vertices.append(tuple(scale * x + o for x, o in zip(p, offset)))
            n = (i + 1) % around * across
            k = (j + 1) % across
            faces.append((first + i * across + j, first + n + j, first + n + k, first + i * across + k))
    return vertices, faces


def obj(*meshes):
    text = ""
    for vertices, _ in meshes:
        text += "".join("v %.9g %.9g %.9g\n" % v for v in vertices)
    for _, faces in meshes:
        text += "".join("f " + " ".join(map(str, f)) + "\n" for f in faces)
    return text


def ply_with_colors(mesh, color_of):
    vertices, faces = mesh
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {c}" for c in "xyz"] + [f"property uchar {c}" for c in ("red", "green", "blue")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += ["%.9g %.9g %.9g %d %d %d" % (*v, *color_of(v)) for v in vertices]
    lines += ["4 " + " ".join(str(i - 1) for i in f) for f in faces]
    return "\n".join(lines) + "\n"


def npy(values):
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d,), }" % len(values)
    header = header.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + \
        struct.pack("<%dd" % len(values), *values)


def run(*arguments):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, check=False)


def vertices_of(path):
    return [tuple(map(float, line.split()[1:])) for line in path.read_text().splitlines() if line.startswith("v ")]


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.file("model.obj", obj(torus()))
        self.cage = self.folder / "cage.obj"
        self.figures = self.folder / "cage.json"

    def file(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content, encoding="utf-8")
        return path

    def generate(self, *options, model=None, pieces=False, ends=DONE):
        made = run("generate", model or self.model, "-o", self.cage, "--json", self.figures, *options)
        self.assertEqual(made.returncode, ends, made.stderr)
        self.assertEqual(made.stderr.count("\n"), 0 if ends == DONE else 1, made.stderr)
        judged = run("check", model or self.model, self.cage, *(["--allow-pieces"] if pieces else []))
        self.assertEqual(judged.returncode, DONE, judged.stdout)
        return json.loads(self.figures.read_text()), made.stdout

    def expect_refusal(self, *options, says=()):
        made = run("generate", self.model, "-o", self.cage, *options)
        self.assertEqual(made.returncode, BAD_INPUT, (options, made.stdout, made.stderr))
        self.assertFalse(self.cage.exists())
        for word in says:
            self.assertIn(word, made.stderr)


class SeveralModels(InAFolder):
    def test_get_one_cage(self):
        coat = self.file("coat.obj", obj(torus(tube=0.35, offset=(0, 0, 0.4))))
        made = run("generate", self.model, coat, "-o", self.cage, "--vertices", 60)
        self.assertEqual(made.returncode, DONE, made.stderr)
        for model in (self.model, coat):
            self.assertEqual(run("check", model, self.cage).returncode, DONE)

    def test_are_read_before_anything_is_made_and_never_written_over(self):
        self.assertIn("none.obj", run("generate", self.model, self.folder / "none.obj", "-o", self.cage).stderr)
        self.assertFalse(self.cage.exists())
        coat = self.file("coat.obj", obj(torus()))
        self.assertEqual(run("generate", self.model, coat, "-o", coat).returncode, BAD_INPUT)
        self.assertIn("f ", coat.read_text())


class OwnCage(InAFolder):
    def test_is_made_valid_and_tight_with_its_faces(self):
        self.generate("--vertices", 40)
        tight = vertices_of(self.cage)
        faces = [line for line in self.cage.read_text().splitlines() if line.startswith("f ")]
        own = self.file("own.obj", "".join("v %.9g %.9g %.9g\n" % tuple(0.8 * x for x in v) for v in tight)
                        + "\n".join(faces) + "\n")
        self.assertEqual(run("check", self.model, own).returncode, COULD_NOT)
        data, said = self.generate("--start", own)
        self.assertEqual([line for line in self.cage.read_text().splitlines() if line.startswith("f ")], faces)
        self.assertEqual(data["method"], "start")
        self.assertIn("made from the cage given", said)
        self.assertIn("makes no difference here", run("generate", self.model, "-o", self.cage, "--start", own,
                                                      "--vertices", 9).stderr)

    def test_that_no_moving_mends_is_refused_by_its_name(self):
        own = self.file("own.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.expect_refusal("--start", own, says=["own.obj", "it is open: 3 edges"])
        self.expect_refusal("--start", self.folder / "none.obj", says=["none.obj"])
        same = run("generate", self.model, "-o", own, "--start", own)
        self.assertEqual(same.returncode, BAD_INPUT)
        self.assertIn("f 1 2 3", own.read_text())


class Budget(InAFolder):
    def test_of_vertices_and_of_faces_is_kept(self):
        for options in (("--vertices", 40), ("--faces", 76), ("--vertices", 200, "--faces", 76),
                        ("--vertices", 40, "--faces", 400), ("--vertices", 40, "--method", "boxes-improved")):
            data, _ = self.generate(*options)
            self.assertTrue(data["budget"]["reached"])
            self.assertLessEqual(data["cage"]["vertices"], 40, options)
            self.assertLessEqual(data["cage"]["faces"], 80, options)
            self.assertGreaterEqual(data["cage"]["vertices"], 30, options)

    def test_is_a_hundred_vertices_where_nothing_is_said_of_it(self):
        data, _ = self.generate()
        self.assertLessEqual(data["cage"]["vertices"], 100)
        self.assertGreater(data["cage"]["vertices"], 80)
        self.assertEqual(data["method"], "envelope")
        self.assertTrue(data["symmetry"]["mirrored"])
        best = self.cage.read_bytes()
        self.generate("--method", "envelope", "--vertices", 100, "--clearance", "0.2%", "--symmetry", "auto")
        self.assertEqual(self.cage.read_bytes(), best)

    def test_that_cannot_be_kept_ends_with_three_and_a_reason_in_one_sentence(self):
        data, text = self.generate("--vertices", 5, "--depth", 3, ends=NOT_AS_ASKED)  # a torus needs seven
        self.assertEqual([r["reason"] for r in data["remarks"] if r["shortfall"]], ["budget_not_reached"])
        self.assertFalse(data["budget"]["reached"])
        self.assertIn("not as asked for", text)

    def test_keeps_the_clearance_from_both_starts(self):
        for method in ("envelope", "boxes-improved"):
            data, text = self.generate("--vertices", 40, "--clearance", 0.02, "--method", method)
            self.assertGreaterEqual(data["cage"]["clearance"], 0.02 * (1 - 1e-9), method)
            self.assertEqual(data["budget"]["clearance"], 0.02)
            self.assertNotIn("came nearer", text)

    def test_out_of_range_is_refused(self):
        for option in (("--vertices", 3), ("--vertices", -5), ("--vertices", "x"), ("--vertices", "10.5"),
                       ("--faces", 2), ("--faces", "many"), ("--clearance", 0), ("--clearance", 1),
                       ("--method", "wrap"), ("--closing", 2)):
            self.expect_refusal(*option)

    def test_refusals_name_the_cause_and_what_may_be_written(self):
        self.expect_refusal("--clearance", "60%", says=("--clearance", "60%", "0.0001% to 50%"))
        self.expect_refusal("--clearance", "5mm", says=("5mm", "0.0001% to 50%"))
        self.expect_refusal("--vertices", "2", says=("--vertices", "4 to 100000"))
        self.expect_refusal("--method", "wrap", says=("wrap", "envelope|boxes|boxes-improved"))

    def test_lengths_are_taken_as_percent_and_as_fraction(self):
        for option, percent, fraction in (("--clearance", "1.5%", 0.015), ("--closing", "1%", 0.01)):
            data, _ = self.generate("--vertices", 24, option, percent)
            self.assertEqual(data["options"][option[2:]], fraction)
            cage = self.cage.read_bytes()
            self.generate("--vertices", 24, option, fraction)
            self.assertEqual(self.cage.read_bytes(), cage)

    def test_options_that_make_no_difference_are_told(self):
        made = run("generate", self.model, "-o", self.cage, "--method", "boxes", "--depth", 2, "--vertices", 40)
        self.assertEqual(made.returncode, DONE)
        self.assertIn("--vertices makes no difference", made.stderr)
        self.assertEqual(made.stderr.count("\n"), 1)


class Boxes(InAFolder):
    def test_are_meant_where_one_of_their_options_is_given(self):
        data, text = self.generate("--depth", 2, "--quads")
        self.assertEqual(data["method"], "boxes")
        self.assertIn("quads", text)
        self.assertEqual(len(data["boxes"]), sum(not node["children"] for node in data["tree"]))
        improved, _ = self.generate("--depth", 2, "--vertices", 30)
        self.assertEqual(improved["method"], "boxes-improved")
        self.assertLessEqual(improved["cage"]["vertices"], 30)

    def test_improved_go_by_an_earlier_name_too(self):
        data, _ = self.generate("--method", "obb", "--vertices", 30)
        self.assertEqual(data["method"], "boxes-improved")


class MaxGap(InAFolder):
    def test_is_kept_as_percent_and_as_fraction(self):
        data, text = self.generate("--max-gap", "4%")
        self.assertTrue(data["budget"]["reached"])
        self.assertLessEqual(data["budget"]["gap"], 0.04)
        self.assertLessEqual(data["cage"]["max_distance"], data["budget"]["gap"] * (1 + 1e-9))
        self.assertIn("proved", text)
        percent = self.cage.read_bytes()
        self.generate("--max-gap", "0.04")
        self.assertEqual(self.cage.read_bytes(), percent)
        coarser, _ = self.generate("--max-gap", "8%")
        self.assertLess(coarser["cage"]["vertices"], data["cage"]["vertices"])

    def test_that_a_limit_does_not_allow_gives_the_nearest_cage_and_says_so(self):
        data, text = self.generate("--max-gap", "0.5%", "--vertices", 20, ends=NOT_AS_ASKED)
        self.assertFalse(data["budget"]["reached"])
        self.assertLessEqual(data["cage"]["vertices"], 20)
        self.assertGreater(data["budget"]["gap"], 0.005)
        self.assertIn("more vertices", text)

    def test_within_the_clearance_is_refused_with_a_remedy(self):
        self.expect_refusal("--max-gap", "1%", "--clearance", 0.01, says=("model.obj", "smaller clearance"))

    def test_out_of_range_is_refused(self):
        for gap in ("0", "0%", "-1%", "51%", "0.6", "1 %", "%", "near", "nan", "inf", "1%%", ""):
            self.expect_refusal("--max-gap", gap)


class Density(InAFolder):
    def setUp(self):
        super().setUp()
        self.points = torus()[0]

    def share_at_right(self):
        points = vertices_of(self.cage)
        return sum(p[0] > 0 for p in points) / len(points)

    def test_from_a_file_makes_the_cage_finer_there(self):
        self.generate("--vertices", 60)
        even = self.share_at_right()
        weights = [16 if p[0] > 0 else 1 for p in self.points]
        text = self.file("weights.txt", "# right side\n" + "".join(f"{w}\n" for w in weights))
        self.generate("--vertices", 60, "--density", text)
        self.assertGreater(self.share_at_right(), even + 0.1)
        from_text = self.cage.read_bytes()
        self.generate("--vertices", 60, "--density", self.file("weights.npy", npy(weights)))
        self.assertEqual(self.cage.read_bytes(), from_text)

    def test_from_painted_colors_makes_the_cage_finer_where_red(self):
        red = self.file("red.ply", ply_with_colors(torus(), lambda p: (255, 0, 0) if p[0] > 0 else (255, 255, 255)))
        self.generate("--vertices", 60, "--density", "colors", model=red)
        painted = self.share_at_right()
        blue = self.file("blue.ply", ply_with_colors(torus(), lambda p: (0, 0, 255) if p[0] < 0 else (90, 90, 90)))
        self.generate("--vertices", 60, "--density", "colors", model=blue)
        self.assertGreater(painted, 0.6)
        self.assertGreater(self.share_at_right(), 0.6)

    def test_that_is_no_density_is_refused_and_the_place_is_named(self):
        count = len(self.points)
        for content, words in (("1\n" * (count - 1), ("numbers", str(count))),
                               ("1\n" * (count + 1), ("numbers", str(count))),
                               ("1\n1\n-1\n" + "1\n" * (count - 3), (":3:",)),
                               ("1\nnan\n" + "1\n" * (count - 2), (":2:",)),
                               ("1\nred\n" + "1\n" * (count - 2), (":2:", "red")),
                               ("0\n" * count, ("above 0",)),
                               (npy([1.0] * (count - 1) + [float("nan")]), (f"number {count - 1}",)),
                               (npy([1.0] * 3), ("3 numbers",)),
                               (npy([1.0] * count)[:-9], ("cut short",))):
            name = "d.npy" if isinstance(content, bytes) else "d.txt"
            self.expect_refusal("--density", self.file(name, content), says=(name, *words))
        self.expect_refusal("--density", self.folder / "none.txt", says=("none.txt",))
        self.expect_refusal("--density", "colors", says=("no vertex colors",))

    def test_from_colors_without_paint_is_refused(self):
        white = self.file("white.ply", ply_with_colors(torus(), lambda p: (255, 255, 255)))
        made = run("generate", white, "-o", self.cage, "--density", "colors")
        self.assertEqual(made.returncode, BAD_INPUT)
        self.assertIn("red", made.stderr)
        self.assertFalse(self.cage.exists())


class PiecesApart(InAFolder):
    def test_give_a_closed_cage_each(self):
        first = torus()
        model = self.file("two.obj", obj(first, torus(16, 8, offset=(3, 0, 0), scale=0.5, first=len(first[0]) + 1)))
        together, _ = self.generate("--vertices", 60, model=model)
        self.assertEqual(together["start"]["bridges"], 1)
        for method in ("envelope", "boxes-improved"):
            data, text = self.generate("--vertices", 60, "--pieces", "apart", "--method", method,
                                       model=model, pieces=True)
            self.assertEqual(data["budget"]["pieces"], 2)
            self.assertEqual(data["budget"]["joined"], 0)
            self.assertLessEqual(data["cage"]["vertices"], 60)
            self.assertIn("2 closed pieces", text)
            self.assertIn("mirrored in the plane", text)
            described = json.loads(self.described())
            self.assertEqual(described["components"], 2)

    def described(self):
        path = self.folder / "info.json"
        self.assertEqual(run("info", self.cage, "--json", path).returncode, DONE)
        return path.read_text()

    def test_that_share_a_cage_are_told(self):
        tori = [torus(16, 8, offset=(3 * k, 0, 0), first=1 + 128 * k) for k in range(3)]
        model = self.file("three.obj", obj(*tori))
        data, text = self.generate("--vertices", 16, "--pieces", "apart", model=model, pieces=True)
        self.assertLessEqual(data["budget"]["pieces"], 2)
        self.assertEqual(data["budget"]["pieces"] + data["budget"]["joined"], 3)
        self.assertIn("share a cage", text)

    def test_or_together_and_nothing_else(self):
        self.expect_refusal("--pieces", "separate")


class Compare(InAFolder):
    def test_shows_cages_side_by_side_valid_or_not(self):
        self.generate("--vertices", 80)
        fine = self.cage.rename(self.folder / "fine.obj")
        self.generate("--vertices", 20)
        coarse = self.cage.rename(self.folder / "coarse.obj")
        inside = self.file("inside.obj", obj(torus(tube=0.1)))
        table = self.folder / "table.json"
        told = run("compare", self.model, fine, coarse, inside, "--json", table)
        self.assertEqual(told.returncode, DONE, told.stderr)
        head, *rows = told.stdout.splitlines()
        self.assertEqual(head.split(), ["fine.obj", "coarse.obj", "inside.obj"])
        cells = {row[:21].strip(): row[21:].split() for row in rows[:15]}
        self.assertEqual(cells["valid"], ["yes", "yes", "NO"])
        self.assertEqual(cells["quads"], ["0", "0", "512"])
        self.assertIn("vertex_outside", told.stdout)
        data = json.loads(table.read_text())
        errors = [cage["poses"]["bend"]["mean_error"] for cage in data["cages"]]
        self.assertLess(errors[0], errors[1])
        self.assertGreater(errors[0], 0)
        self.assertLess(data["cages"][0]["poses"]["twist"]["mean_error"],
                        data["cages"][1]["poses"]["twist"]["mean_error"])
        self.assertEqual([cage["valid"] for cage in data["cages"]], [True, True, False])
        self.assertGreater(data["cages"][2]["violations"]["vertex_outside"], 0)
        self.assertEqual(run("compare", self.model, fine, "--no-poses").returncode, DONE)

    def test_takes_the_model_itself_as_a_perfect_carrier(self):
        table = self.folder / "table.json"
        told = run("compare", self.model, self.model, "--json", table)
        self.assertEqual(told.returncode, DONE, told.stderr)
        cage = json.loads(table.read_text())["cages"][0]
        self.assertFalse(cage["valid"])
        self.assertLess(cage["poses"]["bend"]["max_error"], 1e-9)

    def test_bends_limbs_at_joints(self):
        def ellipsoid(middle, radii, first):  # nearly: a torus almost without a hole
            vertices, faces = torus(tube=0.999, first=first)
            return [tuple(m + r * x / s for m, r, x, s in zip(middle, radii, v, (2, 2, 1))) for v in vertices], faces

        model = self.file("figure.obj", obj(ellipsoid((0, 0, 0), (1, 1.6, 0.7), 1),
                                            ellipsoid((1.8, 0, 0), (1.4, 0.25, 0.25), 513)))
        joints = self.file("joints.txt", "# an elbow, a skeleton: shoulder, elbow, hand\n1 0 0 0\n2 0 0 1\n3 0 0 2\n")
        table = self.folder / "table.json"
        told = run("compare", model, model, "--joints", joints, "--json", table)
        self.assertEqual(told.returncode, DONE, told.stderr)
        self.assertIn("in four directions each: 1", told.stdout)
        bent = json.loads(table.read_text())["cages"][0]["poses"]["limbs"]
        limb, = bent["limbs"]
        self.assertAlmostEqual(limb["joint"][0], 2, delta=0.2)
        self.assertGreater(limb["along"][0], 0.9)
        self.assertLess(limb["max_error"], 1e-6)  # the model is a perfect handle of its own
        self.assertLess(limb["max_drag"], 1e-6)
        cage = self.folder / "cage.obj"
        made = run("generate", model, "-o", cage, "--vertices", 50, "--joints", joints, "--json", self.folder / "r.json")
        self.assertEqual(made.returncode, DONE, made.stderr)
        ring, = json.loads((self.folder / "r.json").read_text())["limb_rings"]
        points = vertices_of(cage)
        self.assertAlmostEqual(sum(points[v][0] for v in ring) / len(ring), 2, delta=0.25)
        run("compare", model, cage, "--json", table)
        bent = json.loads(table.read_text())["cages"][0]["poses"]["limbs"]
        self.assertGreater(bent["limbs"][0]["mean_error"], 0)
        self.assertAlmostEqual(bent["reached_degrees"], 45, delta=8)
        self.assertLess(bent["drag"], 0.01)
        for bad in ("1 2\n", "", "0 0 0 1\n"):
            refused = run("compare", model, cage, "--joints", self.file("bad.txt", bad))
            self.assertEqual(refused.returncode, BAD_INPUT, refused.stdout)
            self.assertIn("bad.txt", refused.stderr)

    def test_refuses_what_it_cannot_read(self):
        for arguments in ((self.model,), (self.model, self.folder / "none.obj"), (self.folder / "none.obj", self.model),
                          (self.model, self.file("bad.obj", "v 0 0 nan\n"))):
            told = run("compare", *arguments)
            self.assertEqual(told.returncode, BAD_INPUT, told.stdout)
        self.assertEqual(sorted(os.listdir(self.folder)), ["bad.obj", "model.obj"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
