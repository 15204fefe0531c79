"""The documentation as pages is whole: every page is in the menu, every link leads somewhere, and the functions of Python, C and
C++ are there.

site_test.py BUILD [unittest arguments]
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.site = pathlib.Path(folder.name) / "docs"
        made = subprocess.run([sys.executable, SOURCE / "tools" / "docs_site.py", BUILD, cls.site], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if made.returncode != 0:
            raise AssertionError(made.stdout)

    def test_every_page_is_in_the_menu(self):
        menu = (SOURCE / "mkdocs.yml").read_text()
        for page in sorted((SOURCE / "docs").glob("*.md")):
            self.assertIn(f": {page.name}\n", menu)
            self.assertTrue((self.site / page.with_suffix(".html").name).exists(), page.name)

    def test_every_link_within_leads_somewhere(self):
        lost = []
        for page in sorted(self.site.glob("*.html")):
            text = re.sub(r"<!--.*?-->", "", page.read_text(), flags=re.S)
            for target in re.findall(r'(?:href|src)="([^"#?:]+)(?:[#?][^"]*)?"', text):
                if not target.startswith("/") and not (page.parent / target).exists():
                    lost.append(f"{page.name}: {target}")
        self.assertEqual(lost, [])

    def test_nothing_is_fetched_from_elsewhere(self):
        """Pages work without a network."""
        for page in sorted(self.site.glob("*.html")):
            fetched = re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="https?:[^"]*"', page.read_text())
            self.assertEqual([tag for tag in fetched if 'rel="canonical"' not in tag], [], page.name)

    def test_can_be_searched(self):
        self.assertIn("harmonic", (self.site / "search" / "search_index.json").read_text())

    def test_functions_of_each_language(self):
        sys.path.insert(0, str(BUILD / "python"))
        import cagewright
        python = (self.site / "api-python.html").read_text()
        for name in cagewright.__all__:
            self.assertIn(f"cagewright.{name}", python)
        declared = re.findall(r"^CW_API [^;(]*?\b(cw_\w+)\(", (SOURCE / "include/cagewright/c/cagewright.h").read_text(), re.M)
        self.assertGreater(len(declared), 40)
        c = (self.site / "cpp" / "cagewright_8h.html").read_text() + "".join(
            path.read_text() for path in (self.site / "cpp").glob("c_2cagewright_8h*.html"))
        self.assertEqual([name for name in declared if name not in c], [])
        cpp = "".join(path.read_text() for path in (self.site / "cpp").glob("namespacecagewright*.html"))
        for name in ("generate", "validate_cage", "read_mesh", "write_mesh", "render"):
            self.assertIn(name, cpp)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
