"""What messages about files say helps is tried, and helps.

Called as: remedies_test.py PROGRAM

Each row of ROWS is (a command, files, words that its message has, what is done then). What is done is a dictionary of

    replace   (old, new) in the file that the command names first: the edit that the message asks for
    run       a command that the message names; {} stands for the folder
    instead   the command that is then given instead

and then the command, or the other one, ends with 0. Remedies of `check` are tried in elsewhere_test.py.
"""

import gzip
import io
import pathlib
import shlex
import subprocess
import sys
import tempfile
import zipfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
QUADS = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]


def cube(size=1.0, point="v {!r} {!r} {!r}\n", faces=QUADS):
    return "".join(point.format(*(size * x for x in c)) for c in CORNERS) + "".join("f " + " ".join(map(str, f)) + "\n" for f in faces)


def zipped(text):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("inner.obj", text)
    return file.getvalue()


MODEL = {"a.obj": cube(), "cage.obj": cube(1.5), "posed.obj": cube(1.8)}
COMMA = cube().replace("1.0", "1,0")
SCENES = ('{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]},{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":'
          '[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],'
          '"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:;base64,'
          'AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}')

ROWS = [
    ("info a.obj", {"a.obj": COMMA}, ["decimal comma", "replace ',' by '.'"], {"replace": (",", ".")}),
    ("info a.obj", {"a.obj": cube().replace("1.0", "1,000.0")}, ["thousands separator", "remove ','"], {"replace": (",", "")}),
    ("info a.obj", {"a.obj": cube().replace("1.0", "1'000.0").replace(".0", "")}, ["remove the apostrophes"], {"replace": ("'", "")}),
    ("info a.obj", {"a.obj": cube().replace("1.0", "1.000.000")}, ["remove the dots"], {"replace": (".", "")}),
    ("info a.obj", {"a.obj": cube(point="v {!r};{!r};{!r}\n")}, ["replace ';' by ' '"], {"replace": (";", " ")}),
    ("info a.obj", {"a.obj": cube(point="v {!r}, {!r}, {!r}\n")}, ["replace ',' by ' '"], {"replace": (",", " ")}),
    ("info a.obj", {"a.obj": cube().replace("-", "\u2212")}, ["replace it by '-'"], {"replace": ("\u2212", "-")}),
    ("info a.obj", {"a.obj": cube(point="v {!r}\u00a0{!r}\u00a0{!r}\n")}, ["replace it by a blank"], {"replace": ("\u00a0", " ")}),
    ("info a.obj", {"a.obj": gzip.compress(cube().encode())}, ["unpack it first"], {"run": "sh -c 'mv a.obj a.gz && gunzip -c a.gz > a.obj'"}),
    ("info a.obj", {"a.obj": zipped(cube())}, ["unpack it"],
     {"run": f"{sys.executable} -m zipfile -e a.obj .", "instead": "info inner.obj"}),
    ("info a.obj", {"a.obj": cube().encode("utf-32")}, ["save it as UTF-8"], {"run": "sh -c 'iconv -f UTF-32 -t UTF-8 a.obj > b && mv b a.obj'"}),
    ("info a.gltf", {"a.gltf": SCENES}, ["make another the default one (scene 1)"], {"replace": ('"scene":0', '"scene":1')}),
    ("generate a.obj -o a.obj --depth 1 --method boxes", MODEL, ["give the output another name"],
     {"instead": "generate a.obj -o b.obj --depth 1 --method boxes"}),
    ("convert a.obj b.fbx", MODEL, ["use one of these"], {"instead": "convert a.obj b.glb"}),
    ("bind a.obj cage.obj -o w.abc", MODEL, [".npz, .csv, .json or .dmat"], {"instead": "bind a.obj cage.obj -o w.dmat"}),
    ("bind a.obj cage.obj -o away/w.npz", MODEL, ["create it first"], {"run": "mkdir away"}),
    ("deform a.obj cage.obj posed.obj -o d.obj --weights w.npz", {**MODEL, "w.npz": "no weights"}, ["bind the model again"],
     {"run": "PROGRAM bind a.obj cage.obj -o w.npz"}),
    ("info a.obj --memory-limit 1x", MODEL, ["such as 4G or 50%"], {"instead": "info a.obj --memory-limit 50%"}),
    ("info a.obj --time-limit soon", MODEL, ["such as 10m"], {"instead": "info a.obj --time-limit 10m"}),
    ("generate a.obj -o c.stl --depth 1 --method boxes --resolution 7", MODEL, ["8"],
     {"instead": "generate a.obj -o c.stl --depth 1 --method boxes --resolution 8"}),
    ("deform a.obj cage.obj posed.obj -o d.obj --only nose", {**MODEL, "a.obj": "o eye\n" + cube()}, ["it has eye"],
     {"instead": "deform a.obj cage.obj posed.obj -o d.obj --only eye"}),
]


def run(words, folder):
    return subprocess.run([str(PROGRAM) if w == "PROGRAM" else w for w in words], cwd=folder, capture_output=True, timeout=120, check=False)


def fault(command, files, texts, remedy):
    """What is wrong with a row, or nothing."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            (pathlib.Path(folder) / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        words = ["PROGRAM", *shlex.split(command)]
        first = run(words, folder)
        said = first.stderr.decode(errors="replace")
        if first.returncode == 0:
            return "ends with 0 at once"
        missing = [text for text in texts if text not in said]
        if missing:
            return f"{missing} is not in: {said.strip()}"
        if "replace" in remedy:
            path = pathlib.Path(folder) / shlex.split(command)[1]
            path.write_text(path.read_text(encoding="utf-8").replace(*remedy["replace"]), encoding="utf-8")
        if "run" in remedy:
            done = run(shlex.split(remedy["run"]), folder)
            if done.returncode != 0:
                return f"the remedy fails: {done.stderr.decode(errors='replace').strip()}"
        again = run(["PROGRAM", *shlex.split(remedy["instead"])] if "instead" in remedy else words, folder)
        return f"does not help: {again.stderr.decode(errors='replace').strip()}" if again.returncode != 0 else None


def main():
    faults = [(command, fault(command, *rest)) for command, *rest in ROWS]
    for command, what in faults:
        if what:
            print(f"cagewright {command}: {what}")
    failed = sum(what is not None for _, what in faults)
    print(f"{failed} of {len(ROWS)} remedies fail")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
