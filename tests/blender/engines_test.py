"""Out to game engines and in again: GLB with skins, materials, animations and morph targets, and our program's files."""

import json
import os
import pathlib
import struct
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).parent))
from support import *  # noqa


def document_of(path):
    content = path.read_bytes()
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20:20 + length])


JUDGE = """
const validator = require(process.argv[1]), fs = require("fs"), path = require("path");
const read = name => new Uint8Array(fs.readFileSync(path.resolve(path.dirname(process.argv[2]), name)));
validator.validateBytes(read(process.argv[2]), {maxIssues: 0, externalResourceFunction: uri => Promise.resolve(read(uri))}).then(report =>
  console.log(JSON.stringify(report.issues.messages.filter(m => m.severity < 2))));
"""


def faults_of(path):
    """What the validator of the Khronos group finds: errors and warnings."""
    validator = os.environ.get("GLTF_VALIDATOR")
    if not validator or not pathlib.Path(validator).is_dir():
        raise unittest.SkipTest("gltf-validator is not here")
    said = subprocess.run(["node", "-e", JUDGE, validator, str(path)], stdout=subprocess.PIPE, check=True).stdout
    return [f"{fault['code']} {fault['pointer']}" for fault in json.loads(said)]


class Engines(Test):
    def export(self, name, **options):
        path = HOME / name
        bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", **options)
        return path

    def test_a_bound_model_goes_out_as_it_is_shown(self):
        model = add_model("rigged_figure.glb")
        bpy.context.scene.frame_set(20)
        bpy.context.scene.cagewright.pose = "REST"
        cage = add_box(model)
        bind(model, cage)
        set_points(cage, bent(points(cage)))
        before = shown(model)
        path = self.export("deformed.glb", export_apply=True)
        written = document_of(path)
        self.assertTrue(written["skins"])
        self.assertTrue(written["animations"])
        empty()
        bpy.ops.import_scene.gltf(filepath=str(path))
        found = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.vertex_groups]
        bpy.context.scene.frame_set(20)
        again = shown(found[0])
        tree = mathutils.kdtree.KDTree(len(again))
        for number, place in enumerate(again):
            tree.insert(place, number)
        tree.balance()
        worst = max(tree.find(place)[2] for place in before)
        self.assertLess(worst, 1e-3 * diagonal(before))

    def test_baked_poses_go_out_as_morph_targets_with_an_animation(self):
        model = add_torus()
        model.data.materials.append(bpy.data.materials.new("Clay"))
        cage = add_box(model)
        bind(model, cage)
        for frame in (1, 5):
            cage.location.z = frame
            cage.keyframe_insert("location", frame=frame)
        select(model)
        bpy.ops.cagewright.bake_keys(start=1, end=5, step=2)
        bpy.data.objects.remove(cage)
        path = self.export("baked.glb")
        written = document_of(path)
        self.assertEqual(len(written["meshes"][0]["primitives"][0]["targets"]), 3)
        self.assertEqual(written["materials"][0]["name"], "Clay")
        self.assertEqual(written["animations"][0]["channels"][0]["target"]["path"], "weights")
        empty()
        bpy.ops.import_scene.gltf(filepath=str(path))
        again = bpy.data.objects["Torus"]
        heights = []
        for frame in (1, 3, 5):
            bpy.context.scene.frame_set(frame)
            heights.append(shown(again)[:, 2].mean())
        self.assertAlmostEqual(heights[2] - heights[1], heights[1] - heights[0], 4)
        self.assertGreater(heights[1] - heights[0], 1)

    def run_program(self, *arguments):
        ran = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(ran.returncode, 0, ran.stdout)

    def rest_in_blender(self, path):
        """Where Blender has the vertices of the skinned mesh of a file in bind pose, in the axes of glTF."""
        empty()
        bpy.ops.import_scene.gltf(filepath=str(path))
        model = next(obj for obj in bpy.data.objects if obj.type == "MESH" and obj.vertex_groups)
        model.find_armature().data.pose_position = "REST"
        bpy.context.view_layer.update()
        return shown(model)[:, [0, 2, 1]] * [1, 1, -1]

    def test_what_the_program_deforms_in_bind_pose_is_shown_by_blender(self):
        figure, cage, posed, out = model_path("rigged_figure.glb"), HOME / "cage.ply", HOME / "posed.ply", HOME / "out.glb"
        self.run_program("generate", figure, "-o", cage, "--pose", "bind", "--vertices", 40, "--rounds", 0, "--quiet")
        vertices, corners, offsets = program_engine.read_ply(cage)
        program_engine.write_ply(posed, bent(vertices), corners, offsets)
        self.run_program("deform", figure, cage, posed, "-o", out, "--pose", "bind", "--quiet")
        wanted = bindings.read_mesh(out, pose="bind").vertices
        found = self.rest_in_blender(out)
        # Blender's bind pose is the model's but for where the root of its armature stands.
        self.assertEqual(len(found), len(wanted))
        moved = found - found.mean(axis=0) - (wanted - wanted.mean(axis=0))
        straight = np.linalg.norm(found - found.mean(axis=0), axis=1) - np.linalg.norm(wanted - wanted.mean(axis=0), axis=1)
        self.assertLess(min(np.abs(moved).max(), np.abs(straight).max()), 1e-4 * diagonal(wanted))
        self.assertTrue(document_of(out)["skins"])

    def test_what_the_program_deforms_has_no_faults_but_those_it_came_with(self):
        """Skins, materials and animations as they were, in either pose, in one file and in two."""
        figure = model_path("rigged_figure.glb")
        before = sorted(faults_of(figure))
        cage, posed = HOME / "cage.ply", HOME / "posed.ply"
        for pose in ("shown", "bind"):
            self.run_program("generate", figure, "-o", cage, "--pose", pose, "--vertices", 40, "--rounds", 0, "--quiet")
            vertices, corners, offsets = program_engine.read_ply(cage)
            program_engine.write_ply(posed, bent(vertices), corners, offsets)
            for out in (HOME / f"out_{pose}.glb", HOME / f"out_{pose}.gltf"):
                self.run_program("deform", figure, cage, posed, "-o", out, "--pose", pose, "--quiet")
                self.assertEqual(sorted(faults_of(out)), before)

    def test_a_skinned_cage_moves_with_the_rig_in_blender(self):
        cage = HOME / "skinned.glb"
        self.run_program("generate", model_path("rigged_figure.glb"), "--skin-cage", "-o", cage, "--vertices", 40,
                         "--rounds", 0, "--quiet")
        self.assertEqual(faults_of(cage), [])
        empty()
        bpy.ops.import_scene.gltf(filepath=str(cage))
        found = next(obj for obj in bpy.data.objects if obj.type == "MESH" and obj.vertex_groups)
        bpy.context.scene.frame_set(1)
        first = shown(found)
        bpy.context.scene.frame_set(25)
        self.assertGreater(np.abs(shown(found) - first).max(), 0.01 * diagonal(first))

    def test_movements_of_the_program_play_in_blender_and_are_valid(self):
        sample, cage = SAMPLES / "creature.obj", HOME / "cage.ply"
        self.run_program("generate", sample, "-o", cage, "--vertices", 40, "--rounds", 0, "--quiet")
        vertices, corners, offsets = program_engine.read_ply(cage)
        frames = []
        for number in range(3):
            frames.append(HOME / f"frame_{number}.ply")
            program_engine.write_ply(frames[-1], vertices + [0, number, 0], corners, offsets)
        out = HOME / "moving.glb"
        try:
            self.run_program("deform", sample, cage, *frames, "-o", out, "--quiet")
        except AssertionError as refused:
            if "is one file, but there are" not in str(refused):
                raise
            self.skipTest("this program writes no movements")
        self.assertEqual(faults_of(out), [])
        empty()
        bpy.ops.import_scene.gltf(filepath=str(out))
        model = next(obj for obj in bpy.data.objects if obj.type == "MESH")
        keys = model.data.shape_keys
        self.assertEqual(len(keys.key_blocks) - 1, 3)
        self.assertIsNotNone(keys.animation_data)
        bpy.context.scene.frame_set(1)
        first = shown(model)[:, 2].mean()
        bpy.context.scene.frame_set(2)
        self.assertNotAlmostEqual(shown(model)[:, 2].mean(), first, 3)

    def test_a_cage_and_a_deformed_model_as_glb_are_valid(self):
        cage, out = HOME / "cage.glb", HOME / "deformed.glb"
        sample, made = SAMPLES / "creature.obj", HOME / "made.ply"
        self.run_program("generate", sample, "-o", made, "--vertices", 40, "--rounds", 0, "--quiet")
        self.run_program("convert", made, cage, "--quiet")
        vertices, corners, offsets = program_engine.read_ply(made)
        program_engine.write_ply(HOME / "posed.ply", bent(vertices), corners, offsets)
        self.run_program("deform", sample, made, HOME / "posed.ply", "-o", out, "--quiet")
        for path in (cage, out):
            self.assertEqual(faults_of(path), [])


if __name__ == "__main__":
    import mathutils.kdtree
    main()
