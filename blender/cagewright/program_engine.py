"""Cagewright by its command line program, for machines on which the library cannot be loaded.

Meshes go there and back as PLY files of doubles, so nothing is rounded.
"""

import json
import pathlib
import shutil
import struct
import subprocess
import tempfile
import time

import numpy as np

from .engine import Cage, Cancelled, Failure
from .preferences import preferences

_NOT_FOUND = ("Cagewright's library cannot be loaded ({}), and its program is not found: give its place in the "
              "add-on's preferences")


def write_ply(path, vertices, corners, offsets):
    counts = np.diff(offsets)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty double x\n"
            f"property double y\nproperty double z\nelement face {len(counts)}\n"
            "property list int int vertex_indices\nend_header\n")
    body = np.insert(np.asarray(corners, "<i4"), np.asarray(offsets[:-1]), counts.astype("<i4"))
    path.write_bytes(head.encode() + np.ascontiguousarray(vertices, "<f8").tobytes() + body.tobytes())


def read_ply(path):
    """What the program writes: doubles, and lists of corners."""
    content = path.read_bytes()
    head, _, body = content.partition(b"end_header\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")}
    vertices = np.frombuffer(body, "<f8", 3 * counts["vertex"]).reshape(-1, 3).copy()
    is_wide = "property list int " in head.decode()
    at, corners, offsets = vertices.nbytes, [], [0]
    for _ in range(counts["face"]):
        count = struct.unpack_from("<i", body, at)[0] if is_wide else body[at]
        at += 4 if is_wide else 1
        corners.extend(struct.unpack_from(f"<{count}i", body, at))
        offsets.append(len(corners))
        at += 4 * count
    return vertices, np.array(corners, np.int32), np.array(offsets, np.int64)


class _Matrix:
    """A model that follows the vertices of its cage by a matrix."""

    def __init__(self, rest, cage, weights):
        self._rest, self._cage, self._weights = rest, cage, weights

    def __call__(self, cage):
        return self._rest + self._weights @ (cage - self._cage)


class Engine:
    name = "program"
    has_all_kinds = False

    def __init__(self, why_no_library=""):
        given = preferences().program
        program = given or shutil.which("cagewright") or ""
        if not program or not pathlib.Path(program).is_file():
            raise Failure(f"there is no program {given}: give its place in the add-on's preferences" if given
                          else _NOT_FOUND.format(why_no_library or "it is not there"))
        self._program = program

    def describe(self):
        return f"Program {self._program}"

    def _run(self, arguments, threads, progress, allowed=(0,)):
        head = [self._program] + (["--threads", str(threads)] if threads else [])
        with tempfile.TemporaryFile() as said:
            running = subprocess.Popen(head + arguments, stdout=said, stderr=subprocess.STDOUT)
            while running.poll() is None:
                if progress is not None and progress(0.0, arguments[0]) is False:
                    running.terminate()
                    running.wait()
                    raise Cancelled()
                time.sleep(0.05)
            said.seek(0)
            if running.returncode not in allowed:
                lines = said.read().decode("utf-8", "replace").strip().splitlines()
                raise Failure(lines[-1] if lines else f"the program ended with {running.returncode}")

    def generate(self, vertices, faces, options, threads=None, progress=None, start=None):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_ply(folder / "model.ply", vertices, *faces)
            given = []
            if start is not None:
                write_ply(folder / "start.ply", start[0], *start[1])
                given += ["--start", str(folder / "start.ply")]
            for option, text in options.items():
                is_switch = option == "quads"
                given += [f"--{option}"] * (text == "on") if is_switch else [f"--{option}", text]
            self._run(["generate", str(folder / "model.ply"), "-o", str(folder / "cage.ply"), "--json",
                       str(folder / "cage.json")] + given, threads, progress, allowed=(0, 3))
            if not (folder / "cage.ply").exists():
                report = json.loads((folder / "cage.json").read_text(encoding="utf-8"))
                raise Failure(report.get("error", report).get("message", "no cage was made"))
            return Cage(*read_ply(folder / "cage.ply"), json.loads((folder / "cage.json").read_text(encoding="utf-8")))

    def check(self, vertices, faces, cage_vertices, cage_faces, max_listed, threads=None, progress=None):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_ply(folder / "model.ply", vertices, *faces)
            write_ply(folder / "cage.ply", cage_vertices, *cage_faces)
            self._run(["check", str(folder / "model.ply"), str(folder / "cage.ply"), "--allow-pieces", "--max-listed",
                       str(max_listed), "--json", str(folder / "check.json")], threads, progress, allowed=(0, 1))
            return json.loads((folder / "check.json").read_text(encoding="utf-8"))

    def weights(self, vertices, cage_vertices, cage_faces, kind, settings, threads=None, progress=None):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            points = np.arange(len(vertices) - len(vertices) % 3, dtype=np.int32)
            loose = np.arange(max(0, len(vertices) - 3), len(vertices), dtype=np.int32)
            corners = np.concatenate([points, loose])
            write_ply(folder / "model.ply", vertices, corners, np.arange(0, len(corners) + 1, 3))
            write_ply(folder / "cage.ply", cage_vertices, *cage_faces)
            given = [word for option, value in settings.items()
                     for word in (f"--{option.replace('_', '-')}", str(value))]
            self._run(["bind", str(folder / "model.ply"), str(folder / "cage.ply"), "-o", str(folder / "weights.npz"),
                       "--coordinates", kind] + given, threads, progress)
            return np.load(folder / "weights.npz")["weights"].astype(np.float64)

    def deformer(self, vertices, faces, cage_vertices, cage_faces, kind, settings, threads=None, progress=None):
        weights = self.weights(vertices, cage_vertices, cage_faces, kind, settings, threads, progress)
        if weights.shape[1] != len(cage_vertices):
            raise Failure(f"{kind}: these coordinates need Cagewright's library; by its program a model can follow "
                          "the vertices of a cage alone, as with mean value coordinates")
        return _Matrix(np.array(vertices, np.float64), np.array(cage_vertices, np.float64), weights)
