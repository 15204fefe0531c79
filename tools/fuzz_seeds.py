"""Writes small valid files of each kind, as seeds for the fuzzers: fuzz_seeds.py FOLDER"""

import base64
import io
import json
import pathlib
import struct
import sys
import zipfile
import zlib

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
TEXT_POINTS = "".join("%g %g %g\n" % p for p in POINTS)
TEXT_FACES = "".join("3 %d %d %d\n" % f for f in FACES)
PLY = ("element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
       "property list uchar int vertex_indices\nend_header\n")
FLOATS = b"".join(struct.pack("<3f", *p) for p in POINTS)



def npy(kind, shape, data):
    head = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}"
    head += " " * (63 - (len(head) + 10) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + data


def npy_text(text):
    return npy(f"<U{len(text)}", "()", text.encode("utf-32-le"))


def npz(compression):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression) as archive:
        for name, array in (("version", npy("<i8", "()", struct.pack("<q", 1))), ("kind", npy_text("mean_value")),
                            ("options", npy_text("quads=center")), ("columns", npy_text("vertices=4")),
                            ("model_checksum", npy("<u8", "()", struct.pack("<Q", 7))),
                            ("cage_positions", npy("<f8", "(4, 3)", struct.pack("<12d", *sum(POINTS, ())))),
                            ("cage_faces", npy("<i4", "(4, 3)", struct.pack("<12i", *sum(FACES, ())))),
                            ("weights", npy("<f4", "(2, 4)", struct.pack("<8f", .25, .25, .25, .25, .7, .1, .1, .1)))):
            archive.writestr(zipfile.ZipInfo(name + ".npy"), array, compression)
    return file.getvalue()


ROWS = [[.25, .25, .25, .25], [.7, .1, .1, .1]]
WEIGHTS_JSON = {"format": "cagewright-weights", "version": 1, "kind": "mean_value", "options": "quads=center",
                "columns": "vertices=4", "model_vertices": 2, "model_checksum": "7", "cage_positions": POINTS,
                "cage_faces": FACES, "weights": ROWS}
WEIGHTS_CSV = ("# cagewright weights, version 1, mean_value\n# options quads=center\n# columns vertices=4\n# model 2 7\n" +
               "".join("# v %g %g %g\n" % p for p in POINTS) + "".join("# f %d %d %d\n" % f for f in FACES) +
               "model_vertex,cage_vertex,weight\n" +
               "".join(f"{row},{column},{w}\n" for row, r in enumerate(ROWS) for column, w in enumerate(r)) + "# end\n")


def project(**more):
    pose = [[x + .5, y, z] for x, y, z in POINTS]
    return {"format": "cagewright-project", "version": 1, "model": {"path": "/a.obj", "relative_path": "a.obj", "checksum": "7"},
            "cage": {"vertices": POINTS, "faces": FACES}, "pose": pose, "bound": True,
            "poses": [{"name": "bent", "positions": pose, "share": 0.5}],
            "time_line": {"first": 1, "last": 9, "frames_per_second": 24,
                          "keys": [{"frame": 1, "positions": POINTS, "shares": [0]}, {"frame": 5, "positions": pose, "shares": [1]}]},
            "density": base64.b64encode(struct.pack(">I", 4) + zlib.compress(b"\0\x32\x9c\1")).decode(),
            "generate": {"vertices": 60, "method": "envelope", "quads": "on", "clearance": 0.01},
            "view": {"camera": {"target": [0, 0, 0], "distance": 3, "yaw_degrees": 30, "pitch_degrees": -20, "perspective": True},
                     "layers": {"wireframe": True, "look": 1, "depth": 2},
                     "tools": {"tool": 1, "symmetry_axis": 1, "brush_radius": 40, "falloff": 2}}, **more}


