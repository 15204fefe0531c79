"""Bind: models follow their cages, live. And Unbind."""

import bpy

from . import binding, follow, generate, jobs, settings


def pairs(context):
    """What is to be bound to what: (model, cage) each.

    With a cage that was made here selected, its models; with some objects selected and another active, as for
    parenting, those to the active one; with a model selected alone, the model to its latest cage.
    """
    active = context.active_object
    if active is None or active.type != "MESH":
        return []
    selected = [obj for obj in context.selected_objects if obj.type == "MESH"]
    cages = [obj for obj in selected if generate.is_cage(obj)]
    models = [obj for obj in selected if not generate.is_cage(obj)]
    if generate.is_cage(active) and active in selected:
        if models:
            return [(model, active) for model in models]
        return [(model, cage) for cage in cages for model in generate.models_of(cage)]
    if len(models) > 1 and active in models and not any(generate.cages_of(model) for model in models):
        return [(model, active) for model in models if model != active]
    found = []
    for model in models:
        own = cages or generate.cages_of(model)
        if own:
            found.append((model, own[-1]))
    return found


class CAGEWRIGHT_OT_bind(jobs.Working, bpy.types.Operator):
    """Bind the selected models to their cages: they follow live when the cage is edited, moved or animated. Select a cage, or models and a mesh to be their cage last"""

    bl_idname = "cagewright.bind"
    bl_label = "Bind"
    bl_options = {"REGISTER", "UNDO"}
    title = "Binding"

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to object mode first")
            return False
        if not pairs(context):
            cls.poll_message_set("Select a cage; or models, and last of all the mesh that is to be their cage")
            return False
        return True

    def prepare(self, context):
        chosen = context.scene.cagewright
        kind, options = settings.coordinates_of(chosen)
        requests = []
        for model, cage in pairs(context):
            binding.unbind(model)  # so that it is bound as it is by itself
            context.view_layer.update()
            requests.append(binding.Request(model, cage, chosen.pose, kind, options))

        def work(progress):
            for number, request in enumerate(requests):
                def told(fraction, step, number=number):
                    return progress((number + fraction) / len(requests), step)
                request.compute(told)
            return requests

        return work

    def finish(self, context, requests):
        for request in requests:
            binding.attach(request)
        follow.gather()
        count = sum(len(request.rest) for request in requests)
        self.report({"INFO"}, f"{count} vertices bound to {requests[0].cage}: move it, or edit its vertices")


class CAGEWRIGHT_OT_unbind(bpy.types.Operator):
    """The selected models, or those of the selected cages, no longer follow a cage, and have their own shape again"""

    bl_idname = "cagewright.unbind"
    bl_label = "Unbind"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and bool(_bound_selected(context))

    def execute(self, context):
        for model in _bound_selected(context):
            binding.unbind(model)
        follow.gather()
        return {"FINISHED"}


def _bound_selected(context):
    models = []
    for obj in context.selected_objects:
        for model in [obj, *binding.models_bound_to(obj)]:
            if binding.is_bound(model) and model not in models:
                models.append(model)
    return models


_CLASSES = [CAGEWRIGHT_OT_bind, CAGEWRIGHT_OT_unbind]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
