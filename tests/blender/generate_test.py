"""Cages made by the add-on are valid, whatever the object is: scaled, mirrored, subdivided, several."""

import sys
import pathlib

sys.path.append(str(pathlib.Path(__file__).parent))
from support import *  # noqa

from cagewright import check_cage, library_engine  # noqa


class Generate(Test):
    def report(self, cage):
        return check_cage.report_on(cage)[0]

    def assertValid(self, cage):
        self.assertTrue(self.report(cage)["valid"], self.report(cage)["counts"])

    def test_a_cage_is_valid_and_looks_like_one(self):
        model = add_model("creature.obj")
        cage = generate(model)
        self.assertLessEqual(len(cage.data.vertices), 60)
        self.assertValid(cage)
        self.assertEqual((cage.display_type, cage.hide_render, cage.parent), ("WIRE", True, model))
        self.assertEqual([c.name for c in cage.users_collection], ["Cages"])
        self.assertEqual(len(cage.data.materials), 0)
        self.assertEqual(bpy.context.selected_objects, [cage])

    def test_options_are_those_of_the_panel(self):
        model = add_torus()
        bpy.context.scene.cagewright.vertices = 40
        bpy.context.scene.cagewright.quads = True
        bpy.context.scene.cagewright.parent = False
        cage = generate(model)
        self.assertLessEqual(len(cage.data.vertices), 40)
        self.assertGreater(sum(len(face.vertices) == 4 for face in cage.data.polygons), len(cage.data.polygons) / 2)
        self.assertIsNone(cage.parent)
        self.assertValid(cage)

    def test_the_same_as_the_program(self):
        model = add_model("creature.obj")
        cage = generate(model)
        stored = bindings.read_mesh(model_path("creature.obj"))
        wanted = bindings.generate(stored.vertices.astype(np.float32).astype(float), stored.faces, num_vertices=60, rounds=0)
        self.assertNear(points(cage), wanted.vertices, 1e-7)

    def test_transformed_models(self):
        for scale in [(1, 1, 1), (3, 0.5, 1), (-1, 1, 1), (-2, -1, -0.5)]:
            with self.subTest(scale=scale):
                empty()
                model = add_torus()
                model.scale = scale
                model.rotation_euler = (0.4, -1, 2)
                model.location = (100, -20, 3)
                bpy.context.view_layer.update()
                cage = generate(model)
                self.assertValid(cage)
                self.assertNear(np.array(cage.matrix_world), np.array(mathutils.Matrix.Translation(model.location)), 1e-5)

    def test_modifiers_as_shown_and_as_stored(self):
        model = add_torus()
        model.modifiers.new("Subdivision", "SUBSURF").levels = 1
        displaced = model.modifiers.new("Displace", "DISPLACE")
        displaced.strength = 0.1 * diagonal(points(model))
        bpy.context.view_layer.update()
        shown_cage = generate(model)
        self.assertValid(shown_cage)
        self.assertGreater(len(shown(model)), len(points(model)))
        bpy.context.scene.cagewright.pose = "REST"
        stored_cage = generate(model)
        self.assertLess(diagonal(points(stored_cage)), diagonal(points(shown_cage)))

    def test_several_models_each_or_together(self):
        first, second = add_torus(), add_torus()
        second.location.x = 2 * diagonal(points(first))
        bpy.context.view_layer.update()
        generate(second, first)
        cages = [obj for obj in bpy.data.objects if obj.cagewright.models]
        self.assertEqual(len(cages), 2)
        for cage in cages:
            self.assertValid(cage)
            bpy.data.objects.remove(cage)
        bpy.context.view_layer.update()
        bpy.context.scene.cagewright.together = True
        cage = generate(second, first)
        self.assertEqual({entry.object for entry in cage.cagewright.models}, {first, second})
        self.assertValid(cage)

    def test_a_model_of_a_thousandth(self):
        model = add_torus()
        model.data.transform(mathutils.Matrix.Scale(1e-3, 4))
        model.location = (5, 5, 5)
        bpy.context.view_layer.update()
        cage = generate(model)
        self.assertValid(cage)

    def test_ngons_and_materials(self):
        bpy.ops.mesh.primitive_cylinder_add(vertices=24)
        model = bpy.context.object
        for name in "AB":
            model.data.materials.append(bpy.data.materials.new(name))
        model.data.polygons[0].material_index = 1
        for pose in ("SHOWN", "REST"):
            bpy.context.scene.cagewright.pose = pose
            self.assertValid(generate(model))

    def test_what_cannot_be_is_told(self):
        empty_mesh = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
        bpy.context.scene.collection.objects.link(empty_mesh)
        select(empty_mesh)
        with self.assertRaisesRegex(RuntimeError, "Nothing has no vertices"):
            bpy.ops.cagewright.generate()
        select(add_mesh("Point", [[0, 0, 0]], np.zeros(0, np.int32), np.zeros(1, np.int64)))
        with self.assertRaisesRegex(RuntimeError, "extent|faces|point"):
            bpy.ops.cagewright.generate()

    def test_the_program_serves_where_the_library_does_not(self):
        model = add_torus()
        by_library = points(generate(model))
        bpy.context.preferences.addons["cagewright"].preferences.program = str(PROGRAM)
        try:
            engine.use(program_engine.Engine())
            cage = generate(model)
            self.assertNear(points(cage), by_library, 1e-9)
            self.assertValid(cage)
            bind(cage)
            set_points(cage, points(cage) + [1, 2, 3])
            self.assertNear(shown(model), points(model) + [1, 2, 3], 1e-6)
            with self.assertRaisesRegex(engine.Failure, "need Cagewright's library"):
                engine.get().deformer(points(model), None, points(cage), geometry.faces_of(cage.data), "green",
                                      {"outside": "continue"})
        finally:
            engine.use(library_engine.Engine())

    def test_undo_takes_the_cage_away(self):
        model = add_torus()
        bpy.ops.ed.undo_push(message="before")
        generate(model)
        bpy.ops.ed.undo_push(message="generated")
        bpy.ops.ed.undo()
        self.assertEqual([obj.name for obj in bpy.data.objects], ["Torus"])
        bpy.ops.ed.redo()
        self.assertEqual(len(bpy.data.objects), 2)


if __name__ == "__main__":
    main()
