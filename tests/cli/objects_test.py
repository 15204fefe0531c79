"""Models and cages that are objects of one file, and models with a pose, from outside.

Called as: objects_test.py PROGRAM [unittest arguments]
"""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
TRIANGLES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
             (1, 3, 7), (1, 7, 5)]


def glb(nodes, skin=None, joints=()):
    """A GLB file whose nodes show one box: (name, scale, translation) each; joints are further nodes."""
    binary = b"".join(struct.pack("<3f", *c) for c in CORNERS) + b"".join(struct.pack("<3H", *t) for t in TRIANGLES)
    views = [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1] * 3, "max": [1] * 3},
                 {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]
    attributes = {"POSITION": 0}
    if skin:
        for name, kind, form, values in (("JOINTS_0", 5121, "<4B", (0, 0, 0, 0)), ("WEIGHTS_0", 5126, "<4f", (1, 0, 0, 0))):
            data = struct.pack(form, *values) * 8
            attributes[name] = len(accessors)
            accessors.append({"bufferView": len(views), "componentType": kind, "count": 8, "type": "VEC4"})
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            binary += data
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes) + len(joints)))}],
        "nodes": [{"mesh": 0, "name": n, "scale": [s] * 3, "translation": t, **({"skin": 0} if skin else {})}
                  for n, s, t in nodes] + list(joints),
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 1}]}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}],
        **({"skins": [skin]} if skin else {})}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    return struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + \
        text + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def cage(size, move=0.0):
    return "".join(f"v {x * size + move * (z > 0)} {y * size} {z * size}\n" for x, y, z in CORNERS) + \
        "".join("f {} {} {}\n".format(*(v + 1 for v in t)) for t in TRIANGLES)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def run_program(self, *arguments, code=0):
        words = [str(self.folder / a) if isinstance(a, str) and (a.startswith("out") or (self.folder / a).exists()) else str(a)
                 for a in arguments]
        ran = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, code, ran.stderr + ran.stdout)
        return ran.stdout + ran.stderr


