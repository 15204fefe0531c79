"""Models follow their cages: as our program says, in every way that a cage can move, and until they are unbound."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).parent))
from support import *  # noqa

from cagewright import follow  # noqa

# Five real models; the figure is rigged, and posed by its animation.
MODEL_NAMES = ["creature.obj", "spot.obj", "suzanne.obj", "homer.off", "rigged_figure.glb"]


class Real(Test):
    def test_real_models_follow_exactly(self):
        for name in MODEL_NAMES:
            with self.subTest(model=name):
                empty()
                try:
                    model = add_model(name)
                except unittest.SkipTest as skip:
                    print(f"skipped: {skip}")
                    continue
                bpy.context.scene.frame_set(20)
                cage = add_box(model)
                rest, cage_rest = shown(model), shown(cage)
                bind(model, cage)
                self.assertNear(shown(model), rest, 1e-6)
                # Every vertex follows a translation.
                step = 0.3 * diagonal(rest) * np.array([1, -2, 0.5])
                set_points(cage, points(cage) + step)
                self.assertNear(shown(model), rest + step, 1e-6)
                # An edit moves what it should.
                set_points(cage, bent(cage_rest))
                wanted = by_program(rest, geometry.faces_of(model.data), cage_rest, geometry.faces_of(cage.data),
                                    bent(cage_rest))
                self.assertGreater(np.abs(wanted - rest).max(), 0.01 * diagonal(rest))
                self.assertNear(shown(model), wanted, 1e-6)


class Bind(Test):
    def bound(self):
        model = add_torus()
        cage = add_box(model)
        self.rest, self.cage_rest = shown(model), points(cage)
        bind(model, cage)
        return model, cage

    def wanted(self, model, cage, posed, *options):
        return by_program(self.rest, geometry.faces_of(model.data), self.cage_rest, geometry.faces_of(cage.data), posed,
                          *options)

    def assertFollows(self, model, cage, posed=None, tolerance=1e-6):
        posed = shown(cage) if posed is None else posed
        self.assertNear(shown(model), self.wanted(model, cage, posed), tolerance)

    def test_all_kinds_of_coordinates(self):
        for kind in engine.kinds():
            with self.subTest(kind=kind["name"]):
                empty()
                bpy.context.scene.cagewright.coordinates = kind["name"]
                model, cage = self.bound()
                set_points(cage, bent(points(cage)))
                wanted = self.wanted(model, cage, bent(self.cage_rest), "--coordinates", kind["name"])
                self.assertNear(shown(model), wanted, 2e-6)
                self.assertGreater(np.abs(shown(model) - self.rest).max(), 0.01)

    def test_object_mode(self):
        model, cage = self.bound()
        cage.location = (1, 2, 3)
        cage.scale = (1, 2, 1)
        cage.rotation_euler = (0.1, 0.2, 0.3)
        bpy.context.view_layer.update()
        self.assertFollows(model, cage)

    def test_edit_mode(self):
        import bmesh
        model, cage = self.bound()
        select(cage)
        bpy.ops.object.mode_set(mode="EDIT")
        edited = bmesh.from_edit_mesh(cage.data)
        edited.verts.ensure_lookup_table()
        edited.verts[3].co += mathutils.Vector((0.5, 0.25, -1))
        bmesh.update_edit_mesh(cage.data)
        bpy.context.view_layer.update()
        posed = self.cage_rest.copy()
        posed[3] += (0.5, 0.25, -1)
        self.assertFollows(model, cage, posed)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertFollows(model, cage, posed)

    def test_shape_keys_and_drivers_and_animation_of_the_cage(self):
        model, cage = self.bound()
        cage.shape_key_add(name="Basis")
        key = cage.shape_key_add(name="Bent")
        key.data.foreach_set("co", bent(self.cage_rest).astype(np.float32).ravel())
        key.value = 0.5
        bpy.context.view_layer.update()
        self.assertFollows(model, cage, (self.cage_rest + bent(self.cage_rest)) / 2)
        driver = key.driver_add("value").driver
        driver.type = "SCRIPTED"
        driver.expression = "frame / 100"
        bpy.context.scene.frame_set(75)
        self.assertFollows(model, cage, self.cage_rest * 0.25 + bent(self.cage_rest) * 0.75)
        cage.keyframe_insert("location", frame=75)
        cage.location = (0, 0, 4)
        cage.keyframe_insert("location", frame=100)
        bpy.context.scene.frame_set(100)
        self.assertFollows(model, cage, bent(self.cage_rest) + [0, 0, 4])

    def moving(self):
        model, cage = self.bound()
        cage.hide_render = True
        cage.keyframe_insert("location", frame=1)
        cage.location = (0, 0, 5)
        cage.keyframe_insert("location", frame=10)
        cage.shape_key_add(name="Basis")
        key = cage.shape_key_add(name="Aside")
        key.data.foreach_set("co", (self.cage_rest + [2, 0, 0]).astype(np.float32).ravel())
        for frame, value in ((1, 0.0), (10, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        return model, cage

    def test_a_hidden_cage_moves_its_model(self):
        model, cage = self.moving()
        cage.hide_set(True)
        bpy.context.view_layer.update()
        bpy.context.scene.frame_set(1)
        self.assertNear(shown(model), self.rest, 1e-6)
        bpy.context.scene.frame_set(10)
        self.assertNear(shown(model), self.rest + [2, 0, 5], 1e-6)

    def test_a_cage_that_is_not_rendered_moves_its_model_in_renders(self):
        """Seen by what the renderer is given: where the model is when a frame has been rendered."""
        model, cage = self.moving()
        scene = bpy.context.scene
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(camera)
        scene.camera = camera
        places = []

        class Engine(bpy.types.RenderEngine):
            bl_idname, bl_label = "TEST", "Test"

            def render(self, depsgraph):
                for instance in depsgraph.object_instances:
                    if instance.object.original == model:
                        places.append(geometry.points_of(instance.object.data).copy())

        bpy.utils.register_class(Engine)
        try:
            scene.render.engine = "TEST"
            scene.render.filepath = str(HOME / "frame_")
            scene.render.resolution_x = scene.render.resolution_y = 16
            scene.frame_start, scene.frame_end, scene.frame_step = 1, 10, 9
            bpy.ops.render.render(animation=True)
        finally:
            scene.render.engine = "BLENDER_WORKBENCH"
            bpy.utils.unregister_class(Engine)
        self.assertEqual(len(places), 2)
        self.assertNear(places[0], self.rest, 1e-6)
        self.assertNear(places[1], self.rest + [2, 0, 5], 1e-6)

    def test_an_armature_on_the_cage(self):
        model, cage = self.bound()
        rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
        bpy.context.scene.collection.objects.link(rig)
        select(rig)
        bpy.ops.object.mode_set(mode="EDIT")
        bone = rig.data.edit_bones.new("Bone")
        bone.tail = (0, 0, 1)
        bpy.ops.object.mode_set(mode="OBJECT")
        cage.vertex_groups.new(name="Bone").add(range(len(self.cage_rest)), 1.0, "REPLACE")
        cage.modifiers.new("Armature", "ARMATURE").object = rig
        rig.pose.bones["Bone"].location = (0.5, 1, 2)
        rig.pose.bones["Bone"].rotation_quaternion = (0.9, 0.1, 0.3, 0)
        bpy.context.view_layer.update()
        self.assertGreater(np.abs(shown(cage) - self.cage_rest).max(), 0.5)
        self.assertFollows(model, cage)

    def test_transformed_models_are_bound_as_they_look(self):
        for kind in ("mean_value", "green"):
            for scale in [(3, 0.5, 1), (-1, 1, 1), (-2, -1, -0.5)]:
                with self.subTest(kind=kind, scale=scale):
                    empty()
                    bpy.context.scene.cagewright.coordinates = kind
                    model = add_torus()
                    model.scale = scale
                    model.rotation_euler = (0.4, -1, 2)
                    model.location = (3, -2, 1)
                    bpy.context.view_layer.update()
                    cage = add_box(model)
                    self.rest, self.cage_rest = shown(model), points(cage)
                    bind(model, cage)
                    set_points(cage, bent(self.cage_rest))
                    wanted = self.wanted(model, cage, bent(self.cage_rest), "--coordinates", kind)
                    self.assertNear(shown(model), wanted, 3e-6)

    def test_a_parented_cage_goes_along(self):
        model, cage = self.bound()
        bpy.ops.cagewright.unbind()
        cage.parent = model
        bind(model, cage)
        set_points(cage, bent(self.cage_rest))
        before = shown(model, world=False)
        self.assertGreater(np.abs(before - points(model)).max(), 0.01)
        model.location = (10, 0, 0)
        model.rotation_euler = (1, 2, 3)
        bpy.context.view_layer.update()
        self.assertNear(shown(model, world=False), before, 1e-6)

    def test_modifiers_of_the_model_go_on_working(self):
        model = add_torus()
        model.modifiers.new("Subdivision", "SUBSURF")
        cage = add_box(model, margin=0.3)
        bind(model, cage)
        self.assertEqual([modifier.name for modifier in model.modifiers], ["Cagewright", "Subdivision"])
        before = shown(model)
        set_points(cage, points(cage) + [0, 1, 0])
        self.assertNear(shown(model), before + [0, 1, 0], 1e-6)

    def test_a_rig_poses_what_the_cage_has_moved(self):
        model = add_model("rigged_figure.glb")
        bpy.context.scene.frame_set(20)
        rest = shown(model)
        cage = add_box(model)
        bpy.context.scene.cagewright.pose = "REST"
        bind(model, cage)
        self.assertEqual([modifier.type for modifier in model.modifiers], ["NODES", "ARMATURE"])
        set_points(cage, points(cage) + [0, 0, 0.2])
        once = shown(model)
        self.assertGreater(np.abs(once - rest).max(), 0.1)
        bpy.context.scene.frame_set(40)
        self.assertGreater(np.abs(shown(model) - once).max(), 1e-3)

    def test_the_rig_moves_cage_and_model_and_edits_are_on_top(self):
        model = add_model("rigged_figure.glb")
        bpy.context.scene.frame_set(20)
        bpy.context.scene.cagewright.skin = True
        cage = generate(model)
        self.assertGreater(len(cage.vertex_groups), 3)
        for vertex in cage.data.vertices:
            self.assertAlmostEqual(sum(element.weight for element in vertex.groups), 1, 4)
        before = shown(cage)
        bind(cage)
        at_20 = shown(model)
        bpy.context.scene.frame_set(45)
        self.assertGreater(np.abs(shown(cage) - before).max(), 0.01 * diagonal(before))
        plain = shown(model)
        binding.unbind(model)
        bpy.context.view_layer.update()
        self.assertNear(plain, shown(model), 1e-6)  # the rig alone moves the model as it did before
        bpy.context.scene.frame_set(20)
        self.assertNear(at_20, shown(model), 1e-6)

    def test_undo_and_redo_across_binding_and_editing(self):
        model, cage = self.bound()
        bpy.ops.ed.undo_push(message="bound")
        set_points(cage, bent(self.cage_rest))
        moved = shown(model)
        bpy.ops.ed.undo_push(message="edited")
        bpy.ops.ed.undo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        self.assertNear(shown(model), self.rest, 1e-6)
        bpy.ops.ed.redo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        self.assertNear(shown(model), moved, 1e-6)
        bpy.ops.ed.undo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        set_points(cage, self.cage_rest + 1)
        self.assertNear(shown(model), self.rest + 1, 1e-6)
        select(cage)
        bpy.ops.ed.undo_push(message="before unbinding")
        bpy.ops.cagewright.unbind()
        bpy.ops.ed.undo_push(message="unbound")
        bpy.ops.ed.undo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        self.assertTrue(binding.is_bound(model))
        set_points(cage, self.cage_rest + 2)
        self.assertNear(shown(model), self.rest + 2, 1e-6)

    def test_undo_of_binding_leaves_nothing(self):
        model = add_torus()
        cage = add_box(model)
        rest = shown(model)
        bpy.ops.ed.undo_push(message="before")
        bind(model, cage)
        bpy.ops.ed.undo_push(message="bound")
        bpy.ops.ed.undo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        self.assertEqual(len(model.modifiers), 0)
        set_points(cage, points(cage) + 1)
        self.assertNear(shown(model), rest, 1e-6)
        bpy.ops.ed.redo()
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        set_points(cage, points(cage) + 1)
        self.assertNear(shown(model), rest + 1, 1e-6)

    def test_saved_and_opened_again(self):
        model, cage = self.bound()
        set_points(cage, bent(self.cage_rest))
        moved = shown(model)
        path = str(HOME / "bound.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        empty()
        bpy.ops.wm.open_mainfile(filepath=path)
        model, cage = bpy.data.objects["Torus"], bpy.data.objects["Box"]
        self.assertNear(shown(model), moved, 1e-6)
        set_points(cage, self.cage_rest + 1)
        self.assertNear(shown(model), self.rest + 1, 1e-6)

    def test_without_the_add_on_and_with_it_again(self):
        model, cage = self.bound()
        set_points(cage, bent(self.cage_rest))
        moved = shown(model)
        bpy.ops.preferences.addon_disable(module="cagewright")
        try:
            self.assertFalse(hasattr(bpy.types.Scene, "cagewright"))
            self.assertNear(shown(model), moved, 1e-6)
            handlers = [handler.__module__ for name in ("depsgraph_update_post", "load_post", "undo_post")
                        for handler in getattr(bpy.app.handlers, name)]
            self.assertFalse([name for name in handlers if name.startswith("cagewright")])
        finally:
            bpy.ops.preferences.addon_enable(module="cagewright")
        sys.modules["cagewright"].follow.gather()  # what a timer does where there is an interface
        set_points(cage, self.cage_rest + 1)
        self.assertNear(shown(model), self.rest + 1, 1e-6)

    def test_deleting_the_cage_unbinds(self):
        for delete in ("data", "operator"):
            with self.subTest(delete=delete):
                empty()
                model, cage = self.bound()
                set_points(cage, bent(self.cage_rest))
                if delete == "data":
                    bpy.data.objects.remove(cage)
                else:
                    select(cage)
                    bpy.ops.object.delete()
                bpy.context.view_layer.update()
                self.assertFalse(binding.is_bound(model))
                self.assertEqual(len(model.modifiers), 0)
                self.assertEqual([a.name for a in model.data.attributes if a.name.startswith("cagewright")], [])
                self.assertNear(shown(model), self.rest, 1e-6)

    def test_a_copy_of_the_model_bends_in_its_own_place(self):
        model, cage = self.bound()
        select(cage)
        bpy.ops.cagewright.unbind()
        cage.parent = model
        bind(model, cage)
        select(model)
        bpy.ops.object.duplicate()
        copy = bpy.context.object
        copy.location.x = 10
        bpy.context.view_layer.update()
        set_points(cage, bent(self.cage_rest))
        self.assertNear(shown(copy), shown(model) + [10, 0, 0], 1e-6)
        binding.unbind(copy)
        follow.gather()
        bpy.context.view_layer.update()
        self.assertNear(shown(copy), self.rest + [10, 0, 0], 1e-6)
        self.assertFollows(model, cage)

    def test_a_copy_of_both_is_bound_to_the_copy(self):
        model, cage = self.bound()
        select(model, cage)
        bpy.ops.object.duplicate()
        copies = bpy.context.selected_objects
        copied_model = next(obj for obj in copies if binding.is_bound(obj))
        copied_cage = next(obj for obj in copies if obj != copied_model)
        self.assertEqual(copied_model.cagewright.cage, copied_cage)
        bpy.context.view_layer.update()
        set_points(copied_cage, self.cage_rest + 1)
        self.assertNear(shown(copied_model), self.rest + 1, 1e-6)
        self.assertNear(shown(model), self.rest, 1e-6)
        set_points(cage, self.cage_rest - 1)
        self.assertNear(shown(copied_model), self.rest + 1, 1e-6)
        self.assertNear(shown(model), self.rest - 1, 1e-6)

    def test_renamed_and_renamed_for_each_other(self):
        model, cage = self.bound()
        model.name, cage.name = "Body", "Skin"
        set_points(cage, self.cage_rest + 1)
        self.assertNear(shown(model), self.rest + 1, 1e-6)
        model.name = "Unused"
        cage.name, model.name = "Body", "Skin"
        set_points(cage, self.cage_rest + 2)
        self.assertNear(shown(model), self.rest + 2, 1e-6)

    def test_linked_copies_of_a_bound_model(self):
        """Copies that share its mesh: each goes where its own place says, in any order."""
        for parented in (False, True):
            with self.subTest(parented=parented):
                empty()
                model, cage = self.bound()
                if parented:
                    bpy.ops.cagewright.unbind()
                    cage.parent = model
                    bind(model, cage)
                select(model)
                bpy.ops.object.duplicate(linked=True)
                copy = bpy.context.object
                self.assertEqual(copy.data, model.data)
                copy.location.x += 10
                bpy.context.view_layer.update()
                set_points(cage, self.cage_rest + 1)
                self.assertNear(shown(model), self.rest + 1, 1e-6)
                # In its own place where the cage is the model's child, else where the cage is.
                self.assertNear(shown(copy), self.rest + 1 + [10 if parented else 0, 0, 0], 1e-6)
                bpy.data.objects.remove(copy)
                set_points(cage, self.cage_rest + 2)
                self.assertNear(shown(model), self.rest + 2, 1e-6)

    def test_an_overridden_character_says_what_to_do_and_follows_then(self):
        model, cage = self.bound()
        collection = bpy.data.collections.new("Character")
        bpy.context.scene.collection.children.link(collection)
        for obj in (model, cage):
            bpy.context.scene.collection.objects.unlink(obj)
            collection.objects.link(obj)
        bpy.ops.wm.save_as_mainfile(filepath=str(HOME / "character.blend"))
        empty()
        with bpy.data.libraries.load(str(HOME / "character.blend"), link=True) as (source, target):
            target.collections = ["Character"]
        bpy.context.scene.collection.children.link(target.collections[0])
        root = target.collections[0].override_hierarchy_create(bpy.context.scene, bpy.context.view_layer)
        model, cage = (next(obj for obj in root.objects if obj.name.startswith(name)) for name in ("Torus", "Box"))
        bpy.context.view_layer.update()
        self.assertNear(shown(model), self.rest, 1e-6)
        cage.location.z += 2
        bpy.context.view_layer.update()
        self.assertIn("make it local", model.cagewright.problem)
        select(model)
        bpy.ops.object.make_local(type="SELECT_OBDATA")
        model = bpy.context.view_layer.objects.active
        self.assertIsNone(model.data.library)
        cage.location.z += 1
        bpy.context.view_layer.update()
        self.assertEqual(model.cagewright.problem, "")
        self.assertNear(shown(model), self.rest + [0, 0, 3], 1e-6)
        names = model.name, cage.name
        bpy.ops.wm.save_as_mainfile(filepath=str(HOME / "shot.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(HOME / "shot.blend"))
        model, cage = (next(obj for obj in bpy.data.objects if obj.name == name and obj.library is None) for name in names)
        self.assertEqual(model.cagewright.cage, cage)
        self.assertNear(shown(model), self.rest + [0, 0, 3], 1e-6)
        cage.location.z += 1
        bpy.context.view_layer.update()
        self.assertNear(shown(model), self.rest + [0, 0, 4], 1e-6)

    def test_linked_models_are_refused_with_a_remedy(self):
        model = add_torus()
        model.name = "Library Torus"
        path = str(HOME / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        empty()
        with bpy.data.libraries.load(path, link=True) as (source, target):
            target.objects = ["Library Torus"]
        linked = target.objects[0]
        bpy.context.scene.collection.objects.link(linked)
        override = linked.override_create(remap_local_usages=True)
        cage = add_box(override)
        select(override, cage)
        with self.assertRaisesRegex(RuntimeError, "make it local"):
            bpy.ops.cagewright.bind()

    def test_a_cage_with_other_vertices_is_told_and_forgiven(self):
        model, cage = self.bound()
        modifier = cage.modifiers.new("More", "SUBSURF")
        bpy.context.view_layer.update()
        self.assertIn("bound", model.cagewright.problem)
        self.assertNear(shown(model), self.rest, 1e-6)
        cage.modifiers.remove(modifier)
        set_points(cage, self.cage_rest + 1)
        self.assertEqual(model.cagewright.problem, "")
        self.assertNear(shown(model), self.rest + 1, 1e-6)

    def test_an_open_or_a_flat_thing_is_refused(self):
        model = add_torus()
        bpy.ops.mesh.primitive_plane_add(size=10)
        plane = bpy.context.object
        select(model, plane)
        with self.assertRaisesRegex(RuntimeError, "open or inconsistent edges"):
            bpy.ops.cagewright.bind()
        self.assertFalse(binding.is_bound(model))

    def test_an_edited_model_keeps_its_cage(self):
        model, cage = self.bound()
        select(model)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=1)
        bpy.ops.object.mode_set(mode="OBJECT")
        rest = shown(model)
        self.assertEqual(len(rest), 4 * len(self.rest))
        set_points(cage, self.cage_rest + 1)
        self.assertNear(shown(model), rest + 1, 1e-6)

    def test_a_tiny_model_far_away(self):
        model = add_torus()
        model.data.transform(mathutils.Matrix.Scale(1e-3, 4))
        model.location = (0.5, 0.25, 0.125)
        bpy.context.view_layer.update()
        cage = add_box(model)
        cage.matrix_world = model.matrix_world
        set_points(cage, points(cage) - np.array(model.location))
        self.rest, self.cage_rest = shown(model), shown(cage)
        bind(model, cage)
        set_points(cage, bent(points(cage)))
        self.assertFollows(model, cage, tolerance=3e-5)  # of float coordinates in the world


if __name__ == "__main__":
    main()
