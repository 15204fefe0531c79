#!/usr/bin/env python3
"""Makes cages of all models at hand and of thousands of synthetic ones, has each judged, bound and deformed, and counts.

    tools/campaign.py build/release/cli/cagewright [--models FOLDER...] [--count 1000] [--minutes 60] [--seed 1]
                      [--short] [--table docs/campaign.md] [--keep FOLDER]

The options of each run (method, quads, budget, symmetry, clearance, solid, ...) are drawn at random, the same for the
same seed. `generate` has the limits --time-limit and --memory-limit; `check` judges what it wrote, `bind` and `deform`
move a quarter of the cage. Told as faults are

    crash     a program ended by a signal, or by an internal error
    invalid   generate wrote a cage that check does not call valid
    hang      a program went on beyond its time limit
    mute      it refused without a line that names the file
    budget    more vertices than asked for, and exit code 0
    clearance the cage is nearer to the model than generate says
    figures   what it says is not finite, or deform's model is not

Exit code 0 if there are none. Models with a fault are kept with --keep, with the command. --short is what the tests
run: some seconds.
"""

import argparse
import collections
import json
import math
import pathlib
import random
import shlex
import statistics
import sys
import tempfile
import time

from limited_run import limited_run

GRACE = 20  # seconds beyond the time limit, for reading, writing, and a busy machine
FORMATS = {".obj", ".ply", ".stl", ".off", ".glb", ".gltf"}


# ---- Synthetic models: lists of vertices and faces.

class Shape:
    def __init__(self):
        self.vertices, self.faces = [], []

    def add(self, vertices, faces):
        first = len(self.vertices)
        self.vertices += [tuple(v) for v in vertices]
        self.faces += [tuple(first + i for i in face) for face in faces]
        return self

    def moved(self, move):
        self.vertices = [move(v) for v in self.vertices]
        return self


def box(size=(1, 1, 1)):
    corners = [[(k >> a & 1) * 2 * size[a] - size[a] for a in range(3)] for k in range(8)]
    return Shape().add(corners, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])


def lathe(profile, around, is_closed=False):
    """A profile of (radius, height) turned about the z axis; open where it begins and ends."""
    shape = Shape()
    rows = len(profile)
    turns = [2 * math.pi * k / around for k in range(around)]
    faces = []
    for i in range(rows if is_closed else rows - 1):
        for k in range(around):
            a, b, after = i * around + k, i * around + (k + 1) % around, (i + 1) % rows * around
            faces.append((a, b, after + (k + 1) % around, after + k))
    return shape.add([(r * math.cos(t), r * math.sin(t), z) for r, z in profile for t in turns], faces)


def arc(radius, begin, end, steps):
    return [(radius * math.cos(begin + (end - begin) * k / steps), radius * math.sin(begin + (end - begin) * k / steps))
            for k in range(steps + 1)]


