"""The command line from outside: what it writes, what it says, and how it ends.

Called as: cli_test.py PROGRAM SAMPLES_DIR [unittest arguments]
"""

import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SAMPLES = pathlib.Path(sys.argv[2]).resolve()
CREATURE = SAMPLES / "creature.obj"

DONE, COULD_NOT, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

CUBE = """v -1 -1 -1
v 1 -1 -1
v -1 1 -1
v 1 1 -1
v -1 -1 1
v 1 -1 1
v -1 1 1
v 1 1 1
f 1 5 7 3
f 2 4 8 6
f 1 2 6 5
f 3 7 8 4
f 1 3 4 2
f 5 6 8 7
"""


def run(*arguments, **options):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, check=False, **options)


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content, encoding="utf-8")
        return path

    def small_cage(self, *options):
        """A quick cage of a torus-like sample: coarse voxels."""
        cage = self.folder / "cage.obj"
        made = run("generate", CREATURE, "-o", cage, "--resolution", 32, "--depth", 2, *options)
        self.assertEqual(made.returncode, DONE, made.stderr)
        return cage


class Generate(InAFolder):
    def test_writes_a_cage_that_check_certifies(self):
        for slicing in ("volume", "published"):
            cage = self.small_cage("--slicing", slicing)
            checked = run("check", CREATURE, cage)
            self.assertEqual(checked.returncode, DONE, checked.stdout)
            self.assertTrue(checked.stdout.startswith("valid"))

    def test_says_what_it_did(self):
        made = run("generate", CREATURE, "-o", self.folder / "c.obj", "--resolution", 32, "--depth", 1)
        self.assertEqual(made.stderr, "")
        for word in ("boxes", "cuts", "vertices", "volume", "mean", "greatest", "least", "time"):
            self.assertIn(word, made.stdout)
        quiet = run("generate", CREATURE, "-o", self.folder / "c.obj", "--depth", 0, "--quiet")
        self.assertEqual(quiet.stdout + quiet.stderr, "")

    def test_describes_every_box_cut_and_cross_section_in_json(self):
        figures = self.folder / "figures.json"
        self.small_cage("--json", figures)
        data = json.loads(figures.read_text())
        self.assertTrue(data["cage"]["valid"])
        self.assertGreater(data["cage"]["clearance"], 0)
        self.assertEqual([node["parent"] for node in data["tree"]][0], -1)
        root = data["tree"][0]
        self.assertEqual(len(root["cross_sections"]), 3)
        self.assertGreater(max(root["cross_sections"][0]["f"]), 0)
        self.assertIn(root["cut"]["axis"], (0, 1, 2))
        leaves = [i for i, node in enumerate(data["tree"]) if not node["children"]]
        self.assertEqual(data["boxes"], leaves)

    def test_mirrors_cages_exactly_as_written_and_tells_the_pairs(self):
        cage, figures = self.folder / "c.obj", self.folder / "c.json"
        made = run("generate", CREATURE, "-o", cage, "--vertices", 40, "--symmetry", "auto", "--json", figures)
        self.assertEqual(made.returncode, DONE, made.stderr)
        self.assertIn("mirrored in the plane x = 0", made.stdout)
        self.assertEqual(run("check", CREATURE, cage).returncode, DONE)
        lines = [line.split() for line in cage.read_text().splitlines()]
        points = [tuple(map(float, line[1:4])) for line in lines if line[:1] == ["v"]]
        symmetry = json.loads(figures.read_text())["symmetry"]
        self.assertEqual(symmetry["plane"], {"normal": [1, 0, 0], "offset": 0})
        self.assertEqual(len(symmetry["vertex_partners"]), len(points))
        for (x, y, z), partner in zip(points, symmetry["vertex_partners"]):
            self.assertEqual(points[partner], (-x, y, z))
        faces = [[int(c) - 1 for c in line[1:]] for line in lines if line[:1] == ["f"]]
        for face, partner in zip(faces, symmetry["face_partners"]):
            self.assertEqual({symmetry["vertex_partners"][v] for v in face}, set(faces[partner]))

    def test_gives_the_same_bytes_on_any_number_of_threads(self):
        outputs = []
        for threads in (1, 2, 1000):
            cage = self.folder / f"cage{threads}.obj"
            made = run("generate", CREATURE, "-o", cage, "--resolution", 32, "--depth", 3, "--threads", threads, "--quiet")
            self.assertEqual(made.stderr, "")
            outputs.append(cage.read_bytes())
        self.assertEqual(outputs[0], outputs[1])
        self.assertEqual(outputs[0], outputs[2])

    def test_writes_every_format_so_that_the_cage_stays_valid(self):
        for extension in ("obj", "ply", "off", "stl"):
            cage = self.folder / f"cage.{extension}"
            made = run("generate", CREATURE, "-o", cage, "--resolution", 32, "--depth", 2)
            self.assertEqual(made.returncode, DONE, made.stderr)
            # STL repeats vertices for every facet, so it can only be judged welded: info says closed.
            if extension == "stl":
                self.assertIn("closed", run("info", cage).stdout)
            else:
                self.assertEqual(run("check", CREATURE, cage).returncode, DONE)

    def test_emits_boxes_and_voxels(self):
        boxes = self.folder / "boxes.obj"
        made = run("generate", CREATURE, "-o", boxes, "--resolution", 32, "--depth", 2, "--emit", "boxes")
        self.assertEqual(made.returncode, DONE, made.stderr)
        text = boxes.read_text()
        objects = sum(line.startswith("o ") for line in text.splitlines())
        self.assertGreater(objects, 2)
        self.assertEqual(sum(line.startswith("f ") for line in text.splitlines()), 6 * objects)
        voxels = self.folder / "voxels.obj"
        run("generate", CREATURE, "-o", voxels, "--resolution", 16, "--emit", "voxels")
        self.assertIn("o feature", voxels.read_text())
        self.assertEqual(run("generate", CREATURE, "-o", voxels, "--emit", "2").returncode, BAD_INPUT)

    def test_refuses_outputs_that_cannot_be_written_before_it_works(self):
        for output, word in ((self.folder / "cage.xyz", ".obj"), (self.folder, "folder"),
                             (self.folder / "no" / "cage.obj", "does not exist")):
            made = run("generate", CREATURE, "-o", output)
            self.assertEqual(made.returncode, BAD_INPUT)
            self.assertIn(word, made.stderr)
            self.assertEqual(made.stderr.count("\n"), 1, made.stderr)

    def test_refuses_options_out_of_range(self):
        for option in (("--depth", "-1"), ("--depth", "x"), ("--resolution", "4"), ("--eta", "0"),
                       ("--slicing", "other"), ("--split", "x"), ("--boxes", "-3"), ("--nonsense", "1")):
            made = run("generate", CREATURE, "-o", self.folder / "c.obj", *option)
            self.assertEqual(made.returncode, BAD_INPUT, option)
            self.assertFalse((self.folder / "c.obj").exists())

    def test_stops_at_an_interrupt_and_leaves_nothing(self):
        cage = self.folder / "cage.obj"
        terminal, errors = os.openpty()  # progress is shown on terminals only
        self.addCleanup(os.close, terminal)
        process = subprocess.Popen(
            [str(PROGRAM), "generate", str(CREATURE), "-o", str(cage), "--resolution", "256", "--depth", "8"],
            stdout=subprocess.DEVNULL, stderr=errors)
        os.close(errors)
        shown = self.read_until(terminal, b"classifying")  # at work, however busy the machine is
        process.send_signal(signal.SIGINT)
        shown += self.read_until(terminal, b"cancelled")
        self.assertEqual(process.wait(timeout=120), INTERRUPTED, shown)
        self.assertEqual(os.listdir(self.folder), [])

    def read_until(self, terminal, word):
        """What the terminal shows up to `word`; all of it where the word never comes."""
        shown = b""
        while word not in shown:
            try:
                shown += os.read(terminal, 4096)
            except OSError:  # the program has ended
                break
        return shown


