"""To Shape Key: the pose of a bound model as a shape key. Bake: its movement as keyed shapes, or a point cache."""

import struct

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper

from . import binding, follow, geometry
from .engine import Failure


def _bound_of(context):
    obj = context.active_object
    if obj is None or obj.type != "MESH" or context.mode != "OBJECT":
        return []
    return [obj] if binding.is_bound(obj) else binding.models_bound_to(obj)


class _Shape:
    """How far the cage moves each vertex, in the space of the model's shape keys.

    A cage may move the model after its armature; shape keys come before. What the modifiers between them do to a small
    step is measured once a frame, with the modifier of the binding at the bottom of the stack: exact for armatures that
    do not preserve volume.
    """

    def __init__(self, model):
        self._model = model
        self._modifier = binding.modifier_of(model)
        place = list(model.modifiers).index(self._modifier)
        self._is_first = not any(other.show_viewport for other in list(model.modifiers)[:place])

    def offsets(self):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        moves = binding.offsets_now(self._model, depsgraph).astype(np.float64)
        return moves if self._is_first else self._before_modifiers(moves)

    def _shown_with(self, attribute, step):
        attribute.data.foreach_set("vector", np.tile(step, len(attribute.data)).astype(np.float32))
        self._model.data.update_tag()
        bpy.context.view_layer.update()
        return geometry.own_points_shown(self._model)

    def _before_modifiers(self, moves):
        model, modifiers = self._model, self._model.modifiers
        name, place = self._modifier.name, list(modifiers).index(self._modifier)
        attribute = model.data.attributes[binding.attribute_of(model.cagewright)]
        with follow.paused():
            binding.move_to(model, modifiers[name], 0)
            rest = self._shown_with(attribute, np.zeros(3))
            columns = [self._shown_with(attribute, step) - rest for step in np.eye(3)]
            binding.move_to(model, modifiers[name], place)
        self._modifier = modifiers[name]
        binding.show_again(model)
        binding.follow(model, bpy.context.evaluated_depsgraph_get())
        linear = np.stack(columns, axis=2)
        if (np.abs(np.linalg.det(linear)) < 1e-9).any():
            raise Failure(f"{model.name}: its modifiers flatten some vertices, so no shape key moves them there")
        return np.linalg.solve(linear, moves[:, :, None])[:, :, 0]


def _add_key(model, name, offsets):
    if model.data.shape_keys is None:
        model.shape_key_add(name="Basis", from_mix=False)
    key = model.shape_key_add(name=name, from_mix=False)
    flat = np.empty(3 * len(key.data), np.float32)
    model.data.shape_keys.reference_key.data.foreach_get("co", flat)
    key.data.foreach_set("co", (flat.reshape(-1, 3) + offsets).astype(np.float32).ravel())
    return key


class CAGEWRIGHT_OT_to_shape_key(bpy.types.Operator):
    """Keep how the cage has moved the model as a shape key of the model. Its value is 0 while the model is bound, for the cage moves it already"""

    bl_idname = "cagewright.to_shape_key"
    bl_label = "To Shape Key"
    bl_options = {"REGISTER", "UNDO"}

    name: bpy.props.StringProperty(name="Name", default="Pose")
    then_unbind: bpy.props.BoolProperty(name="Unbind", default=False,
                                        description="Unbind the model; the shape key shows the pose instead")

    @classmethod
    def poll(cls, context):
        return bool(_bound_of(context))

    def execute(self, context):
        try:
            for model in _bound_of(context):
                key = _add_key(model, self.name, _Shape(model).offsets())
                key.value = 1.0 if self.then_unbind else 0.0
                if self.then_unbind:
                    binding.unbind(model)
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        follow.gather()
        return {"FINISHED"}


def _key_value(key, frame, value):
    key.value = value
    key.keyframe_insert("value", frame=frame)


def _make_linear(model):
    action = model.data.shape_keys.animation_data.action
    curves = getattr(action, "fcurves", None)
    if curves is None:  # Blender 5: curves are in the bags of the layers' strips
        curves = [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags
                  for curve in bag.fcurves]
    for curve in curves:
        if "Baked" in curve.data_path:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"