def sphere(around=16):
    return lathe(arc(1, -1.5707, 1.5707, around // 2), around)  # its poles are tiny holes


def cylinder(rng, around=16):
    return lathe([(1e-6, -1), (1, -1), (1, 1), (1e-6 if rng.random() < 0.5 else 0.5, 1)], around)


def torus(rng, around=20):
    tube = rng.uniform(0.1, 0.6)
    return lathe([(1 + tube * math.cos(2 * math.pi * k / 10), tube * math.sin(2 * math.pi * k / 10)) for k in range(10)],
                 around, True)


def turned(rng):
    """A random rotation, as a function of points."""
    while True:
        q = [rng.uniform(-1, 1) for _ in range(4)]
        n = math.sqrt(sum(x * x for x in q))
        if 0.1 < n < 1:
            break
    w, x, y, z = (c / n for c in q)
    m = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return lambda v: tuple(sum(m[r][c] * v[c] for c in range(3)) for r in range(3))


def placed(shape, rng, spread, sizes):
    turn = turned(rng)
    size = [rng.uniform(*sizes) for _ in range(3)]
    to = [rng.uniform(-spread, spread) for _ in range(3)]
    return shape.moved(lambda v: tuple(c + t for c, t in zip(turn([v[a] * size[a] for a in range(3)]), to)))


def primitive(rng):
    return rng.choice((lambda: box(), lambda: sphere(), lambda: cylinder(rng), lambda: torus(rng)))()


def union(rng):
    shape = Shape()
    for _ in range(rng.randint(2, 8)):
        part = placed(primitive(rng), rng, 1.2, (0.2, 1))
        shape.add(part.vertices, part.faces)
    return shape


def pieces(rng):
    shape = Shape()
    for _ in range(rng.randint(2, 12)):
        part = placed(primitive(rng), rng, 8, (0.2, 1))
        shape.add(part.vertices, part.faces)
    return shape


def sheet(rng):
    n, height, waves = rng.randint(1, 24), rng.choice((0, 0.01, 0.3)), rng.uniform(0, 9)
    grid = [(i / n, j / n, height * math.sin(waves * i / n) * math.cos(waves * j / n)) for i in range(n + 1)
            for j in range(n + 1)]
    return Shape().add(grid, [(a, a + 1, a + n + 2, a + n + 1) for i in range(n) for j in range(n)
                              for a in [i * (n + 1) + j]])


def needle(rng):
    thin = 10 ** rng.uniform(-5, -1)
    return placed(primitive(rng), rng, 0, (1, 1)).moved(lambda v: (v[0], thin * v[1], thin * v[2]))


def shells(rng):
    shape = Shape()
    for k in range(rng.randint(2, 4)):
        size = 1 - rng.choice((0, 1e-7, 0.01, 0.2)) * k  # 0: doubled
        part = sphere().moved(lambda v, size=size: tuple(size * c for c in v))
        faces = part.faces if rng.random() < 0.7 else [face[::-1] for face in part.faces]
        shape.add(part.vertices, faces)
    return shape


def lattice(rng):
    n, thick = rng.randint(1, 3), rng.uniform(0.03, 0.2)
    shape = Shape()
    for axis in range(3):
        for i in range(n + 1):
            for j in range(n + 1):
                size, to = [thick] * 3, [0, 0, 0]
                size[axis] = n / 2 + thick
                to[axis], to[(axis + 1) % 3], to[(axis + 2) % 3] = n / 2, i, j
                bar = box(size).moved(lambda v, to=to: tuple(c + t for c, t in zip(v, to)))
                shape.add(bar.vertices, bar.faces)
    return shape


def soup(rng):
    shape = Shape()
    spread = rng.choice((0.02, 0.3, 1))
    for _ in range(rng.choice((1, 3, 30, 300))):
        middle = [rng.uniform(-1, 1) for _ in range(3)]
        shape.add([[c + rng.uniform(-spread, spread) for c in middle] for _ in range(3)], [(0, 1, 2)])
    return shape


def opened(rng):
    profile = rng.choice((arc(1, 0, 1.57, 10), [(0.5, z / 4) for z in range(12)],
                          [(0.001, 0), (0.7, 0.1), (1, 1), (0.6, 2), (0.7, 2.2), (0.6, 2.2), (0.5, 2), (0.9, 1), (0.6, 0.2),
                           (0.001, 0.2)], [(0.8, 0), (0.8, 2), (0.7, 2), (0.7, 0), (0.8, 0)]))
    noise = rng.choice((0, 0, 0.02))
    return lathe(profile, 24).moved(lambda v: tuple(c + rng.uniform(-noise, noise) for c in v))


def specked(rng):
    shape = primitive(rng)
    for _ in range(rng.randint(1, 4)):
        far = 10 ** rng.uniform(1, 6)
        at = [rng.uniform(-far, far) for _ in range(3)]
        shape.add([at, [at[0] + 0.01, at[1], at[2]], [at[0], at[1] + 0.01, at[2]]], [(0, 1, 2)])
    return shape


def dirty(rng):
    """Faces turned, left out, doubled, without extent; loose vertices."""
    shape = union(rng)
    faces = []
    for face in shape.faces:
        kind = rng.random()
        if kind < 0.05:
            continue
        faces.append(face[::-1] if kind < 0.15 else (face[0],) * 2 + face[2:] if kind < 0.2 else face)
        if kind > 0.95:
            faces.append(face)
    shape.faces = faces or shape.faces
    shape.vertices.append((0.5, 0.5, 0.5))
    return shape


FAMILIES = {f.__name__: f for f in (union, pieces, sheet, needle, shells, lattice, soup, opened, specked, dirty)}


def synthetic(rng, family):
    """A model, and what was done with its size and place."""
    shape = FAMILIES[family](rng)
    size = 10 ** rng.choice((0, 0, 0, rng.uniform(-6, 6)))
    shift = rng.choice((0, 0, 0, 10 ** rng.uniform(0, 5)))
    turn = rng.choice((turned(rng), lambda v: v))
    return shape.moved(turn).moved(lambda v: tuple(size * (c + shift) for c in v))


def write_obj(path, shape):
    lines = ["v %.17g %.17g %.17g" % tuple(v) for v in shape.vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in shape.faces]
    path.write_text("\n".join(lines) + "\n")


# ---- Runs

def options_for(rng, is_short):
    """Words for generate, and what check must be told."""
    budget = rng.choice((8, 12, 20, 40) if is_short else (8, 12, 20, 50, 50, 100, 100, 200, 400))
    words = ["--method", rng.choice(("envelope", "envelope", "envelope", "boxes", "boxes-improved"))]
    judged = ["--allow-pieces"] if rng.random() < 0.15 else []
    if judged:
        words += ["--pieces", "apart"]
    for chance, extra in ((0.3, ["--quads"]), (0.3, ["--symmetry", rng.choice(("off", "x", "y", "z"))]),
                          (0.2, ["--clearance", rng.choice(("0.01%", "1%", "5%"))]), (0.1, ["--solid"]),
                          (0.1, ["--closing", "3%"]), (0.1, ["--faces", str(2 * budget)])):
        if rng.random() < chance:
            words += extra
    if rng.random() < 0.15:
        words += ["--ignore-specks"]
        judged += ["--ignore-specks"]
    if rng.random() < 0.1:
        words += ["--max-gap", rng.choice(("2%", "8%"))]
    if is_short:
        words += ["--rounds", "1", "--envelope-resolution", "24", "--resolution", "24", "--depth", "3"]
    return budget, ["--vertices", str(budget), *words], judged


def is_finite(value):
    if isinstance(value, dict):
        return all(map(is_finite, value.values()))
    if isinstance(value, list):
        return all(map(is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def posed(cage, out):
    """The cage with a quarter of its vertices moved by a tenth of its size."""
    lines = cage.read_text().splitlines()
    points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    size = math.dist([min(c) for c in zip(*points)], [max(c) for c in zip(*points)])
    moved = iter([(p[0] + size / 10 if 4 * k < len(points) else p[0], p[1], p[2]) for k, p in enumerate(points)])
    out.write_text("\n".join("v %.17g %.17g %.17g" % next(moved) if line.startswith("v ") else line for line in lines))


class Trial:
    """One model with one choice of options."""

    def __init__(self, program, model, rng, limits, is_short, folder):
        self.program, self.model, self.limits, self.folder = program, model, limits, folder
        self.budget, self.words, self.judged = options_for(rng, is_short)
        self.outcome, self.faults = "", []
        self.seconds, self.memory, self.reason, self.figures = 0.0, 0, "", {}

    def command(self):
        return ["generate", str(self.model), "-o", str(self.folder / "cage.obj"), *self.words]

    def fault(self, kind, text):
        self.faults.append((kind, text.strip().splitlines()[-1] if text.strip() else ""))

    def call(self, name, command):
        ran = limited_run([self.program, *command, *self.limits_of(name)], self.limits[0] + GRACE)
        if ran.code is None:
            self.fault("hang", f"{name}: still there after {self.limits[0] + GRACE} s")
        elif ran.code < 0 or ran.code > 4:
            self.fault("crash", f"{name}: exit code {ran.code}: {ran.said}")
        return ran

    def limits_of(self, _name):
        return ["--time-limit", f"{self.limits[0]}s", "--memory-limit", f"{self.limits[1]}M"]

    def go(self):
        report = self.folder / "report.json"
        code, said, self.seconds, _, self.memory = self.call("generate", [*self.command(), "--json", report])
        if self.faults:
            self.outcome = "fault"
        elif not (self.folder / "cage.obj").exists():
            self.refused(code, said, report)
        else:
            self.made(code, json.loads(report.read_text()))
        return self

    def refused(self, code, said, report):
        told = json.loads(report.read_text()) if report.exists() else {}
        self.reason = told.get("error", told).get("code", "") or f"exit code {code}"
        self.outcome = "limit" if code == 4 else "refused"
        if self.model.name not in said and code != 4:
            self.fault("mute", said)

    def made(self, code, report):
        cage = self.folder / "cage.obj"
        self.outcome = "as asked" if code == 0 else "not as asked"
        self.figures = report["cage"]
        vertices = self.figures["vertices"]
        if code == 0 and report["method"] != "boxes" and vertices > self.budget:
            self.fault("budget", f"{vertices} vertices instead of {self.budget}, and exit code 0")
        if code == 3:
            self.reason = report["remarks"][0]["reason"]
        kept = report["budget"]["clearance"]
        # Of a solid cage the model is another one, with another box.
        if report["method"] != "boxes" and "--solid" not in self.words and self.figures["clearance"] < 0.999 * kept:
            self.fault("clearance", f"{self.figures['clearance']} of {kept}")
        if not is_finite(report):
            self.fault("figures", "not finite")
        verdict, said, *_ = self.call("check", ["check", self.model, cage, "--allow-pieces", *self.judged])
        if verdict == 1:
            self.fault("invalid", said)
        elif verdict not in (0, 4):
            self.fault("mute", "check: " + said)
        posed(cage, self.folder / "posed.obj")
        self.call("bind", ["bind", self.model, cage, "-o", self.folder / "w.npz"])
        code, said, *_ = self.call("deform", ["deform", self.model, cage, self.folder / "posed.obj", "-o",
                                                self.folder / "moved.obj"])
        moved = self.folder / "moved.obj"
        if code == 0 and ("nan" in moved.read_text() or "inf" in moved.read_text()):
            self.fault("figures", "deform: not finite")


# ---- The table

def percent(part, whole):
    return f"{100 * part / whole:.0f} %" if whole else "-"


def row(name, trials):
    made = [t for t in trials if t.outcome in ("as asked", "not as asked")]
    seconds = sorted(t.seconds for t in trials)
    reasons = collections.Counter(t.reason for t in trials if t.outcome in ("refused", "limit", "not as asked"))
    return "| {} | {} | {} | {} | {} | {} | {:.2f} | {:.1f} | {:.0f} | {} |".format(
        name, len(trials), len(made), sum(t.outcome == "refused" for t in trials),
        percent(sum(t.outcome == "as asked" for t in made), len(made)), sum(len(t.faults) for t in trials),
        statistics.median(seconds), seconds[-1], max(t.memory for t in trials) / 1e6,
        ", ".join(f"{reason} {count}" for reason, count in reasons.most_common()) or "-")


def table(groups):
    lines = ["| models | runs | valid cages | refused | as asked | faults | median s | most s | most MB | why not |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|---|"]
    lines += [row(name, trials) for name, trials in groups.items() if trials]
    everything = [trial for trials in groups.values() for trial in trials]
    return "\n".join([*lines, row("**all**", everything)]) + "\n"


def renew(path, text):
    """Puts the table between the marks of a page."""
    page = path.read_text()
    begin, end = "<!-- table: ./dev campaign -->\n", "<!-- end of table -->"
    head, rest = page.split(begin)
    path.write_text(head + begin + text + end + rest.split(end)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--models", nargs="*", default=[], type=pathlib.Path)
    parser.add_argument("--count", type=int, default=1000, help="runs")
    parser.add_argument("--minutes", type=float, default=1e9, help="begin no run after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--time-limit", type=int, default=120, help="of each program, in seconds")
    parser.add_argument("--memory-limit", type=int, default=4000, help="of each program, in MB")
    parser.add_argument("--short", action="store_true", help="small budgets and coarse grids")
    parser.add_argument("--table", type=pathlib.Path, help="a page whose table is renewed")
    parser.add_argument("--keep", type=pathlib.Path)
    given = parser.parse_args()
    program = given.program.resolve()
    files = sorted(p for folder in given.models if folder.exists() for p in folder.iterdir() if p.suffix in FORMATS)
    groups = collections.OrderedDict((name, []) for name in [*FAMILIES, "files"])
    kinds = [*FAMILIES, *(["files"] * (2 if files else 0))]
    begin = time.monotonic()
    for number in range(given.count):
        if time.monotonic() - begin > 60 * given.minutes:
            break
        rng = random.Random(f"{given.seed}/{number}")
        kind = kinds[number % len(kinds)]
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            if kind == "files":
                model = rng.choice(files)
            else:
                model = folder / f"{kind}_{number}.obj"
                write_obj(model, synthetic(rng, kind))
            trial = Trial(program, model, rng, (given.time_limit, given.memory_limit), given.short, folder)
            groups[kind].append(trial.go())
            for fault, text in trial.faults:
                print(f"{fault}: {number}: {shlex.join(trial.command())}: {text}", flush=True)
            if trial.faults and given.keep:
                given.keep.mkdir(parents=True, exist_ok=True)
                (given.keep / model.name).write_bytes(model.read_bytes())
    print(table(groups))
    if given.table:
        renew(given.table, table(groups))
    return 1 if any(trial.faults for trials in groups.values() for trial in trials) else 0


if __name__ == "__main__":
    sys.exit(main())
