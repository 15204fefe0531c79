"""The command convert, and models chosen by the names of OBJ objects, from outside.

Called as: convert_test.py PROGRAM [unittest arguments]
"""

import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
QUADS = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
BOXES = "".join(
    f"o box{k}\n" + "".join(f"v {x + 4 * k} {y} {z} {k / 2} 0 1\n" for x, y, z in CORNERS) +
    "".join(f"vt {i / 8} 0.5\n" for i in range(8)) + "vn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 0 1 0\nvn -1 0 0\nvn 1 0 0\n" +
    "".join(f"g {'front' if f < 3 else 'back'}\nusemtl {'red' if k else 'blue'}\nf " +
            " ".join(f"{v + 8 * k}/{v + 8 * k}/{f + 1 + 6 * k}" for v in quad) + "\n" for f, quad in enumerate(QUADS))
    for k in range(2))
FORMS = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Gltf:
    """Reads glTF by the words of its specification, and holds the file to them."""

    def __init__(self, test, path):
        data = path.read_bytes()
        if path.suffix == ".glb":
            magic, version, length = struct.unpack_from("<4sII", data)
            test.assertEqual((magic, version, length), (b"glTF", 2, len(data)))
            size, kind = struct.unpack_from("<I4s", data, 12)
            test.assertEqual((kind, size % 4), (b"JSON", 0))
            self.json = json.loads(data[20:20 + size])
            length, kind = struct.unpack_from("<I4s", data, 20 + size)
            test.assertEqual((kind, length % 4), (b"BIN\0", 0))
            self.buffer = data[28 + size:28 + size + length]
        else:
            self.json = json.loads(data)
            self.buffer = base64.b64decode(self.json["buffers"][0]["uri"].split("base64,")[1])
        self.test = test
        test.assertEqual(self.json["asset"]["version"], "2.0")
        test.assertLessEqual(self.json["buffers"][0]["byteLength"], len(self.buffer))

    def values(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        form, size = FORMS[accessor["componentType"]]
        width = WIDTHS[accessor["type"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        self.test.assertEqual(begin % 4, 0)
        self.test.assertLessEqual(accessor["count"] * width * size, view["byteLength"])
        flat = struct.unpack_from(f"<{accessor['count'] * width}{form}", self.buffer, begin)
        rows = [flat[i:i + width] for i in range(0, len(flat), width)]
        for name, pick in (("min", min), ("max", max)):
            if name in accessor:
                self.test.assertEqual(list(map(pick, zip(*rows))), accessor[name])
        return rows

    def nodes(self):
        """Names of nodes that show a mesh, with that of the node above."""
        above = {child: node.get("name") for node in self.json["nodes"] for child in node.get("children", ())}
        return [(above.get(i), node["name"]) for i, node in enumerate(self.json["nodes"]) if "mesh" in node]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.folder / "boxes.obj"
        self.model.write_text(BOXES)

    def run_program(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        return done


class Convert(InFolder):
    def test_writes_gltf_that_keeps_its_word(self):
        for name in ("a.glb", "a.gltf"):
            done = self.run_program("convert", self.model, name)
            self.assertIn("cut into triangles", done.stderr)
            file = Gltf(self, self.folder / name)
            self.assertEqual(file.nodes(), [("box0", "front"), ("box0", "back"), ("box1", "front"), ("box1", "back")])
            self.assertEqual([m["name"] for m in file.json["materials"]], ["blue", "red"])
            triangles = 0
            for mesh in file.json["meshes"]:
                for primitive in mesh["primitives"]:
                    columns = {name: file.values(index) for name, index in primitive["attributes"].items()}
                    self.assertEqual(set(columns), {"POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"})
                    self.assertEqual(len({len(column) for column in columns.values()}), 1)
                    self.assertIn("min", file.json["accessors"][primitive["attributes"]["POSITION"]])
                    indices = [i for i, in file.values(primitive["indices"])]
                    triangles += len(indices) // 3
                    self.assertLess(max(indices), len(columns["POSITION"]))
                    for a, b, c in zip(*[iter(indices)] * 3):
                        p, q, r = (columns["POSITION"][i] for i in (a, b, c))
                        u, v = [y - x for x, y in zip(p, q)], [y - x for x, y in zip(p, r)]
                        out = [u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)]
                        self.assertEqual(columns["NORMAL"][a], tuple(x / 4 for x in out))
                    for (x, y, z), (u, v) in zip(columns["POSITION"], columns["TEXCOORD_0"]):
                        self.assertEqual((u * 8, v), (((x + 1) % 4 > 0) + 2 * (y > 0) + 4 * (z > 0), 0.5))
            self.assertEqual(triangles, 24)

    def test_every_format_leads_back(self):
        for kind in ("ply", "off", "stl", "glb", "gltf"):
            self.run_program("convert", self.model, f"there.{kind}")
            self.run_program("convert", f"there.{kind}", "back.obj")
            report = self.run_program("info", "back.obj").stdout
            self.assertIn("closed", report)
            self.assertIn("volume 16", report)

    def test_gltf_changes_its_container_and_keeps_the_rest(self):
        self.run_program("convert", self.model, "a.glb")
        before = Gltf(self, self.folder / "a.glb")
        before.json["extras"] = {"made": "by hand"}
        text = json.dumps(before.json).encode()
        text += b" " * (-len(text) % 4)
        (self.folder / "a.glb").write_bytes(
            struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(before.buffer), len(text), b"JSON") + text +
            struct.pack("<I4s", len(before.buffer), b"BIN\0") + before.buffer)
        for source, target in (("a.glb", "b.gltf"), ("b.gltf", "c.glb"), ("c.glb", "d.glb")):
            done = self.run_program("convert", source, target)
            self.assertEqual(done.stderr, "")
            after = Gltf(self, self.folder / target)
            self.assertEqual(after.json["extras"], {"made": "by hand"})
            self.assertEqual(after.buffer, before.buffer)

    def test_deform_writes_the_other_container_too(self):
        self.run_program("convert", self.model, "a.glb")
        cage = "".join(f"v {12 * x} {3 * y} {3 * z}\n" for x, y, z in CORNERS) + \
            "".join("f {} {} {} {}\n".format(*quad) for quad in QUADS)
        (self.folder / "cage.obj").write_text(cage)
        (self.folder / "posed.obj").write_text(cage.replace("v 12", "v 13").replace("v -12", "v -11"))
        self.run_program("deform", "a.glb", "cage.obj", "posed.obj", "-o", "moved.gltf")
        xs = [x for p in Gltf(self, self.folder / "moved.gltf").json["accessors"] if "min" in p
              for x in (p["min"][0], p["max"][0])]
        self.assertEqual((round(min(xs), 6), round(max(xs), 6)), (0, 6))

    def test_never_writes_over_what_it_reads(self):
        for out in (self.model, "./boxes.obj"):
            done = self.run_program("convert", self.model, out, code=2)
            self.assertIn("would write over it", done.stderr)
        self.assertEqual(self.model.read_text(), BOXES)

    def test_is_quiet_when_asked(self):
        done = self.run_program("convert", "--quiet", self.model, "a.ply")
        self.assertEqual(done.stdout, "")
        self.assertIn("materials, groups", done.stderr)  # a loss is told all the same

    def test_refuses_what_it_cannot_write(self):
        done = self.run_program("convert", self.model, "a.fbx", code=2)
        self.assertIn(".obj, .ply, .stl, .off, .glb or .gltf", done.stderr)


class OnlyObjects(InFolder):
    def test_an_object_stands_for_its_groups(self):
        cage = "".join(f"v {4 + 2 * x} {2 * y} {2 * z}\n" for x, y, z in CORNERS) + \
            "".join("f {} {} {} {}\n".format(*quad) for quad in QUADS)
        (self.folder / "cage.obj").write_text(cage)
        (self.folder / "posed.obj").write_text(cage.replace("v 6", "v 8"))
        done = self.run_program("deform", self.model, "cage.obj", "posed.obj", "-o", "a.obj", "--only", "box1")
        self.assertIn("8 of 16 vertices moved", done.stdout)
        self.assertNotIn("warning", done.stderr)

    def test_names_the_objects_there_are(self):
        self.run_program("convert", self.model, "cage.obj")
        done = self.run_program("deform", self.model, "cage.obj", "cage.obj", "-o", "a.obj", "--only", "ball", code=2)
        self.assertIn("it has front#1, back#1, front#2, back#2, box0, box1", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
