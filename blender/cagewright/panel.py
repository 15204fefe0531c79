"""The panel in the sidebar of the 3D view, and the operators in menus."""

import bpy

from . import binding, jobs, settings

# Of the options, those that are always in view; the others are in panels of their groups.
_FIRST = ("vertices", "quads", "symmetry", "clearance")


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Cagewright"


class CAGEWRIGHT_PT_main(_Panel, bpy.types.Panel):
    bl_label = "Cagewright"

    def draw(self, context):
        layout = self.layout
        if jobs.running is not None:
            self._progress(layout)
            return
        column = layout.column()
        column.scale_y = 1.4
        column.operator("cagewright.generate", icon="MESH_ICOSPHERE")
        row = column.row(align=True)
        row.operator("cagewright.bind", icon="LINKED")
        row.operator("cagewright.unbind", text="", icon="UNLINKED")
        self._state(layout, context)

    @staticmethod
    def _progress(layout):
        running = jobs.running
        text = "Stopping" if running.stopping else f"{running.title}: {running.step}"
        if hasattr(layout, "progress"):
            layout.progress(factor=running.fraction, text=text)
        else:
            layout.label(text=f"{running.fraction:4.0%}  {text}", icon="TIME")
        layout.operator("cagewright.cancel", icon="X")

    @staticmethod
    def _state(layout, context):
        """What is bound to what, and what stands in the way."""
        obj = context.active_object
        if obj is None or obj.type != "MESH":
            layout.label(text="Select a model", icon="INFO")
            return
        for model in [obj, *binding.models_bound_to(obj)]:
            state = model.cagewright
            if not binding.is_bound(model):
                continue
            for line in _wrapped(f"{model.name} follows {state.cage.name if state.cage else 'nothing'}"):
                layout.label(text=line, icon="LINKED")
            if state.problem:
                for line in _wrapped(state.problem):
                    layout.label(text=line, icon="ERROR")
        if obj.cagewright.verdict:
            valid = obj.cagewright.verdict == "valid"
            for line in _wrapped(obj.cagewright.verdict):
                layout.label(text=line, icon="CHECKMARK" if valid else "ERROR")


def _wrapped(text, width=27):
    import textwrap
    return textwrap.wrap(text, width)


class CAGEWRIGHT_PT_options(_Panel, bpy.types.Panel):
    bl_label = "Cage"
    bl_parent_id = "CAGEWRIGHT_PT_main"

    def draw(self, context):
        layout, chosen = self.layout, context.scene.cagewright
        layout.use_property_split = True
        layout.use_property_decorate = False
        for option in settings.OPTIONS:
            if option.name in _FIRST:
                layout.prop(chosen, option.attribute, text="Quads" if option.name == "quads" else None)
        layout.prop(chosen, "pose")
        column = layout.column(heading="Object")
        column.prop(chosen, "together")
        column.prop(chosen, "parent")
        column.prop(chosen, "skin")


class CAGEWRIGHT_PT_more(_Panel, bpy.types.Panel):
    bl_label = "More Options"
    bl_parent_id = "CAGEWRIGHT_PT_options"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, chosen = self.layout, context.scene.cagewright
        layout.use_property_split = True
        layout.use_property_decorate = False
        group = None
        for option in settings.OPTIONS:
            if option.name in _FIRST:
                continue
            if option.group == "Boxes" and chosen.method == "envelope":
                continue
            if option.group != group:
                group = option.group
                layout.separator()
            layout.prop(chosen, option.attribute)


class CAGEWRIGHT_PT_binding(_Panel, bpy.types.Panel):
    bl_label = "Binding"
    bl_parent_id = "CAGEWRIGHT_PT_main"

    def draw(self, context):
        layout, chosen = self.layout, context.scene.cagewright
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(chosen, "coordinates")
        for option in settings.KINDS[chosen.coordinates]["options"]:
            layout.prop(chosen, settings.COORDINATE + option["name"].replace("-", "_"))
        layout.operator("cagewright.mesh_deform", icon="MOD_MESHDEFORM")


class CAGEWRIGHT_PT_tools(_Panel, bpy.types.Panel):
    bl_label = "Tools"
    bl_parent_id = "CAGEWRIGHT_PT_main"

    def draw(self, context):
        column = self.layout.column(align=True)
        for operator, icon in _TOOLS:
            text = {"cagewright.weights_to_groups": "To Vertex Groups"}.get(operator)
            column.operator(operator, icon=icon, **({"text": text} if text else {}))


_TOOLS = [("cagewright.check", "CHECKMARK"), ("cagewright.fit", "MOD_SHRINKWRAP"), ("cagewright.mirror", "MOD_MIRROR"),
          ("cagewright.to_shape_key", "SHAPEKEY_DATA"), ("cagewright.bake_keys", "ACTION"),
          ("cagewright.bake_cache", "FILE_CACHE"), ("cagewright.weights_to_groups", "GROUP_VERTEX")]


class CAGEWRIGHT_MT_menu(bpy.types.Menu):
    """In the menu of objects, so that the search of operators finds all of them."""

    bl_label = "Cagewright"

    def draw(self, context):
        for operator, icon in [("cagewright.generate", "MESH_ICOSPHERE"), ("cagewright.bind", "LINKED"),
                               ("cagewright.unbind", "UNLINKED"), ("cagewright.mesh_deform", "MOD_MESHDEFORM"), *_TOOLS]:
            self.layout.operator(operator, icon=icon)


def _in_menu(self, context):
    self.layout.separator()
    self.layout.menu("CAGEWRIGHT_MT_menu")


_CLASSES = [CAGEWRIGHT_PT_main, CAGEWRIGHT_PT_options, CAGEWRIGHT_PT_more, CAGEWRIGHT_PT_binding, CAGEWRIGHT_PT_tools,
            CAGEWRIGHT_MT_menu]
_MENUS = ["VIEW3D_MT_object", "VIEW3D_MT_edit_mesh"]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for menu in _MENUS:
        getattr(bpy.types, menu).append(_in_menu)


def unregister():
    for menu in _MENUS:
        getattr(bpy.types, menu).remove(_in_menu)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
