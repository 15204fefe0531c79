"""Bind by Blender's own Mesh Deform modifier, set up right.

That modifier says it is bound even if nothing follows: of a posed figure, of an open cage, or of one that is too tight
for its grid. Here the armature goes to its rest position while it binds, and back, unless the cage is for the pose that is
shown: then it deforms after the armature. A binding is one only if every vertex follows when the cage is moved.
"""

import bpy
import numpy as np

from . import bind, binding, engine, follow, geometry
from .engine import Failure

MODIFIER = "Cagewright Mesh Deform"
_PRECISIONS = (4, 5, 6)  # each takes some times as long as the one before
_SLACK = 1e-3            # how far a vertex may be from following, as a part of the way


class at_rest:
    """While it lasts, the armatures of some objects are in their rest position: `with at_rest(...) as is_posed`, which
    says whether any was in another."""

    def __init__(self, *objects):
        rigs = {modifier.object.data for obj in objects for modifier in obj.modifiers
                if modifier.type == "ARMATURE" and modifier.object is not None}
        self._rigs = [rig for rig in rigs if rig.pose_position != "REST"]

    def __enter__(self):
        for rig in self._rigs:
            rig.pose_position = "REST"
        bpy.context.view_layer.update()
        return bool(self._rigs)

    def __exit__(self, *_):
        for rig in self._rigs:
            rig.pose_position = "POSE"
        bpy.context.view_layer.update()


def _shown(model):
    with geometry.Evaluated(model, bpy.context.evaluated_depsgraph_get()) as mesh:
        return geometry.points_of(mesh)


def staying(model, cage):
    """How many vertices of the model do not follow when the cage is shifted; and how many there are."""
    making = {modifier.name for modifier in model.modifiers[geometry.first_making(model):]}
    with geometry.modifiers_off(model, lambda modifier: modifier.name in making):
        before = _shown(model)
        flat = np.empty(3 * len(cage.data.vertices), np.float32)
        cage.data.vertices.foreach_get("co", flat)
        size = np.linalg.norm(np.ptp(flat.reshape(-1, 3), axis=0))
        moved = flat.reshape(-1, 3) + np.float32(0.1 * size) * np.array([1, 0, 0], np.float32)
        try:
            cage.data.vertices.foreach_set("co", moved.ravel())
            cage.data.update()
            bpy.context.view_layer.update()
            after = _shown(model)
        finally:
            cage.data.vertices.foreach_set("co", flat)
            cage.data.update()
            bpy.context.view_layer.update()
    way = np.linalg.inv(geometry.matrix_of(model.matrix_world))[:3, :3] @ \
        (geometry.matrix_of(cage.matrix_world)[:3, :3] @ np.array([0.1 * size, 0, 0]))
    off = np.linalg.norm(after - before - way, axis=1)
    return int((off > _SLACK * np.linalg.norm(way)).sum()), len(before)


def _bind(model, modifier):
    """Calls Blender's operator, which binds, or unbinds what is bound."""
    with bpy.context.temp_override(object=model, active_object=model, selected_objects=[model]):
        bpy.ops.object.meshdeform_bind(modifier=modifier.name)


def _check(model, cage):
    """Refuses what Mesh Deform would bind to nothing, silently."""
    world = geometry.matrix_of(cage.matrix_world)
    report = engine.get().check(*geometry.model_of(model, as_shown=True),
                                geometry.transformed(geometry.points_of(cage.data), world), geometry.faces_of(cage.data),
                                max_listed=0)
    counts = report["counts"]
    wrong = [("open_edge", "it has {} open edges: close them"),
             ("inverted_piece", "it faces inward: flip its normals"),
             ("flipped_edge", "its faces do not all face outward: recalculate its normals"),
             ("vertex_outside", "{} vertices of the model are outside: move the cage outward there")]
    for kind, words in wrong:
        if counts.get(kind):
            raise Failure(f"{cage.name} is no cage for Mesh Deform: " + words.format(counts[kind]))


def bind_one(model, cage):
    """Binds a model by Mesh Deform. Failure: not every vertex would follow."""
    if cage.data.shape_keys is not None:
        raise Failure(f"{cage.name} has shape keys: bind it live, or without them")
    old = model.modifiers.get(MODIFIER)
    if old is not None:
        model.modifiers.remove(old)
    try:
        with at_rest(model, cage) as is_posed:
            _check(model, cage)
            return _bind_at(model, cage, 0)
    except Failure as at_rest_failure:
        if not is_posed:
            raise
        try:
            _check(model, cage)
        except Failure:
            raise Failure(f"{at_rest_failure} (in the rest position of the armature)") from None
    return _bind_at(model, cage, geometry.first_making(model))  # a cage for the pose that is shown


def _bind_at(model, cage, place):
    """Binds with the modifier at a place of the stack, and gives the precision it took. Failure: some vertices stay."""
    modifier = model.modifiers.new(MODIFIER, "MESH_DEFORM")
    modifier.object = cage
    binding.move_to(model, modifier, place)
    left = count = 0
    for precision in _PRECISIONS:
        modifier.precision = precision
        _bind(model, modifier)
        left, count = staying(model, cage)
        if left == 0:
            return precision
        if modifier.is_bound:
            _bind(model, modifier)
    model.modifiers.remove(modifier)
    raise Failure(f"Mesh Deform leaves {left} of {count} vertices of {model.name} behind, even at precision "
                  f"{_PRECISIONS[-1]}: make a cage with more clearance (2 %), or bind it live")


class CAGEWRIGHT_OT_mesh_deform(bpy.types.Operator):
    """Bind the selected models to their cages by Blender's own Mesh Deform modifier: in the rest position of their armature, as finely as it takes until every vertex follows. Without this add-on it works on"""

    bl_idname = "cagewright.mesh_deform"
    bl_label = "Bind by Mesh Deform"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and bool(bind.pairs(context))

    def execute(self, context):
        for model, cage in bind.pairs(context):
            binding.unbind(model)
            follow.gather()
            try:
                precision = bind_one(model, cage)
            except Failure as failure:
                self.report({"ERROR"}, str(failure))
                return {"CANCELLED"}
            self.report({"INFO"}, f"{model.name}: every vertex follows, at precision {precision}")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(CAGEWRIGHT_OT_mesh_deform)


def unregister():
    bpy.utils.unregister_class(CAGEWRIGHT_OT_mesh_deform)
