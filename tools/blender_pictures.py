#!/usr/bin/env python3
"""The pictures of docs/blender.md, made as a user would:  blender_pictures.py ZIP [FOLDER]

A Blender window opens on a screen of its own (Xvfb, openbox) with the add-on installed from its zip, and is driven by
mouse and keys (xdotool). What the window has to show first is waited for, never a time.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PATIENCE = 300  # seconds for anything, on a busy machine

# Runs in Blender: does what is written to a file, and says how things are in another.
SERVANT = '''
import bpy, json, os, pathlib, sys, traceback
HOME, ZIP, SAMPLE = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1:])
bpy.ops.preferences.addon_install(filepath=str(ZIP), overwrite=True)
bpy.ops.preferences.addon_enable(module="cagewright")
bpy.context.preferences.view.show_splash = False
import mathutils
import numpy as np
from cagewright import bindings, binding, geometry, jobs

def creature():
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    read = bindings.read_mesh(SAMPLE)
    mesh = geometry.new_mesh("Creature", read.vertices[:, [0, 2, 1]] * [1, -1, 1], read.corners, read.offsets)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    model = bpy.data.objects.new("Creature", mesh)
    bpy.context.scene.collection.objects.link(model)
    model.select_set(True)
    bpy.context.view_layer.objects.active = model
    return model

def look(model):
    """The view shows the model, with the sidebar open."""
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            area.spaces[0].show_region_ui = True
            area.spaces[0].region_3d.view_rotation = mathutils.Euler((1.2, 0, 0.75)).to_quaternion()
            region = next(region for region in area.regions if region.type == "WINDOW")
            with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
                bpy.ops.view3d.view_selected()

def turn(by):
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            area.spaces[0].region_3d.view_rotation = mathutils.Euler(by).to_quaternion()

def screen(obj, vertex):
    """Where a vertex is on the screen, from the top left corner of the window."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d
    window = bpy.context.window_manager.windows[0]
    for area in window.screen.areas:
        if area.type == "VIEW_3D":
            region = next(region for region in area.regions if region.type == "WINDOW")
            place = obj.matrix_world @ obj.data.vertices[vertex].co
            x, y = location_3d_to_region_2d(region, area.spaces[0].region_3d, place)
            return [region.x + x, window.height - region.y - y]

answer = None
def serve():
    global answer
    command = HOME / "command.py"
    if command.exists():
        text = command.read_text()
        command.unlink()
        answer = None
        try:
            scope = dict(globals())
            exec(text, scope)
            answer = scope.get("answer")
        except Exception:
            answer = {"failed": traceback.format_exc()}
        (HOME / "done").write_text(json.dumps({"answer": answer}))
    active = bpy.context.view_layer.objects.active
    state = {"running": jobs.running is not None, "fraction": jobs.running.fraction if jobs.running else 0,
             "active": active.name if active else None, "mode": active.mode if active else None,
             "bound": [obj.name for obj in binding.bound_models()],
             "selected": sum(v.select for v in active.data.vertices) if active and active.type == "MESH" else 0}
    (HOME / "state.new").write_text(json.dumps(state))
    os.replace(HOME / "state.new", HOME / "state")
    return 0.1

