#!/usr/bin/env python3
"""The documentation as pages: docs/, README.md and what is made of docstrings and headers, by MkDocs and Doxygen.

docs_site.py BUILD OUT

BUILD is a build folder with the program and the Python package. A link that leads nowhere is an error.
"""

import inspect
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCE = ROOT / "build" / "docs_source"
PAGES = {"README.md": "index.md", **{name: name for name in ("ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")}}

DOXYFILE = """
PROJECT_NAME = Cagewright
INPUT = {root}/include/cagewright
RECURSIVE = YES
FILE_PATTERNS = *.h
STRIP_FROM_INC_PATH = {root}/include
OUTPUT_DIRECTORY = {out}
HTML_OUTPUT = cpp
GENERATE_LATEX = NO
JAVADOC_AUTOBRIEF = YES
EXTRACT_ALL = YES
MACRO_EXPANSION = YES
PREDEFINED = CW_API=
ENABLE_PREPROCESSING = YES
HAVE_DOT = NO
QUIET = YES
WARNINGS = NO
"""


def link_to(target, page_folder):
    """Where a link to a file of the repository leads on the site; None: nowhere."""
    path = (page_folder / target).resolve()
    if not path.exists() or ROOT not in path.parents:
        return None
    name = path.relative_to(ROOT).as_posix()
    if name in PAGES:
        return PAGES[name]
    if name.startswith("docs/"):
        return name[len("docs/"):]
    if path.is_dir():
        return None
    copy = SOURCE / "source" / (name + ".txt")  # so that browsers show it
    copy.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(path, copy)
    return f"source/{name}.txt"


def page(path):
    """A page with links as the site has them, and without comments for tests."""
    def link(match):
        words, target = match[1], match[2]
        name, _, anchor = target.partition("#")
        if re.match(r"[a-z]+:", target) or not name:
            return match[0]
        there = link_to(name, path.parent)
        if there is None:
            return words
        return f"[{words}]({there}{'#' + anchor if anchor else ''})"
    text = re.sub(r"^<!--.*?-->\n", "", path.read_text(), flags=re.S | re.M)
    parts = re.split(r"(^```.*?^```)", text, flags=re.S | re.M)
    return "".join(part if part.startswith("```") else re.sub(r"\[([^\]\[]*)\]\(([^)\s]+)\)", link, part)
                   for part in parts)


def python_page(package):
    """What help() says, as a page."""
    sys.path.insert(0, str(package))
    import cagewright
    lines = ["# Python functions", "", inspect.getdoc(cagewright).split("\n")[0], "",
             "What stands here is what `help()` says; [Python](python.md) shows how they go together.", ""]

    def described(name, thing, level):
        try:
            signature = str(inspect.signature(thing))
        except (TypeError, ValueError):
            signature = ""
        lines.extend([f"{'#' * level} {name}", "", "```text", f"{name}{signature}", "```", "", "```text",
                      inspect.getdoc(thing) or "", "```", ""])

    for name in cagewright.__all__:
        thing = getattr(cagewright, name)
        if inspect.isfunction(thing):
            described(f"cagewright.{name}", thing, 2)
        elif inspect.isclass(thing):
            described(f"cagewright.{name}", thing, 2)
            for method, member in vars(thing).items():
                if not method.startswith("_") and (inspect.isfunction(member) or isinstance(member, property)):
                    described(f"{name}.{method}", member, 3)
        else:
            lines.extend([f"## cagewright.{name}", "", f"`{json.dumps(thing)}`", ""])
    return "\n".join(lines)


# Tables as the theme draws them.
THEME_EXTRA = """jQuery(function ($) {
  $("div.section table, div[role=main] table").addClass("docutils");
});
"""


def complete_theme(folder):
    """The scripts that Debian's MkDocs names in each page, and leaves out: without jQuery the menu does not unfold."""
    wanted = folder / "jquery-3.6.0.min.js"
    if not wanted.exists():
        shutil.copy("/usr/share/javascript/jquery/jquery.min.js", wanted)
    if not (folder / "theme_extra.js").exists():
        (folder / "theme_extra.js").write_text(THEME_EXTRA)


def main():
    build, out = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.rmtree(out, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    shutil.copytree(ROOT / "docs" / "images", SOURCE / "images")
    for path in sorted((ROOT / "docs").glob("*.md")):
        (SOURCE / path.name).write_text(page(path))
    for name, target in PAGES.items():
        (SOURCE / target).write_text(page(ROOT / name))
    (SOURCE / "api-python.md").write_text(python_page(build / "python"))
    (SOURCE / "api-cpp.md").write_text(
        "# C++ and C functions\n\n<a href=\"cpp/index.html\">Every header, class and function</a>, made of the headers by Doxygen. Where to begin:\n\n"
        "| | |\n|---|---|\n" + "".join(
            f"| `<cagewright/{header}>` | {about} |\n" for header, about in [
                ("cage/generate.h", "from a model to a cage"), ("validate/validate_cage.h", "the judge"),
                ("coordinates/kinds.h", "all kinds of coordinates"), ("deform/deformer.h", "a model that follows its cage"),
                ("io/model_file.h", "files, with all that they hold"), ("c/cagewright.h", "the C interface")]))
    subprocess.run(["mkdocs", "build", "--strict", "--quiet", "-f", ROOT / "mkdocs.yml", "-d", out], check=True)
    complete_theme(out / "js")
    doxyfile = SOURCE.with_name("Doxyfile")
    doxyfile.write_text(DOXYFILE.format(root=ROOT, out=out))
    subprocess.run(["doxygen", str(doxyfile)], check=True, stdout=subprocess.DEVNULL)
    print(out / "index.html")


if __name__ == "__main__":
    main()
