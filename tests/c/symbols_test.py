"""The shared library exports what its header declares, and nothing else; other languages can call it.

symbols_test.py LIBRARY HEADER
"""

import ctypes
import pathlib
import re
import subprocess
import sys
import unittest

LIBRARY, HEADER = sys.argv[1], pathlib.Path(sys.argv[2])


class Symbols(unittest.TestCase):
    def test_exports_what_the_header_declares(self):
        declared = set(re.findall(r"CW_API[^;]*?\b(cw_\w+)\(", HEADER.read_text()))
        self.assertGreater(len(declared), 50)
        lines = subprocess.run(["nm", "-D", "--defined-only", LIBRARY], check=True, capture_output=True, text=True)
        exported = {line.split()[-1] for line in lines.stdout.splitlines()}
        self.assertEqual(exported - declared, set(), "exported, but not declared")
        self.assertEqual(declared - exported, set(), "declared, but not exported")

    def test_the_documentation_shows_the_example(self):
        source = HEADER.parents[3]
        self.assertIn((source / "examples" / "make_cage.c").read_text(), (source / "docs" / "c.md").read_text())

    def test_has_a_name_with_its_abi(self):
        read = subprocess.run(["readelf", "-d", LIBRARY], check=True, capture_output=True, text=True)
        self.assertRegex(read.stdout, r"SONAME.*libcagewright\.so\.\d+\]")

    def test_can_be_called_without_a_compiler(self):
        library = ctypes.CDLL(LIBRARY)
        library.cw_version.restype = ctypes.c_char_p
        self.assertRegex(library.cw_version().decode(), r"^\d+\.\d+\.\d+$")
        mesh, error = ctypes.c_void_p(), ctypes.c_void_p()
        text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        code = library.cw_parse_mesh(text, ctypes.c_size_t(len(text)), None, None, 0, ctypes.byref(mesh), ctypes.byref(error))
        self.assertEqual((code, error.value), (0, None))
        library.cw_mesh_positions.restype = ctypes.POINTER(ctypes.c_double)
        self.assertEqual(library.cw_mesh_positions(mesh)[3], 1)
        library.cw_mesh_free(mesh)
        library.cw_error_message.restype = ctypes.c_char_p
        self.assertNotEqual(library.cw_read_mesh(b"/nowhere.obj", 0, ctypes.byref(mesh), ctypes.byref(error)), 0)
        self.assertIn(b"/nowhere.obj", library.cw_error_message(error))
        library.cw_error_free(error)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
