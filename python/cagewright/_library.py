"""The shared library: where it is, and what its functions take.

Everything here mirrors include/cagewright/c/cagewright.h. The library is loaded by ctypes rather than by a compiled
module: the same files then serve every version of Python, that of Blender among them, and calls release the GIL.
"""

import ctypes
import pathlib
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_ssize_t, c_void_p

from .errors import error_of

ABI = 1

Report = ctypes.CFUNCTYPE(c_int, c_void_p, c_double, c_char_p)


class Array(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("type", c_int), ("rows", c_size_t), ("columns", c_size_t),
                ("row_stride", c_ssize_t), ("column_stride", c_ssize_t)]


class MeshView(ctypes.Structure):
    _fields_ = [("positions", Array), ("faces", Array), ("offsets", Array)]


class Control(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("threads", c_int), ("report", Report), ("cancelled", c_void_p),
                ("user", c_void_p), ("stop", c_void_p)]


class DeformerOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("coordinates", c_char_p), ("settings", c_char_p), ("storage", c_int),
                ("no_normals", c_int), ("allow_open", c_int)]


class RenderOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("width", c_int), ("height", c_int), ("views", POINTER(c_double)),
                ("view_count", c_size_t), ("z_up", c_int), ("background", c_int), ("no_shadows", c_int),
                ("no_ambient_occlusion", c_int), ("model_edges", c_int), ("no_cage_faces", c_int)]


class SequenceOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("coordinates", c_char_p), ("settings", c_char_p), ("frames_per_second", c_double),
                ("first_frame", c_double)]


_text = c_char_p
_handle = c_void_p
_out = POINTER(c_void_p)
_mesh = POINTER(MeshView)
_array = POINTER(Array)
_control = POINTER(Control)

# Name: what it returns, and what it takes. Those that can fail return a code, and take an error last.
_FUNCTIONS = {
    "cw_abi_version": (c_int, []),
    "cw_version": (_text, []),
    "cw_features": (_text, []),
    "cw_licence": (_text, []),
    "cw_free": (None, [c_void_p]),
    "cw_name_of_code": (_text, [c_int]),
    "cw_error_message": (_text, [_handle]),
    "cw_error_free": (None, [_handle]),
    "cw_stop_new": (_handle, []),
    "cw_stop_request": (None, [_handle]),
    "cw_stop_free": (None, [_handle]),
    "cw_mesh_free": (None, [_handle]),
    "cw_mesh_vertex_count": (c_size_t, [_handle]),
    "cw_mesh_face_count": (c_size_t, [_handle]),
    "cw_mesh_corner_count": (c_size_t, [_handle]),
    "cw_mesh_triangle_count": (c_size_t, [_handle]),
    "cw_mesh_positions": (c_void_p, [_handle]),
    "cw_mesh_corners": (c_void_p, [_handle]),
    "cw_mesh_offsets": (c_void_p, [_handle]),
    "cw_mesh_triangles": (c_void_p, [_handle]),
    "cw_mesh_colors": (c_void_p, [_handle]),
    "cw_mesh_group_count": (c_size_t, [_handle]),
    "cw_mesh_group_name": (_text, [_handle, c_size_t]),
    "cw_mesh_face_groups": (c_void_p, [_handle]),
    "cw_mesh_notes": (_text, [_handle]),
    "cw_read_mesh": (c_int, [_text, c_int, _out, _out]),
    "cw_parse_mesh": (c_int, [_text, c_size_t, _text, _text, c_int, _out, _out]),
    "cw_write_mesh": (c_int, [_mesh, _text, _out]),
    "cw_options_new": (_handle, []),
    "cw_options_free": (None, [_handle]),
    "cw_options_set": (c_int, [_handle, _text, _text, _out]),
    "cw_options_set_density": (c_int, [_handle, _array, _out]),
    "cw_options_set_joints": (c_int, [_handle, _array, _array, _out]),
    "cw_options_set_start": (c_int, [_handle, _mesh, _out]),
    "cw_options_describe": (c_int, [_out, _out]),
    "cw_cage_free": (None, [_handle]),
    "cw_cage_mesh": (_handle, [_handle]),
    "cw_cage_report": (_text, [_handle]),
    "cw_cage_is_as_asked": (c_int, [_handle]),
    "cw_generate": (c_int, [_mesh, _handle, _control, _out, _out]),
    "cw_verdict_free": (None, [_handle]),
    "cw_verdict_is_valid": (c_int, [_handle]),
    "cw_verdict_report": (_text, [_handle]),
    "cw_check": (c_int, [_mesh, _mesh, c_int, c_size_t, _control, _out, _out]),
    "cw_compare": (c_int, [_mesh, _mesh, POINTER(_text), c_size_t, c_int, _control, _out, _out]),
    "cw_info": (c_int, [_mesh, c_int, _control, _out, _out]),
    "cw_coordinate_columns": (c_int, [_text, _text, _mesh, POINTER(c_size_t), _out]),
    "cw_coordinates": (c_int, [_text, _text, _array, _mesh, _control, c_void_p, c_size_t, _out]),
    "cw_coordinates_sparse": (c_int, [_text, _text, _array, _mesh, _control, _out, _out]),
    "cw_sparse_free": (None, [_handle]),
    "cw_sparse_row_count": (c_size_t, [_handle]),
    "cw_sparse_column_count": (c_size_t, [_handle]),
    "cw_sparse_value_count": (c_size_t, [_handle]),
    "cw_sparse_values": (c_void_p, [_handle]),
    "cw_sparse_columns": (c_void_p, [_handle]),
    "cw_sparse_offsets": (c_void_p, [_handle]),
    "cw_coordinates_describe": (c_int, [_out, _out]),
    "cw_deformer_bind": (c_int, [_mesh, _mesh, POINTER(DeformerOptions), _control, _out, _out]),
    "cw_deformer_free": (None, [_handle]),
    "cw_deformer_set_cage": (c_int, [_handle, _array, _control, _out]),
    "cw_deformer_move": (c_int, [_handle, _array, _array, _control, _out]),
    "cw_deformer_vertex_count": (c_size_t, [_handle]),
    "cw_deformer_cage_vertex_count": (c_size_t, [_handle]),
    "cw_deformer_positions": (c_void_p, [_handle]),
    "cw_deformer_normals": (c_void_p, [_handle]),
    "cw_deformer_cage_positions": (c_void_p, [_handle]),
    "cw_deformer_unbound_count": (c_size_t, [_handle]),
    "cw_deformer_weight_bytes": (c_size_t, [_handle]),
    "cw_deform_file": (c_int, [_text, _text, _text, _text, _control, _out, _out]),
    "cw_deform_sequence": (c_int, [_text, _text, POINTER(_text), _array, c_size_t, POINTER(_text), c_size_t,
                                   POINTER(SequenceOptions), _control, _out, _out]),
    "cw_view_named": (c_int, [_text, c_double * 2]),
    "cw_image_free": (None, [_handle]),
    "cw_image_width": (c_size_t, [_handle]),
    "cw_image_height": (c_size_t, [_handle]),
    "cw_image_pixels": (c_void_p, [_handle]),
    "cw_render": (c_int, [_mesh, _mesh, POINTER(RenderOptions), _out, _out]),
}


