"""Files as people really have them, and what the program makes of each.

Called as: field_test.py PROGRAM FOLDER [ID...]

FOLDER holds the field cases (base.obj, cage.obj, posed.obj, F01_end_loop.stl, ...), which are no part of the
repository; without it nothing is tested, and the exit code is 77 (skipped). Each row of CASES is (id, command,
expectation): the command without the program's name, in which files of FOLDER stand by name and outputs go to a folder
of their own as out/NAME; the expectation is a dictionary of

    code    the exit code (0 unless given)
    out     texts that stdout contains, in any order
    err     texts that stderr contains
    not_err texts that stderr does not contain
    file    {"out/NAME": [texts that the file contains]}
    check   a function of the folder of outputs that returns what is wrong, or nothing

Rows are independent of one another. Every row stands for a kind of file; more of each kind are in the tests of the
readers.
"""

import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

POSE = "cage.obj posed.obj"

# Reading and writing OBJ, STL, PLY and OFF.
WHOLE = {"out": ["1280 triangles", "  closed"]}
MOVED = {"out": ["642 of 642 vertices moved"]}
READERS = [
    ("F01", "info F01_end_loop.stl", WHOLE),
    ("F01", f"deform F01_end_loop.stl {POSE} -o out/r.obj", {}),
    ("F04", f"deform F04_rows_over_lines.ply {POSE} -o out/r.obj", MOVED),
    ("F05", f"deform F05_meshlab_ncoff.off {POSE} -o out/x.off",
     {**MOVED, "file": {"out/x.off": [" 64 255 127 255 ", " 191 255 127 255 "]}}),
    ("F07", "info F07_repeated_corner.obj",
     {"out": ["8 vertices, 6 faces: 6 quads", "  closed", "genus 0", "volume 2.4"], "err": ["a corner twice in a row"]}),
    ("F08", "info F08_trailing_slashes.obj", WHOLE),
    ("F11a", "info F11_usemtl_sjis.obj", WHOLE),
    ("F23", "info F23_crlf_empty_lines.ply", WHOLE),
    ("F26", "info F26_comma.obj", {"code": 2, "err": ["F26_comma.obj:1", "decimal comma", "replace ',' by '.'"]}),
    ("F26", "info F26_comma.ply", {"code": 2, "err": ["F26_comma.ply:10", "decimal comma", "replace ',' by '.'"]}),
    ("F29b", "info F29_keyhole.obj", {"out": ["  closed", "genus 1", "area 280"]}),
    ("F30a", "info F30_off_with_colors.off", WHOLE),
    ("F30b", f"deform F30_4off.off {POSE} -o out/r.obj", MOVED),
    ("F30b", f"deform F30_4off.off {POSE} -o out/r.off", MOVED),
    ("F31", "info F31_w.obj", WHOLE),
    ("F34", "info F34_lines_only.obj", {"code": 2, "err": ["F34_lines_only.obj", "has no faces"]}),
    ("F37", "info F37_points_only.ply", {"code": 2, "err": ["F37_points_only.ply", "has no faces"]}),
    ("F44", "info F44_local_large.stl", {"out": ["1280 triangles"]}),
    ("F84", f"deform F84_modelnet.off {POSE} -o out/r.obj", MOVED),
    ("F84", f"deform F84_modelnet.off {POSE} -o out/r.off", MOVED),
    ("F86", "info F86_thousands.obj", {"code": 2, "err": ["F86_thousands.obj:3444", "thousands separator"]}),
    ("F90", "info F90_no_solid.stl", {**WHOLE, "err": ["before any line 'solid'"]}),
    ("F91b", f"deform F91_ind.obj {POSE} -o out/x.obj", {**MOVED, "file": {"out/x.obj": ["vn 1.#QNAN0 0 0"]}}),
    ("F97", "convert F82_dressed.obj out/x.ply",
     {"err": ["x.ply: PLY cannot hold all: left out are", "materials"],
      "file": {"out/x.ply": ["texcoord", "property double nx", "red"]}}),
    ("F97", "convert F75_attributes.ply out/x.obj",
     {"err": ["'quality'", "'label'"], "file": {"out/x.obj": ["\nvt ", "\nvn ", "/1"]}}),
    ("F97", f"deform F82_dressed.obj {POSE} -o out/x.ply",
     {**MOVED, "err": ["warning: ", "x.ply: PLY cannot hold all: left out are", "materials"],
      "file": {"out/x.ply": ["texcoord", "property double nx", "red"]}}),
    ("F97", f"deform F75_attributes.ply {POSE} -o out/x.obj",
     {**MOVED, "err": ["'quality'", "'label'"], "file": {"out/x.obj": ["\nvt ", "\nvn ", "/1"]}}),
    ("F97", f"deform F15_interleaved.glb {POSE} -o out/x.obj", {**MOVED, "file": {"out/x.obj": ["\nvn ", "\nvt "]}}),
    ("F102", f"deform F82_dressed.obj {POSE} -o out/x.glb", MOVED),
    ("F102", f"deform F15_interleaved.glb {POSE} -o out/x.gltf", {**MOVED, "not_err": ["warning"]}),
]

