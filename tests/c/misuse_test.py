"""No argument makes the C library crash: every function that the header declares is called with NULL, zeros, negative
numbers and nonsense in place of each of its arguments. It says what was wrong, or gives 0, NULL or "".

misuse_test.py LIBRARY HEADER

New functions are found by themselves; an argument of a type that is not known here fails the test.
"""

import ctypes
import os
import pathlib
import re
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIBRARY, HEADER = ctypes.CDLL(str(pathlib.Path(sys.argv[1]).resolve())), pathlib.Path(sys.argv[2]).resolve()
NULL = ctypes.c_void_p()
FLOAT64, UINT32 = 0, 7
LOG = sys.stdout


class Array(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("type", ctypes.c_int), ("rows", ctypes.c_size_t),
                ("columns", ctypes.c_size_t), ("row_stride", ctypes.c_ssize_t), ("column_stride", ctypes.c_ssize_t)]


class MeshView(ctypes.Structure):
    _fields_ = [("positions", Array), ("faces", Array), ("offsets", Array)]


def functions():
    """(what is returned, name, [type of each argument])"""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", HEADER.read_text(), flags=re.S)
    for result, name, arguments in re.findall(r"CW_API\s+([^;(]*?)\s*\b(cw_\w+)\(([^;]*)\);", text):
        types = [re.sub(r"\s*\b\w+(\[2\])?$", r"\1", " ".join(one.split())) for one in arguments.split(",")]
        yield result, name, [] if arguments.strip() == "void" else types