SEEDS = {
    "weights": {
        "csv": WEIGHTS_CSV, "json": json.dumps(WEIGHTS_JSON), "stored.npz": npz(zipfile.ZIP_STORED),
        "deflated.npz": npz(zipfile.ZIP_DEFLATED),
        "dmat": "4 2\n" + "".join(f"{r[c]}\n" for c in range(4) for r in ROWS),
    },
    "numbers": {
        "text": "# weights\n1\n0.5\n\n2e3\n0\n",
        "npy": npy("<f4", "(4,)", struct.pack("<4f", 1, 2, 3, 4)), "column": npy("<i2", "(4, 1)", struct.pack("<4h", 1, 2, 3, 4)),
    },
    "project": {"whole": json.dumps(project()), "newer": json.dumps(project(version=2)), "empty": '{"format":"cagewright-project","version":1}'},
    "generate": {str(i): bytes((i * 37 + k * k * (i + 3)) % 256 for k in range(200)) for i in range(8)},
    "obj": {
        "plain": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
        "dressed": "mtllib a.mtl\no a\ng b c\nv 0 0 0 1 0 0.5\nv 1 0 0\nv 1 1 0 255 0 0\nv 0 1 0 1.0\nvt 0 0\nvt 1 1\n"
                   "vn 0 0 1\nvn 1.#QNAN 0 0\nusemtl a\\\ns 1\nf 1/1/1 2//2 -2/2 \\\n4/1/1 4\nl 1 2\nf 1 2\n",
        "keyhole": "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 3 3 0\nv 3 6 0\nv 6 6 0\nv 6 3 0\nf 1 2 3 4 1 5 6 7 8 5\n",
    },
    "off": {
        "plain": "OFF\n4 4 6\n" + TEXT_POINTS + TEXT_FACES,
        "glued": "OFF4 4\n" + TEXT_POINTS + "3 0 1 2 255 0 0\n2 0 1\n3 0 2 3 0.5 1 0 1\n4 0 1 2 3\n",
        "ncoff": "NCOFF # x\n3 1 0\n0 0 0 10 20 30 255 0 0 1\n1 0 0 10 20 30 255 0 0 1\n0 1 0 1 2 3 255 0 0 1\n3 0 1 2\n",
        "stoff": "STOFF\n3 1 0\n0 0 0 .1 .2\n1 0 0 0 1\n0 1 0 1 1\n3 0 1 2\n",
        "4off": "4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 1 0 1\n3 0 1 2\n",
        "binary": b"OFF BINARY\n" + struct.pack(">3I9f", 3, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0) +
                  struct.pack(">5I", 3, 0, 1, 2, 0),
    },
    "ply": {
        "text": "ply\nformat ascii 1.0\ncomment x\n" + PLY + TEXT_POINTS + TEXT_FACES,
        "binary": b"ply\nformat binary_little_endian 1.0\n" + PLY.encode() + FLOATS +
                  b"".join(struct.pack("<B3i", 3, *f) for f in FACES),
        "dressed": "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                   "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
                   "property uchar blue\nproperty float quality\nproperty float s\nproperty float t\nelement face 1\n"
                   "property list uchar int vertex_index\nproperty int label\nelement edge 1\nproperty list uint8 int v\n"
                   "end_header\n0 0 0 0 0 1 1 2 3 .5 0 0\n1 0 0 0 0 1 1 2 3 .5 0 0\n0 1 0 0 0 1 1 2 3 .5 0 0\n3 0 1 2 7\n2 0 1\n",
        "strips": "ply\nformat ascii 1.0\n" + PLY.replace("face 4", "tristrips 1") + TEXT_POINTS + "5 0 1 2 -1 3\n",
    },
    "stl": {
        "text": "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nend loop\n"
                "endfacet color 1 0 0\nendsolid a\n",
        "binary": b" " * 80 + struct.pack("<I12fH", 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 7),
    },
    "gltf": {
        "plain": '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,2,2]}],'
                 '"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,'
                 '"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":12,'
                 '"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,'
                 '"byteLength":24}],"buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,'
                 'AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMA"}]}',
    },
}

for target, files in SEEDS.items():
    folder = pathlib.Path(sys.argv[1], target)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