# glTF.
GLTF = [
    ("F13b", "info F13_gltf_buffer.gltf", {"out": ["1280 triangles"]}),
    ("F14b", f"deform F14_quantized.glb {POSE} -o out/x.glb", {"out": ["642 of 642"]}),
    ("F17a", "info F17_no_default_scene.glb", {"out": ["1280 triangles"]}),
    ("F18", "info F18_skin_moved_node.glb", {"out": ["4 x 2.11215 x 2.4"]}),
    ("F18bind", "info F18_skin_moved_node.glb --pose bind", {"out": ["triangles"]}),
    ("F19a", "info F19_morph_mesh_weights.glb", {"out": ["6.59954 x 1.62271 x 1.46217"]}),
    ("F19bind", "info F19_morph_mesh_weights.glb --pose bind", {"out": ["3.59954 x 1.62271 x 1.46217"]}),
    ("F20", f"deform F20_same_names.glb {POSE} -o out/x.glb --only Cube", {"out": ["1284 of 1284"]}),
    ("F20first", f"deform F20_same_names.glb {POSE} -o out/x.glb --only Cube#1", {"out": ["642 of 1284"]}),
    ("F20none", f"deform F20_same_names.glb {POSE} -o out/x.glb --only Cylinder",
     {"code": 2, "err": ["no group 'Cylinder'; it has Cube#1, Cube#2"]}),
    ("F21", "info F21_data_in_glb.glb", {"out": ["1280 triangles"]}),
    ("F89", "info F89_bin_type_one.glb", {"code": 2, "err": ["F89_bin_type_one.glb", "buffer 0"]}),
    # Their buffer is not in the folder: it is looked for under the name with blanks.
    ("F96", "info 'F96_Box With Spaces.gltf'", {"code": 2, "err": ["Box With Spaces.bin: there is no such file"]}),
    ("F96b", "info F96_escaped.gltf", {"code": 2, "err": ["Box With Spaces.bin: there is no such file"]}),
    ("F101", "info F101_meshopt.glb", {"code": 2, "err": ["meshopt", "without compression"]}),
    ("F101b", "info F101_draco.glb", {"code": 2, "err": ["draco", "without compression"]}),
    ("N9", "bind F64_all_in_one.glb F64_all_in_one.glb --cage-object Shirt_OuterCage -o out/w.npz",
     {"out": ["model vertices bound to"], "not_err": ["nested_piece", "vertex_on_"]}),
]

