"""Builds the shared library with CMake and puts it into the package. All else stands in pyproject.toml.

CAGEWRIGHT_LIBRARY=/path/to/libcagewright.so takes a library that was built before.
"""

import os
import pathlib
import re
import shutil
import subprocess

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

ROOT = pathlib.Path(__file__).resolve().parent


def built_library():
    given = os.environ.get("CAGEWRIGHT_LIBRARY")
    if given:
        return pathlib.Path(given).resolve()
    subprocess.run(["cmake", "--preset", "library"], cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", "--preset", "library", "--target", "cagewright_c"], cwd=ROOT, check=True)
    return (ROOT / "build" / "library" / "c" / "libcagewright.so").resolve()


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        package = pathlib.Path(self.build_lib) / "cagewright"
        if not self.editable_mode:  # an editable package finds the library beside its sources
            shutil.copy2(built_library(), package / "libcagewright.so")
        else:
            shutil.copy2(built_library(), ROOT / "python" / "cagewright" / "libcagewright.so")


class WheelOfAnyPython(bdist_wheel):
    """The library is for one machine, but for every version of Python: it is loaded, not linked."""

    def get_tag(self):
        return ("py3", "none", super().get_tag()[2])


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True


setup(version=re.search(r"project\(cagewright VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1),
      cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelOfAnyPython}, distclass=WithLibrary)