class Check(InAFolder):
    def test_says_no_with_kind_and_place(self):
        model = self.file("model.obj", CUBE)
        scaled = "".join(
            "v " + " ".join(str(0.5 * float(x)) for x in line.split()[1:]) + "\n"
            if line.startswith("v") else line + "\n" for line in CUBE.splitlines())
        cage = self.file("cage.obj", scaled)
        report = self.folder / "report.json"
        checked = run("check", model, cage, "--json", report)
        self.assertEqual(checked.returncode, COULD_NOT)
        data = json.loads(report.read_text())
        self.assertFalse(data["valid"])
        self.assertIn("vertex_outside", report.read_text())

    def test_refuses_what_it_cannot_read(self):
        self.assertEqual(run("check", CREATURE, self.folder / "none.obj").returncode, BAD_INPUT)


class Info(InAFolder):
    def test_describes_a_model(self):
        described = self.folder / "info.json"
        told = run("info", self.file("cube.obj", CUBE), "--json", described)
        self.assertEqual(told.returncode, DONE, told.stderr)
        for word in ("8 vertices", "closed", "genus", "volume", "Mirror plane x = 0"):
            self.assertIn(word, told.stdout)
        self.assertEqual(json.loads(described.read_text())["mirror_plane"]["normal"], [1, 0, 0])


