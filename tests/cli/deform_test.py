"""The commands bind and deform from outside.

Called as: deform_test.py PROGRAM [unittest arguments]
"""

import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DONE, COULD_NOT, BAD_INPUT = 0, 1, 2

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
QUADS = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]

# Two boxes with hard edges, texture coordinates, groups, materials and comments.
MODEL = """# a comment with numbers 1 2 3
mtllib colors.mtl
o boxes
""" + "".join(f"v {0.5 * x - 0.3} {0.5 * y} {0.5 * z}\n" for x, y, z in CORNERS) + \
    "".join(f"v {0.1 * x + 0.6} {0.1 * y} {0.1 * z} 1 0 0\n" for x, y, z in CORNERS) + \
    "vt 0 0\nvt 1 0\nvt 1 1\n" + \
    "vn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 0 1 0\nvn -1 0 0\nvn 1 0 0\n" + \
    "g large\nusemtl red # a remark\ns off\n" + \
    "".join("f " + " ".join(f"{v}/1/{n}" for v in quad) + "\n" for n, quad in enumerate(QUADS, 1)) + \
    "g small\nusemtl blue\n" + \
    "".join("f " + " ".join(f"{v + 8}/2/{n}" for v in quad) + "\n" for n, quad in enumerate(QUADS, 1))
PLAIN = re.sub(r"(?m)^(v( \S+){3}) 1 0 0$", r"\1", MODEL)  # without colors


def cage(move=lambda x, y, z: (x, y, z), faces=QUADS):
    text = "".join("v {} {} {}\n".format(*move(x, y, z)) for x, y, z in CORNERS)
    return text + "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)


def normals_at_corners(path):
    """The normal at each corner (face, vertex) of an OBJ file."""
    normals, corners, face = [], {}, 0
    for words in map(str.split, path.read_text().splitlines()):
        if words[:1] == ["vn"]:
            normals.append(tuple(map(float, words[1:])))
        elif words[:1] == ["f"]:
            for corner in words[1:]:
                vertex, _, normal = corner.split("/")
                corners[face, int(vertex)] = normals[int(normal) - 1]
            face += 1
    return corners


def box_glb(normals=24):
    """A box of six quads, four vertices to each, under a node that scales and moves it."""
    positions, directions, indices = [], [], []
    for face in QUADS:
        a, b, c = (CORNERS[face[i] - 1] for i in (0, 1, 2))
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - b[i] for i in range(3)]
        n = [(u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) / 4 for i in range(3)]
        first = len(positions)
        positions += [CORNERS[i - 1] for i in face]
        directions += [n] * 4
        indices += [first, first + 1, first + 2, first, first + 2, first + 3]
    binary = b"".join(struct.pack("<3f", *row) for row in positions + directions) + \
        struct.pack("<36H", *indices)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "box", "mesh": 0, "scale": [0.5, 0.5, 0.5],
                   "translation": [0.125, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2,
                                    "material": 0}]}],
        "materials": [{"name": "red"}], "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 288},
                        {"buffer": 0, "byteOffset": 288, "byteLength": 288},
                        {"buffer": 0, "byteOffset": 576, "byteLength": 72}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3",
                       "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5126, "count": normals, "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5123, "count": 36, "type": "SCALAR"}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + \
        struct.pack("<I4s", len(text), b"JSON") + text + \
        struct.pack("<I4s", len(binary), b"BIN\0") + binary


def parts_of_glb(data):
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + size]), data[28 + size:]


def run(*arguments):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, check=False)