class Objects(InFolder):
    def setUp(self):
        super().setUp()
        self.write("all.glb", glb([("Body", 0.5, [0, 0, 0]), ("Body", 0.25, [9, 0, 0]), ("Cage", 2, [0, 0, 0]),
                                   ("Cage", 2, [9, 0, 0])]))
        self.write("posed.obj", cage(2, move=0.5))

    def test_a_name_stands_for_all_that_have_it(self):
        self.assertIn("16 vertices, 24 faces", self.run_program("info", "all.glb", "--only", "Body"))
        self.assertIn("8 vertices, 12 faces", self.run_program("info", "all.glb", "--only", "Body#2"))

    def test_an_unknown_name_is_refused_with_those_there_are(self):
        for name in ("Head", "Body#3", "Body#0", "Body#"):
            told = self.run_program("info", "all.glb", "--only", name, code=2)
            self.assertIn(f"no group '{name}'; it has Body#1, Body#2, Cage#1, Cage#2", told)

    def test_specks_are_told_and_ignored_by_generate_and_its_judge(self):
        specked = cage(1) + "v 1e6 1e6 1e6\n" + "v 9000 0 0\nv 9000.1 0 0\nv 9000 0.1 0\nf 10 11 12\n"
        self.write("specked.obj", specked)
        generate = ("generate", "specked.obj", "-o", "out.obj", "--vertices", "20", "--json", "out.json")
        told = self.run_program(*generate, "--method", "boxes", "--depth", "0")
        self.assertIn("2 tiny pieces far from the rest are enclosed, too", told)
        self.assertIn("leave them out with --ignore-specks", told)
        self.assertNotIn("enclosed, too", self.run_program(*generate, "--ignore-specks"))
        report = json.loads((self.folder / "out.json").read_text())
        self.assertEqual(report["options"]["ignore-specks"], "on")
        self.assertEqual([remark["reason"] for remark in report["remarks"]], ["specks_ignored"])
        self.assertIn("--ignore-specks", self.run_program("check", "specked.obj", "out.obj", code=1))
        self.assertTrue(self.run_program("check", "specked.obj", "out.obj", "--ignore-specks").startswith("valid"))
        self.assertIn("yes", self.run_program("compare", "specked.obj", "out.obj", "--ignore-specks"))
        self.assertIn("8 model vertices bound", self.run_program("bind", "specked.obj", "out.obj", "-o", "out.npz",
                                                                 "--ignore-specks"))

    def test_model_and_cage_may_be_objects_of_one_file(self):
        told = self.run_program("check", "all.glb", "all.glb", "--only", "Body#1", "--cage-object", "Cage#1")
        self.assertIn("valid", told)
        self.run_program("check", "all.glb", "all.glb", "--cage-object", "Cage#1", code=1)  # the rest is no model for it
        told = self.run_program("check", "all.glb", "all.glb", "--cage-object", "Cage", "--allow-pieces")
        self.assertIn("valid", told)
        told = self.run_program("check", "all.glb", "all.glb", "--cage-object", "Body", "--cage-object", "Cage", code=2)
        self.assertIn("nothing is left", told)

    def test_only_the_chosen_object_moves(self):
        told = self.run_program("deform", "all.glb", "all.glb", "posed.obj", "-o", "out.glb", "--only", "Body#1",
                                "--cage-object", "Cage#1")
        self.assertIn("8 of 32 vertices moved", told)
        self.assertNotIn("warning", told)
        self.assertIn("32 vertices", self.run_program("info", "out.glb"))

    def test_weights_of_a_part_move_that_part(self):
        chosen = ("--only", "Body#1", "--cage-object", "Cage#1")
        told = self.run_program("bind", "all.glb", "all.glb", "-o", "out.npz", *chosen)
        self.assertIn("8 model vertices", told)
        self.run_program("deform", "all.glb", "all.glb", "posed.obj", "-o", "out1.glb", *chosen)
        self.run_program("deform", "all.glb", "all.glb", "posed.obj", "-o", "out2.glb", "--weights", "out.npz", *chosen)
        self.assertEqual((self.folder / "out1.glb").read_bytes(), (self.folder / "out2.glb").read_bytes())

    def test_generate_makes_a_cage_for_an_object(self):
        self.run_program("generate", "all.glb", "-o", "out.obj", "--only", "Body#1", "--vertices", "8")
        self.assertIn("valid", self.run_program("check", "all.glb", "out.obj", "--only", "Body#1"))


class Poses(InFolder):
    def setUp(self):
        super().setUp()  # the joint doubles and moves; the mesh's own node says nothing
        self.write("rig.glb", glb([("Body", 5, [7, 7, 7])], {"joints": [1]}, [{"scale": [2, 2, 2], "translation": [1, 0, 0]}]))

    def test_a_skinned_mesh_is_shown_by_its_joints(self):
        self.assertIn("4 x 4 x 4", self.run_program("info", "rig.glb"))
        self.assertIn("2 x 2 x 2", self.run_program("info", "rig.glb", "--pose", "bind"))
        self.assertIn("Run with --help", self.run_program("info", "rig.glb", "--pose", "rest", code=2))

    def test_it_is_deformed_in_either_pose(self):
        for pose, size in (("shown", 4), ("bind", 1.5)):
            self.write("cage.obj", cage(size))
            self.write("posed.obj", cage(size, move=0.5))
            told = self.run_program("deform", "rig.glb", "cage.obj", "posed.obj", "-o", "out.glb", "--pose", pose)
            self.assertNotIn("warning", told)
            self.assertIn("8 of 8 vertices moved", told)
            self.write("moved.obj", cage(size, move=0.5))
            self.assertIn("valid", self.run_program("check", "out.glb", "moved.obj", "--pose", pose))
            for command in (("generate", "rig.glb", "-o", "out.obj", "--vertices", "8"), ("bind", "rig.glb", "cage.obj", "-o", "out.npz")):
                self.run_program(*command, "--pose", pose)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
