"""`generate --skin-cage`: the cage of a rigged model, with its rig.

The model is a tube along y of two joints, one at its foot and one at its middle; its animation bends the upper one.
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)
SIDES, RINGS = 8, 9


def tube():
    """Positions, triangles, and for each vertex how much of it follows the upper joint."""
    points, upper = [], []
    for ring in range(RINGS):
        y = 4.0 * ring / (RINGS - 1)
        for side in range(SIDES):
            angle = 2 * math.pi * side / SIDES
            points.append((0.5 * math.cos(angle), y, 0.5 * math.sin(angle)))
            upper.append(min(1.0, max(0.0, y - 1.5)))
    points += [(0, 0, 0), (0, 4, 0)]
    upper += [0.0, 1.0]
    foot, top = len(points) - 2, len(points) - 1
    triangles = []
    for ring in range(RINGS - 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            triangles += [(a, a + SIDES, b), (b, a + SIDES, b + SIDES)]
    for side in range(SIDES):
        triangles.append((side, (side + 1) % SIDES, foot))
        last = (RINGS - 1) * SIDES
        triangles.append((last + side, top, last + (side + 1) % SIDES))
    return points, triangles, upper


def turned(degrees):
    """A turn about z, as glTF has it."""
    return [0, 0, math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2)]


def write_model(path, bent=0.0, skinned=True):
    points, triangles, upper = tube()
    blob, views, accessors = b"", [], []

    def add(form, values, count, kind, component, **more):
        nonlocal blob
        blob += b"\0" * (-len(blob) % 4)
        data = struct.pack(f"<{len(values)}{form}", *values)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
        blob += data
        return len(accessors) - 1

    bounds = {"min": [min(p[k] for p in points) for k in range(3)], "max": [max(p[k] for p in points) for k in range(3)]}
    position = add("f", [x for p in points for x in p], len(points), "VEC3", 5126, **bounds)
    joints = add("B", [x for _ in points for x in (0, 1, 0, 0)], len(points), "VEC4", 5121)
    weights = add("f", [x for u in upper for x in (1 - u, u, 0, 0)], len(points), "VEC4", 5126)
    indices = add("H", [c for t in triangles for c in t], 3 * len(triangles), "SCALAR", 5123)
    matrices = add("f", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1],
                   2, "MAT4", 5126)
    times = add("f", [0, 1], 2, "SCALAR", 5126, min=[0], max=[1])
    turns = add("f", turned(0) + turned(40), 2, "VEC4", 5126)
    attributes = {"POSITION": position}
    if skinned:
        attributes.update({"JOINTS_0": joints, "WEIGHTS_0": weights})
    body = {"mesh": 0, "name": "Body", "camera": 0}
    if skinned:
        body["skin"] = 0
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"name": "Foot", "children": [1]},
                  {"name": "Middle", "translation": [0, 2, 0], "rotation": turned(bent)}, body],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices}]}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": matrices}],
        "animations": [{"name": "Bend", "samplers": [{"input": times, "output": turns}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(blob)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob += b"\0" * (-len(blob) % 4)
    path.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(blob), len(text), b"JSON") + text +
                     struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def parts_of(path):
    """The JSON and the binary chunk of a GLB file."""
    content = path.read_bytes()
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20:20 + length]), content[28 + length:]


def values_of(document, blob, accessor):
    accessor = document["accessors"][accessor]
    view = document["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor["type"]]
    form = {5126: "f", 5123: "H", 5125: "I"}[accessor["componentType"]]
    flat = struct.unpack_from(f"<{accessor['count'] * width}{form}", blob, view["byteOffset"])
    return [flat[i:i + width] for i in range(0, len(flat), width)]


class SkinCage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.folder / "tube.glb"

    def run_program(self, *arguments, code=0):
        ran = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(ran.returncode, code, ran.stderr)
        return ran.stderr

    def made(self, name="cage.glb", *options):
        cage = self.folder / name
        self.run_program("generate", self.model, "--skin-cage", "-o", cage, "--vertices", 40, "--rounds", 0, "--quiet",
                         *options)
        return cage

    def test_the_cage_is_valid_in_the_pose_it_was_made_for(self):
        for bent in (0, 35):
            for pose in ("shown", "bind"):
                with self.subTest(bent=bent, pose=pose):
                    write_model(self.model, bent)
                    cage = self.made("cage.glb", "--pose", pose)
                    self.run_program("check", self.model, cage, "--pose", pose, "--quiet")

    def test_it_follows_the_joints_of_the_model_near_it(self):
        write_model(self.model)
        document, blob = parts_of(self.made())
        attributes = document["meshes"][0]["primitives"][0]["attributes"]
        names = [document["nodes"][joint]["name"] for joint in document["skins"][0]["joints"]]
        for place, joints, weights in zip(*(values_of(document, blob, attributes[name])
                                            for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))):
            self.assertAlmostEqual(sum(weights), 1, 5)
            upper = sum(weight for joint, weight in zip(joints, weights) if names[joint] == "Middle")
            if place[1] > 3:
                self.assertGreater(upper, 0.999)
            if place[1] < 1:
                self.assertLess(upper, 0.001)

    def test_a_cage_made_in_bind_pose_encloses_the_model_when_the_rig_bends_it(self):
        """The joints turn in both files alike, by less than the clearance can bear."""
        write_model(self.model)
        document = parts_of(self.made("cage.glb", "--clearance", "3%"))[0]
        cage = self.folder / "cage.glb"
        turn = json.dumps(document["nodes"][1]["rotation"])
        self.assertEqual(json.loads(turn), turned(0))
        write_model(self.model, 10)
        content = cage.read_bytes()
        bent = self.folder / "bent.gltf"
        self.run_program("convert", cage, self.folder / "flat.obj", "--quiet")
        document, blob = parts_of(cage)
        document["nodes"][1]["rotation"] = turned(10)
        import base64
        document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(
            blob[:document["buffers"][0]["byteLength"]]).decode()
        bent.write_text(json.dumps(document))
        self.assertEqual(content, cage.read_bytes())
        self.run_program("check", self.model, bent, "--quiet")

    def test_rig_and_animation_stay_and_the_model_goes(self):
        write_model(self.model)
        document, blob = parts_of(self.made())
        self.assertEqual([node["name"] for node in document["nodes"]], ["Foot", "Middle", "Body", "Cage"])
        self.assertEqual([node.get("mesh") for node in document["nodes"]], [None, None, None, 0])
        self.assertNotIn("camera", document["nodes"][2])
        self.assertEqual(document["scenes"][0]["nodes"], [0, 2, 3])
        animation = document["animations"][0]
        self.assertEqual(animation["channels"][0]["target"], {"node": 1, "path": "rotation"})
        values = values_of(document, blob, animation["samplers"][0]["output"])
        for found, wanted in zip(values[1], turned(40)):
            self.assertAlmostEqual(found, wanted, 6)

    def test_json_and_the_same_bytes_again(self):
        write_model(self.model)
        self.made("cage.gltf")
        self.run_program("check", self.model, self.folder / "cage.gltf", "--quiet")
        self.assertEqual(self.made("one.glb").read_bytes(), self.made("two.glb").read_bytes())

    def test_refusals(self):
        write_model(self.model, skinned=False)
        said = self.run_program("generate", self.model, "--skin-cage", "-o", self.folder / "cage.glb", "--rounds", 0, code=2)
        self.assertIn("no mesh of it has a skin", said)
        self.assertFalse((self.folder / "cage.glb").exists())
        write_model(self.model)
        said = self.run_program("generate", self.model, "--skin-cage", "-o", self.folder / "cage.obj", code=2)
        self.assertIn(".glb or .gltf", said)
        said = self.run_program("generate", self.model, "-o", self.folder / "cage.glb", code=2)
        self.assertIn("cages are written as", said)


if __name__ == "__main__":
    unittest.main()
