#!/usr/bin/env python3
"""Packs the add-on for Blender:  make_addon.py LIBRARY OUT.zip

The zip holds blender/cagewright with the Python package of python/ as its part `bindings`, the shared library within it,
and what the library says of its options. It can be installed as it is, by Blender's preferences.
"""

import ctypes
import json
import pathlib
import sys
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def described(library, function):
    """The JSON of a function of the library's that hands out text."""
    out, error = ctypes.c_void_p(), ctypes.c_void_p()
    library.cw_free.argtypes = [ctypes.c_void_p]
    if getattr(library, function)(ctypes.byref(out), ctypes.byref(error)) != 0:
        sys.exit(f"make_addon.py: {function} failed")
    text = ctypes.string_at(out).decode()
    library.cw_free(out)
    return json.dumps(json.loads(text), indent=1) + "\n"


def check_manifest():
    """What Blender refuses in a manifest (Blender manual, "How to Create Extensions")."""
    manifest = tomllib.loads((ROOT / "blender" / "cagewright" / "blender_manifest.toml").read_text())
    for text in [manifest["tagline"], *manifest["permissions"].values()]:
        if len(text) > 64 or not text[-1].isalnum():
            sys.exit(f"make_addon.py: Blender takes 64 characters without a full stop, not: {text}")


def pack(library, out):
    check_manifest()
    loaded = ctypes.CDLL(str(library))
    folder = "cagewright"
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as packed:
        for file in sorted((ROOT / "blender" / "cagewright").glob("*")):
            if file.suffix in {".py", ".toml"}:
                packed.write(file, f"{folder}/{file.name}")
        for file in sorted((ROOT / "python" / "cagewright").glob("*.py")):
            packed.write(file, f"{folder}/bindings/{file.name}")
        packed.write(library.resolve(), f"{folder}/bindings/libcagewright.so")
        packed.writestr(f"{folder}/options.json", described(loaded, "cw_options_describe"))
        packed.writestr(f"{folder}/coordinates.json", described(loaded, "cw_coordinates_describe"))
        packed.write(ROOT / "LICENSE", f"{folder}/LICENSE")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    pack(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