# Commands, cages from elsewhere, exit codes.
COMMANDS = [
    ("F40a", "compare F40_skin_cloth_bone.obj cage.obj --no-poses --json out/f.json",
     {"check": lambda out: volume_method(out, "enclosed")}),
    ("F53", "compare F53_double_sided.obj cage.obj --no-poses --json out/f.json",
     {"check": lambda out: volume_method(out, "enclosed")}),
    ("F46a", "generate F46_specks.ply -o out/c.obj --vertices 100 --rounds 0",
     {"err": ["tiny pieces far from the rest", "times as long", "--ignore-specks"]}),
    ("F46b", "generate F46_stray_vertex.obj -o out/c.obj --vertices 40 --rounds 0 --ignore-specks --json out/f.json",
     {"out": ["1 tiny piece far from the rest is ignored"], "file": {"out/f.json": ["specks_ignored"]}}),
    ("F60a", "check base.obj F60_cage_split.glb", {"out": ["valid", "26 vertices", "70 vertices", "cagewright weld"]}),
    ("F60a weld", "weld F60_cage_split.glb out/w.obj", {"out": ["26 vertices of 96"]}),
    ("F61", "check base.obj F61_cage_touching.obj", {"code": 1, "out": ["not valid", "at (", "remedy:"]}),
    ("F62", "check base.obj F62_cage_concave.obj",
     {"code": 1, "out": ["concave", "folds over", "face 0", "--triangulate"]}),
    ("F65", "check base.obj F65_cage_inner_reversed.obj", {"code": 1, "out": ["inner shell", "--allow-inner-shells"]}),
    ("F65 allowed", "check base.obj F65_cage_inner_reversed.obj --allow-inner-shells", {"out": ["valid"]}),
    ("F70", "deform base.obj cage.obj F70_posed_triangulated.obj -o out/z.obj",
     {"out": ["642 of 642 vertices moved"], "err": ["faces are others"]}),
    # Its one vertex more is loose.
    ("F71", "deform base.obj cage.obj F71_posed_one_more.obj -o out/z.obj",
     {"out": ["642 of 642 vertices moved"], "err": ["F71_posed_one_more.obj: it has other vertices that no face uses"]}),
    ("F72a", "bind F72_subdivided.obj cage.obj -o out/w.npz", {"out": ["bound to 26 cage vertices"]}),
    ("F74", "bind base.obj F74_half_cage.obj -o out/w.npz", {"err": ["vertex_outside"], "not_err": ["would fit"]}),
    ("F78a", "deform base.obj cage.obj F78_posed_corner_rotated.obj -o out/z.obj",
     {"out": ["642 of 642 vertices moved"]}),
    ("F80a", "check base.obj F80_cage_cm.obj", {"out": ["valid", "scaled by 0.01", "--fit"]}),
    ("F80a deform", "deform base.obj F80_cage_cm.obj F80_cage_cm.obj -o out/z.obj", {"err": ["scaled by 0.01"]}),
    ("F80a mended", "weld F80_cage_cm.obj out/w.obj --fit base.obj", {"out": ["100 % of the model's vertices"]}),
    ("F81", "bind base.obj cage.obj -o out/w.csv",
     {"file": {"out/w.csv": ["# cagewright weights", "model_vertex,cage_vertex,weight"]}}),
    ("F81 other", "bind base.obj cage.obj -o out/w.abc", {"code": 2, "err": [".npz, .csv, .json or .dmat"]}),
    ("N8", "bind base.obj cage.obj -o out/g.json --format vertex-groups",
     {"file": {"out/g.json": ["cagewright-vertex-groups", "cage_25"]}}),
]


def volume_method(out, method):
    cage = json.loads((out / "f.json").read_text())["cages"][0]
    if cage["model_volume_method"] != method or not 1 < cage["volume_ratio"] < 10:
        return f"the volume is {cage['model_volume_method']}, the ratio {cage['volume_ratio']}"
    return None


CASES = READERS + GLTF + COMMANDS


def wrong_with(program, folder, command, expected):
    """What is wrong with a row, as a list of sentences."""
    with tempfile.TemporaryDirectory() as temporary:
        outputs = pathlib.Path(temporary, "out")
        outputs.mkdir()
        words = [str(outputs / w[4:]) if w.startswith("out/") else str(folder / w) if (folder / w).exists() else w
                 for w in shlex.split(command)]
        ran = subprocess.run([program, *words], capture_output=True, text=True, errors="replace", timeout=300,
                             check=False)
        wrong = []
        if ran.returncode != expected.get("code", 0):
            wrong.append(f"exit code {ran.returncode}, not {expected.get('code', 0)}; stderr: {ran.stderr.strip()}")
        for key, text in (("out", ran.stdout), ("err", ran.stderr)):
            wrong += [f"std{key} lacks {part!r}: {text.strip()!r}" for part in expected.get(key, []) if part not in text]
        wrong += [f"stderr says {part!r}" for part in expected.get("not_err", []) if part in ran.stderr]
        for name, parts in expected.get("file", {}).items():
            path = outputs / name[4:]
            text = path.read_text(errors="replace") if path.exists() else ""
            wrong += [f"{name} lacks {part!r}" for part in parts if part not in text]
        if not wrong and "check" in expected:
            found = expected["check"](outputs)
            wrong += [found] if found else []
        return wrong


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(sys.argv[2])
    chosen = set(sys.argv[3:])
    if not (folder / "base.obj").exists():
        print(f"skipped: there are no field cases in {folder}")
        return 77
    failed = 0
    for name, command, expected in CASES:
        if chosen and name not in chosen:
            continue
        wrong = wrong_with(program, folder, command, expected)
        failed += bool(wrong)
        for sentence in wrong:
            print(f"{name}: cagewright {command}: {sentence}")
    print(f"{failed} of {len(CASES)} field cases fail")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
