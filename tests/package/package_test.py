"""The installed library as its users meet it: headers alone, examples, components, pkg-config, as a
part of another project.

package_test.py BUILD SOURCE CXX [SUITE]
"""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

BUILD, SOURCE, CXX = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
WORK = BUILD / "package_test"
PREFIX = WORK / "prefix"
EIGEN = ["-isystem", "/usr/include/eigen3"]
SAMPLE = SOURCE / "samples" / "creature.obj"


def run(*command, expect=0, cwd=None):
    done = subprocess.run([str(c) for c in command], cwd=cwd, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    if done.returncode != expect:
        raise AssertionError(f"{' '.join(map(str, command))}\nexit code {done.returncode}, not {expect}\n{done.stdout}")
    return done.stdout


def configure(source, name, *arguments, expect=0):
    return run("cmake", "-S", source, "-B", WORK / name, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={CXX}",
               f"-DCMAKE_PREFIX_PATH={PREFIX}", *arguments, expect=expect)


def project(name, text, **files):
    folder = WORK / (name + "_source")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "CMakeLists.txt").write_text(text)
    for file, content in files.items():
        (folder / f"{file}.cpp").write_text(content)
    return folder


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        run("cmake", "--install", BUILD, "--prefix", PREFIX)
        cls.is_release = "CMAKE_BUILD_TYPE:STRING=Release" in (BUILD / "CMakeCache.txt").read_text()

    def test_every_installed_header_compiles_alone(self):
        headers = sorted(PREFIX.rglob("*.h"))
        self.assertGreater(len(headers), 20)
        for header in headers:
            name = header.relative_to(PREFIX / "include")
            self.assertEqual(name.parts[0], "cagewright")
            with self.subTest(header=str(name)):
                subprocess.run([CXX, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++",
                                "-isystem", PREFIX / "include", *EIGEN, "-"],
                               input=f"#include <{name}>\nint main() {{}}\n", text=True, check=True)

    def test_a_header_of_the_users_own_hides_none_of_ours(self):
        own = WORK / "own" / "core"
        own.mkdir(parents=True, exist_ok=True)
        (own / "result.h").write_text("#error of the user\n")
        subprocess.run([CXX, "-std=c++20", "-fsyntax-only", "-x", "c++", f"-I{own.parent}",
                        f"-I{PREFIX / 'include'}", *EIGEN, "-"],
                       input="#include <cagewright/cagewright.h>\nint main() {}\n", text=True, check=True)

    def test_names_no_path_of_this_system(self):
        for file in [*PREFIX.rglob("*.cmake"), *PREFIX.rglob("*.pc")]:
            text = file.read_text()
            for path in ["/usr/", str(SOURCE), str(BUILD)]:
                self.assertNotIn(path, text, file)

    def test_licences_are_installed(self):
        names = {path.name for path in PREFIX.rglob("*")}
        self.assertLessEqual({"LICENSE", "MIT.txt", "GPL-3.0-or-later.txt", "version.h"}, names)

    def test_examples(self):
        configure(SOURCE / "examples", "examples", "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", WORK / "examples")
        programs, cage = WORK / "examples", WORK / "cage.obj"
        cagewright = PREFIX / "bin" / "cagewright"
        self.assertIn("a valid cage", run(programs / "make_cage", SAMPLE, cage))
        run(cagewright, "check", SAMPLE, cage)
        run(programs / "bind_and_deform", SAMPLE, cage, WORK / "moved.obj")
        self.assertTrue((WORK / "moved.obj").stat().st_size > 0)
        self.assertRegex(run(programs / "own_coordinates"), r": 15 degrees\n.*: 14 degrees")
        with_boxes = re.search(r"^features:.*\bboxes\b", run(cagewright, "--version"), re.M) is not None
        boxes = run(programs / "boxes", SAMPLE, WORK / "boxes.obj", expect=0 if with_boxes else 3)
        if with_boxes:
            self.assertIn("center", boxes)
            run(cagewright, "check", SAMPLE, WORK / "boxes.obj")
        for program, rest in [("make_cage", [cage]), ("bind_and_deform", [cage, cage]), ("boxes", [cage])]:
            said = run(programs / program, WORK / "missing.obj", *rest, expect=2)
            self.assertIn("missing.obj", said)

    def test_the_example_of_the_readme_is_a_file(self):
        blocks = re.findall(r"```cpp\n(.*?)```", (SOURCE / "README.md").read_text(), re.S)
        self.assertIn((SOURCE / "examples" / "make_cage.cpp").read_text(), blocks)

    def test_a_user_of_coordinates_needs_nothing_of_the_rest(self):
        source = project("components", """
cmake_minimum_required(VERSION 3.24)
project(user LANGUAGES CXX)
foreach(package PNG PkgConfig CGAL GMP MPFR Qt6 nlohmann_json)
  set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON)
endforeach()
find_package(cagewright REQUIRED COMPONENTS coordinates deform)
add_executable(user user.cpp)
target_link_libraries(user PRIVATE cagewright::coordinates cagewright::deform)
foreach(module render cage)
  if(TARGET cagewright::${module})
    message(FATAL_ERROR "${module} was not asked for")
  endif()
endforeach()
""", user=(SOURCE / "examples" / "own_coordinates.cpp").read_text())
        configure(source, "components")
        run("cmake", "--build", WORK / "components")
        self.assertIn("15 degrees", run(WORK / "components" / "user"))
        needs = run("readelf", "-d", WORK / "components" / "user")
        for library in ["gmp", "mpfr", "png", "epoxy"]:
            self.assertNotIn(f"lib{library}", needs)

    def test_says_which_component_is_missing(self):
        source = project("missing", """
cmake_minimum_required(VERSION 3.24)
project(user LANGUAGES CXX)
find_package(cagewright REQUIRED COMPONENTS teapots)
""")
        self.assertRegex(configure(source, "missing", expect=1), r"there\s+is\s+no\s+component\s+teapots")

    def test_pkg_config(self):
        path = next(PREFIX.rglob("cagewright.pc")).parent
        flags = run("env", f"PKG_CONFIG_PATH={path}", "pkg-config", "--cflags", "--libs", "cagewright").split()
        program = WORK / "by_pkg_config"
        run(CXX, "-std=c++20", SOURCE / "examples" / "make_cage.cpp", "-o", program, *flags)
        run(program, SAMPLE, WORK / "pc.obj")

    def test_a_part_of_another_project(self):
        source = project("parent", f"""
cmake_minimum_required(VERSION 3.24)
project(parent LANGUAGES CXX)
add_subdirectory({SOURCE} cagewright)
add_executable(user user.cpp)
target_link_libraries(user PRIVATE cagewright::coordinates)
if(CMAKE_BUILD_TYPE OR TARGET cagewright_render OR TARGET cagewright-app OR BUILD_TESTING)
  message(FATAL_ERROR "a setting of the parent's was changed, or something built that nobody asked for")
endif()
""", user=(SOURCE / "examples" / "own_coordinates.cpp").read_text())
        configure(source, "parent")
        self.assertIn("CMAKE_BUILD_TYPE:STRING=\n", (WORK / "parent" / "CMakeCache.txt").read_text())
        run("cmake", "--build", WORK / "parent", "--target", "user")
        self.assertIn("15 degrees", run(WORK / "parent" / "user"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
