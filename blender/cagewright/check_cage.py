"""Check Cage: is it valid for its models? What is wrong is selected."""

import bpy
import numpy as np

from . import binding, engine, generate, geometry
from .engine import Failure
from .preferences import threads

# What the numbers of each kind of violation are: of the cage, or of the model.
_ELEMENTS = {
    "bad_corner": ("cage face",), "not_finite": ("cage vertex",), "unused_vertex": ("cage vertex",),
    "coincident_vertices": ("cage vertex", "cage vertex"), "degenerate_face": ("cage face",), "folded_face": ("cage face",),
    "duplicate_face": ("cage face",), "open_edge": ("cage vertex", "cage vertex"), "t_junction": ("cage vertex", "cage face"),
    "nonmanifold_edge": ("cage vertex", "cage vertex"), "flipped_edge": ("cage vertex", "cage vertex"),
    "nonmanifold_vertex": ("cage vertex",), "self_intersection": ("cage face", "cage face"), "inverted_piece": ("cage face",),
    "several_pieces": ("cage face",), "nested_piece": ("cage face",), "vertex_outside": ("model vertex",),
    "vertex_on_cage": ("model vertex", "cage face"), "face_contact": ("model face", "cage face"),
}


def models_for(cage):
    return binding.models_bound_to(cage) or generate.models_of(cage)


def rest_of(model):
    """A model as its cage has to enclose it: what is shown, but for what the cage itself does to it."""
    modifier = binding.modifier_of(model) if binding.is_bound(model) else None
    with geometry.modifiers_off(model, lambda other: other == modifier):
        return geometry.model_of(model, as_shown=not binding.is_bound(model) or model.cagewright.pose != "REST")


def models_in_world(cage):
    """The models of a cage, as it has to enclose them: points, faces, and where floats are reckoned from."""
    models = models_for(cage)
    if not models:
        raise Failure(f"{cage.name} is the cage of no model: bind a model to it first")
    points, faces = geometry.together([rest_of(model) for model in models])
    return points, faces, np.array(cage.matrix_world.translation, np.float64)


def report_on(cage, max_listed=100000):
    """What Cagewright says of a cage and its models, in the world; and the models' points."""
    points, faces, home = models_in_world(cage)
    cage_points = geometry.transformed(geometry.points_of(cage.data), geometry.matrix_of(cage.matrix_world))
    return engine.get().check(points - home, faces, cage_points - home, geometry.faces_of(cage.data), max_listed,
                              threads=threads()), points


def _offending(report, cage, points):
    """The vertices and faces of the cage that something is wrong with. For a model vertex outside it is the face that is
    nearest to it."""
    vertices, faces, outside = set(), set(), []
    for violation in report["violations"]:
        for number, what in zip(violation["elements"], _ELEMENTS.get(violation["kind"], ())):
            if what == "cage vertex":
                vertices.add(number)
            elif what == "cage face":
                faces.add(number)
            elif what == "model vertex":
                outside.append(points[number])
    if outside:
        from mathutils import Vector
        back = cage.matrix_world.inverted_safe()
        for place in outside:
            found, _, _, face = cage.closest_point_on_mesh(back @ Vector(place))
            if found:
                faces.add(face)
    return vertices, faces


def _select(cage, vertices, faces):
    """Selects in the mesh, as edit mode will show it."""
    mesh = cage.data
    chosen_faces = np.zeros(len(mesh.polygons), bool)
    chosen_faces[list(faces)] = True
    chosen = np.zeros(len(mesh.vertices), bool)
    chosen[list(vertices)] = True
    for face in faces:
        chosen[list(mesh.polygons[face].vertices)] = True
    edges = np.zeros(len(mesh.edges), bool)
    mesh.vertices.foreach_set("select", chosen)
    mesh.edges.foreach_set("select", edges)
    mesh.polygons.foreach_set("select", chosen_faces)
    mesh.update()


class CAGEWRIGHT_OT_check(bpy.types.Operator):
    """Judge the active cage, exactly: closed, outward, without self-intersections, all of its models inside. What is wrong is selected in edit mode"""

    bl_idname = "cagewright.check"
    bl_label = "Check Cage"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        if obj is None or obj.type != "MESH" or not models_for(obj):
            cls.poll_message_set("Select a cage: a mesh that was made as one, or that a model is bound to")
            return False
        return True

    def execute(self, context):
        cage = context.active_object
        was_editing = cage.mode == "EDIT"
        if was_editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            report, points = report_on(cage)
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        vertices, faces = _offending(report, cage, points)
        _select(cage, vertices, faces)
        if vertices or faces or was_editing:
            if not bpy.app.background and vertices and not faces:
                context.tool_settings.mesh_select_mode = (True, False, False)
            elif not bpy.app.background and faces and not vertices:
                context.tool_settings.mesh_select_mode = (False, False, True)
            bpy.ops.object.mode_set(mode="EDIT")
        cage.cagewright.verdict = in_words(report)
        self.report({"INFO"} if report["valid"] else {"WARNING"}, f"{cage.name}: {cage.cagewright.verdict}")
        return {"FINISHED"}


def in_words(report):
    if report["valid"]:
        return "valid"
    found = [f"{count} {kind.replace('_', ' ')}" for kind, count in report["counts"].items() if count]
    return "not valid: " + ", ".join(found)


def register():
    bpy.utils.register_class(CAGEWRIGHT_OT_check)


def unregister():
    bpy.utils.unregister_class(CAGEWRIGHT_OT_check)
