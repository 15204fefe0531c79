"""Fit: a cage for a model that was edited. Mirror: one side of a cage as the other."""

import contextlib
import json

import bpy
import numpy as np
from mathutils import Vector
from mathutils.kdtree import KDTree

from . import binding, check_cage, engine, follow, geometry
from .engine import Failure
from .preferences import threads

_ROUNDS = 40        # of pushing outward, at most
_CLEARANCE = 0.002  # parts of the diagonal that a vertex is pushed beyond what was outside
_NEAREST = 8        # vertices of the model that a vertex of the cage goes along with
_PAIRED = 1e-4      # parts of the diagonal between a vertex and the mirror image of its partner


class _in_object_mode:
    """While it lasts, the object is in object mode; back to what it was in afterwards."""

    def __init__(self, obj):
        self._was_editing = obj.mode == "EDIT"

    def __enter__(self):
        if self._was_editing:
            bpy.ops.object.mode_set(mode="OBJECT")

    def __exit__(self, *_):
        if self._was_editing:
            bpy.ops.object.mode_set(mode="EDIT")


def move_vertices(obj, moves):
    """Moves the vertices of a mesh, in all its shape keys."""
    keys = obj.data.shape_keys
    for points in [obj.data.vertices] + ([block.data for block in keys.key_blocks] if keys else []):
        flat = np.empty(3 * len(points), np.float32)
        points.foreach_get("co", flat)
        points.foreach_set("co", (flat.reshape(-1, 3) + moves).astype(np.float32).ravel())
    obj.data.update()
    obj.data.update_tag()


def _carried(cage_points, before, after):
    """How far each vertex of the cage goes along with the vertices of the model near it."""
    tree = KDTree(len(before))
    for number, place in enumerate(before):
        tree.insert(place, number)
    tree.balance()
    moves = np.zeros_like(cage_points)
    for number, place in enumerate(cage_points):
        near = tree.find_n(Vector(place), _NEAREST)
        shares = np.array([1.0 / (distance + near[0][2] + 1e-12) ** 2 for _, _, distance in near])
        indices = [index for _, index, _ in near]
        moves[number] = shares @ (after[indices] - before[indices]) / shares.sum()
    return moves


def _edits_of(model):
    """A bound model's own points in the world, as they were when it was bound and as they are now; None where their
    number has changed."""
    live = binding.live_of(model)
    world = geometry.matrix_of(model.matrix_world)
    modifier = binding.modifier_of(model)
    with geometry.modifiers_off(model, lambda other: other == modifier):
        now = geometry.points_of(model.data) if model.cagewright.pose == "REST" else geometry.own_points_shown(model)
    before = geometry.transformed(live.rest, np.linalg.inv(live.record.frame))
    return geometry.transformed(before, world), geometry.transformed(now, world)


def _pushed(cage, report, points):
    """How far each vertex of the cage has to go outward, in its own space, for what is outside to be inside."""
    mesh = cage.data
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    back = cage.matrix_world.inverted_safe()
    scale = abs(back.determinant()) ** (1 / 3)
    least = _CLEARANCE * diagonal * scale
    push = np.zeros(len(mesh.vertices))
    for violation in report["violations"]:
        if violation["kind"] == "face_contact":
            for vertex in mesh.polygons[violation["elements"][1]].vertices:
                push[vertex] = max(push[vertex], least)
        elif violation["kind"] in ("vertex_outside", "vertex_on_cage"):
            place = back @ Vector(points[violation["elements"][0]])
            found, nearest, _, face = cage.closest_point_on_mesh(place)
            if found:
                way = (place - nearest).length + least
                for vertex in mesh.polygons[face].vertices:
                    push[vertex] = max(push[vertex], way)
    normals = np.array([vertex.normal[:] for vertex in mesh.vertices])
    if cage.matrix_world.is_negative:
        normals = -normals
    return normals * push[:, None]


_MENDABLE = {"face_contact", "vertex_outside", "vertex_on_cage"}


def _push(cage):
    """Pushes the cage outward until it is valid. Failure: that does not help."""
    for _ in range(_ROUNDS):
        report, points = check_cage.report_on(cage)
        if report["valid"]:
            return
        if {kind for kind, count in report["counts"].items() if count} - _MENDABLE:
            break
        move_vertices(cage, _pushed(cage, report, points))
        bpy.context.view_layer.update()
    raise Failure(f"{check_cage.in_words(report)}; generate a new cage")


def _lay(cage):
    """Moves the vertices of the cage to where it is valid and tight. Failure: they cannot be laid so."""
    points, faces, home = check_cage.models_in_world(cage)
    world = geometry.matrix_of(cage.matrix_world)
    own = geometry.transformed(geometry.points_of(cage.data), world)
    made = engine.get().generate(points - home, faces, {}, threads(), start=(own - home, geometry.faces_of(cage.data)))
    move_vertices(cage, (made.vertices + home - own) @ np.linalg.inv(world)[:3, :3].T)
    bpy.context.view_layer.update()


def fit(cage):
    """Moves the vertices of a cage until it is valid for its models again; its faces stay. Failure: it cannot be."""
    start = np.empty(3 * len(cage.data.vertices), np.float32)
    cage.data.vertices.foreach_get("co", start)
    _go_along_with_edits(cage)
    try:
        if not check_cage.report_on(cage)[0]["valid"]:
            with contextlib.suppress(Failure):
                _lay(cage)
            _push(cage)  # what Blender's floats leave to do; all of it where the cage could not be laid so
    except Failure as failure:
        now = np.empty_like(start)
        cage.data.vertices.foreach_get("co", now)
        move_vertices(cage, (start - now).reshape(-1, 3))
        raise Failure(f"{cage.name} cannot be fitted: {failure}") from None


