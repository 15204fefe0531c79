"""The add-on against the Blenders that are not here, 3.5 to 5.1: what they have removed is not used, or only where it is
there; what came in its place is, with stand-ins for Blender's data. Needs no Blender.

other_versions.py FOLDER_OF_ADDON [unittest arguments]
"""

import ast
import pathlib
import re
import sys
import tomllib
import types
import unittest

ADDON = pathlib.Path(sys.argv[1]).resolve()

# From the change logs of Blender's Python API, those that an add-on like this may be tempted to use. Attributes, then
# texts (operators' and enumerations' names).
REMOVED_ATTRIBUTES = {
    "calc_normals": "4.0: normals are there by themselves", "version_char": "4.0", "face_maps": "4.0: attributes",
    "bevel_weight": "4.0: an attribute of the mesh", "crease": "4.0: an attribute of the mesh",
    "bone_groups": "4.0: bone collections", "use_inherit_scale": "4.0: inherit_scale", "asset_file_handle": "4.0: asset",
    "sculpt_vertex_colors": "4.0: color_attributes", "vertex_colors": "4.0: color_attributes",
    "polygon_layers_float": "4.0: attributes", "polygon_layers_int": "4.0: attributes", "vertex_layers_float": "4.0: attributes",
    "vertex_layers_int": "4.0: attributes", "use_auto_smooth": "4.1: a modifier", "auto_smooth_angle": "4.1: a modifier",
    "calc_normals_split": "4.1: corner_normals", "create_normals_split": "4.1", "free_normals_split": "4.1",
    "override_template_create": "4.1", "shadow_method": "4.2", "fcurve_ensure_for_datablock": "other arguments in 5.0",
    "id_root": "5.0: slots", "bindcode": "5.0: gpu.texture.from_image()", "node_tree": "5.0, of scenes: compositing_node_group",
    "use_nodes": "5.0", "blend_method": "5.0: surface_render_method", "template_asset_view": "5.0", "grease_pencils_v3": "5.0",
}
REMOVED_MODULES = {"bgl": "5.0: gpu", "bl_ui_utils": "5.0", "rna_info": "5.0", "bl_console_utils": "5.0", "imp": "Python 3.12",
                   "distutils": "Python 3.12", "pkg_resources": "not in every Blender"}
REMOVED_TEXTS = {"BLENDER_EEVEE_NEXT": "BLENDER_EEVEE in 5.0", "BLENDER_EEVEE": "BLENDER_EEVEE_NEXT in 4.2 to 4.5",
                 "3D_UNIFORM_COLOR": "4.0: UNIFORM_COLOR", "2D_UNIFORM_COLOR": "4.0: UNIFORM_COLOR"}
REMOVED_OPERATORS = {"import_scene.obj": "4.0: wm.obj_import", "export_scene.obj": "4.0: wm.obj_export",
                     "import_mesh.ply": "4.0: wm.ply_import", "import_mesh.stl": "4.2: wm.stl_import",
                     "export_mesh.ply": "4.0: wm.ply_export", "export_mesh.stl": "4.2: wm.stl_export",
                     "object.shade_smooth_auto": "4.1: object.shade_smooth_by_angle"}
# numpy 1.24 and 2: Blender brings either.
REMOVED_NUMPY = {"float", "int", "bool", "object", "float_", "infty", "Inf", "NaN", "product", "cumproduct", "alltrue", "sometrue", "in1d",
                 "row_stack", "trapz", "string_", "unicode_", "asscalar", "msort", "find_common_type", "cast", "bool8"}


def sources():
    return [(path, ast.parse(path.read_text(encoding="utf-8"))) for path in sorted(ADDON.rglob("*.py"))]