bpy.app.timers.register(serve, first_interval=1.0)
'''


class Window:
    """A Blender window, and the mouse and keys before it."""

    def __init__(self, zip_file, home):
        self.home = home
        (home / "scripts" / "addons").mkdir(parents=True)
        (home / "servant.py").write_text(SERVANT)
        self.environment = {"PATH": "/usr/bin:/bin", "HOME": str(home), "BLENDER_USER_SCRIPTS": str(home / "scripts"),
                            "BLENDER_USER_CONFIG": str(home / "config"), "XDG_RUNTIME_DIR": str(home),
                            "LIBGL_ALWAYS_SOFTWARE": "1", "LANG": "C.UTF-8"}
        display = next(n for n in range(90, 200) if not pathlib.Path(f"/tmp/.X11-unix/X{n}").exists())
        self.environment["DISPLAY"] = f":{display}"
        self.processes = []
        self._start("Xvfb", f":{display}", "-screen", "0", "1500x950x24")
        self._wait(lambda: pathlib.Path(f"/tmp/.X11-unix/X{display}").exists(), "the screen")
        self._start("openbox")
        self._start("blender", "--factory-startup", "--threads", "2", "--window-geometry", "0", "0", "1500", "950",
                    "--python", str(home / "servant.py"), "--", str(home), str(zip_file),
                    str(ROOT / "samples" / "creature.obj"))
        self.wait("a window", lambda state: True)

    def _start(self, *command):
        log = open(self.home / f"{command[0]}.log", "wb")
        self.processes.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))

    def close(self):
        for process in reversed(self.processes):
            process.terminate()
            process.wait()

    @staticmethod
    def _wait(is_there, what):
        until = time.monotonic() + PATIENCE
        while not is_there():
            if time.monotonic() > until:
                sys.exit(f"blender_pictures.py: waited in vain for {what}")
            time.sleep(0.1)

    def state(self):
        try:
            return json.loads((self.home / "state").read_text())
        except FileNotFoundError:
            return None

    def wait(self, what, holds):
        self._wait(lambda: self.state() is not None and holds(self.state()), what)

    def do(self, text):
        """Runs Python in Blender, and gives its `answer`."""
        (self.home / "command.new").write_text(text)
        os.replace(self.home / "command.new", self.home / "command.py")
        self._wait((self.home / "done").exists, text)
        answer = json.loads((self.home / "done").read_text())["answer"]
        (self.home / "done").unlink()
        if isinstance(answer, dict) and "failed" in answer:
            sys.exit(answer["failed"])
        return answer

    def _xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)

    def move(self, x, y):
        self._xdotool("mousemove", round(x), round(y))
        self.settle()

    def click(self, x, y):
        self.move(x, y)
        self._xdotool("click", 1)
        self.settle()

    def key(self, name):
        self._xdotool("key", name)
        self.settle()

    def settle(self):
        """Blender has done with what came, and has drawn it."""
        for _ in range(3):
            self.do("for window in bpy.context.window_manager.windows:\n"
                    "    for area in window.screen.areas: area.tag_redraw()\n")

    def picture(self, path):
        self.settle()
        whole = self.home / "whole.png"
        subprocess.run(["import", "-window", "root", str(whole)], env=self.environment, check=True)
        subprocess.run(["convert", str(whole), "-crop", f"1500x926+0+{FRAME}", "+repage", "-resize", "1000x", "-strip",
                        "-colors", "255", f"PNG8:{path}"], env=self.environment, check=True)
        print(path)


TAB, GENERATE, BIND = (1224, 279), (1113, 151), (1113, 181)  # of the sidebar
BESIDE = (600, 800)                                          # in the view, on nothing
FRAME = 20                                                   # of the window, above what Blender draws

LEFTMOST = '''
cage = bpy.context.view_layer.objects.active
number = min(range(len(cage.data.vertices)), key=lambda v: screen(cage, v)[0])
answer = screen(cage, number)
'''

RIG = '''
model = creature()
rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
bpy.context.scene.collection.objects.link(rig)
rig.show_in_front = True
bpy.context.view_layer.objects.active = rig
bpy.ops.object.mode_set(mode="EDIT")
low, high = (np.array(model.bound_box).min(axis=0), np.array(model.bound_box).max(axis=0))
def at(x, y, z): return low + (high - low) * [x, y, z]
bones, last = rig.data.edit_bones, None
for name, head, tail in [("Body", (.5, .45, .2), (.5, .4, .5)), ("Head", (.5, .4, .5), (.5, .25, .8))]:
    bone = bones.new(name)
    bone.head, bone.tail, bone.parent = at(*head), at(*tail), last
    last = bone
bpy.ops.object.mode_set(mode="OBJECT")
groups = {name: model.vertex_groups.new(name=name) for name in ("Body", "Head")}
points = geometry.points_of(model.data)
share = np.clip(((points - low) / (high - low))[:, 2] * 8 - 3.6, 0, 1)
share[((points - low) / (high - low))[:, 1] > 0.62] = 0
for number, part in enumerate(share):
    groups["Head"].add([number], float(part), "REPLACE")
    groups["Body"].add([number], float(1 - part), "REPLACE")
model.modifiers.new("Armature", "ARMATURE").object = rig
rig.pose.bones["Head"].rotation_mode = "XYZ"
rig.pose.bones["Head"].rotation_euler = (0.35, 0.3, 0.25)
rig.select_set(False)
model.select_set(True)
bpy.context.view_layer.objects.active = model
bpy.context.scene.cagewright.skin = True
look(model)
'''

EDIT_ON_TOP = '''
cage = bpy.context.view_layer.objects.active
points = geometry.points_of(cage.data)
ear = points[:, 2] > np.quantile(points[:, 2], 0.93)
points[ear] += [0, 0, 0.12 * np.ptp(points[:, 2])]
cage.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
cage.data.update()
bpy.context.view_layer.update()
'''

BROKEN = '''
cage = bpy.context.view_layer.objects.active
points = geometry.points_of(cage.data)
for vertex in (int(np.argmax(points[:, 2])), int(np.argmin(points[:, 1]))):
    points[vertex] += 0.6 * (points.mean(axis=0) - points[vertex])