def _load():
    """The library beside this package, as in a wheel; else that of the system."""
    beside = sorted(pathlib.Path(__file__).parent.glob("libcagewright.*"))
    name = str(beside[0]) if beside else "libcagewright.so.0"
    try:
        library = ctypes.CDLL(name)
    except OSError as error:
        raise ImportError(f"cagewright: the library cannot be loaded ({error}); install the package libcagewright0, "
                          "or install cagewright by pip, which brings it along") from error
    if library.cw_abi_version() != ABI:
        raise ImportError(f"cagewright: {name} has version {library.cw_abi_version()} of the C interface, not {ABI}; "
                          "install the library and the Python package from the same release")
    for function, (result, arguments) in _FUNCTIONS.items():
        if not hasattr(library, function):
            raise ImportError(f"cagewright: {name} is older than this Python package (it has no {function}); install both from "
                              "the same release")
        getattr(library, function).restype = result
        getattr(library, function).argtypes = arguments
    return library


lib = _load()


def checked(function, *arguments):
    """Calls a function that can fail, and raises what it says."""
    error = c_void_p()
    code = function(*arguments, ctypes.byref(error))
    if code != 0:
        message = lib.cw_error_message(error)
        name = lib.cw_name_of_code(code).decode()
        lib.cw_error_free(error)
        raise error_of(name, message.decode("utf-8", "replace"))


class Handle:
    """Something of the library's that is freed with the last reference to it."""

    def __init__(self, pointer, free):
        self.pointer = pointer
        self._free = free

    def __del__(self):
        if self.pointer:
            self._free(self.pointer)


def take_text(pointer):
    """Text that was handed out, as a string; the library's copy is freed."""
    try:
        return ctypes.string_at(pointer).decode("utf-8", "replace")
    finally:
        lib.cw_free(pointer)


def path_bytes(path):
    """A path as the library takes it. A NUL would cut it short."""
    import os
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError("a path has no NUL in it")
    return name