class Help(unittest.TestCase):
    def test_every_command_explains_every_option(self):
        overview = run("--help")
        self.assertEqual(overview.returncode, DONE)
        for command in ("generate", "check", "info"):
            self.assertIn(command, overview.stdout)
            text = run(command, "--help")
            self.assertEqual(text.returncode, DONE)
            self.assertIn("Usage", text.stdout)

    def test_values_are_shown_as_words_with_examples(self):
        text = run("generate", "--help").stdout
        for words in ("envelope|boxes|boxes-improved", "cage|boxes|voxels", "off|auto|x|y|z", "together|apart",
                      "--clearance PERCENT=0.2%", "--vertices COUNT=100", "Examples:"):
            self.assertIn(words, text)
        self.assertNotIn("->", text)

    def test_misuse_ends_with_two(self):
        self.assertEqual(run().returncode, BAD_INPUT)
        for words in (["nonsense"], ["--threads", "2", "nonsense", "a.obj"]):
            misused = run(*words)
            self.assertEqual(misused.returncode, BAD_INPUT)
            self.assertRegex(misused.stderr, "no command 'nonsense'; there are generate, .*deform")
        self.assertIn("deformed-cage", run("sequence", "--help").stdout)
        self.assertEqual(run("generate").returncode, BAD_INPUT)


NAN_OBJ = "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n"
BAD_FILES = {
    "empty.obj": "",
    "empty.stl": b"",
    "empty.ply": b"",
    "empty.off": b"",
    "empty.glb": b"",
    "garbage.obj": bytes(range(256)) * 64,
    "garbage.ply": bytes(range(255, -1, -1)) * 64,
    "garbage.stl": b"\x93" * 5000,
    "garbage.off": b"\x00\xff" * 3000,
    "garbage.glb": b"glTF" + b"\xee" * 2000,
    "truncated.obj": "v 0 0 0\nv 1 0 0\nv 0 1",
    "truncated.off": "OFF\n3 1 0\n0 0 0\n1 0 0\n",
    "truncated.stl": b"\0" * 80 + struct.pack("<I", 100) + b"\0" * 60,
    "truncated.glb": b"glTF" + struct.pack("<II", 2, 900) + struct.pack("<I4s", 800, b"JSON") + b"{",
    "nan.obj": NAN_OBJ,
    "infinite.obj": NAN_OBJ.replace("nan", "inf"),
    "overflow.obj": NAN_OBJ.replace("nan", "1e999"),
    "index_zero.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n",
    "index_high.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
    "index_huge.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n",
    "index_low.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",
    "two_corners.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",
    "huge_count.off": "OFF\n4000000000 4000000000 0\n0 0 0\n",
    "huge_count.stl": b"\0" * 80 + struct.pack("<I", 0x7FFFFFFF) + b"\0" * 50,
    "huge_count.ply": "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\n"
                      "property float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n",
    "negative_count.off": "OFF\n-3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "coincident.obj": "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n",
    "collinear.obj": "v 0 0 0\nv 1 1 1\nv 3 3 3\nf 1 2 3\n",
    "points_only.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    "unknown.xyz": "1 2 3\n",
}


class BadInput(InAFolder):
    def expect_refusal(self, model, name):
        output = self.folder / "out.obj"
        for command in (("generate", model, "-o", output), ("check", model, model)):
            if command[0] == "check" and name in ("coincident.obj", "collinear.obj"):
                continue  # a legal file, and a cage that the judge rejects
            with self.subTest(file=name, command=command[0]):
                ended = run(*command)
                self.assertEqual(ended.returncode, BAD_INPUT, ended.stdout + ended.stderr)
                self.assertEqual(ended.stderr.count("\n"), 1, ended.stderr)
                self.assertIn(name, ended.stderr)
                self.assertFalse(output.exists())

    def test_is_refused_in_one_line_that_names_the_file(self):
        for name, content in BAD_FILES.items():
            self.expect_refusal(self.file(name, content), name)
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(BAD_FILES))

    def test_names_the_line_and_the_remedy(self):
        ended = run("info", self.file("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"))
        self.assertIn("bad.obj:4:", ended.stderr)

    def test_folders_and_missing_files_are_refused(self):
        (self.folder / "folder.obj").mkdir()
        self.expect_refusal(self.folder / "folder.obj", "folder.obj")
        self.expect_refusal(self.folder / "missing.obj", "missing.obj")

    @unittest.skipIf(os.geteuid() == 0, "the superuser may read everything")
    def test_unreadable_files_are_refused(self):
        path = self.file("secret.obj", CUBE)
        path.chmod(0)
        self.expect_refusal(path, "secret.obj")

    def test_any_truncation_of_a_small_file_ends_well(self):
        for length in range(0, len(CUBE), 7):
            ended = run("info", self.file("cut.obj", CUBE[:length]))
            self.assertIn(ended.returncode, (DONE, BAD_INPUT), ended.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
