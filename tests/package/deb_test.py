"""The Debian packages as their users meet them: what they hold and depend on; and, installed into a fresh Debian, the
program, the Python package and the application work.

deb_test.py FOLDER_OF_PACKAGES ROOT

ROOT is where debootstrap makes a bare Debian once; each run works in a copy. Skipped (exit code 77) where that cannot be
done: without root, debootstrap or network.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

PACKAGES, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
MIRROR = "http://deb.debian.org/debian"

USE_C = r"""
#include <cagewright/c/cagewright.h>
#include <stdio.h>
int main(void) { puts(cw_version()); return 0; }
"""
USE_PYTHON = """
import cagewright
V, F = cagewright.read_mesh("/tmp/creature.obj")
cage = cagewright.generate(V, F, num_vertices=60, rounds=1, envelope_resolution=24)
again = cagewright.read_mesh("/tmp/cage.obj")
assert (cage.vertices == again.vertices).all(), "the program and the package make different cages"
print(bool(cagewright.check(V, F, cage)))
"""


def run(*command, expect=0, **options):
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          **options)
    if done.returncode != expect:
        raise AssertionError(f"{' '.join(map(str, command))}\nexit code {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def field(deb, name):
    return run("dpkg-deb", "-f", deb, name).strip()


class Contents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.debs = {field(path, "Package"): path for path in PACKAGES.glob("*.deb")}
        cls.files = {name: set(re.findall(r" \.(/\S+)", run("dpkg-deb", "-c", path))) for name, path in cls.debs.items()}

    def test_six_packages(self):
        self.assertEqual(set(self.debs), {"cagewright", "cagewright-app", "libcagewright0", "libcagewright-dev",
                                          "python3-cagewright", "cagewright-doc"})

    def test_hold_what_belongs_to_them(self):
        lib = "/usr/lib/" + run("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
        for package, wanted in {
            "cagewright": ["/usr/bin/cagewright", "/usr/share/man/man1/cagewright-generate.1.gz",
                           "/usr/share/bash-completion/completions/cagewright",
                           "/usr/share/zsh/vendor-completions/_cagewright",
                           "/usr/share/fish/vendor_completions.d/cagewright.fish"],
            "cagewright-app": ["/usr/bin/cagewright-app", "/usr/share/applications/org.cagewright.Cagewright.desktop",
                               "/usr/share/metainfo/org.cagewright.Cagewright.metainfo.xml",
                               "/usr/share/icons/hicolor/scalable/apps/cagewright.svg",
                               "/usr/share/mime/packages/cagewright.xml"],
            "libcagewright0": [f"{lib}/libcagewright.so.0"],
            "libcagewright-dev": [f"{lib}/libcagewright.so", f"{lib}/libcagewright_deform.a",
                                  "/usr/include/cagewright/cagewright.h", "/usr/include/cagewright/c/cagewright.h",
                                  f"{lib}/cmake/cagewright/cagewrightConfig.cmake", f"{lib}/pkgconfig/cagewright.pc"],
            "python3-cagewright": ["/usr/lib/python3/dist-packages/cagewright/__init__.py"],
            "cagewright-doc": ["/usr/share/doc/cagewright-doc/docs/python.md"],
        }.items():
            self.assertLessEqual(set(wanted), self.files[package], package)
            self.assertIn(f"/usr/share/doc/{package}/copyright", self.files[package])

    def test_no_file_is_in_two_packages(self):
        seen = {}
        for package, files in self.files.items():
            for file in files:
                if not file.endswith("/"):
                    self.assertNotIn(file, seen, f"{package} and {seen.get(file)}")
                    seen[file] = package

    def test_dependencies(self):
        self.assertRegex(field(self.debs["cagewright"], "Depends"), r"libtbb12")
        self.assertNotIn("libqt6", field(self.debs["cagewright"], "Depends").lower())
        self.assertIn("libqt6widgets6", field(self.debs["cagewright-app"], "Depends").lower())
        self.assertIn("libcagewright0 (=", field(self.debs["libcagewright-dev"], "Depends"))
        self.assertIn("libcagewright0 (>=", field(self.debs["python3-cagewright"], "Depends"))
        self.assertEqual(field(self.debs["python3-cagewright"], "Architecture"), "all")

    def test_files_of_the_desktop_are_well_formed(self):
        packaging = SOURCE / "packaging"
        for words in [["desktop-file-validate", packaging / "org.cagewright.Cagewright.desktop"],
                      ["appstreamcli", "validate", "--no-net", PACKAGES.parent / "packaging" / "org.cagewright.Cagewright.metainfo.xml"]]:
            with self.subTest(tool=words[0]):
                if shutil.which(words[0]) is None:
                    self.skipTest(f"{words[0]} is not installed")
                run(*words)

    def test_lintian_finds_no_error(self):
        run("lintian", "--fail-on", "error", "--allow-root", *self.debs.values())

    def test_manual_pages_can_be_read(self):
        folder = PACKAGES.parent / "packaging"
        for page in [*folder.glob("man1/*.1"), SOURCE / "packaging" / "cagewright-app.1"]:
            said = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", str(page)], text=True,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  env={**os.environ, "LC_ALL": "C.UTF-8", "MANROFFSEQ": "", "MANWIDTH": "80"})
            self.assertEqual((said.returncode, said.stderr), (0, ""), page)


class FreshDebian(unittest.TestCase):
    """All packages in a Debian that has nothing else."""

    @classmethod
    def setUpClass(cls):
        if os.geteuid() != 0 or shutil.which("debootstrap") is None:
            raise unittest.SkipTest("a fresh Debian needs root and debootstrap")
        if not (ROOT / "complete").exists():
            shutil.rmtree(ROOT, ignore_errors=True)
            made = subprocess.run(["debootstrap", "--variant=minbase", "bookworm", str(ROOT), MIRROR],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if made.returncode != 0:
                raise unittest.SkipTest("debootstrap: " + made.stdout[-500:])
            (ROOT / "complete").touch()
        cls.root = ROOT.with_name(ROOT.name + "-used")
        shutil.rmtree(cls.root, ignore_errors=True)
        run("cp", "-a", ROOT, cls.root)
        for deb in PACKAGES.glob("*.deb"):
            shutil.copy(deb, cls.root / "tmp")
        shutil.copy(SOURCE / "samples" / "creature.obj", cls.root / "tmp")
        cls.inside("apt-get", "update", "-q")
        cls.inside("sh", "-c", "apt-get install -q -y --no-install-recommends /tmp/*.deb")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root, ignore_errors=True)

    @classmethod
    def inside(cls, *command):
        return run("chroot", cls.root, "/usr/bin/env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL=C.UTF-8",
                   "DEBIAN_FRONTEND=noninteractive", "QT_QPA_PLATFORM=offscreen", "XDG_RUNTIME_DIR=/tmp", *command)

    def test_program_and_python_make_the_same_cage(self):
        said = self.inside("cagewright", "generate", "/tmp/creature.obj", "-o", "/tmp/cage.obj", "--vertices", "60",
                           "--rounds", "1", "--envelope-resolution", "24")
        self.assertIn("valid", said)
        self.inside("cagewright", "check", "/tmp/creature.obj", "/tmp/cage.obj")
        (self.root / "tmp" / "use.py").write_text(USE_PYTHON)
        self.assertEqual(self.inside("python3", "/tmp/use.py").strip(), "True")

    def test_application_starts(self):
        self.assertIn("Cagewright", self.inside("cagewright-app", "--version"))

    def test_completion_in_bash(self):
        said = self.inside("bash", "-c", ". /usr/share/bash-completion/completions/cagewright; "
                           "COMP_WORDS=(cagewright generate --method b); COMP_CWORD=3; _cagewright; "
                           "echo ${COMPREPLY[@]}")
        self.assertEqual(said.split(), ["boxes", "boxes-improved"])

    def test_c_programs_compile(self):
        self.inside("apt-get", "install", "-q", "-y", "--no-install-recommends", "gcc", "libc6-dev")
        (self.root / "tmp" / "use.c").write_text(USE_C)
        self.inside("gcc", "-std=c99", "/tmp/use.c", "-o", "/tmp/use", "-lcagewright")
        self.assertRegex(self.inside("/tmp/use"), r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
