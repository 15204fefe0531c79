"""The documentation runs: each block of commands (```sh) and each script (```python) of README.md and docs/, page by page in
a scratch folder with small models under the names that the pages use; links lead somewhere; every command has its place in the reference (which ./dev docs renews).

docs_test.py PROGRAM FOLDER_OF_PYTHON_PACKAGE [unittest arguments]

Comments that a reader of the page does not see steer this:
  <!-- before: COMMANDS -->  run before the next block
  <!-- not run: REASON -->   the next block is not for a test
`cagewright` is a wrapper here that lets cages be made in haste.
"""

import contextlib
import io
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, PACKAGE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
TOP = [SOURCE / name for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md")]

# What a page shows as a command or a script is marked as such, so that none is left out by chance.
COMMAND = re.compile(r"^\s*(\$ )?(cagewright(-app)? |\./dev |snakemake |dask-|pip |python3? |apt(-get)? |cmake )", re.M)
BLOCK = re.compile(r"(?P<comments>(?:^<!--.*?-->\n+)*)^```(?P<language>\w*)\n(?P<text>.*?)^```", re.S | re.M)

WRAPPER = """#!/bin/bash
# generate and batch in haste, unless the page itself says how thorough to be.
case " $* " in
*" generate "*|*" batch "*)
  haste="--rounds 1"
  case " $* " in *" --depth "*|*"boxes"*) haste="--resolution 16" ;; *) haste="$haste --envelope-resolution 16" ;; esac
  case "$*" in *"--rounds"*|*"--help"*) haste= ;; esac
  exec {program} "$@" $haste 2> >(grep -v "makes no difference here" >&2) ;;
esac
exec {program} "$@"
"""


def ring(around=20, across=10):
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 1 + (0.3 + 0.1 * math.cos(a)) * math.cos(b)
            lines.append((r * math.cos(a), r * math.sin(a), (0.3 + 0.1 * math.cos(a)) * math.sin(b)))
    at = lambda i, j: i % around * across + j % across  # noqa: E731
    return lines, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(around) for j in range(across)]


def write_models(folder):
    points, faces = ring()
    obj = "".join("v {} {} {}\n".format(*p) for p in points) + \
        "".join("f {} {} {} {}\n".format(*(c + 1 for c in face)) for face in faces)
    (folder / "model.obj").write_text(obj)
    off = f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("{} {} {}\n".format(*p) for p in points) + \
        "".join("4 {} {} {} {}\n".format(*face) for face in faces)
    (folder / "armadillo.off").write_text(off)
    for name in ("models/one.obj", "models/deep/two.obj"):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(obj)
    shutil.copytree(SOURCE / "examples", folder / "examples")


class Page:
    """A page in a scratch folder: blocks share files, scripts share names."""

    def __init__(self, path, folder):
        self.path, self.folder, self.names = path, folder, {}
        write_models(folder)
        (folder / "bin").mkdir()
        wrapper = folder / "bin" / "cagewright"
        wrapper.write_text(WRAPPER.format(program=PROGRAM))
        wrapper.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "PYTHONPATH": str(PACKAGE),
                            "OMP_NUM_THREADS": "1"}

    def run(self):
        for block in BLOCK.finditer(self.path.read_text()):
            comments = block["comments"]
            for before in re.findall(r"<!-- before: (.*?)-->", comments, re.S):
                self.shell(before)
            if "<!-- not run:" in comments:
                continue
            if block["language"] == "sh":
                self.shell(block["text"])
            elif block["language"] == "python":
                self.script(block["text"])

    def shell(self, text):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode not in (0, 3):  # 3: in haste not all that was asked for comes out
            raise AssertionError(f"{self.path.name}: exit code {done.returncode}\n{text}\n{done.stdout}")

    def script(self, text):
        import warnings
        said = io.StringIO()
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                exec(compile(text, f"{self.path.name}", "exec"), self.names)
            except Exception as error:
                raise AssertionError(f"{self.path.name}: {type(error).__name__}: {error}\n{text}\n{said.getvalue()}")


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        sys.path.insert(0, str(PACKAGE))
        try:
            import cagewright
        except ImportError as error:
            print(f"skipped: {error}")
            sys.exit(77)
        made = cagewright.generate

        def in_haste(*arguments, **options):
            return made(*arguments, **{"rounds": 1, "envelope_resolution": 16, **options})
        in_haste.__doc__ = made.__doc__
        cagewright.generate = in_haste

    def test_run(self):
        for path in PAGES:
            with self.subTest(page=path.name), tempfile.TemporaryDirectory() as folder:
                Page(path, pathlib.Path(folder)).run()