class _Frames:
    """The frames of a bake; the scene goes back to the frame it was at."""

    def __init__(self, scene, start, end, step):
        self.numbers = list(range(start, end + 1, step))
        self._scene, self._at = scene, scene.frame_current

    def __enter__(self):
        return self

    def __iter__(self):
        for number in self.numbers:
            self._scene.frame_set(number)
            yield number

    def __exit__(self, *_):
        self._scene.frame_set(self._at)


class _Range:
    """The frames of a bake as properties of an operator."""

    start: bpy.props.IntProperty(name="Start", default=1)
    end: bpy.props.IntProperty(name="End", default=250)
    step: bpy.props.IntProperty(name="Step", default=1, min=1)

    def from_scene(self, scene):
        if not self.properties.is_property_set("start"):
            self.start = scene.frame_start
        if not self.properties.is_property_set("end"):
            self.end = scene.frame_end


class CAGEWRIGHT_OT_bake_keys(_Range, bpy.types.Operator):
    """Keep the movement of a bound model as shape keys, one for each frame, that are keyed one after the other. The model is unbound: it moves without the cage, and goes to game engines as morph targets"""

    bl_idname = "cagewright.bake_keys"
    bl_label = "Bake to Shape Keys"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return bool(_bound_of(context))

    def invoke(self, context, event):
        self.from_scene(context.scene)
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        self.from_scene(context.scene)
        models = _bound_of(context)
        shapes = {model.name: [] for model in models}
        try:
            with _Frames(context.scene, self.start, self.end, self.step) as frames:
                for _ in frames:
                    for model in models:
                        shapes[model.name].append(_Shape(model).offsets())
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        for model in models:
            binding.unbind(model)
            for number, offsets in zip(frames.numbers, shapes[model.name]):
                key = _add_key(model, f"Baked {number:04d}", offsets)
                if number != frames.numbers[0]:
                    _key_value(key, number - self.step, 0.0)
                if number != frames.numbers[-1]:
                    _key_value(key, number + self.step, 0.0)
                _key_value(key, number, 1.0)
            _make_linear(model)
        follow.gather()
        context.scene.frame_set(context.scene.frame_current)
        return {"FINISHED"}


class CAGEWRIGHT_OT_bake_cache(_Range, ExportHelper, bpy.types.Operator):
    """Write the movement of a bound model as a point cache, .pc2 or .mdd: the positions of its own vertices at each frame, as floats, for the Mesh Cache modifier and other programs"""

    bl_idname = "cagewright.bake_cache"
    bl_label = "Bake to Point Cache"
    bl_options = {"REGISTER"}

    filename_ext = ".pc2"
    check_extension = None
    filter_glob: bpy.props.StringProperty(default="*.pc2;*.mdd", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return len(_bound_of(context)) == 1

    def invoke(self, context, event):
        self.from_scene(context.scene)
        return super().invoke(context, event)

    def execute(self, context):
        self.from_scene(context.scene)
        scene, model = context.scene, _bound_of(context)[0]
        path = self.filepath
        if not path.lower().endswith((".pc2", ".mdd")):
            self.report({"ERROR"}, f"{path}: point caches are written as .pc2 or .mdd")
            return {"CANCELLED"}
        try:
            with _Frames(scene, self.start, self.end, self.step) as frames:
                positions = [geometry.own_points_shown(model).astype(np.float32) for _ in frames]
            if not positions:
                raise Failure(f"there is no frame from {self.start} to {self.end}")
            write_cache(path, positions, frames.numbers, scene.render.fps / scene.render.fps_base, self.step)
        except (Failure, OSError) as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(positions)} frames of {len(positions[0])} vertices: {path}")
        return {"FINISHED"}


def write_cache(path, positions, frames, rate, step):
    """PC2 is little endian, MDD big endian with the time of each frame."""
    count = len(positions[0])
    with open(path, "wb") as file:
        if path.lower().endswith(".pc2"):
            file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, count, frames[0], step, len(frames)))
            order = "<f4"
        else:
            file.write(struct.pack(f">ii{len(frames)}f", len(frames), count, *[frame / rate for frame in frames]))
            order = ">f4"
        for points in positions:
            file.write(points.astype(order).tobytes())


_CLASSES = [CAGEWRIGHT_OT_to_shape_key, CAGEWRIGHT_OT_bake_keys, CAGEWRIGHT_OT_bake_cache]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