cage.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
cage.data.update()
bpy.context.view_layer.update()
'''

RENDERED = '''
scene = bpy.context.scene
scene.render.engine = "BLENDER_WORKBENCH"
scene.display.shading.light = "STUDIO"
scene.display.shading.color_type = "OBJECT"
scene.display.shading.show_cavity = True
scene.render.resolution_x, scene.render.resolution_y = 1000, 420
scene.render.film_transparent = False
scene.view_settings.view_transform = "Standard"
world = scene.world or bpy.data.worlds.new("World")
scene.world = world
world.color = (0.9, 0.9, 0.9)
model = bpy.data.objects["Creature"]
cage = model.cagewright.cage
size = max(model.dimensions)
rest = geometry.points_of(cage.data)
def posed(amount):
    if amount == 0:
        return rest
    middle = rest.mean(axis=0)
    angle = amount * (rest[:, 2] - rest[:, 2].min()) / np.ptp(rest[:, 2])
    c, s = np.cos(angle), np.sin(angle)
    x, y = (rest - middle)[:, 0], (rest - middle)[:, 1]
    return middle + np.stack([c * x - s * y, s * x + c * y, (rest - middle)[:, 2] * (1 + 0.15 * amount)], axis=1)
copies = []
for number, amount in enumerate((-1.2, 0.0, 1.2)):
    cage.data.vertices.foreach_set("co", posed(amount).astype(np.float32).ravel())
    cage.data.update()
    bpy.context.view_layer.update()
    shape = bpy.data.meshes.new_from_object(model.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    copy = bpy.data.objects.new(f"Pose {number}", shape)
    copy.color = (0.55, 0.62, 0.75, 1)
    copy.location.x = (number - 1) * 1.25 * size
    copy.rotation_euler.z = 0.6
    scene.collection.objects.link(copy)
    copies.append(copy)
model.hide_render = True
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(camera)
camera.data.type = "ORTHO"
camera.data.ortho_scale = 3.6 * size
camera.location = (0, -10 * size, 3 * size + 0.45 * size)
camera.rotation_euler = (1.2793, 0, 0)
camera.data.clip_end = 100 * size
scene.camera = camera
scene.render.filepath = str(HOME / "rendered.png")
bpy.ops.render.render(write_still=True)
'''


def new_scene(window, text):
    window.do(text)
    window.settle()


def generate(window):
    window.click(*GENERATE)
    window.wait("the cage", lambda state: not state["running"] and (state["active"] or "").endswith("Cage"))


def bind(window):
    window.click(*BIND)
    window.wait("the binding", lambda state: not state["running"] and state["bound"])


def two_clicks(window, folder):
    new_scene(window, "look(creature())")
    window.click(*TAB)
    window.picture(folder / "blender-model.png")
    generate(window)
    window.move(*BESIDE)
    window.picture(folder / "blender-cage.png")
    bind(window)
    window.move(*BESIDE)
    window.key("Tab")
    window.wait("edit mode", lambda state: state["mode"] == "EDIT")
    x, y = window.do(LEFTMOST)
    window.click(x, y + FRAME)
    window.key("g")
    for step in range(1, 6):
        window.move(x - 14 * step, y - 24 * step)
    window.picture(folder / "blender-drag.png")
    window.click(x - 70, y - 120)
    window.key("Tab")
    window.wait("object mode", lambda state: state["mode"] == "OBJECT")


def checked(window, folder):
    new_scene(window, "look(creature())")
    generate(window)
    new_scene(window, BROKEN)
    window.do("bpy.ops.cagewright.check()")
    window.wait("edit mode", lambda state: state["mode"] == "EDIT")
    window.do("bpy.context.tool_settings.mesh_select_mode = (False, False, True)")
    window.move(*BESIDE)
    window.picture(folder / "blender-check.png")
    window.key("Tab")
    window.wait("object mode", lambda state: state["mode"] == "OBJECT")


def rigged(window, folder):
    new_scene(window, RIG)
    generate(window)
    bind(window)
    new_scene(window, EDIT_ON_TOP)
    window.move(*BESIDE)
    window.picture(folder / "blender-rig.png")


def rendered(window, folder):
    new_scene(window, "bpy.context.scene.cagewright.skin = False\nlook(creature())")
    generate(window)
    bind(window)
    window.do(RENDERED)
    subprocess.run(["convert", str(window.home / "rendered.png"), "-strip", "-colors", "255",
                    f"PNG8:{folder / 'blender-poses.png'}"], check=True)
    print(folder / "blender-poses.png")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for tool in ("blender", "Xvfb", "openbox", "xdotool", "import", "convert"):
        if shutil.which(tool) is None:
            sys.exit(f"blender_pictures.py: {tool} is missing")
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "docs" / "images").resolve()
    with tempfile.TemporaryDirectory() as home:
        window = Window(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(home))
        try:
            for scene in (two_clicks, checked, rigged, rendered):
                scene(window, folder)
        finally:
            window.close()


if __name__ == "__main__":
    main()
