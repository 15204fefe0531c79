"""Writes small valid files of each format, as seeds for the fuzzers: fuzz_seeds.py FOLDER"""

import pathlib
import struct
import sys

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
TEXT_POINTS = "".join("%g %g %g\n" % p for p in POINTS)
TEXT_FACES = "".join("3 %d %d %d\n" % f for f in FACES)
PLY = ("element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
       "property list uchar int vertex_indices\nend_header\n")
FLOATS = b"".join(struct.pack("<3f", *p) for p in POINTS)

SEEDS = {
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