def dotted(node):
    """a.b.c of an expression, as far as it is one."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if isinstance(node, ast.Name):
        parts.append(node.id)
    return ".".join(reversed(parts))


class WhatIsGone(unittest.TestCase):
    def found(self, is_it):
        return [f"{path.name}:{node.lineno}: {what}" for path, tree in sources() for node in ast.walk(tree)
                if (what := is_it(node))]

    def test_attributes_and_operators_and_names(self):
        def gone(node):
            if isinstance(node, ast.Attribute):
                name = dotted(node)
                if name.startswith("bpy.ops.") and name[8:] in REMOVED_OPERATORS:
                    return f"{name}: {REMOVED_OPERATORS[name[8:]]}"
                if name.startswith(("np.", "numpy.")):
                    return name if node.attr in REMOVED_NUMPY and name.count(".") == 1 else None
                return f"{node.attr}: {REMOVED_ATTRIBUTES[node.attr]}" if node.attr in REMOVED_ATTRIBUTES else None
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                return REMOVED_TEXTS.get(node.value)
            return None
        self.assertEqual(self.found(gone), [])

    def test_modules(self):
        def gone(node):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
                [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
            return next((f"{name}: {REMOVED_MODULES[name]}" for name in names if name in REMOVED_MODULES), None)
        self.assertEqual(self.found(gone), [])

    def test_operators_are_given_a_context_the_new_way(self):
        """Since 4.0 by temp_override() only, no longer as their first argument."""
        def gone(node):
            if not (isinstance(node, ast.Call) and dotted(node.func).startswith("bpy.ops.") and node.args):
                return None
            first = node.args[0]  # "EXEC_DEFAULT" and the like may still come first
            return None if isinstance(first, ast.Constant) and isinstance(first.value, str) else dotted(node.func)
        self.assertEqual(self.found(gone), [])

    def test_our_properties_are_never_read_as_entries(self):
        """Since 5.0 obj["cagewright"] is not obj.cagewright."""
        texts = [f"{path.name}:{node.lineno}" for path, tree in sources() for node in ast.walk(tree)
                 if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and node.slice.value == "cagewright"]
        self.assertEqual(texts, [])

    def test_where_both_ways_are_there_is_a_question_first(self):
        binding = (ADDON / "binding.py").read_text()
        poses = (ADDON / "poses.py").read_text()
        self.assertRegex(binding, r'hasattr\(tree, "interface"\)')      # before tree.inputs, gone in 4.0
        self.assertRegex(binding, r'hasattr\(model\.modifiers, "move"\)')
        self.assertRegex(poses, r'getattr\(action, "fcurves", None\)')  # gone in 5.0
        self.assertNotRegex(poses, r"action\.fcurves")


def stand_in_for_bpy():
    """Enough of bpy for the add-on's modules to be read."""
    class Anything(types.ModuleType):
        def __getattr__(self, name):
            if name.startswith("__"):
                raise AttributeError(name)
            made = Anything(f"{self.__name__}.{name}")
            setattr(self, name, made)
            return made

        def __call__(self, *_, **__):
            return None

    bpy = Anything("bpy")
    for name in ("Operator", "Panel", "PropertyGroup", "AddonPreferences", "Menu"):
        setattr(bpy.types, name, type(name, (), {}))
    handlers = Anything("bpy.app.handlers")
    handlers.persistent = lambda function: function
    bpy.app.handlers = handlers
    io_utils = Anything("bpy_extras.io_utils")
    io_utils.ExportHelper = type("ExportHelper", (), {})
    return {"bpy": bpy, "bpy.app": bpy.app, "bpy.app.handlers": handlers, "bpy.types": bpy.types, "bpy.props": bpy.props,
            "bpy_extras": Anything("bpy_extras"), "bpy_extras.io_utils": io_utils, "mathutils": Anything("mathutils"),
            "mathutils.kdtree": Anything("mathutils.kdtree")}


class Data(types.SimpleNamespace):
    """Some of Blender's data: only what it is given."""


