"""Cagewright in Blender: cages round models, proved valid, and models that follow them.

`engine` is the one door to Cagewright itself: its library, or its program. `geometry` turns objects into arrays and
back. `binding` is what a bound model is, and keeps it up to date; `follow` says when. The operators are in the other
modules, one for each thing to do; `panel` shows them.
"""

bl_info = {
    "name": "Cagewright",
    "description": "Cages round models, proved valid, and models that follow them",
    "author": "Cagewright contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Cagewright",
    "category": "Mesh",
}

from . import (check_cage, edit_cage, follow, generate, bind, mesh_deform, panel, poses, preferences, settings,
               vertex_groups)

_MODULES = [preferences, settings, generate, bind, mesh_deform, check_cage, edit_cage, poses, vertex_groups, panel,
            follow]


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