def _go_along_with_edits(cage):
    for model in binding.models_bound_to(cage):
        before, after = _edits_of(model)
        if len(before) == len(after) and not np.array_equal(before, after):
            world = geometry.matrix_of(cage.matrix_world)
            own = geometry.transformed(geometry.points_of(cage.data), world)
            moves = _carried(own, before, after)
            move_vertices(cage, moves @ np.linalg.inv(world)[:3, :3].T)
    bpy.context.view_layer.update()


class CAGEWRIGHT_OT_fit(bpy.types.Operator):
    """Move the vertices of the active cage so that it encloses its models again after they were edited, and bind them again. The faces of the cage stay as they are"""

    bl_idname = "cagewright.fit"
    bl_label = "Fit"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return obj is not None and obj.type == "MESH" and context.mode == "OBJECT" and bool(check_cage.models_for(obj))

    def execute(self, context):
        cage = context.active_object
        models = binding.models_bound_to(cage)
        remembered = [(model, model.cagewright.pose, model.cagewright.kind, binding.options_of(model.cagewright))
                      for model in models]
        try:
            fit(cage)
            for model, pose, kind, options in remembered:
                binding.unbind(model)
                context.view_layer.update()
                binding.attach(binding.Request(model, cage, pose, kind, options).compute(None))
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        follow.gather()
        self.report({"INFO"}, f"{cage.name}: valid")
        return {"FINISHED"}


def _pairing(cage, axis):
    """For each vertex its partner, and on which side it is (1, -1, or 0 in the plane); the plane as normal and offset.

    As it was when the cage was made; of other cages by their shape at rest: as it was bound, else as it is.
    """
    if cage.cagewright.mirror:
        known = json.loads(cage.cagewright.mirror)
        if len(known["partners"]) == len(cage.data.vertices):
            return np.array(known["partners"]), np.array(known["sides"]), np.array(known["normal"]), known["offset"]
    rest = _rest_of(cage)
    normal = np.zeros(3)
    normal[axis] = 1.0
    tolerance = _PAIRED * np.linalg.norm(np.ptp(rest, axis=0))
    tree = KDTree(len(rest))
    for number, place in enumerate(rest):
        tree.insert(place, number)
    tree.balance()
    partners = np.full(len(rest), -1)
    for number, place in enumerate(rest):
        _, index, distance = tree.find(Vector(place * np.where(normal, -1, 1)))
        if distance <= tolerance:
            partners[number] = index
    if (partners < 0).any():
        raise Failure(f"{cage.name} is not its own mirror image: {(partners < 0).sum()} of {len(rest)} vertices have no "
                      f"partner across its {'XYZ'[axis]} axis")
    return partners, np.sign(np.where(np.abs(rest[:, axis]) <= tolerance, 0, rest[:, axis])), normal, 0.0


def _rest_of(cage):
    if cage.data.shape_keys:
        flat = np.empty(3 * len(cage.data.vertices), np.float32)
        cage.data.shape_keys.reference_key.data.foreach_get("co", flat)
        return flat.reshape(-1, 3).astype(np.float64)
    for model in binding.models_bound_to(cage):
        record = binding.live_of(model).record
        depsgraph = bpy.context.evaluated_depsgraph_get()
        to_world = geometry.matrix_of(model.evaluated_get(depsgraph).matrix_world) @ np.linalg.inv(record.frame)
        return geometry.transformed(record.cage, np.linalg.inv(geometry.matrix_of(cage.matrix_world)) @ to_world)
    return geometry.points_of(cage.data)


class CAGEWRIGHT_OT_mirror(bpy.types.Operator):
    """Pose one side of the active cage as the mirror image of the other, vertex by vertex"""

    bl_idname = "cagewright.mirror"
    bl_label = "Mirror"
    bl_options = {"REGISTER", "UNDO"}

    side: bpy.props.EnumProperty(name="From", items=[("POSITIVE", "Positive Side", "The side of positive coordinates"),
                                                     ("NEGATIVE", "Negative Side", "The side of negative coordinates")])
    axis: bpy.props.EnumProperty(name="Axis", items=[(name, name, "") for name in "XYZ"],
                                 description="Across which axis of the cage, where it was not made with a mirror plane")

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return obj is not None and obj.type == "MESH" and obj.mode in {"OBJECT", "EDIT"} \
            and bool(check_cage.models_for(obj))

    def execute(self, context):
        cage = context.active_object
        with _in_object_mode(cage):
            try:
                partners, sides, normal, offset = _pairing(cage, "XYZ".index(self.axis))
            except Failure as failure:
                self.report({"ERROR"}, str(failure))
                return {"CANCELLED"}
            now = _active_points(cage)
            mirrored = now - 2 * np.outer(now @ normal - offset, normal)
            wanted = now.copy()
            goes = sides == (1 if self.side == "POSITIVE" else -1)
            wanted[partners[goes]] = mirrored[goes]
            middle = sides == 0
            wanted[middle] = (now[middle] + mirrored[middle]) / 2
            _set_active_points(cage, wanted)
        return {"FINISHED"}


def _active_points(obj):
    """The vertices of the active shape key, or of the mesh."""
    flat = np.empty(3 * len(obj.data.vertices), np.float32)
    (obj.active_shape_key.data if obj.active_shape_key else obj.data.vertices).foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def _set_active_points(obj, points):
    flat = points.astype(np.float32).ravel()
    key = obj.active_shape_key
    if key is not None:
        key.data.foreach_set("co", flat)
    if key is None or key == obj.data.shape_keys.reference_key:
        obj.data.vertices.foreach_set("co", flat)
    obj.data.update()
    obj.data.update_tag()


_CLASSES = [CAGEWRIGHT_OT_fit, CAGEWRIGHT_OT_mirror]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