class Misuse(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        os.chdir(folder.name)  # what is written under nonsensical names goes away with it
        cls.keep = []
        cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        cls.corners = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7,
                       1, 7, 3]
        cls.model = cls.mesh(cube)
        cls.cage = cls.mesh([[3 * c - 1 for c in p] for p in cube])
        cls.path = str(pathlib.Path(folder.name) / "cube.off").encode()
        cls.out = str(pathlib.Path(folder.name) / "out.off").encode()
        cls.make_objects()

    @classmethod
    def array(cls, numbers, kind, rows, columns):
        cls.keep.append(numbers)
        return Array(ctypes.addressof(numbers), kind, rows, columns, 0, 0)

    @classmethod
    def mesh(cls, points):
        xyz = (ctypes.c_double * 24)(*[float(c) for p in points for c in p])
        corners = (ctypes.c_uint32 * 36)(*cls.corners)
        return MeshView(cls.array(xyz, FLOAT64, 8, 3), cls.array(corners, UINT32, 12, 3), Array())

    @classmethod
    def make_objects(cls):
        """One of each kind, by the functions under test."""
        cls.objects = {}
        LIBRARY.cw_options_new.restype = LIBRARY.cw_stop_new.restype = ctypes.c_void_p
        options = cls.objects["cw_options"] = LIBRARY.cw_options_new()
        cls.objects["cw_stop"] = LIBRARY.cw_stop_new()
        for name, value in [(b"envelope-resolution", b"8"), (b"rounds", b"0"), (b"symmetry", b"off")]:
            assert LIBRARY.cw_options_set(ctypes.c_void_p(options), name, value, NULL) == 0
        model, cage = ctypes.byref(cls.model), ctypes.byref(cls.cage)
        assert LIBRARY.cw_write_mesh(model, cls.path, NULL) == 0
        for kind, function, words in [
            ("cw_mesh", LIBRARY.cw_read_mesh, [cls.path, 0]),
            ("cw_cage", LIBRARY.cw_generate, [model, ctypes.c_void_p(options), NULL]),
            ("cw_verdict", LIBRARY.cw_check, [model, cage, 0, ctypes.c_size_t(3), NULL]),
            ("cw_deformer", LIBRARY.cw_deformer_bind, [model, cage, NULL, NULL]),
            ("cw_image", LIBRARY.cw_render, [model, cage, NULL]),
            ("cw_sparse", LIBRARY.cw_coordinates_sparse, [None, None, ctypes.byref(cls.model.positions), cage, NULL]),
        ]:
            out = ctypes.c_void_p()
            code = function(*words, ctypes.byref(out), NULL)
            assert code == 0 or kind == "cw_image", (kind, code)  # no pictures here
            cls.objects[kind] = out.value

    def candidates(self, kind):
        """Something right for an argument of this type, and what may be wrong with it."""
        bad_arrays = [Array(), Array(None, 0, 5, 3), Array(None, -1, 5, 3), Array(None, 77, 0, 3),
                      Array(None, 0, 2**64 - 1, 3), Array(None, 0, 2**63, 2**63), Array(None, 6, 0, 3, -8, -8)]
        byte = ctypes.create_string_buffer(4096)
        self.keep += [byte, bad_arrays]
        plain = kind.replace("const ", "").replace(" const", "")
        if plain in ("cw_mesh*", "cw_cage*", "cw_verdict*", "cw_deformer*", "cw_image*", "cw_options*", "cw_stop*",
                     "cw_sparse*"):
            return [ctypes.c_void_p(self.objects[plain[:-1]]), NULL]
        if plain == "cw_mesh_view*":
            wrong = [MeshView(array, self.model.faces, Array()) for array in bad_arrays]
            wrong += [MeshView(self.model.positions, array, Array()) for array in bad_arrays]
            wrong += [MeshView(self.model.positions, self.model.faces, array) for array in bad_arrays[1:]]
            self.keep.append(wrong)
            return [ctypes.byref(self.model), NULL, *map(ctypes.byref, wrong)]
        if plain == "cw_array*":
            return [ctypes.byref(self.model.positions), NULL, *map(ctypes.byref, bad_arrays)]
        if plain == "char*" and kind.startswith("const"):
            return [self.path, None, b"", b"nonsense", b"-1"]
        if plain == "char**" and kind.startswith("const"):
            paths = (ctypes.c_char_p * 2)(self.out, None)
            none = (ctypes.c_char_p * 2)()
            self.keep += [paths, none]
            return [paths, NULL, none]
        if plain == "cw_control*":
            wrong = [(ctypes.c_int64 * 8)(0), (ctypes.c_int64 * 8)(48, -5), (ctypes.c_int64 * 8)(-1)]
            self.keep.append(wrong)
            return [NULL, *wrong]
        if plain in ("cw_deformer_options*", "cw_render_options*", "cw_sequence_options*"):
            at = 1 if plain == "cw_render_options*" else 3  # the first number that is no pointer
            wrong = [(ctypes.c_int64 * 12)(0)] + [(ctypes.c_int64 * 12)(64, *[0] * (at - 1), number) for number in (-1, 9)]
            small = (ctypes.c_int64 * 12)(64, 16 * (2**32 + 1)) if plain == "cw_render_options*" else NULL
            self.keep += [wrong, small]
            return [small, *wrong[1:]]
        if plain in ("int", "cw_code", "cw_pose"):
            return [0, -1, 9999]
        if plain == "size_t":
            return [1, 0]
        if plain in ("double[2]", "double*", "void*"):
            return [byte, NULL]
        if plain.endswith("**") or plain == "size_t*":  # a place for a result
            place = ctypes.c_void_p()
            self.keep.append(place)
            return [ctypes.byref(place), NULL]
        if plain == "char*":  # text to be freed
            return [NULL]
        if plain == "cw_error*":
            return [NULL]
        self.fail(f"what can be wrong with a {kind}? Tell {pathlib.Path(__file__).name}")

    def call(self, result, name, arguments):
        function = getattr(LIBRARY, name)
        function.restype = ctypes.c_int if result == "cw_code" else MeshView if result == "cw_mesh_view" else ctypes.c_void_p
        return function(*[ctypes.c_size_t(a) if isinstance(a, int) and a >= 0 else a for a in arguments])

    def test_nothing_crashes(self):
        tried = 0
        frees = {f"{kind}_free" for kind in ("cw_mesh", "cw_cage", "cw_verdict", "cw_deformer", "cw_image", "cw_options", "cw_sparse",
                                             "cw_stop", "cw_error")}
        for result, name, types in functions():
            choices = [self.candidates(kind) for kind in types]
            if name in frees:
                choices = [[NULL]]
            if name == "cw_stop_request":
                choices = [[NULL]]
            calls = [[one[0] for one in choices], [one[-1] for one in choices],
                     [one[1] if len(one) > 1 else one[0] for one in choices]]
            for i, options in enumerate(choices):
                calls += [[one[0] for one in choices[:i]] + [wrong] + [one[0] for one in choices[i + 1:]]
                          for wrong in options[1:]]
            for arguments in calls:
                print(name, arguments, file=LOG, flush=True)  # the last one, should it crash
                self.call(result, name, arguments)
                tried += 1
        self.assertGreater(tried, 300)

    def test_says_what_is_missing(self):
        """Where NULL may not be, that is told with a sentence; the code and the error agree."""
        LIBRARY.cw_error_message.restype = ctypes.c_char_p
        required = {"cw_mesh_view*", "cw_array*", "cw_deformer*"}
        for result, name, types in functions():
            if result != "cw_code":
                continue
            choices = [self.candidates(kind) for kind in types]
            for i, kind in enumerate(types[:-1]):
                plain = kind.replace("const ", "")
                error = ctypes.c_void_p()
                words = [one[0] for one in choices[:i]] + [NULL] + [one[0] for one in choices[i + 1:-1]]
                code = self.call(result, name, [*words, ctypes.byref(error)])
                self.assertEqual(code != 0, error.value is not None, (name, kind))
                is_optional = (name, i) in {("cw_render", 1), ("cw_deform_sequence", 3),
                                            ("cw_options_set_joints", 2)}
                if plain in required and not is_optional:
                    self.assertNotEqual(code, 0, (name, kind))
                if code != 0:
                    self.assertGreater(len(LIBRARY.cw_error_message(error)), 10, (name, kind))
                LIBRARY.cw_error_free(error)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
