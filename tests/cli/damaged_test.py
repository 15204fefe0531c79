"""Files of each format, damaged alike each time: no crash, no hang, nothing said that is not so (tools/mutate.py).

Called as: damaged_test.py PROGRAM MUTATE [COUNT]

The model is a small torus with texture points, normals and colours, converted to every format by the program.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, MUTATE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
COUNT = sys.argv[3] if len(sys.argv) > 3 else "4"
FORMATS = ["obj", "ply", "stl", "off", "glb", "gltf"]
ROUND, ACROSS = 8, 5


def torus(thickness):
    """A ring of quads as OBJ, dressed."""
    lines = ["mtllib none.mtl", "o ring"]
    for i in range(ROUND):
        for k in range(ACROSS):
            a, b = 2 * math.pi * i / ROUND, 2 * math.pi * k / ACROSS
            n = (math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), math.sin(b))
            p = (math.cos(a) + thickness * n[0], math.sin(a) + thickness * n[1], thickness * n[2])
            lines += ["v {:.6f} {:.6f} {:.6f} {:.3f} {:.3f} 0.5".format(*p, i / ROUND, k / ACROSS),
                      "vt {:.3f} {:.3f}".format(i / ROUND, k / ACROSS), "vn {:.6f} {:.6f} {:.6f}".format(*n)]
    lines.append("usemtl skin")
    for i in range(ROUND):
        for k in range(ACROSS):
            corners = [i * ACROSS + k, (i + 1) % ROUND * ACROSS + k, (i + 1) % ROUND * ACROSS + (k + 1) % ACROSS,
                       i * ACROSS + (k + 1) % ACROSS]
            lines.append("f " + " ".join("{0}/{0}/{0}".format(v + 1) for v in corners))
    return "\n".join(lines) + "\n"


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "ring.obj").write_text(torus(0.3))
        (folder / "cage.obj").write_text(torus(0.5))
        for extension in FORMATS[1:]:
            subprocess.run([PROGRAM, "convert", folder / "ring.obj", folder / f"ring.{extension}", "-q"], check=True,
                           stderr=subprocess.DEVNULL)
        models = [folder / f"ring.{extension}" for extension in FORMATS]
        return subprocess.run([sys.executable, MUTATE, PROGRAM, folder / "cage.obj", *models, "--count", COUNT], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
