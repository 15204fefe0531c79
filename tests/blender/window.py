#!/usr/bin/env python3
"""The add-on in a real Blender window, driven by mouse and keys:  window.py ZIP

Two clicks from a character to a cage that moves it live; undo and redo across both; Esc stops. The window and what it is
told are those of tools/blender_pictures.py. Where there is no Blender or no screen for it, it is skipped (exit code 77).
"""

import pathlib
import shutil
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "tools"))
import blender_pictures as drive  # noqa: E402

SHAPE = """
model = bpy.data.objects["Creature"]
with geometry.Evaluated(model, bpy.context.evaluated_depsgraph_get()) as mesh:
    moved = np.abs(geometry.points_of(mesh) - geometry.points_of(model.data)).max()
answer = float(moved)
"""


def moved(window):
    """How far the cage has moved the vertex of the model that goes farthest."""
    return window.do(SHAPE)


def expect(what, holds):
    if not holds:
        sys.exit(f"window.py: {what}: not so")
    print(what)


def undo(window, what, holds):
    window.move(*drive.BESIDE)
    window.key("ctrl+z")
    window.wait(what, holds)


def redo(window, what, holds):
    window.key("ctrl+shift+z")
    window.wait(what, holds)


def check(window):
    window.do("look(creature())\nbpy.ops.ed.undo_push(message='model')")
    window.settle()
    window.click(*drive.TAB)
    drive.generate(window)
    expect("one click makes a cage", window.do("answer = len(bpy.data.objects)") == 2)
    drive.bind(window)
    window.move(*drive.BESIDE)
    window.key("Tab")
    window.wait("edit mode", lambda state: state["mode"] == "EDIT")
    x, y = window.do(drive.LEFTMOST)
    window.click(x, y + drive.FRAME)
    window.wait("the vertex to be selected", lambda state: True)
    window.key("g")
    for step in range(1, 6):
        window.move(x - 14 * step, y - 24 * step)
    expect("the model follows while the cage is dragged", moved(window) > 0.05)
    window.key("Escape")
    window.settle()
    expect("and goes back when the drag is given up", moved(window) < 1e-6)
    window.key("Tab")
    window.wait("object mode", lambda state: state["mode"] == "OBJECT")
    for _ in range(8):  # of edit mode and selecting
        if not window.state()["bound"]:
            break
        window.key("ctrl+z")
        window.settle()
        window.settle()
    expect("undo goes back before binding", not window.state()["bound"])
    redo(window, "the binding again", lambda state: state["bound"])
    window.do("cage = bpy.data.objects['Creature Cage']\nfor v in cage.data.vertices: v.co.x += 1\n"
              "cage.data.update()\nbpy.context.view_layer.update()")
    expect("what was bound again follows", abs(moved(window) - 1) < 1e-4)
    window.do("look(creature())\nbpy.context.scene.cagewright.vertices = 400")
    window.settle()
    window.click(*drive.GENERATE)
    window.wait("work under way", lambda state: state["running"])
    window.move(*drive.BESIDE)
    window.key("Escape")
    window.wait("the end of it", lambda state: not state["running"])
    expect("Esc stops it and leaves nothing", window.do("answer = [o.name for o in bpy.data.objects]") == ["Creature"])


def main():
    if any(shutil.which(tool) is None for tool in ("blender", "Xvfb", "openbox", "xdotool")):
        print("there is no Blender, or no screen for it: skipped")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as home:
        window = drive.Window(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(home))
        try:
            check(window)
        finally:
            window.close()


if __name__ == "__main__":
    main()
