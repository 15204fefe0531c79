"""Copy Weights to Vertex Groups; and cages that follow the rig of their models."""

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from . import binding, engine, geometry
from .preferences import threads

_NEAREST = 8     # vertices of the model whose weights a vertex of the cage takes the mean of
_LEAST = 1e-6    # smaller weights are left out of groups


def _armature_modifiers(models):
    found = []
    for model in models:
        for modifier in model.modifiers:
            if modifier.type == "ARMATURE" and modifier.object is not None \
                    and modifier.object not in [other.object for other in found]:
                found.append(modifier)
    return found


def _groups_of(model, names):
    """Per vertex a list of (name, weight) of the groups with these names."""
    by_index = {group.index: group.name for group in model.vertex_groups if group.name in names}
    return [[(by_index[element.group], element.weight) for element in vertex.groups if element.group in by_index]
            for vertex in model.data.vertices]


def skin_cage(cage, models, as_shown):
    """The cage follows the armatures of the models: each of its vertices the bones of the model near it, nearer ones
    more. Models without an armature change nothing.

    as_shown: the cage was made round the models as they are posed.
    """
    modifiers = _armature_modifiers(models)
    if not modifiers:
        return
    names = {bone.name for modifier in modifiers for bone in modifier.object.data.bones}
    places, weights = [], []
    for model in models:
        own = geometry.own_points_shown(model) if as_shown else geometry.points_of(model.data)
        places.append(geometry.transformed(own, geometry.matrix_of(model.matrix_world)))
        weights += _groups_of(model, names)
    places = np.concatenate(places)
    tree = KDTree(len(places))
    for number, place in enumerate(places):
        if weights[number]:
            tree.insert(place, number)
    tree.balance()
    for vertex in cage.data.vertices:
        near = tree.find_n(cage.matrix_world @ vertex.co, _NEAREST)
        shares = {}
        for _, number, distance in near:
            for name, weight in weights[number]:
                # Nearer ones count more; the least distance keeps one from counting alone.
                shares[name] = shares.get(name, 0.0) + weight / (distance + near[0][2] + 1e-12) ** 2
        total = sum(shares.values())
        for name, share in shares.items():
            group = cage.vertex_groups.get(name) or cage.vertex_groups.new(name=name)
            group.add([vertex.index], share / total, "REPLACE")
    if as_shown:
        _unpose(cage, modifiers)
    for modifier in modifiers:
        own = cage.modifiers.new(modifier.name, "ARMATURE")
        own.object = modifier.object


def _unpose(cage, modifiers):
    """A cage that was made round the pose as shown: its vertices go to where the rig brings them back from."""
    for modifier in modifiers:
        rig = modifier.object
        if rig.data.pose_position == "REST":
            continue
        bones = {bone.name: geometry.matrix_of(bone.matrix_channel) for bone in rig.pose.bones}
        into = np.linalg.inv(geometry.matrix_of(rig.matrix_world)) @ geometry.matrix_of(cage.matrix_world)
        for vertex in cage.data.vertices:
            posing = np.zeros((4, 4))
            for element in vertex.groups:
                name = cage.vertex_groups[element.group].name
                posing += element.weight * bones.get(name, np.zeros((4, 4)))
            if abs(np.linalg.det(posing)) > 1e-12:
                back = np.linalg.inv(into) @ np.linalg.inv(posing) @ into
                vertex.co = (back @ np.array([*vertex.co, 1.0]))[:3]
    cage.data.update()


class CAGEWRIGHT_OT_weights_to_groups(bpy.types.Operator):
    """Copy how far each vertex of a bound model follows each vertex of its cage to vertex groups, one for each vertex of the cage. Blender's groups hold weights from 0 to 1: what is negative becomes 0"""

    bl_idname = "cagewright.weights_to_groups"
    bl_label = "Copy Weights to Vertex Groups"
    bl_options = {"REGISTER", "UNDO"}

    only_selected: bpy.props.BoolProperty(
        name="Selected Cage Vertices Only", default=False,
        description="Groups for the selected vertices of the cage alone")

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return obj is not None and context.mode == "OBJECT" and (binding.is_bound(obj) or
                                                                 bool(binding.models_bound_to(obj)))

    def execute(self, context):
        active = context.active_object
        models = [active] if binding.is_bound(active) else binding.models_bound_to(active)
        negative = 0
        try:
            for model in models:
                negative += self._copy(model)
        except engine.Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        if negative:
            self.report({"WARNING"}, f"{negative} negative weights became 0: the groups do not add up to 1 there")
        return {"FINISHED"}

    def _copy(self, model):
        live = binding.live_of(model)
        state = model.cagewright
        weights = engine.get().weights(live.rest, live.record.cage, (live.record.corners, live.record.offsets), state.kind,
                                       binding.options_of(state), threads=threads())
        chosen = [vertex.index for vertex in state.cage.data.vertices if vertex.select or not self.only_selected]
        for column in chosen:
            name = f"Cage {column:03d}"
            group = model.vertex_groups.get(name)
            if group is not None:
                model.vertex_groups.remove(group)
            group = model.vertex_groups.new(name=name)
            for vertex in np.flatnonzero(weights[:, column] > _LEAST):
                group.add([int(vertex)], float(min(weights[vertex, column], 1.0)), "REPLACE")
        return int((weights[:, chosen] < -_LEAST).sum())


def register():
    bpy.utils.register_class(CAGEWRIGHT_OT_weights_to_groups)


def unregister():
    bpy.utils.unregister_class(CAGEWRIGHT_OT_weights_to_groups)
