"""Generate Cage: for the active object, or for all that are selected."""

import json

import bpy
import numpy as np

from . import engine, geometry, jobs, settings, vertex_groups
from .engine import Failure
from .preferences import threads

COLLECTION = "Cages"


def is_cage(obj):
    return obj.type == "MESH" and len(obj.cagewright.models) > 0


def models_of(cage):
    """The models that a cage was made for, those that are still in the scene."""
    return [entry.object for entry in cage.cagewright.models if entry.object is not None and entry.object.users_scene]


def cages_of(model):
    """The cages that were made for a model, the latest last."""
    return [obj for obj in bpy.context.scene.objects if is_cage(obj) and model in models_of(obj)]


def chosen_models(context):
    """The selected meshes that are no cages, the active one first; of a selected cage its models."""
    chosen = [obj for obj in context.selected_objects if obj.type == "MESH"]
    if context.active_object in chosen:
        chosen.remove(context.active_object)
        chosen.insert(0, context.active_object)
    models = []
    for obj in chosen:
        for model in models_of(obj) if is_cage(obj) else [obj]:
            if model not in models:
                models.append(model)
    return models


class _Task:
    """A cage to be made: arrays, and the names of what they were read from."""

    def __init__(self, models, as_shown):
        self.names = [model.name for model in models]
        self.points, self.faces = geometry.together([geometry.model_of(model, as_shown) for model in models])
        if len(self.points) == 0:
            raise Failure(f"{self.names[0]} has no vertices")
        self.home = np.array(models[0].matrix_world.translation, np.float64)
        # Near the origin, where floats are densest; the cage becomes an object with its origin at the model's.
        self.points = self.points - self.home
        self.cage = None


def _collection(context):
    """Where cages go: a collection of their own, in the scene."""
    scene = context.scene
    for collection in scene.collection.children:
        if collection.name.split(".")[0] == COLLECTION and collection.library is None:
            return collection
    collection = bpy.data.collections.new(COLLECTION)
    scene.collection.children.link(collection)
    return collection


def _remember_mirror(cage, made):
    """Which vertex mirrors which, and on which side each is, for Mirror."""
    found = made.report.get("symmetry", {})
    if not (found.get("mirrored") and found.get("vertex_partners")):
        return
    normal, offset = found["plane"]["normal"], found["plane"]["offset"]
    partners = np.array(found["vertex_partners"])
    if found.get("in_plane", True):
        sides = np.where(partners == np.arange(len(partners)), 0, np.sign(made.vertices @ np.array(normal) - offset))
    else:  # in a pose a left hand may be on the right: the side that the normal points to comes first
        sides = np.sign(partners - np.arange(len(partners)))
    cage.cagewright.mirror = json.dumps({"partners": partners.tolist(), "sides": sides.astype(int).tolist(),
                                         "normal": normal, "offset": offset})


def _add_cage(context, task, parent, skin, as_shown):
    models = [bpy.data.objects.get(name) for name in task.names]
    if models[0] is None:
        raise Failure(f"{task.names[0]} was deleted while its cage was made")
    name = f"{models[0].name} Cage"
    mesh = geometry.new_mesh(name, task.cage.vertices, task.cage.corners, task.cage.offsets)
    cage = bpy.data.objects.new(name, mesh)
    _collection(context).objects.link(cage)
    cage.display_type = "WIRE"
    cage.show_in_front = True
    cage.hide_render = True
    cage.matrix_world.translation = task.home
    if parent:
        cage.parent = models[0]
        cage.matrix_parent_inverse = models[0].matrix_world.inverted_safe()
    for model in filter(None, models):
        cage.cagewright.models.add().object = model
    _remember_mirror(cage, task.cage)
    context.view_layer.update()
    if skin:
        vertex_groups.skin_cage(cage, [model for model in models if model is not None], as_shown)
    return cage


class CAGEWRIGHT_OT_generate(jobs.Working, bpy.types.Operator):
    """Make a cage: a coarse closed mesh round the selected models that moves them. It is proved valid"""

    bl_idname = "cagewright.generate"
    bl_label = "Generate Cage"
    bl_options = {"REGISTER", "UNDO"}
    title = "Generating"

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to object mode first")
            return False
        if not chosen_models(context):
            cls.poll_message_set("Select a model: a mesh")
            return False
        return True

    def prepare(self, context):
        chosen = context.scene.cagewright
        as_shown = chosen.pose == "SHOWN"
        models = chosen_models(context)
        groups = [models] if chosen.together else [[model] for model in models]
        self._tasks = [_Task(group, as_shown) for group in groups]
        self._look = (chosen.parent, chosen.skin, as_shown)
        options, cores, tasks, made_by = settings.options_of(chosen), threads(), self._tasks, engine.get()

        def work(progress):
            for number, task in enumerate(tasks):
                def told(fraction, step, number=number):
                    return progress((number + fraction) / len(tasks), step)
                task.cage = made_by.generate(task.points, task.faces, options, cores, told)
            return tasks

        return work

    def finish(self, context, tasks):
        cages = [_add_cage(context, task, *self._look) for task in tasks]
        for obj in context.selected_objects:
            obj.select_set(False)
        for cage in cages:
            cage.select_set(True)
        context.view_layer.objects.active = cages[0]
        for task in tasks:
            for remark in task.cage.remarks:
                self.report({"WARNING"}, remark)
            figures = task.cage.report["cage"]
            self.report({"INFO"}, f"{task.names[0]}: a valid cage of {len(task.cage.vertices)} vertices, "
                                  f"{figures['volume_ratio']:.2f} times the volume of the model")


class CAGEWRIGHT_OT_cancel(bpy.types.Operator):
    """Stop what is under way"""

    bl_idname = "cagewright.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return jobs.running is not None

    def execute(self, context):
        jobs.running.stop()
        return {"FINISHED"}


_CLASSES = [CAGEWRIGHT_OT_generate, CAGEWRIGHT_OT_cancel]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