def rows(path, keyword):
    return [[float(n) for n in line.split()[1:4]] for line in path.read_text().splitlines()
            if line.startswith(keyword + " ")]


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.file("model.obj", MODEL)
        self.rest = self.file("cage.obj", cage())
        self.pose = self.file("pose.obj", cage(lambda x, y, z: (x + 2, y, z)))
        self.out = self.folder / "out.obj"

    def file(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def assert_near(self, a, b, tolerance):
        self.assertEqual(len(a), len(b))
        for one, other in zip(a, b):
            for x, y in zip(one, other):
                self.assertAlmostEqual(x, y, delta=tolerance)

    def assert_refused(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(self.out.exists())


class Deform(InAFolder):
    def test_follows_the_cage(self):
        done = run("deform", self.model, self.rest, self.pose, "-o", self.out)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(done.stderr, "")
        self.assertIn("16 of 16 vertices moved", done.stdout)
        moved = [[x + 2, y, z] for x, y, z in rows(self.model, "v")]
        self.assert_near(rows(self.out, "v"), moved, 1e-12)

    def test_says_in_figures_what_became_of_the_model(self):
        wide = self.file("wide.obj", cage(lambda x, y, z: (2 * x, y, z)))
        told = self.folder / "told.json"
        result = run("deform", self.model, self.rest, wide, "-o", self.folder / "out.obj", "--json", told)
        self.assertEqual(result.returncode, DONE, result.stderr)
        (pose,) = json.loads(told.read_text())["poses"]
        self.assertAlmostEqual(pose["max_stretch"], 2, places=6)
        self.assertAlmostEqual(pose["volume_change"], 1, places=6)
        self.assertEqual(pose["flipped_triangles"], 0)
        self.assertEqual(pose["output"], str(self.folder / "out.obj"))

    def test_keeps_all_but_positions_and_normals(self):
        run("deform", self.model, self.rest, self.pose, "-o", self.out)
        kept = [line for line in MODEL.splitlines() if not line.startswith(("v ", "vn "))]
        self.assertEqual(kept, [line for line in self.out.read_text().splitlines()
                                if not line.startswith(("v ", "vn "))])
        colored = [line for line in self.out.read_text().splitlines() if line.startswith("v ")][8:]
        self.assertTrue(all(line.endswith(" 1 0 0") for line in colored))

    def test_turns_normals_and_keeps_edges_hard(self):
        turned = self.file("turned.obj", cage(lambda x, y, z: (-y, x, z)))
        run("deform", self.model, self.rest, turned, "-o", self.out)
        self.assert_near(rows(self.out, "vn"),
                         [[-y, x, z] for x, y, z in rows(self.model, "vn")], 1e-9)

    def test_leaves_the_model_as_it_was_when_the_cage_rests(self):
        run("deform", self.model, self.rest, self.rest, "-o", self.out)
        self.assertEqual(rows(self.out, "v"), rows(self.model, "v"))

    def test_writes_a_sequence(self):
        frames = [self.file(f"frame_{i}.obj", cage(lambda x, y, z, i=i: (x, y + i, z)))
                  for i in (1, 2, 3)]
        folder = self.folder / "frames"
        done = run("deform", self.model, self.rest, self.folder / "frame_*.obj", "-o", f"{folder}/")
        self.assertEqual(done.returncode, DONE, done.stderr)
        named = run("deform", self.model, self.rest, *frames, "-o", self.folder / "m_*.obj")
        self.assertEqual(named.returncode, DONE, named.stderr)
        for i in (1, 2, 3):
            moved = [[x, y + i, z] for x, y, z in rows(self.model, "v")]
            self.assert_near(rows(folder / f"frame_{i}.obj", "v"), moved, 1e-12)
            self.assertEqual((folder / f"frame_{i}.obj").read_bytes(),
                             (self.folder / f"m_frame_{i}.obj").read_bytes())
        self.assert_refused(run("deform", self.model, self.rest, *frames, "-o", self.out),
                            BAD_INPUT, "is one file, but there are 3")

    def test_a_sequence_in_another_format_keeps_what_it_holds_and_warns_once(self):
        for i in (1, 2, 3):
            self.file(f"frame_{i}.obj", cage(lambda x, y, z, i=i: (-y, x + i, z)))
        done = run("deform", self.model, self.rest, self.folder / "frame_*.obj", "-o", self.folder / "m_*.ply")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(done.stderr.count("PLY cannot hold all"), 1, done.stderr)
        self.assertIn("materials", done.stderr)
        for i in (1, 2, 3):
            back = self.folder / f"back_{i}.obj"
            run("convert", self.folder / f"m_frame_{i}.ply", back)
            self.assert_near(rows(back, "v"), [[-y, x + i, z] for x, y, z in rows(self.model, "v")], 1e-12)

    def test_normals_follow_into_another_format(self):
        smooth = self.file("smooth.obj", "v 0 0 0\nv .2 0 0\nv 0 .2 0\nv 0 0 .2\nvn -1 -1 -1\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\n"
                                         "f 1//1 3//3 2//2\nf 1//1 2//2 4//4\nf 1//1 4//4 3//3\nf 2//2 3//3 4//4\n")
        turned = self.file("turned.obj", cage(lambda x, y, z: (-y, x, z)))
        through = [self.folder / f"through.{kind}" for kind in ("ply", "off")]
        for path in through:
            self.assertEqual(run("deform", smooth, self.rest, turned, "-o", path).returncode, DONE)
            back = self.folder / "back.obj"
            self.assertEqual(run("convert", path, back).returncode, DONE)
            self.assert_near(rows(back, "vn"), [[-y, x, z] for x, y, z in rows(smooth, "vn")], 1e-9)

    def test_refuses_formats_it_cannot_write_before_the_work(self):
        self.assert_refused(run("deform", self.model, self.rest, self.pose, "-o", self.folder / "x.fbx"),
                            BAD_INPUT, ".stl, .off, .glb or .gltf")

    def test_moves_one_group_only(self):
        done = run("deform", self.model, self.rest, self.pose, "-o", self.out, "--only", "small")
        self.assertEqual(done.returncode, DONE, done.stderr)
        before, after = rows(self.model, "v"), rows(self.out, "v")
        self.assertEqual(after[:8], before[:8])
        self.assert_near(after[8:], [[x + 2, y, z] for x, y, z in before[8:]], 1e-12)
        self.out.unlink()
        self.assert_refused(run("deform", self.model, self.rest, self.pose, "-o", self.out,
                                "--only", "tail"), BAD_INPUT, "no group 'tail'", "large", "small")

    def test_writes_other_formats(self):
        done = run("deform", self.model, self.rest, self.pose, "-o", self.folder / "out.off")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertTrue((self.folder / "out.off").read_text().split()[1:3], ["16", "12"])

    def test_deforms_glb_in_place(self):
        model, out = self.folder / "box.glb", self.folder / "out.glb"
        model.write_bytes(box_glb())
        turned = self.file("turned.obj", cage(lambda x, y, z: (-y, x + 2, z)))
        done = run("deform", model, self.rest, turned, "-o", out)
        self.assertEqual(done.returncode, DONE, done.stderr)
        before, old = parts_of_glb(model.read_bytes())
        after, new = parts_of_glb(out.read_bytes())
        for name in set(before) - {"accessors"}:
            self.assertEqual(before[name], after[name])
        self.assertEqual(new[576:], old[576:])  # faces
        old, new = struct.unpack("<144f", old[:576]), struct.unpack("<144f", new[:576])
        for i in range(0, 72, 3):
            x, y, z = (0.5 * old[i] + 0.125, 0.5 * old[i + 1], 0.5 * old[i + 2])
            scene = (0.5 * new[i] + 0.125, 0.5 * new[i + 1], 0.5 * new[i + 2])
            self.assert_near([scene], [(-y, x + 2, z)], 1e-6)
            x, y, z = old[72 + i:75 + i]
            self.assert_near([new[72 + i:75 + i]], [(-y, x, z)], 1e-6)
        for axis in range(3):
            self.assertEqual(after["accessors"][0]["min"][axis], min(new[axis:72:3]))
            self.assertEqual(after["accessors"][0]["max"][axis], max(new[axis:72:3]))

    def test_turns_normals_in_big_endian_files(self):
        turned = self.file("turned.obj", cage(lambda x, y, z: (-y, x, z)))
        points = [(0, 0, 0.5), (0.5, 0, 0), (0, 0.5, 0)]
        n = 3 ** -0.5  # of each component of the normal
        rows_of = b"".join(struct.pack(">6f", *p, n, n, n) for p in points)
        header = "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz"))
        ply = (f"ply\nformat binary_big_endian 1.0\nelement vertex 3\n{header}element face 1\n"
               "property list uchar int vertex_indices\nend_header\n").encode()
        off = b"NOFF BINARY\n" + struct.pack(">3i", 3, 1, 0)
        for name, begin, end in (("m.ply", ply, struct.pack(">B3i", 3, 0, 1, 2)),
                                 ("m.off", off, struct.pack(">5i", 3, 0, 1, 2, 0))):
            model, out = self.folder / name, self.folder / ("out_" + name)
            model.write_bytes(begin + rows_of + end)
            done = run("deform", model, self.rest, turned, "-o", out)
            self.assertEqual(done.returncode, DONE, done.stderr)
            data = out.read_bytes()
            self.assertEqual((data[:len(begin)], data[-len(end):]), (begin, end))
            for i, (x, y, z) in enumerate(points):
                row = struct.unpack_from(">6f", data, len(begin) + 24 * i)
                self.assert_near([row], [(-y, x, z, -n, n, n)], 1e-6)

    def test_binds_glb_as_any_other(self):
        model, weights = self.folder / "box.glb", self.folder / "w.npz"
        direct, again = self.folder / "direct.glb", self.folder / "again.glb"
        model.write_bytes(box_glb())
        self.assertEqual(run("bind", model, self.rest, "-o", weights).returncode, DONE)
        for out, more in ((direct, ()), (again, ("--weights", weights))):
            done = run("deform", model, self.rest, self.pose, "-o", out, *more)
            self.assertEqual(done.returncode, DONE, done.stderr)
        one, other = (struct.unpack("<72f", parts_of_glb(path.read_bytes())[1][:288])
                      for path in (direct, again))
        self.assert_near([one], [other], 1e-5)

    def test_normals_that_are_broken_stand_in_the_way_only_where_they_are_kept(self):
        model, out = self.folder / "box.glb", self.folder / "out.glb"
        model.write_bytes(box_glb(normals=20))
        done = run("deform", model, self.rest, self.pose, "-o", self.out)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("normals, which are damaged", done.stderr)
        self.out.unlink()
        self.assert_refused(run("deform", model, self.rest, self.pose, "-o", out), BAD_INPUT,
                            "a normal for each vertex")
        self.assertFalse(out.exists())

    def test_says_which_linked_files_are_not_beside_the_result(self):
        self.file("colors.mtl", "newmtl red\n")
        done = run("deform", self.model, self.rest, self.pose, "-o", self.out)
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        done = run("deform", self.model, self.rest, self.pose, "-o", elsewhere / "out.obj")
        self.assertEqual(done.returncode, DONE)
        self.assertIn("out.obj refers to colors.mtl, which is not beside it", done.stderr)

    def test_normals_shared_at_rest_turn_apart(self):
        bent = self.file("bent.obj", cage(lambda x, y, z: (x, y, z + x * y)))
        done = run("deform", self.model, self.rest, bent, "-o", self.out)
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))
        before, after = (normals_at_corners(p) for p in (self.model, self.out))
        self.assertEqual(before.keys(), after.keys())
        # The tops of the two boxes lean by different angles now; a mean would be off for both.
        tops = {after[corner] for corner in before if before[corner] == (0, 0, 1)}
        self.assertGreater(len(tops), 1)
        for faces in ([f for f, _ in after if f < 6], [f for f, _ in after if f >= 6]):
            self.assertEqual(len({after[c] for c in after if c[0] in faces and before[c] == (0, 0, 1)}), 1)

    def test_a_sequence_with_a_wrong_frame_writes_nothing(self):
        self.file("frame_1.obj", cage())
        self.file("frame_2.obj", MODEL)
        folder = self.folder / "frames"
        self.assert_refused(run("deform", self.model, self.rest, self.folder / "frame_*.obj", "-o",
                                f"{folder}/"), BAD_INPUT, "frame_2.obj has 16 vertices")
        self.assertEqual(list(folder.glob("*")), [])
        self.assert_refused(run("deform", self.model, self.rest, self.folder / "frame_1.obj",
                                self.folder / "frame_3.obj", "-o", f"{folder}/"), BAD_INPUT,
                            "frame_3.obj")
        self.assert_refused(run("deform", self.model, self.rest, self.folder / "none_*.obj", "-o",
                                f"{folder}/"), BAD_INPUT, "no file has such a name")

    def test_says_what_is_wrong_with_a_cage_that_is_none(self):
        for name, text in (("empty", ""), ("one", "v 0 0 0\n"), ("points", "v 0 0 0\nv 1 0 0\n"),
                           ("flat", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 3 2 1\n")):
            none = self.file(name + ".obj", text)
            for more in ((), ("--strict",)):
                done = run("deform", self.model, none, none, "-o", self.out, *more)
                self.assertIn(done.returncode, (COULD_NOT, BAD_INPUT), name)
                self.assertIn(name + ".obj", done.stderr)
                self.assertFalse(self.out.exists())

    def test_refuses_points_without_faces(self):
        points = self.file("points.obj", "v 0 0 0\nv 0.5 0 0\n")
        self.assert_refused(run("deform", points, self.rest, self.pose, "-o", self.out), BAD_INPUT,
                            "points.obj: has no faces")

    def test_only_says_when_a_format_has_no_groups(self):
        self.assertEqual(run("deform", self.model, self.rest, self.rest, "-o",
                             self.folder / "m.off").returncode, DONE)
        self.assert_refused(run("deform", self.folder / "m.off", self.rest, self.pose, "-o",
                                self.folder / "moved.off", "--only", "small"), BAD_INPUT,
                            "no group 'small', nor any other")

    def test_inverted_cages_move_the_model_too(self):
        inverted = self.file("inverted.obj", cage(faces=[face[::-1] for face in QUADS]))
        pose = self.file("moved.obj", cage(lambda x, y, z: (x + 2, y, z),
                                           [face[::-1] for face in QUADS]))
        done = run("deform", self.model, inverted, pose, "-o", self.out)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("warning", done.stderr)
        self.assert_near(rows(self.out, "v"), [[x + 2, y, z] for x, y, z in rows(self.model, "v")],
                         1e-12)
        self.out.unlink()
        self.assert_refused(run("deform", self.model, inverted, pose, "-o", self.out, "--strict"),
                            COULD_NOT, "not a valid cage")

    def test_warns_of_a_cage_that_does_not_fit(self):
        narrow = self.file("narrow.obj", cage(lambda x, y, z: (0.75 * x, y, z)))
        done = run("deform", self.model, narrow, narrow, "-o", self.out)
        self.assertEqual(done.returncode, DONE)
        self.assertIn("warning", done.stderr)
        self.assertIn("4 vertex_outside", done.stderr)
        self.out.unlink()
        self.assert_refused(run("deform", self.model, narrow, narrow, "-o", self.out, "--strict"),
                            COULD_NOT, "4 vertex_outside")
        open_cage = self.file("open.obj", cage(faces=QUADS[1:]))
        done = run("deform", self.model, open_cage, open_cage, "-o", self.out)
        self.assertEqual(done.returncode, DONE)
        self.assertIn("4 open_edge", done.stderr)
        self.assertEqual(rows(self.out, "v"), rows(self.model, "v"))

    def test_says_how_cages_differ(self):
        swapped = self.file("swapped.obj", cage(faces=[[{1: 8, 8: 1}.get(v, v) for v in face]
                                                       for face in QUADS[::-1]]))
        self.assert_refused(run("deform", self.model, self.rest, swapped, "-o", self.out), BAD_INPUT,
                            "swapped.obj", "vertex order")
        self.assert_refused(run("deform", self.model, self.rest, self.model, "-o", self.out),
                            BAD_INPUT, "16 vertices", "the cage at rest 8", "pose a copy")

    def test_takes_a_pose_whose_faces_are_others(self):
        expected = self.folder / "expected.obj"
        run("deform", self.model, self.rest, self.pose, "-o", expected)
        points = [line for line in self.pose.read_text().splitlines() if line.startswith("v ")]
        fans = [f for q in QUADS for f in ((q[1], q[2], q[3]), (q[1], q[3], q[0]))]
        for name, faces in (("cut", fans), ("turned", [q[1:] + q[:1] for q in QUADS[::-1]]), ("fewer", QUADS[1:])):
            pose = self.file(f"{name}.obj", "\n".join(points) + "\n" + "".join(
                "f " + " ".join(map(str, face)) + "\n" for face in faces))
            done = run("deform", self.model, self.rest, pose, "-o", self.out)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertEqual(self.out.read_text(), expected.read_text())
            self.assertEqual("faces are others" in done.stderr, name != "turned", done.stderr)


def frames_of_pc2(data):
    """First frame, and for each frame its positions: what the format says, read by hand."""
    signature, version, points, first, step, frames = struct.unpack_from("<12siiffi", data)
    assert (signature, version, step) == (b"POINTCACHE2\0", 1, 1.0)
    assert len(data) == 32 + 12 * points * frames
    numbers = struct.unpack_from(f"<{3 * points * frames}f", data, 32)
    rows = [numbers[3 * i:3 * i + 3] for i in range(points * frames)]
    return first, [rows[points * f:points * (f + 1)] for f in range(frames)]


def frames_of_mdd(data):
    frames, points = struct.unpack_from(">ii", data)
    assert len(data) == 8 + 4 * frames + 12 * points * frames
    times = struct.unpack_from(f">{frames}f", data, 8)
    numbers = struct.unpack_from(f">{3 * points * frames}f", data, 8 + 4 * frames)
    rows = [numbers[3 * i:3 * i + 3] for i in range(points * frames)]
    return times, [rows[points * f:points * (f + 1)] for f in range(frames)]


def frames_of_animated_glb(data):
    """For each frame the positions of the vertices of the file, and the times."""
    document, binary = parts_of_glb(data)

    def floats(number):
        accessor = document["accessors"][number]
        width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        begin = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
        numbers = struct.unpack_from(f"<{width * accessor['count']}f", binary, begin)
        return [numbers[i:i + width] for i in range(0, len(numbers), width)] if width > 1 else numbers

    node = document["nodes"][0]
    primitive = document["meshes"][node["mesh"]]["primitives"][0]
    rest = floats(primitive["attributes"]["POSITION"])
    targets = [floats(target["POSITION"]) for target in primitive["targets"]]
    sampler = document["animations"][0]["samplers"][0]
    weights = floats(sampler["output"])
    frames = []
    for f in range(len(weights) // len(targets)):
        shares = weights[f * len(targets):(f + 1) * len(targets)]
        frames.append([tuple(p[k] + node["translation"][k] + sum(w * t[v][k] for w, t in zip(shares, targets))
                             for k in range(3)) for v, p in enumerate(rest)])
    return floats(sampler["input"]), frames


class Movement(InAFolder):
    """Sequences in one file, read back by what the formats say."""

    def setUp(self):
        super().setUp()
        for i in (1, 2, 9, 10):  # as a shell lists them, 10 comes before 2
            self.file(f"frame_{i}.obj", cage(lambda x, y, z, i=i: (x - 0.1 * i * y, y + 0.01 * i * x * z, z)))
        self.frames = [self.folder / f"frame_{i}.obj" for i in (1, 2, 9, 10)]
        done = run("deform", self.model, self.rest, *self.frames, "-o", f"{self.folder}/m_*.obj")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.expected = [rows(self.folder / f"m_frame_{i}.obj", "v") for i in (1, 2, 9, 10)]

    def assert_frames(self, found, tolerance=1e-6):
        self.assertEqual(len(found), len(self.expected))
        for one, other in zip(found, self.expected):
            self.assert_near(one, other, tolerance)

    def deform(self, *words, code=DONE):
        done = run("deform", self.model, self.rest, *words)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_point_caches(self):
        pc2, mdd = self.folder / "model.pc2", self.folder / "MODEL.MDD"
        said = self.deform(self.folder / "frame_*.obj", "-o", pc2)
        self.assertIn("4 frames of 16 vertices", said.stdout)
        self.assertEqual(said.stderr, "")
        first, frames = frames_of_pc2(pc2.read_bytes())
        self.assertEqual(first, 1)
        self.assert_frames(frames)
        self.deform(*self.frames, "-o", mdd, "--fps", 25, "--first-frame", 50)
        times, frames = frames_of_mdd(mdd.read_bytes())
        self.assert_near([times], [[50 / 25, 51 / 25, 52 / 25, 53 / 25]], 1e-6)
        self.assert_frames(frames)

    def test_the_shells_order_is_mended_and_ones_own_is_kept(self):
        pc2 = self.folder / "model.pc2"
        said = self.deform(*sorted(self.frames), "-o", pc2)
        self.assertIn("order of their numbers", said.stderr)
        self.assertEqual(said.stderr.count("\n"), 1)
        self.assert_frames(frames_of_pc2(pc2.read_bytes())[1])
        there_and_back = self.frames + self.frames[-2::-1]
        self.assertEqual(self.deform(*there_and_back, "-o", pc2).stderr, "")
        self.expected += self.expected[-2::-1]
        self.assert_frames(frames_of_pc2(pc2.read_bytes())[1])

    def test_one_frame_is_a_movement_only_in_a_point_cache(self):
        self.deform(self.frames[2], "-o", self.folder / "one.pc2")
        self.expected = self.expected[2:3]
        self.assert_frames(frames_of_pc2((self.folder / "one.pc2").read_bytes())[1])
        self.deform(self.frames[2], "-o", self.folder / "one.glb")
        self.assertNotIn("animations", parts_of_glb((self.folder / "one.glb").read_bytes())[0])

    def test_animated_glb(self):
        glb = self.folder / "model.glb"
        self.deform(*self.frames, "-o", glb, "--fps", 10)
        times, frames = frames_of_animated_glb(glb.read_bytes())
        self.assert_near([times], [[0, 0.1, 0.2, 0.3]], 1e-6)
        # The file's vertices are split at texture points: each is one of the model's.
        for found, expected in zip(frames, self.expected):
            for p in found:
                self.assertLess(min(max(abs(a - b) for a, b in zip(p, q)) for q in expected), 1e-6)

    def test_stored_weights_and_groups(self):
        weights, pc2 = self.folder / "weights.npz", self.folder / "model.pc2"
        run("bind", self.model, self.rest, "-o", weights)
        self.deform(*self.frames, "-o", pc2, "--weights", weights)
        self.assert_frames(frames_of_pc2(pc2.read_bytes())[1], 1e-5)
        self.deform(*self.frames, "-o", pc2, "--only", "large")
        for frame, expected in zip(frames_of_pc2(pc2.read_bytes())[1], self.expected):
            self.assert_near(frame[:8], expected[:8], 1e-6)
            self.assert_near(frame[8:], rows(self.model, "v")[8:], 1e-6)

    def test_refusals_leave_nothing(self):
        out = self.folder / "model.mdd"
        wrong = self.file("wrong.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.deform(self.frames[0], wrong, "-o", out, code=BAD_INPUT)
        self.assertFalse(out.exists())
        huge = self.file("huge.obj", cage(lambda x, y, z: (x * 1e39, y, z)))
        self.assertIn("too large", self.deform(self.frames[0], huge, "-o", out, code=BAD_INPUT).stderr)
        self.deform(*self.frames, "-o", out, "--fps", 0, code=BAD_INPUT)
        said = self.deform(*self.frames, "-o", self.folder / "nowhere" / "model.pc2", code=BAD_INPUT)
        self.assertIn("nowhere", said.stderr)
        self.assertFalse(out.exists())
        self.assertEqual(list(self.folder.glob(".cagewright*")), [])


class Bind(InAFolder):
    def setUp(self):
        super().setUp()
        self.weights = self.folder / "weights.npz"
        done = run("bind", self.model, self.rest, "-o", self.weights)
        self.assertEqual(done.returncode, DONE, done.stderr)

    def test_gives_the_same_model(self):
        direct = self.folder / "direct.obj"
        run("deform", self.model, self.rest, self.pose, "-o", direct)
        done = run("deform", self.model, self.rest, self.pose, "-o", self.out, "--weights",
                   self.weights)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assert_near(rows(self.out, "v"), rows(direct, "v"), 1e-6)

    def test_takes_the_best_kind_and_says_why(self):
        told = self.folder / "told.json"
        best = self.folder / "best.npz"
        result = run("bind", self.model, self.rest, "-o", best, "--coordinates", "auto", "--json", told)
        self.assertEqual(result.returncode, DONE, result.stderr)
        kind = json.loads(told.read_text())["coordinates"]
        self.assertIn(f"{kind} coordinates", result.stdout)
        self.assertIn("drag across gaps", result.stdout)
        for more in ([], ["--weights", best]):
            result = run("deform", self.model, self.rest, self.pose, "-o", self.out, "--coordinates", "auto", *more)
            self.assertEqual(result.returncode, DONE, result.stderr)
            self.assert_near(rows(self.out, "v"), [[x + 2, y, z] for x, y, z in rows(self.model, "v")], 1e-5)

    def test_says_in_figures_what_was_bound(self):
        for kind in ("mean_value", "quad_green"):
            told = self.folder / "told.json"
            result = run("bind", self.model, self.rest, "-o", self.weights, "--coordinates", kind, "--json", told)
            self.assertEqual(result.returncode, DONE, result.stderr)
            report = json.loads(told.read_text())
            self.assertEqual(report["coordinates"], kind)
            self.assertEqual(report["points"], 16)
            self.assertEqual((report["outside"], report["undefined"]), (0, 0))
            self.assertEqual(report["unseen_share"], {"mean": 0, "p95": 0, "points": 16})  # a box

    def test_stores_arrays_that_reproduce_the_model(self):
        with zipfile.ZipFile(self.weights) as archive:
            self.assertIsNone(archive.testzip())
            self.assertEqual({"weights.npy", "cage_positions.npy", "cage_faces.npy", "kind.npy",
                          "options.npy", "columns.npy",
                              "version.npy", "model_checksum.npy"}, set(archive.namelist()))
            raw = archive.read("weights.npy")
        begin = 10 + struct.unpack("<H", raw[8:10])[0]
        self.assertIn(b"'shape': (16, 8)", raw[:begin])
        weights = struct.unpack("<128f", raw[begin:])
        for p, position in enumerate(rows(self.model, "v")):
            row = weights[8 * p:8 * p + 8]
            self.assertAlmostEqual(sum(row), 1, delta=1e-6)
            for axis in range(3):
                x = sum(w * corner[axis] for w, corner in zip(row, CORNERS))
                self.assertAlmostEqual(x, position[axis], delta=1e-6)

    def test_text_formats_are_read_back(self):
        expected = self.folder / "expected.obj"
        run("deform", self.model, self.rest, self.pose, "-o", expected, "--weights", self.weights)
        for name, start in (("w.csv", "# cagewright weights"), ("W.JSON", "{"), ("w.dmat", "8 16\n")):
            weights = self.folder / name
            done = run("bind", self.model, self.rest, "-o", weights)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertTrue(weights.read_text().startswith(start), name)
            done = run("deform", self.model, self.rest, self.pose, "-o", self.out, "--weights", weights)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertEqual(self.out.read_text(), expected.read_text(), name)
            self.out.unlink()
            wide = self.file("wide.obj", cage(lambda x, y, z: (2 * x, y, z)))
            self.assert_refused(run("deform", self.model, wide, wide, "-o", self.out, "--weights", weights),
                                BAD_INPUT, "another")

    def test_groups_of_vertices_are_what_scripts_read(self):
        groups = self.folder / "groups.json"
        done = run("bind", self.model, self.rest, "-o", groups, "--format", "vertex-groups")
        self.assertEqual(done.returncode, DONE, done.stderr)
        told = json.loads(groups.read_text())
        self.assertEqual((told["format"], told["vertices"], len(told["groups"])), ("cagewright-vertex-groups", 16, 8))
        sums = [0] * 16
        for group in told["groups"]:
            for vertex, weight in zip(group["vertices"], group["weights"], strict=True):
                sums[vertex] += weight
        for total in sums:
            self.assertAlmostEqual(total, 1, delta=1e-6)

    def test_unknown_extensions_are_refused_with_the_list(self):
        for name in ("w.xyz", "w", "w.npy"):
            refused = run("bind", self.model, self.rest, "-o", self.folder / name)
            self.assertEqual(refused.returncode, BAD_INPUT)
            self.assertIn(".npz, .csv, .json or .dmat", refused.stderr)
            self.assertFalse((self.folder / name).exists())

    def test_can_be_loaded_by_numpy(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("no numpy")
        with numpy.load(self.weights) as arrays:
            self.assertEqual(str(arrays["kind"]), "mean_value")
            self.assertEqual(arrays["weights"].shape, (16, 8))
            self.assertEqual(arrays["cage_faces"].shape, (6, 4))

    def test_weights_of_others_are_refused(self):
        def deform(model, rest, weights):
            return run("deform", model, rest, self.pose, "-o", self.out, "--weights", weights)

        moved = self.file("moved.obj", MODEL.replace("v 0.2 ", "v 0.25 "))
        self.assert_refused(deform(moved, self.rest, self.weights), BAD_INPUT, "another shape")
        self.assert_refused(deform(self.rest, self.rest, self.weights), BAD_INPUT,
                            "for a model of 16 vertices, but this one has 8")
        wide = self.file("wide.obj", cage(lambda x, y, z: (2 * x, y, z)))
        self.assert_refused(deform(self.model, wide, self.weights), BAD_INPUT, "another cage")
        self.assert_refused(deform(self.model, self.rest, self.model), BAD_INPUT, "not a .npz file")
        cut = self.folder / "cut.npz"
        cut.write_bytes(self.weights.read_bytes()[:-30])
        self.assert_refused(deform(self.model, self.rest, cut), BAD_INPUT, "cut off")

    def test_every_kind_of_coordinates_binds_and_deforms(self):
        listed = run("coordinates", "--json", "-", "-q")
        kinds = json.loads(listed.stdout)["kinds"]
        names = [kind["name"] for kind in kinds]
        self.assertEqual(names[0], "mean_value")
        text = run("coordinates").stdout
        turned = self.file("turned.obj", cage(lambda x, y, z: (-2 * y + 1, 2 * x, 2 * z)))
        for name in names:
            self.assertIn(name + ": ", text)
            weights = self.folder / f"{name}.npz"
            bound = run("bind", self.model, self.rest, "-o", weights, "--coordinates", name)
            self.assertEqual(bound.returncode, DONE, bound.stderr)
            direct = run("deform", self.model, self.rest, turned, "-o", self.out, "--coordinates",
                         name)
            self.assertEqual(direct.returncode, DONE, direct.stderr)
            there = rows(self.out, "v")
            stored = run("deform", self.model, self.rest, turned, "-o", self.out, "--weights",
                         weights)
            self.assertEqual(stored.returncode, DONE, stored.stderr)
            # A similarity of the cage is one of the model, whatever the coordinates.
            expected = [[-2 * y + 1, 2 * x, 2 * z] for x, y, z in rows(self.model, "v")]
            self.assert_near(there, expected, 1e-5)
            self.assert_near(rows(self.out, "v"), expected, 1e-5)

    def test_two_kinds_are_mixed_by_a_weight_for_each_vertex(self):
        pose = self.file("bent.obj", cage(lambda x, y, z: (x * (1 + z), y + z * x, z)))
        count = len(rows(self.model, "v"))
        shares = [i / (count - 1) for i in range(count)]
        paint = self.file("paint.txt", "".join(f"{share}\n" for share in shares))
        positions = {}
        for name in ("mean_value", "green"):
            run("deform", self.model, self.rest, pose, "-o", self.out, "--coordinates", name)
            positions[name] = rows(self.out, "v")
        expected = [[(1 - s) * x + s * y for x, y in zip(a, b)]
                    for s, a, b in zip(shares, positions["mean_value"], positions["green"])]
        mix = ["--mix", "green", "--mix-weights", paint]
        for name in ("mix.npz", "mix.csv", "mix.json"):
            weights = self.folder / name
            told = self.folder / "told.json"
            bound = run("bind", self.model, self.rest, "-o", weights, *mix, "--json", told)
            self.assertEqual(bound.returncode, DONE, bound.stderr)
            self.assertEqual(json.loads(told.read_text())["coordinates"], "mean_value+green")
            done = run("deform", self.model, self.rest, pose, "-o", self.out, "--weights", weights)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assert_near(rows(self.out, "v"), expected, 1e-5)
            self.out.unlink()
            self.assert_refused(run("deform", self.model, self.rest, pose, "-o", self.out, "--weights", weights,
                                    "--mix", "harmonic"), BAD_INPUT, "are mean_value+green coordinates")
        done = run("deform", self.model, self.rest, pose, "-o", self.out, *mix)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assert_near(rows(self.out, "v"), expected, 1e-5)

    def test_mixing_by_colors_and_by_groups(self):
        red = "".join(line + (" 1 0 0" if line.startswith("v ") else "") + "\n"
                      for line in PLAIN.splitlines())
        model = self.file("red.obj", red)
        run("deform", model, self.rest, self.pose, "-o", self.out, "--coordinates", "green")
        expected = rows(self.out, "v")
        for source in ("colors", "group:boxes"):
            done = run("deform", model, self.rest, self.pose, "-o", self.out, "--mix", "green", "--mix-weights", source)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assert_near(rows(self.out, "v"), expected, 1e-12)

    def test_mixing_that_makes_no_sense_is_refused(self):
        model = self.file("plain.obj", PLAIN)
        self.file("many.txt", "0\n" * 3)
        self.file("large.txt", "2\n" * 16)
        for options, words in ((["--mix", "green"], "--mix-weights"),
                               (["--mix-weights", "many.txt"], "--mix"),
                               (["--mix", "mean_value", "--mix-weights", "colors"], "give another"),
                               (["--mix", "green", "--mix-weights", "colors"], "no vertex colors"),
                               (["--mix", "green", "--mix-weights", "group:arm"], "arm"),
                               (["--mix", "green", "--mix-weights", self.folder / "many.txt"], "16"),
                               (["--mix", "green", "--mix-weights", self.folder / "large.txt"], "from 0 to 1"),
                               (["--coordinates", "auto", "--mix", "green", "--mix-weights", "colors"], "auto"),
                               (["--coordinates", "somigliana", "--local", "1", "--mix", "green", "--mix-weights",
                                 self.file("half.txt", "0.5\n" * 16)], "cannot be mixed")):
            self.assert_refused(run("bind", model, self.rest, "-o", self.folder / "no.npz", *options), BAD_INPUT, words)

    def test_weights_of_one_kind_are_not_applied_as_another(self):
        weights = self.folder / "green.npz"
        run("bind", self.model, self.rest, "-o", weights, "--coordinates", "green")

        def deform(*options):
            return run("deform", self.model, self.rest, self.pose, "-o", self.out, "--weights",
                       weights, *options)

        self.assert_refused(deform("--coordinates", "mean_value"), BAD_INPUT,
                            "the weights are green coordinates, not mean_value")
        self.assert_refused(deform("--quads", "diagonal"), BAD_INPUT, "made with quads=center")
        self.assertEqual(deform("--quads", "center").returncode, DONE)

    def test_points_outside_are_refused_left_or_continued(self):
        model = self.file("large.obj", MODEL.replace("v 0.2 ", "v 1.2 "))

        def deform(*options):
            return run("deform", model, self.rest, self.pose, "-o", self.out, "--coordinates",
                       "green", *options)

        refused = deform()
        self.assertEqual(refused.returncode, BAD_INPUT)
        self.assertIn("outside the cage, where these coordinates are not defined", refused.stderr)
        self.assertFalse(self.out.exists())
        self.assertEqual(deform("--outside", "rest").returncode, DONE)
        there, before = rows(self.out, "v"), rows(model, "v")
        for old, new in zip(before, there):
            self.assertAlmostEqual(new[0], old[0] + (0 if old[0] > 1 else 2), delta=1e-5)
        self.assertEqual(deform("--outside", "continue").returncode, DONE)
        self.assert_near(rows(self.out, "v"), [[x + 2, y, z] for x, y, z in before], 1e-5)
        warned = run("deform", model, self.rest, self.pose, "-o", self.out, "--outside", "rest")
        self.assertIn("--outside makes no difference to mean_value", warned.stderr)

    def test_groups_of_vertices_hold_no_normals(self):
        self.assert_refused(run("bind", self.model, self.rest, "-o", self.folder / "g.json",
                                "--format", "vertex-groups", "--coordinates", "green"), BAD_INPUT,
                            "one weight for each vertex of the cage")

    def test_leaves_nothing_when_it_cannot_write(self):
        failed = run("bind", self.model, self.rest, "-o", self.folder / "no" / "w.npz")
        self.assertEqual(failed.returncode, BAD_INPUT)
        self.assertIn("the folder does not exist", failed.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
