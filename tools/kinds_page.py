#!/usr/bin/env python3
"""Makes docs/kinds.md: the same pose under every kind of coordinates, side by side.

  kinds_page.py --program build/release/cli/cagewright [--model samples/creature.obj] [--output docs/kinds.md]

Kinds are those that `cagewright coordinates` lists, so a new one appears by itself.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

TOOLS = pathlib.Path(__file__).resolve().parent
ACROSS = 3  # pictures in a row
BEND = 75  # degrees
SIZE = 380


def run(program, *arguments):
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):  # 3: a valid cage, though not as asked for
        sys.exit(f"{program} {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return done.stdout


def kinds_of(program):
    """Names with what each is, as the program tells."""
    lines = run(program, "coordinates").splitlines()
    return [line.split(": ", 1) for line in lines if line and not line.startswith(" ") and ": " in line]


def chapter(name):
    """Where docs/coordinates.md tells of a kind."""
    of_quads = name.startswith("quad_")
    return name.removeprefix("quad_").replace("_", "-") + ("-of-quads" if of_quads else "")


def draw(program, model, cage, picture):
    run(program, "render", model, cage, "-o", picture, "--view", "-35:12", "--size", f"{SIZE}x{SIZE}", "--background", "white",
        "--vertex-radius", 1.8, "--edge-width", 1.2, "--no-shadows")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--model", type=pathlib.Path, default=TOOLS.parent / "samples" / "creature.obj")
    parser.add_argument("--output", type=pathlib.Path, default=TOOLS.parent / "docs" / "kinds.md")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    images = arguments.output.parent / "images" / "kinds"
    images.mkdir(parents=True, exist_ok=True)

    cells = []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        cage, posed, moved = work / "cage.obj", work / "posed.obj", work / "moved.obj"
        run(program, "generate", arguments.model, "-o", cage, "--vertices", 60, "--quads")
        subprocess.run([sys.executable, str(TOOLS / "pose.py"), str(cage), str(posed), "--bend", str(BEND)], check=True)
        draw(program, arguments.model, cage, images / "rest.png")
        cells.append(("at rest", "the model in its cage", "rest.png"))
        for name, idea in kinds_of(program):
            run(program, "deform", arguments.model, cage, posed, "-o", moved, "--coordinates", name)
            draw(program, moved, posed, images / f"{name}.png")
            cells.append((f"[{name}](coordinates.md#{chapter(name)})", idea, f"{name}.png"))

    lines = ["# One pose, every kind of coordinates", "",
             f"The same cage of quads, its trunk bent by {BEND} degrees, and the model as it follows. Made by `tools/kinds_page.py`; what the kinds are is told in",
             "[coordinates](coordinates.md).", ""]
    for first in range(0, len(cells), ACROSS):
        row = cells[first:first + ACROSS]
        row += [("", "", "")] * (ACROSS - len(row))
        lines.append("| " + " | ".join(title for title, _, _ in row) + " |")
        lines.append("|" + ":-:|" * ACROSS)
        lines.append("| " + " | ".join(f"![{picture[:-4]}](images/kinds/{picture})" if picture else "" for _, _, picture in row) + " |")
        lines.append("| " + " | ".join(idea for _, idea, _ in row) + " |")
        lines.append("")
    arguments.output.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