class WhatCameInstead(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            import numpy  # noqa: F401
        except ImportError:
            raise unittest.SkipTest("numpy is not installed (Debian: python3-numpy)") from None
        sys.modules.update(stand_in_for_bpy())
        package = types.ModuleType("addon")
        package.__path__ = [str(ADDON)]
        sys.modules["addon"] = package
        import importlib
        cls.binding = importlib.import_module("addon.binding")
        cls.poses = importlib.import_module("addon.poses")

    def curves(self):
        return [Data(data_path='key_blocks["Baked 0001"].value', keyframe_points=[Data(interpolation="BEZIER")]),
                Data(data_path='key_blocks["Smile"].value', keyframe_points=[Data(interpolation="BEZIER")])]

    def model_with(self, action):
        return Data(data=Data(shape_keys=Data(animation_data=Data(action=action))))

    def test_curves_of_actions_until_4_5_and_since_5_0(self):
        for version in ("4.3", "5.0"):
            with self.subTest(version=version):
                curves = self.curves()
                action = Data(fcurves=curves) if version < "5" else \
                    Data(layers=[Data(strips=[Data(channelbags=[Data(fcurves=curves)])])])
                self.poses._make_linear(self.model_with(action))
                self.assertEqual([curve.keyframe_points[0].interpolation for curve in curves], ["LINEAR", "BEZIER"])

    def test_sockets_of_node_groups_until_3_6_and_since_4_0(self):
        class Sockets(list):
            def new(self, kind, name):
                self.append((name, kind))

            def new_socket(self, name, in_out, socket_type):
                self.append((name, socket_type, in_out))

        class Node(Data):
            pass

        class Named(dict):
            def __missing__(self, name):
                self[name] = Data(default_value=None)
                return self[name]

        class Tree(Data):
            def __setitem__(self, name, value):
                setattr(self, "entry_" + name, value)

        def node_of(kind):
            sockets = [Data(name="Attribute", enabled=True), Data(name="Exists", enabled=True)]
            return Node(inputs=Both(), outputs=sockets, data_type="", kind=kind)

        class Both(Named):  # sockets by name or number
            pass

        for version in ("3.6", "4.0"):
            with self.subTest(version=version):
                links = []
                tree = Tree(nodes=Data(new=node_of), links=Data(new=lambda a, b: links.append((a, b))))
                if version < "4":
                    tree.inputs, tree.outputs = Sockets(), Sockets()
                else:
                    tree.interface, tree.is_modifier = Sockets(), False
                sys.modules["bpy"].data = Data(node_groups=Data(new=lambda name, kind, tree=tree: tree))
                self.assertIs(self.binding._nodes("key", "the cage"), tree)
                self.assertEqual(len(links), 3)
                if version < "4":
                    self.assertEqual((tree.inputs, tree.outputs), ([("Geometry", "NodeSocketGeometry")],) * 2)
                else:
                    self.assertEqual([socket[2] for socket in tree.interface], ["INPUT", "OUTPUT"])
                    self.assertTrue(tree.is_modifier)

    def test_moving_modifiers_since_4_0(self):
        class Modifiers(list):
            def move(self, at, to):
                self.insert(to, self.pop(at))
        modifiers = Modifiers(["Subdivision", "Cagewright"])
        self.binding.move_to(Data(modifiers=modifiers), "Cagewright", 0)
        self.assertEqual(modifiers, ["Cagewright", "Subdivision"])


class Manifest(unittest.TestCase):
    """What Blender 4.2 and later demands of extensions."""

    def test_says_what_bl_info_says_and_is_accepted(self):
        manifest = tomllib.loads((ADDON / "blender_manifest.toml").read_text(encoding="utf-8"))
        assigned, = [node.value for node in ast.parse((ADDON / "__init__.py").read_text()).body
                     if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info"]
        info = ast.literal_eval(assigned)
        self.assertEqual(manifest["version"], ".".join(map(str, info["version"])))
        self.assertEqual(manifest["name"], info["name"])
        self.assertEqual(manifest["schema_version"], "1.0.0")
        self.assertEqual(manifest["type"], "add-on")
        self.assertRegex(manifest["id"], r"^[a-z][a-z0-9_]*$")
        self.assertEqual(manifest["id"], ADDON.name)
        self.assertGreaterEqual(tuple(map(int, manifest["blender_version_min"].split("."))), (4, 2, 0))
        self.assertTrue(all(licence.startswith("SPDX:") for licence in manifest["license"]))
        for text in (manifest["tagline"], *manifest["permissions"].values()):
            self.assertLessEqual(len(text), 64)
            self.assertRegex(text, r"[\w)]$")
        self.assertLessEqual(set(manifest["permissions"]), {"files", "network", "clipboard", "camera", "microphone"})
        self.assertLessEqual(set(manifest["tags"]), {"3D View", "Animation", "Bake", "Game Engine", "Geometry Nodes", "Import-Export",
                                                     "Mesh", "Modeling", "Object", "Pipeline", "Rigging", "User Interface"})

    def test_the_add_on_knows_its_own_name_wherever_it_is_installed(self):
        """As an extension it is bl_ext.user_default.cagewright."""
        for path, _ in sources():
            text = path.read_text(encoding="utf-8")
            self.assertNotRegex(text, r"(?m)^\s*(from|import) cagewright\b", path.name)
            self.assertNotRegex(text, r"addons(\.get\(|\[)[\"']", path.name)
        self.assertRegex((ADDON / "preferences.py").read_text(), re.escape("bl_idname = __package__"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
