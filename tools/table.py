#!/usr/bin/env python3
"""Makes a cage of every model at every depth by both slicing rules, has each certified by
`cagewright check`, and writes the figures as a table in Markdown.

  table.py --program build/release/cli/cagewright [--models DIR ...] [--output docs/table.md]

Without --models: the bundled sample, and the folder that the environment variable
CAGEWRIGHT_MODELS names. Exits with 1 when a cage fails or is not certified, so it is also an acceptance test.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SUFFIXES = {".off", ".obj", ".ply", ".stl", ".glb", ".gltf"}
# Of the many small test files in the package these are models that people would deform.
PACKAGED = """armadillo bear bull bunny00 camel cheese couplingdown cow dino elephant
elephant-with-holes fandisk hand homer knot1 man mushroom pig turbine triceratops""".split()


def models_in(folders, everything):
    for folder in folders:
        for path in sorted(pathlib.Path(folder).iterdir()):
            packaged = (path.parent / "armadillo.off").exists() and (path.parent / "turbine.off").exists()
            if path.suffix.lower() in SUFFIXES and (everything or not packaged or path.stem in PACKAGED):
                yield path


def default_models():
    packaged = os.environ.get("CAGEWRIGHT_MODELS")
    return [str(pathlib.Path(__file__).parent.parent / "samples")] + ([packaged] if packaged else [])


def run(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)


def row(program, model, depth, rule, work):
    cage, figures = work / "cage.obj", work / "cage.json"
    made = run(program, "generate", model, "-o", cage, "--method", "boxes", "--depth", depth, "--slicing", rule, "--json", figures)
    if made.returncode != 0:
        return None, f"{model.name}, depth {depth}, {rule}: {made.stderr.strip()}"
    judged = run(program, "check", model, cage)
    if judged.returncode != 0:
        return None, f"{model.name}, depth {depth}, {rule}: not certified: {judged.stdout.strip()}"
    data = json.loads(figures.read_text())
    times = {t["stage"]: t["seconds"] for t in data["times"]}
    before = sum(s for stage, s in times.items() if stage not in ("union", "check"))
    return (model.name, rule, depth, len(data["boxes"]), data["cage"]["vertices"],
            f"{data['cage']['volume_ratio']:.3f}", f"{100 * data['cage']['mean_distance']:.2f}",
            f"{100 * data['cage']['max_distance']:.2f}", f"{100 * data['cage']['clearance']:.2f}",
            f"{before:.2f}", f"{times['union']:.2f}"), None


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/cli/cagewright")
    parser.add_argument("--models", nargs="+", default=default_models())
    parser.add_argument("--depths", nargs="+", type=int, default=[0, 1, 2, 3, 4, 5, 6])
    parser.add_argument("--rules", nargs="+", default=["volume", "published"])
    parser.add_argument("--all", action="store_true", help="also the package's small test files")
    parser.add_argument("--note", default="", help="a sentence about the machine, for the table")
    parser.add_argument("--output", default="docs/table.md")
    arguments = parser.parse_args()

    rows, failures = [], []
    with tempfile.TemporaryDirectory() as folder:
        for model in models_in(arguments.models, arguments.all):
            for rule in arguments.rules:
                for depth in arguments.depths:
                    cells, failure = row(arguments.program, model, depth, rule, pathlib.Path(folder))
                    if failure:
                        failures.append(failure)
                        print(failure, file=sys.stderr)
                    else:
                        rows.append(cells)
            print(f"{model.name}: {len(rows)} cages so far, {len(failures)} failures", file=sys.stderr)

    lines = ["# Cages from boxes: every model, depth and slicing rule", "",
             "Made by `./dev table`. Every cage below was certified by `cagewright check`. Gaps (mean",
             "and greatest distance from the cage to the model, and the clearance between them) are in",
             "percent of the diagonal of the model's bounding box; times are in seconds on two cores,",
             "up to the union and for the union itself. For open models the volume is an estimate.",
             arguments.note, "",
             "| model | slicing | depth | boxes | vertices | volume ratio | mean gap % | max gap % | clearance % | boxes s | union s |",
             "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    lines += ["| " + " | ".join(str(c) for c in cells) + " |" for cells in rows]
    if failures:
        lines += ["", "Not made:", ""] + [f"- {f}" for f in failures]
    pathlib.Path(arguments.output).write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{len(rows)} cages certified, {len(failures)} failures; see {arguments.output}")
    sys.exit(1 if failures or not rows else 0)


if __name__ == "__main__":
    main()
