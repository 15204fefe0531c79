"""A program that was built with CAGEWRIGHT_WITH_BOXES=OFF: nothing of CGAL, GMP or MPFR in it, cages
from envelopes, and a plain answer to who asks for boxes.

no_boxes_test.py PROGRAM SAMPLES
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SAMPLE = sys.argv[1], pathlib.Path(sys.argv[2]) / "creature.obj"


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], text=True, capture_output=True)


class NoBoxes(unittest.TestCase):
    def test_has_nothing_under_the_gpl_in_it(self):
        needs = subprocess.run(["readelf", "-d", PROGRAM], text=True, capture_output=True, check=True).stdout
        symbols = subprocess.run(["nm", "-C", PROGRAM], text=True, capture_output=True, check=True).stdout
        for name in ["libgmp", "libmpfr"]:
            self.assertNotIn(name, needs)
        for name in ["CGAL", "__gmp", "mpfr_"]:
            self.assertNotIn(name, symbols)
        self.assertIn("MIT", run("--version").stdout)

    def test_makes_cages_of_envelopes(self):
        with tempfile.TemporaryDirectory() as folder:
            cage = pathlib.Path(folder) / "cage.obj"
            for more in [[], ["--quads"], ["--pieces", "apart", "--vertices", "60"]]:
                made = run("generate", SAMPLE, "-o", cage, *more)
                self.assertEqual(made.returncode, 0, made.stderr)
                self.assertEqual(run("check", SAMPLE, cage).returncode, 0)

    def test_says_what_boxes_would_need(self):
        with tempfile.TemporaryDirectory() as folder:
            for asked in [["--method", "boxes"], ["--method", "boxes-improved"], ["--depth", "3"]]:
                cage = pathlib.Path(folder) / "cage.obj"
                refused = run("generate", SAMPLE, "-o", cage, *asked)
                self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
                self.assertIn("CGAL", refused.stderr)
                self.assertIn("CAGEWRIGHT_WITH_BOXES", refused.stderr)
                self.assertFalse(cage.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
