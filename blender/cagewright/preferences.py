"""The add-on's preferences."""

import bpy

from . import engine


class CagewrightPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The command line program of Cagewright, used where the library that comes with the add-on "
                    "cannot be loaded. Empty: found by its name")
    threads: bpy.props.IntProperty(
        name="Threads", min=0, max=1024, default=0,
        description="How many cores Cagewright may use; 0: all. Results do not depend on it")

    def draw(self, context):
        try:
            self.layout.label(text=engine.get().describe(), icon="CHECKMARK")
        except engine.Failure as failure:
            self.layout.label(text=str(failure), icon="ERROR")
        self.layout.prop(self, "program")
        self.layout.prop(self, "threads")


class _Initial:
    program = ""
    threads = 0


def preferences():
    """The preferences; as they are initially where the add-on runs without being enabled by the user."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon is not None and addon.preferences is not None else _Initial


def threads():
    return preferences().threads or None


def register():
    bpy.utils.register_class(CagewrightPreferences)


def unregister():
    bpy.utils.unregister_class(CagewrightPreferences)
