"""pip builds a wheel of the package and installs it, without the network; it then works by itself.

pip_test.py SOURCE LIBRARY
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, LIBRARY = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
missing = [name for name in ("numpy", "pip", "setuptools", "wheel", "venv") if importlib.util.find_spec(name) is None]
if missing:
    print(f"skipped: {', '.join(missing)} not installed (Debian: python3-numpy, python3-pip, python3-setuptools, "
          "python3-wheel, python3-venv)")
    sys.exit(77)

TRIAL = """
import numpy as np, cagewright
V = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
F = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
C, G = cagewright.generate(V, F, num_vertices=8, envelope_resolution=8, rounds=1)
assert cagewright.check(V, F, C, G)
print(cagewright.__file__)
"""


class Pip(unittest.TestCase):
    def test_wheel(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            source = folder / "source"  # what pip leaves behind shall not lie in the repository
            source.mkdir()
            for item in ("pyproject.toml", "setup.py", "CMakeLists.txt", "README.md", "LICENSE", "docs", "python"):
                whole = SOURCE / item
                (shutil.copytree if whole.is_dir() else shutil.copy)(whole, source / item)
            environment = {**os.environ, "CAGEWRIGHT_LIBRARY": str(LIBRARY), "PIP_NO_INDEX": "1",
                           "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
            environment.pop("PYTHONPATH", None)

            def run(*words):
                done = subprocess.run([str(word) for word in words], cwd=folder, env=environment, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.assertEqual(done.returncode, 0, done.stdout)
                return done.stdout

            run(sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "-w", folder, source)
            wheel, = folder.glob("*.whl")
            self.assertRegex(wheel.name, r"^cagewright-\d+\.\d+\.\d+-py3-none-linux_\w+\.whl$")
            run(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", folder / "env")
            python = folder / "env" / "bin" / "python"
            run(python, "-m", "pip", "install", wheel)
            self.assertIn(str(folder / "env"), run(python, "-c", TRIAL))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