class Routes(unittest.TestCase):
    """What docs/routes.md shows of C and C++ is true, too."""

    def block(self, language):
        text = (SOURCE / "docs" / "routes.md").read_text()
        return next(block["text"] for block in BLOCK.finditer(text) if block["language"] == language)

    def test_c(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_models(folder)
            text = self.block("c").replace('"60", NULL)', '"60", NULL) || cw_options_set(options, "rounds", "0", NULL) || '
                                           'cw_options_set(options, "envelope-resolution", "16", NULL)')
            text = text.replace("/* pose it: posed.obj */", 'cw_write_mesh(&view, "posed.obj", NULL) ||')
            (folder / "route.c").write_text("#include <cagewright/c/cagewright.h>\nint main(void) {\n" + text + "return failed;\n}\n")
            library = (PACKAGE / "cagewright" / "libcagewright.so").resolve().parent
            self.run_words(folder, "cc", "-std=c99", "-Wall", "-Werror", "route.c", "-o", "route", f"-I{SOURCE / 'include'}",
                           f"-L{library}", f"-Wl,-rpath,{library}", "-lcagewright")
            self.run_words(folder, "./route")
            self.assertTrue((folder / "armadillo_posed.off").exists())

    def test_cpp(self):
        text = self.block("cpp")
        with tempfile.TemporaryDirectory() as name:
            (pathlib.Path(name) / "route.cpp").write_text(
                "#include <cagewright/cagewright.h>\nusing namespace cagewright;\nint main() {\n" + text + "}\n")
            self.run_words(name, os.environ.get("CXX", "c++"), "-std=c++20", "-fsyntax-only", f"-I{SOURCE / 'include'}",
                           f"-I{PACKAGE.parent / 'include'}", "-isystem", "/usr/include/eigen3", "route.cpp")

    def run_words(self, folder, *words):
        done = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)


class Pages(unittest.TestCase):
    def test_commands_are_marked_as_such(self):
        for path in PAGES:
            for block in BLOCK.finditer(path.read_text()):
                if block["language"] == "" and "<!-- not run:" not in block["comments"]:
                    self.assertIsNone(COMMAND.search(block["text"]),
                                      f"{path.name}: write ```sh, so that it is run:\n{block['text']}")

    def test_links_lead_somewhere(self):
        for path in [*PAGES, *TOP]:
            text = re.sub(r"```.*?```", "", path.read_text(), flags=re.S)
            for link in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"[a-z]+:", link):
                    continue
                name, _, anchor = link.partition("#")
                target = (path.parent / name).resolve() if name else path
                self.assertTrue(target.exists(), f"{path.name}: {link}")
                if anchor and target.suffix == ".md":
                    headings = re.findall(r"^#+ (.*)$", target.read_text(), re.M)
                    anchors = {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}
                    anchors |= set(re.findall(r'<a (?:id|name)="([^"]+)"', target.read_text()))
                    self.assertIn(anchor, anchors, f"{path.name}: {link}")

    def test_every_command_is_described(self):
        said = subprocess.run([str(PROGRAM), "--help"], capture_output=True, text=True).stdout
        commands = re.findall(r"^  ([a-z]+)  ", said.partition("Subcommands:")[2], re.M)
        self.assertGreater(len(commands), 9)
        reference = (SOURCE / "docs" / "reference.md").read_text()
        for command in commands:
            self.assertIn(f"\n## {command}\n", reference)

    def test_the_reference_is_what_the_program_says(self):
        """tools/reference.py renews the page after a change of options."""
        said = subprocess.run([sys.executable, str(SOURCE / "tools" / "reference.py"), str(PROGRAM), "--check",
                               str(SOURCE / "docs" / "reference.md")], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(said.returncode, 0, said.stdout)

    def test_completion_is_what_shells_take(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, str(SOURCE / "tools" / "reference.py"), str(PROGRAM), "--out", folder],
                           check=True)
            completions = pathlib.Path(folder) / "completions"
            for words, expected in [("cagewright gene", ["generate"]), ("cagewright generate --meth", ["--method"]),
                                    ("cagewright generate --symmetry a", ["auto"]),
                                    ("cagewright --threads 2 deform --fp", ["--fps"])]:
                script = f'. "{completions}/cagewright"; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); ' \
                    '_cagewright; echo "${COMPREPLY[@]}"'
                said = subprocess.run(["bash", "-c", script], capture_output=True, text=True)
                self.assertEqual((said.stdout.split(), said.stderr), (expected, ""), words)
            for shell, name in [("zsh", "_cagewright"), ("fish", "cagewright.fish")]:
                if shutil.which(shell):
                    said = subprocess.run([shell, "-n", str(completions / name)], capture_output=True, text=True)
                    self.assertEqual((said.returncode, said.stderr), (0, ""), shell)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
