"""When bound models are brought up to date: whenever their cages have moved, by hand, by animation, or by undo."""

import bpy
from bpy.app.handlers import persistent

from . import binding

_bound = {}     # names of bound models, by the names of their cages
_objects = -1   # how many objects the file had when they were gathered


_paused = False


class paused:
    """While it lasts, models do not follow: what they show is being used for something else."""

    def __enter__(self):
        global _paused
        _paused = True

    def __exit__(self, *_):
        global _paused
        _paused = False


def gather():
    """Finds the bound models anew."""
    global _objects
    _bound.clear()
    models = []
    for model in binding.bound_models():
        cage = model.cagewright.cage
        if cage is None or not cage.users_scene:  # deleted
            binding.unbind(model)
            continue
        binding.own_nodes(model)
        binding.own_attributes(model, models)
        models.append(model)
        _bound.setdefault(cage.name, []).append(model.name)
    _objects = len(bpy.data.objects)


def _models(cage_name):
    for name in _bound.get(cage_name, ()):
        model = bpy.data.objects.get(name)
        if model is not None and binding.is_bound(model):
            yield model


def _is_as_gathered(model_name, cage_name):
    model, cage = bpy.data.objects.get(model_name), bpy.data.objects.get(cage_name)
    return model is not None and cage is not None and model.cagewright.cage == cage and bool(cage.users_scene)


def _deleted_or_renamed():
    return not all(_is_as_gathered(name, cage_name) for cage_name, names in _bound.items() for name in names)


def _name_hidden():
    """Cages that cannot be seen are evaluated for the sake of their models."""
    for model in _all():
        binding.name_cage(model, not model.cagewright.cage.visible_get())


@persistent
def _before_render(*_):
    for model in _all():
        binding.name_cage(model, True)


@persistent
def _after_render(*_):
    _name_hidden()


@persistent
def _after_update(scene, depsgraph):
    if _paused:
        return
    if len(bpy.data.objects) != _objects or _deleted_or_renamed():
        gather()
        for model in _all():
            binding.follow(model, depsgraph)
        return
    if not _bound:
        return
    _name_hidden()
    moved = set()
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Object) and (update.is_updated_geometry or update.is_updated_transform):
            moved.add(update.id.name)
    for cage_name in list(_bound):
        for model in _models(cage_name):
            parent = bpy.data.objects[cage_name].parent
            if cage_name in moved or (parent is None and model.name in moved):
                binding.follow(model, depsgraph)


def _all():
    for cage_name in list(_bound):
        yield from _models(cage_name)


@persistent
def _after_frame(scene, depsgraph=None):
    if _bound:
        depsgraph = depsgraph or bpy.context.evaluated_depsgraph_get()
        for model in _all():
            binding.follow(model, depsgraph)


@persistent
def _after_undo(scene, *_):
    gather()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for model in _all():
        binding.show_again(model)
        binding.follow(model, depsgraph)


@persistent
def _after_load(*_):
    binding.forget()
    gather()
    if _bound:
        _after_frame(bpy.context.scene)


_HANDLERS = [("render_init", _before_render), ("render_complete", _after_render), ("render_cancel", _after_render),
             ("depsgraph_update_post", _after_update), ("frame_change_post", _after_frame),
             ("undo_post", _after_undo), ("redo_post", _after_undo), ("load_post", _after_load)]


def _once_registered():
    """Data cannot be read while add-ons are being registered."""
    gather()
    _after_frame(bpy.context.scene)


def register():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    bpy.app.timers.register(_once_registered, first_interval=0)


def unregister():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    if bpy.app.timers.is_registered(_once_registered):
        bpy.app.timers.unregister(_once_registered)
    binding.forget()
    _bound.clear()
