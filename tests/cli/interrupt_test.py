"""Ctrl-C at any moment of any command: exit code 130, and nothing is left half made.

    interrupt_test.py PROGRAM SUITE [--moments N] [--seed N] [--rings N]

By hand, with larger models (--rings 60) and many moments, it also tells how long the program took to end.
"""
import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

DONE, INTERRUPTED = 0, 130
arguments = None


def sphere(path, rings, scale=1.0, squeeze=0.0):
    """A sphere of about 2 rings^2 quads, as OBJ."""
    import math
    around = 2 * rings
    lines = [f"v 0 0 {scale}", f"v 0 0 {-scale}"]
    for i in range(1, rings):
        z, r = math.cos(math.pi * i / rings), math.sin(math.pi * i / rings)
        for j in range(around):
            a = 2 * math.pi * j / around
            lines.append(f"v {scale * r * math.cos(a) * (1 + squeeze * z)} {scale * r * math.sin(a)} {scale * z}")
    at = lambda i, j: 3 + (i - 1) * around + j % around
    for j in range(around):
        lines.append(f"f 1 {at(1, j)} {at(1, j + 1)}")
        lines.append(f"f 2 {at(rings - 1, j + 1)} {at(rings - 1, j)}")
        for i in range(1, rings - 1):
            lines.append(f"f {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}")
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.input = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.input.cleanup)
        folder = pathlib.Path(cls.input.name)
        cls.model = folder / "model.obj"
        sphere(cls.model, arguments.rings)
        cls.cage, cls.large = folder / "cage.obj", folder / "large.obj"
        subprocess.run([arguments.program, "-q", "generate", cls.model, "-o", cls.cage, "--vertices", "40",
                        "--rounds", "1"], check=True)
        sphere(cls.large, 5 * arguments.rings)
        for k in range(6):
            text = cls.cage.read_text().splitlines()
            (folder / f"pose_{k}.obj").write_text("\n".join(
                f"v {float(l.split()[1]) * (1 + 0.05 * k)} {l.split()[2]} {l.split()[3]}" if l.startswith("v ") else l
                for l in text) + "\n")
        cls.poses = [str(folder / f"pose_{k}.obj") for k in range(6)]

    def interrupted(self, *words, outputs):
        """Runs it to the end, and then again and again up to some moment."""
        command = [arguments.program, *map(str, words)]
        with tempfile.TemporaryDirectory() as whole:
            begin = time.monotonic()
            subprocess.run(command, cwd=whole, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            length = time.monotonic() - begin
            made = {name: (pathlib.Path(whole) / name).stat().st_size for name in outputs}
            self.assertEqual(sorted(os.listdir(whole)), sorted(outputs))
        chance = random.Random(arguments.seed)
        slowest = 0
        for _ in range(arguments.moments):
            moment = chance.uniform(0.02, 1) * length
            with tempfile.TemporaryDirectory() as folder:
                process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                time.sleep(moment)
                process.send_signal(signal.SIGINT)
                begin = time.monotonic()
                errors = process.communicate()[1].decode()
                slowest = max(slowest, time.monotonic() - begin)
                told = f"{words[0]} after {moment:.3f} of {length:.3f} s: {errors}"
                # One that comes before main() ends the program as the system does: for a shell that is 130, too.
                self.assertIn(process.returncode, (INTERRUPTED, DONE, -signal.SIGINT), told)
                if process.returncode == INTERRUPTED:
                    self.assertEqual(errors.count("cancelled"), 1, told)
                for name in os.listdir(folder):
                    self.assertIn(name, made, told)
                    if not name.endswith(".json"):  # has times in it
                        self.assertEqual((pathlib.Path(folder) / name).stat().st_size, made[name], told)
        print(f"{words[0]}: {length:.2f} s, ended within {slowest:.3f} s of the signal", file=sys.stderr)


class Generate(Commands):
    def test_triangles(self):
        self.interrupted("generate", self.model, "-o", "cage.obj", "--vertices", "20", "--rounds", "1",
                         outputs=["cage.obj"])

    def test_quads(self):
        self.interrupted("generate", self.model, "-o", "cage.obj", "--faces", "24", "--quads", "--rounds", "1",
                         "--json", "cage.json", outputs=["cage.obj", "cage.json"])

    def test_boxes(self):
        self.interrupted("generate", self.model, "-o", "cage.obj", "--method", "boxes", outputs=["cage.obj"])

    def test_a_large_model(self):
        self.interrupted("generate", self.large, "-o", "cage.obj", "--vertices", "20", "--rounds", "1",
                         outputs=["cage.obj"])


class Others(Commands):
    def test_check(self):
        self.interrupted("check", self.model, self.cage, "--json", "check.json", outputs=["check.json"])

    def test_compare(self):
        self.interrupted("compare", self.model, self.cage, "--json", "compared.json", outputs=["compared.json"])

    def test_info(self):
        self.interrupted("info", self.model, "--json", "info.json", outputs=["info.json"])

    def test_convert(self):
        self.interrupted("convert", self.large, "large.ply", outputs=["large.ply"])

    def test_bind(self):
        self.interrupted("bind", self.model, self.cage, "-o", "weights.npz", outputs=["weights.npz"])

    def test_bind_as_text(self):
        self.interrupted("bind", self.model, self.cage, "-o", "weights.csv", outputs=["weights.csv"])

    def test_deform_a_sequence(self):
        self.interrupted("deform", self.model, self.cage, *self.poses, "-o", "moved_*.obj",
                         outputs=[f"moved_pose_{k}.obj" for k in range(6)])

    def test_render(self):
        if "render" not in subprocess.run([arguments.program, "--help"], capture_output=True, text=True).stdout:
            self.skipTest("built without render")
        self.interrupted("render", self.large, self.cage, "-o", "picture.png", "--size", "640x480",
                         outputs=["picture.png"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("suite")
    parser.add_argument("--moments", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rings", type=int, default=16)
    arguments = parser.parse_args()
    unittest.main(argv=[sys.argv[0], arguments.suite])
