#!/usr/bin/env python3
"""Makes docs/gallery.md: for every model a picture of its cages of 50, 100, 200 and 400 vertices,
and their figures by `cagewright compare`.

  gallery.py --program build/release/cli/cagewright [--models DIR ...] [--output docs/gallery.md]

Models are taken from the folder that CAGEWRIGHT_MODELS names (Debian's libcgal-demo) and from those
given. Where a folder has NAME.obj and NAME_cage.obj, a cage made by hand, ours of as many vertices
is compared with it. No model or cage is kept: only pictures and figures.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

BUDGETS = (50, 100, 200, 400)
# Of the package, those that people would deform. The view: yaw and pitch in degrees; z: its up axis.
PACKAGED = {
    "armadillo": ("145:10", "y"), "camel": ("-35:12", "y"), "cow": ("-35:12", "y"), "dino": ("-35:12", "z"),
    "elephant": ("-35:12", "y"), "fandisk": ("-35:20", "y"), "hand": ("-35:12", "y"), "homer": ("20:8", "y"),
    "man": ("-25:10", "y"), "triceratops": ("-35:12", "y"), "turbine": ("-35:20", "y"), "knot1": ("-35:30", "y"),
}
SIZE = 300


class Gallery:
    def __init__(self, program, images, work):
        self.program, self.images, self.work = program, images, work

    def run(self, *arguments):
        return subprocess.run([str(self.program), *map(str, arguments)], capture_output=True, text=True, check=False)

    def cage(self, model, name, *options):
        path = self.work / name
        made = self.run("generate", model, "-o", path, *options)
        if made.returncode != 0:
            print(f"{model.name}: {name}: {made.stderr.strip()}", file=sys.stderr)
        if made.returncode not in (0, 3):  # 3: a valid cage, though not as asked for
            return None
        return path

    def sheet(self, model, cages, name, view, up):
        """One picture of all cages side by side."""
        target = self.work / "sheet.png"
        for index, cage in enumerate(cages):
            beside = ["--beside", target] if index else []
            drawn = self.run("render", model, cage, "-o", self.work / "next.png", "--view", view, "--up", up, "--size",
                             f"{SIZE}x{SIZE}", "--background", "white", "--vertex-radius", 1.6, "--edge-width", 1.1, *beside)
            if drawn.returncode != 0:
                sys.exit(f"{model.name}: {drawn.stderr.strip()}")
            (self.work / "next.png").replace(target)
        target.replace(self.images / name)
        return name

    def compare(self, model, cages):
        path = self.work / "compare.json"
        done = self.run("compare", model, *cages, "--json", path)
        if done.returncode != 0:
            sys.exit(f"{model.name}: {done.stderr.strip()}")
        return json.loads(path.read_text())["cages"]


HEAD = ["| cage | valid | vertices | faces | quads | volume ratio | mean gap % | max gap % | 2r/R least | 5 % | valence | bend % | twist % |",
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]


def row(title, c):
    poses = c["poses"] or {"bend": {"mean_error": 0}, "twist": {"mean_error": 0}}
    cells = (title, "yes" if c["valid"] else "**no**", c["vertices"], c["faces"], c["quads"], f"{c['volume_ratio']:.3f}",
             f"{100 * c['mean_distance']:.2f}", f"{100 * c['max_distance']:.2f}", f"{c['min_quality']:.3f}", f"{c['low_quality']:.2f}",
             c["max_valence"], f"{100 * poses['bend']['mean_error']:.2f}", f"{100 * poses['twist']['mean_error']:.2f}")
    return "| " + " | ".join(map(str, cells)) + " |"


def chapter(gallery, model, view, up):
    """The lines for one model."""
    lines, rows = [f"## {model.stem}", ""], []
    for mode, options in (("triangles", []), ("quads", ["--quads"])):
        cages, titles = [], []
        for budget in BUDGETS:
            cage = gallery.cage(model, f"{mode}{budget}.obj", "--vertices", budget, *options)
            if cage:
                cages.append(cage)
                titles.append(f"{mode}, {budget}")
        if cages:
            name = gallery.sheet(model, cages, f"{model.stem}-{mode}.png", view, up)
            lines += [f"![{model.stem}: cages of {', '.join(t.split()[-1] for t in titles)} vertices, {mode}](images/gallery/{name})", ""]
            rows += [row(t, c) for t, c in zip(titles, gallery.compare(model, cages))]
    print(f"{model.stem}: {len(rows)} cages", file=sys.stderr, flush=True)
    return lines + HEAD + rows + [""] if rows else []


def by_hand(gallery, model, hand, view, up):
    """A cage made by hand against ours of as many vertices."""
    vertices = sum(line.startswith("v ") for line in hand.read_text().splitlines())
    clearances = (0.002, 0.01, 0.02)
    ours = [gallery.cage(model, f"ours{k}.obj", "--vertices", vertices, "--clearance", c) for k, c in enumerate(clearances)]
    cages = [hand] + [c for c in ours if c]
    name = gallery.sheet(model, cages, f"{model.stem}-by-hand.png", view, up)
    rows = [row(t, c) for t, c in zip(["by hand"] + [f"ours, clearance {c:g}" for c, o in zip(clearances, ours) if o],
                                      gallery.compare(model, cages))]
    print(f"{model.stem}: by hand", file=sys.stderr, flush=True)
    return [f"## {model.stem}, against a cage made by hand", "",
            f"From the left: the cage made by hand, and ours of as many vertices ({vertices}) at clearances of "
            + ", ".join(f"{c:g}" for c in clearances) + ".", "",
            f"![{model.stem}: by hand and ours](images/gallery/{name})", ""] + HEAD + rows + [""]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/cli/cagewright")
    parser.add_argument("--models", nargs="*", default=[], help="more folders or files of models")
    parser.add_argument("--only", nargs="*", help="only models of these names")
    parser.add_argument("--note", default="", help="a sentence for the end: where further models come from")
    parser.add_argument("--output", default="docs/gallery.md")
    arguments = parser.parse_args()
    output = pathlib.Path(arguments.output)
    images = output.parent / "images" / "gallery"
    images.mkdir(parents=True, exist_ok=True)

    packaged = pathlib.Path(os.environ.get("CAGEWRIGHT_MODELS", "/nonexistent"))
    models = [(packaged / f"{name}.off", *look) for name, look in PACKAGED.items() if (packaged / f"{name}.off").exists()]
    known = {m[0].stem for m in models}
    for given in map(pathlib.Path, arguments.models):
        for path in sorted(given.iterdir()) if given.is_dir() else [given]:
            if path.suffix in {".obj", ".off", ".ply", ".stl", ".glb"} and not path.stem.endswith("_cage") and path.stem not in known:
                models.append((path, *PACKAGED.get(path.stem, ("-35:12", "y"))))
    models = [m for m in models if not arguments.only or m[0].stem in arguments.only]

    lines = ["# Gallery", "", "Made by `./dev gallery`: cages of 50, 100, 200 and 400 vertices at the default clearance of 0.002, judged by",
             "`cagewright compare`. Gaps and errors are in % of the model's diagonal. Bend and twist: how far the model that follows",
             "its cage is from the model deformed directly, in the mean, in the standard poses of [budget.md](budget.md#comparing).", ""]
    end = ["## Where the models come from", "",
           "From Debian's package libcgal-demo (data/meshes), unless said here. None of them is part of this repository."
           + (" " + arguments.note if arguments.note else "")]
    with tempfile.TemporaryDirectory() as folder:
        gallery = Gallery(pathlib.Path(arguments.program).resolve(), images, pathlib.Path(folder))
        for model, view, up in models:
            hand = model.with_name(f"{model.stem}_cage.obj")
            if hand.exists():
                lines += by_hand(gallery, model, hand, view, up)
            lines += chapter(gallery, model, view, up)
            output.write_text("\n".join(lines + end) + "\n", encoding="utf-8")
    total = sum(p.stat().st_size for p in images.iterdir())
    print(f"{output}: {total / 1e6:.1f} MB of pictures")


if __name__ == "__main__":
    main()
