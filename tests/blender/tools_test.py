"""Mesh Deform set up right; the judge, fitting, mirroring; poses as shape keys and point caches; weights as groups."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).parent))
from support import *  # noqa

from cagewright import mesh_deform, poses  # noqa


class MeshDeform(Test):
    def assertBound(self, model, cage):
        select(model, cage)
        self.assertEqual(bpy.ops.cagewright.mesh_deform(), {"FINISHED"})
        with mesh_deform.at_rest(model, cage):  # the armature turns what the cage has moved
            self.assertEqual(mesh_deform.staying(model, cage)[0], 0)

    def test_every_vertex_of_a_posed_figure_follows(self):
        model = add_model("rigged_figure.glb")
        rig = model.find_armature()
        bpy.context.scene.frame_set(20)
        posed = shown(model)
        rig.data.pose_position = "REST"
        bpy.context.view_layer.update()
        cage = add_box(model)
        rig.data.pose_position = "POSE"
        bpy.context.view_layer.update()
        self.assertBound(model, cage)
        self.assertEqual(rig.data.pose_position, "POSE")
        self.assertEqual(model.modifiers[0].type, "MESH_DEFORM")
        self.assertNear(shown(model), posed, 1e-4)

    def test_a_cage_of_the_pose_that_is_shown(self):
        """It does not enclose the model at rest, so it moves the model after its armature."""
        model = add_model("rigged_figure.glb")
        bpy.context.scene.frame_set(20)
        posed = shown(model)
        cage = add_box(model, margin=0.02)
        select(model, cage)
        self.assertEqual(bpy.ops.cagewright.mesh_deform(), {"FINISHED"})
        self.assertEqual([modifier.type for modifier in model.modifiers], ["ARMATURE", "MESH_DEFORM"])
        self.assertNear(shown(model), posed, 1e-4)
        set_points(cage, points(cage) + [0, 0, 0.2])
        self.assertNear(shown(model), posed + [0, 0, 0.2], 1e-3)
        bpy.context.scene.frame_set(40)
        self.assertGreater(np.abs(shown(model) - posed - [0, 0, 0.2]).max(), 1e-2)  # the rig goes on
        # One that encloses neither is refused, and the rig is as it was.
        model.modifiers.remove(model.modifiers[-1])
        set_points(cage, points(cage) * 0.5)
        select(model, cage)
        with self.assertRaisesRegex(RuntimeError, "are outside: .* rest position"):
            bpy.ops.cagewright.mesh_deform()
        self.assertEqual(model.find_armature().data.pose_position, "POSE")

    def test_a_model_as_it_looks(self):
        model = add_torus()
        model.scale = (-1, 2, 1)
        bpy.context.view_layer.update()
        cage = add_box(model)
        self.assertBound(model, cage)
        before = shown(model)
        set_points(cage, points(cage) + [0, 0, 1])
        self.assertNear(shown(model), before + [0, 0, 1], 1e-3)

    def test_what_it_would_bind_to_nothing_is_refused(self):
        model = add_torus()
        cage = add_box(model)
        set_points(cage, points(cage) * 0.5)
        select(model, cage)
        with self.assertRaisesRegex(RuntimeError, "vertices of the model are outside"):
            bpy.ops.cagewright.mesh_deform()
        set_points(cage, points(cage) * 2)
        cage.data.flip_normals()
        with self.assertRaisesRegex(RuntimeError, "faces inward"):
            bpy.ops.cagewright.mesh_deform()
        self.assertEqual(len(model.modifiers), 0)


class Judge(Test):
    def caged(self):
        model = add_torus()
        cage = add_box(model)
        bind(model, cage)
        select(cage)
        return model, cage

    def selected(self, cage):
        if cage.mode == "EDIT":
            bpy.ops.object.mode_set(mode="OBJECT")
        return ({vertex.index for vertex in cage.data.vertices if vertex.select},
                {face.index for face in cage.data.polygons if face.select})

    def test_a_good_cage(self):
        model, cage = self.caged()
        bpy.ops.cagewright.check()
        self.assertEqual(cage.cagewright.verdict, "valid")
        self.assertEqual(cage.mode, "OBJECT")
        # Moved as a pose it is still judged round the model at rest.
        set_points(cage, points(cage) + [0, 0, 3])
        bpy.ops.cagewright.check()
        self.assertIn("vertex outside", cage.cagewright.verdict)

    def test_what_is_wrong_is_selected(self):
        model, cage = self.caged()
        face = max(cage.data.polygons, key=lambda f: f.center.z)
        pushed = points(cage)
        pushed[list(face.vertices), 2] -= 1.5
        set_points(cage, pushed)
        bpy.ops.cagewright.check()
        self.assertEqual(cage.mode, "EDIT")
        vertices, faces = self.selected(cage)
        self.assertIn(face.index, faces)
        self.assertLess(len(faces), len(cage.data.polygons) / 2)

    def test_open_edges_are_selected(self):
        import bmesh
        model, cage = self.caged()
        edited = bmesh.new()
        edited.from_mesh(cage.data)
        edited.faces.ensure_lookup_table()
        corners = {vertex.index for vertex in edited.faces[0].verts}
        bmesh.ops.delete(edited, geom=[edited.faces[0]], context="FACES_ONLY")
        edited.to_mesh(cage.data)
        bpy.context.view_layer.update()
        bpy.ops.cagewright.check()
        self.assertTrue(corners <= self.selected(cage)[0])

    def test_from_edit_mode(self):
        model, cage = self.caged()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.cagewright.check()
        self.assertEqual(cage.mode, "EDIT")


class Fit(Test):
    def test_an_edited_model_is_enclosed_again(self):
        for scale in [(1, 1, 1), (-1, 0.5, 2)]:
            with self.subTest(scale=scale):
                empty()
                model = add_torus()
                model.scale = scale
                bpy.context.view_layer.update()
                cage = generate(model)
                bind(cage)
                edited = points(model)
                edited[:20] *= 1.6
                set_points(model, edited)
                faces = [tuple(face.vertices) for face in cage.data.polygons]
                select(cage)
                bpy.ops.cagewright.fit()
                self.assertEqual([tuple(face.vertices) for face in cage.data.polygons], faces)
                bpy.ops.cagewright.check()
                self.assertEqual(cage.cagewright.verdict, "valid")
                before = shown(model)
                set_points(cage, points(cage) + [0, 0, 1])
                self.assertNear(shown(model), before + [0, 0, 1], 1e-5)

    def test_what_cannot_be_fitted_stays(self):
        model = add_torus()
        cage = add_box(model)
        bind(model, cage)
        cage.data.flip_normals()
        before = points(cage)
        select(cage)
        with self.assertRaisesRegex(RuntimeError, "cannot be fitted: .*generate a new cage"):
            bpy.ops.cagewright.fit()
        self.assertNear(points(cage), before, 0)


class Mirror(Test):
    def test_a_made_cage(self):
        model = add_torus()
        model.location = (3, 0, 0)
        bpy.context.view_layer.update()
        cage = generate(model)
        self.assertTrue(cage.cagewright.mirror)
        import json
        known = json.loads(cage.cagewright.mirror)
        side = known["sides"].index(1)
        moved = points(cage)
        moved[side] += 0.2
        set_points(cage, moved)
        bpy.ops.cagewright.mirror()
        normal, offset = np.array(known["normal"]), known["offset"]
        mirrored = moved - 2 * np.outer(moved @ normal - offset, normal)
        self.assertNear(points(cage)[known["partners"][side]], mirrored[side], 1e-6, 1)
        self.assertNear(points(cage)[side], moved[side], 1e-6, 1)

    def test_a_cage_from_elsewhere_in_edit_mode(self):
        model = add_torus()
        cage = add_box(model)
        bind(model, cage)
        rest = points(cage)
        moved = rest.copy()
        moved[rest[:, 0] < 0] += [0.1, 0.2, 0.3]
        set_points(cage, moved)
        select(cage)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.cagewright.mirror(side="NEGATIVE")
        bpy.ops.object.mode_set(mode="OBJECT")
        after = points(cage)
        self.assertNear(after[rest[:, 0] < 0], moved[rest[:, 0] < 0], 1e-6)
        for number in np.flatnonzero(rest[:, 0] > 1e-6):
            partner = np.argmin(np.abs(rest * [-1, 1, 1] - rest[number]).sum(axis=1))
            self.assertNear(after[number], moved[partner] * [-1, 1, 1], 1e-6, 1)


class Poses(Test):
    def posed(self):
        model = add_torus()
        cage = add_box(model)
        bind(model, cage)
        set_points(cage, bent(points(cage)))
        select(model)
        return model, cage

    def test_to_shape_key(self):
        model, cage = self.posed()
        before = shown(model)
        bpy.ops.cagewright.to_shape_key(name="Bent")
        self.assertEqual([key.name for key in model.data.shape_keys.key_blocks], ["Basis", "Bent"])
        bpy.context.view_layer.update()
        self.assertNear(shown(model), before, 1e-6)
        bpy.ops.cagewright.to_shape_key(name="Again", then_unbind=True)
        bpy.context.view_layer.update()
        self.assertFalse(binding.is_bound(model))
        self.assertNear(shown(model), before, 1e-6)

    def test_to_shape_key_beneath_an_armature(self):
        model = add_model("rigged_figure.glb")
        bpy.context.scene.frame_set(20)
        cage = add_box(model)
        bind(model, cage)
        set_points(cage, bent(points(cage)))
        before = shown(model)
        select(model)
        bpy.ops.cagewright.to_shape_key(then_unbind=True)
        bpy.context.view_layer.update()
        self.assertNear(shown(model), before, 1e-5)

    def animated(self):
        model, cage = self.posed()
        for frame, place in [(1, (0, 0, 0)), (11, (0, 0, 2))]:
            cage.location = place
            cage.scale = (1, 1 + place[2], 1)
            cage.keyframe_insert("location", frame=frame)
            cage.keyframe_insert("scale", frame=frame)
        wanted = {}
        for frame in (1, 4, 7, 10):
            bpy.context.scene.frame_set(frame)
            wanted[frame] = shown(model)
        return model, cage, wanted

    def test_bake_to_shape_keys(self):
        model, cage, wanted = self.animated()
        select(model)
        bpy.ops.cagewright.bake_keys(start=1, end=10, step=3)
        self.assertFalse(binding.is_bound(model))
        for frame, positions in wanted.items():
            bpy.context.scene.frame_set(frame)
            self.assertNear(shown(model), positions, 1e-5)
        bpy.context.scene.frame_set(2)
        self.assertNear(shown(model), wanted[1] * 2 / 3 + wanted[4] / 3, 1e-5)

    def test_bake_to_point_caches(self):
        model, cage, wanted = self.animated()
        select(model)
        for ending in ("pc2", "mdd"):
            path = str(HOME / f"moving.{ending}")
            bpy.ops.cagewright.bake_cache(filepath=path, start=1, end=10, step=3)
            cached = add_torus()
            modifier = cached.modifiers.new("Cache", "MESH_CACHE")
            modifier.cache_format = ending.upper()
            modifier.filepath = path
            modifier.frame_scale = 1 / 3 if ending == "pc2" else 1
            modifier.frame_start = 1
            if ending == "pc2":
                bpy.context.scene.frame_set(1)
                self.assertNear(shown(cached), wanted[1], 1e-6)
            select(model)
        with self.assertRaisesRegex(RuntimeError, "pc2 or .mdd"):
            bpy.ops.cagewright.bake_cache(filepath=str(HOME / "moving.abc"))

    def test_weights_as_groups(self):
        model, cage = self.posed()
        bpy.ops.cagewright.weights_to_groups()
        count = len(cage.data.vertices)
        self.assertEqual(len(model.vertex_groups), count)
        live = binding.live_of(model)
        weights = bindings.coordinates("mean_value", live.rest, live.record.cage, (live.record.corners, live.record.offsets))
        for vertex in (0, 77):
            found = np.zeros(count)
            for element in model.data.vertices[vertex].groups:
                found[element.group] = element.weight
            self.assertNear(found, np.clip(weights[vertex], 0, 1), 2e-6, 1)


if __name__ == "__main__":
    main()
