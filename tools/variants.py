#!/usr/bin/env python3
"""Makes harmless variants of models (shifted, scaled, turned, mirrored, shuffled, subdivided), a
cage of each, and a table of how much the figures differ that should not.

  variants.py MODEL.off|MODEL.obj... [--vertices 100] [--options "--quads"] [--kinds same shifted ...] [--jobs 2]

Each row: volume ratio, mean and greatest gap (% of the diagonal), webbing (%), handles, seconds of
user CPU; and for each model the spread of the volume ratio, and which variants have the very faces
of the model's own cage. Exits with 1 when a cage is missing or not certified.
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile


def read_off(path):
    words = re.sub(r"#.*", "", path.read_text()).split()
    words = words[1:] if words[0].endswith("OFF") else words
    vertices, faces = int(words[0]), int(words[1])
    numbers = iter(words[3:])
    points = [tuple(float(next(numbers)) for _ in range(3)) for _ in range(vertices)]
    return points, [[int(next(numbers)) for _ in range(int(next(numbers)))] for _ in range(faces)]


def read_obj(path):
    points, faces = [], []
    for words in (line.split() for line in path.read_text().splitlines()):
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) for w in words[1:]])
    return points, [[v - 1 if v > 0 else len(points) + v for v in face] for face in faces]


def write_off(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(repr(x) for x in p) for p in points]
    lines += [" ".join(map(str, [len(f), *f])) for f in faces]
    path.write_text("\n".join(lines) + "\n")


def moved(points, function):
    return [function(*p) for p in points]


def turned(points, about_x, about_z):
    cx, sx, cz, sz = (f(math.radians(a)) for a in (about_x, about_z) for f in (math.cos, math.sin))
    return moved(points, lambda x, y, z: (cz * x - sz * (cx * y - sx * z), sz * x + cz * (cx * y - sx * z), sx * y + cx * z))


def subdivided(points, faces):
    """Each triangle in four, every other polygon in fans: the same surface."""
    points, middles, result = list(points), {}, []
    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(points)
            points.append(tuple((p + q) / 2 for p, q in zip(points[a], points[b])))
        return middles[key]
    for face in faces:
        for i in range(1, len(face) - 1):
            a, b, c = face[0], face[i], face[i + 1]
            d, e, f = middle(a, b), middle(b, c), middle(c, a)
            result += [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
    return points, result


def shuffled(points, faces):
    order = list(range(len(points)))
    generator = random.Random(1)
    generator.shuffle(order)
    number = {old: new for new, old in enumerate(order)}
    faces = [[number[v] for v in face] for face in faces]
    faces = [face[k:] + face[:k] for face in faces for k in [generator.randrange(len(face))]]
    generator.shuffle(faces)
    return [points[v] for v in order], faces


def size_of(points):
    return math.dist(*zip(*((min(c), max(c)) for c in zip(*points))))


def variant(kind, points, faces):
    size = size_of(points)
    if kind == "shifted":
        return moved(points, lambda x, y, z: (x + 0.371 * size, y - 1.13 * size, z + 2.7 * size)), faces
    if kind == "scaled":
        return moved(points, lambda x, y, z: (x * 0.0377, y * 0.0377, z * 0.0377)), faces
    if kind == "turned":
        return turned(points, 0, 29), faces
    if kind == "tilted":
        return turned(points, 17, 41), faces
    if kind == "upright":
        return moved(points, lambda x, y, z: (z, x, y)), faces
    if kind == "mirrored":
        return moved(points, lambda x, y, z: (-x, y, z)), [face[::-1] for face in faces]
    if kind == "shuffled":
        return shuffled(points, faces)
    if kind == "subdivided":
        return subdivided(points, faces)
    return points, faces


KINDS = ["same", "shifted", "scaled", "shuffled", "mirrored", "upright", "turned", "tilted", "subdivided"]


def run(program, model, options, cage):
    made = subprocess.Popen([program, "generate", model, "-o", cage, "--json", cage.with_suffix(".json"), *options],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = made.stdout.read()
    _, status, usage = os.wait4(made.pid, 0)
    if not cage.exists():
        return None, f"{os.waitstatus_to_exitcode(status)}: {said.strip().splitlines()[-1] if said.strip() else ''}"
    judge = subprocess.run([program, "check", model, cage, "--json", cage.with_suffix(".check.json")], capture_output=True,
                           text=True, check=False)
    if judge.returncode != 0:
        return None, "NOT VALID: " + " ".join(judge.stdout.split())[:200]
    figures = json.loads(cage.with_suffix(".check.json").read_text())["cage"]
    figures["user"] = usage.ru_utime
    lines = cage.read_text().splitlines()
    faces = [line for line in lines if line.startswith("f ")]
    edges = {frozenset(pair) for line in faces for c in [[w.split("/")[0] for w in line.split()[1:]]]
             for pair in zip(c, c[1:] + c[:1])}
    figures["genus"] = 1 - (sum(line.startswith("v ") for line in lines) - len(edges) + len(faces)) // 2
    figures["quads"] = sum(len(line.split()) == 5 for line in faces) / len(faces)
    figures["topology"] = faces
    return figures, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+")
    parser.add_argument("--program", default="build/release/cli/cagewright")
    parser.add_argument("--vertices", default="100")
    parser.add_argument("--options", default="", help="more options of generate")
    parser.add_argument("--kinds", nargs="+", default=KINDS, choices=KINDS)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="folder for the variants and their cages")
    arguments = parser.parse_args()
    options = ["--vertices", arguments.vertices, *arguments.options.split()]
    failed = False
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        folder = pathlib.Path(arguments.keep or scratch)
        folder.mkdir(parents=True, exist_ok=True)
        print(f"{'':28}  verts  ratio   mean    max   web %  handles  quads %  user s")
        for model in map(pathlib.Path, arguments.models):
            points, faces = read_off(model) if model.suffix.lower() == ".off" else read_obj(model)
            jobs = {}
            for kind in arguments.kinds:
                file = folder / f"{model.stem}-{kind}.off"
                write_off(file, *variant(kind, points, faces))
                cage = file.with_suffix(".obj")
                cage.unlink(missing_ok=True)
                jobs[kind] = pool.submit(run, arguments.program, file, options, cage)
            found = {}
            for kind, job in jobs.items():
                figures, why_not = job.result()
                name = f"{model.stem} {kind}"
                if figures is None:
                    failed = True
                    print(f"{name:28}  {why_not}", flush=True)
                    continue
                found[kind] = figures
                print(f"{name:28}  {figures['vertices']:5}  {figures['volume_ratio']:.3f}  {100 * figures['mean_distance']:5.2f}"
                      f"  {100 * figures['max_distance']:5.2f}  {100 * figures.get('webbing', -1):6.1f}  {figures['genus']:7}"
                      f"  {100 * figures['quads']:7.0f}  {figures['user']:6.1f}", flush=True)
            ratios = [f["volume_ratio"] for f in found.values()]
            if len(ratios) > 1:
                own = found.get("same", {}).get("topology")
                alike = [kind for kind, f in found.items() if kind != "same" and f["topology"] == own]
                print(f"{model.stem + ' spread':28}  {100 * (max(ratios) / min(ratios) - 1):.1f} % of the volume ratio; "
                      f"the same faces: {' '.join(alike) or 'none'}", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
