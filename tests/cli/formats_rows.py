"""What is read, kept and refused: the rows of docs/formats.md, each with files that show it.

SECTIONS is a list of (title, rows); a row is (the file, is, samples): two cells of the page, and files (name, bytes,
expectation). Unless told otherwise a sample shows the unit square: 4 vertices (in STL 6) and 2 triangles. Expectations:

    read(vertices, faces, note)    what `info` says; `note` is the code of the only note, none without
    refused(texts...)              exit code 2, and a message with all the texts
"""

import base64
import gzip
import json
import struct

POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def read(vertices=4, faces=2, note=None, **more):
    return {"code": 0, "vertices": vertices, "faces": faces, "note": note, **more}


def refused(*texts):
    return {"code": 2, "texts": texts}


def sample(name, content, expectation=None):
    content = content if isinstance(content, bytes) else content.encode()
    return name, content, expectation or read(6 if name.endswith(".stl") else 4)


# ---- OBJ

V = "".join("v {} {} {}\n".format(*p) for p in POINTS)
F = "f 1 2 3\nf 1 3 4\n"


def obj(text, expectation=None, name="a.obj"):
    return sample(name, text, expectation)


# ---- PLY

PLY_FACES = "element face 2\nproperty list uchar int vertex_indices\n"
PLY_ROWS = "3 0 1 2\n3 0 2 3\n"


def ply_head(form="ascii", vertex="property float x\nproperty float y\nproperty float z\n", faces=PLY_FACES, count=4):
    return f"ply\nformat {form} 1.0\nelement vertex {count}\n{vertex}{faces}end_header\n"


def ply_text(vertex=None, rows=None, faces=PLY_FACES, lists=PLY_ROWS, **head):
    rows = rows if rows is not None else "".join("{} {} {}\n".format(*p) for p in POINTS)
    return ply_head(faces=faces, **({"vertex": vertex} if vertex else {}), **head) + rows + lists


def ply_binary(order, coordinate="f", coordinate_type="float", count="B", count_type="uchar", index="i", index_type="int"):
    head = ply_head("binary_big_endian" if order == ">" else "binary_little_endian",
                    "".join(f"property {coordinate_type} {axis}\n" for axis in "xyz"),
                    f"element face 2\nproperty list {count_type} {index_type} vertex_indices\n")
    return head.encode() + b"".join(struct.pack(order + 3 * coordinate, *p) for p in POINTS) + \
        b"".join(struct.pack(f"{order}{count}{3 * index}", 3, *t) for t in TRIANGLES)


# ---- STL


def stl_facet(t, word="facet normal 0 0 1", end_facet="endfacet", loop="outer loop", end_loop="endloop", vertex="vertex"):
    return f"{word}\n{loop}\n" + "".join("{} {} {} {}\n".format(vertex, *POINTS[v]) for v in t) + f"{end_loop}\n{end_facet}\n"


def stl_text(begin="solid a\n", end="endsolid a\n", **words):
    return begin + "".join(stl_facet(t, **words) for t in TRIANGLES) + end


def stl_binary(head=b"", count=2, attribute=0, behind=b"", normal=(0, 0, 1), form="<f"):
    facets = b"".join(struct.pack("<12fH", *normal, *POINTS[a], *POINTS[b], *POINTS[c], attribute) for a, b, c in TRIANGLES)
    return head.ljust(80, b" ") + struct.pack("<i", count) + facets + behind


# ---- OFF

OFF_POINTS = "".join("{} {} {}\n".format(*p) for p in POINTS)


def off(head="OFF\n4 2 0\n", points=OFF_POINTS, lists=PLY_ROWS, behind=""):
    return sample("a.off", head + points + lists + behind)


# ---- glTF

FLOATS = b"".join(struct.pack("<3f", *p) for p in POINTS)


def gltf_parts(positions=FLOATS, component=5126, indices=struct.pack("<6H", *sum(TRIANGLES, ())), index_component=5123,
               normalized=False, stride=None, count=4):
    """JSON and binary of a scene with one mesh under one node."""
    pad = b"\0" * (-len(positions) % 4)
    views = [{"buffer": 0, "byteLength": len(positions)},
             {"buffer": 0, "byteOffset": len(positions) + len(pad), "byteLength": len(indices)}]
    if stride:
        views[0]["byteStride"] = stride
    binary = positions + pad + indices
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "square"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": component, "count": count, "type": "VEC3", "min": [0, 0, 0],
                           "max": [1, 1, 0], **({"normalized": True} if normalized else {})},
                          {"bufferView": 1, "componentType": index_component, "type": "SCALAR",
                           "count": len(indices) // {5121: 1, 5123: 2, 5125: 4}[index_component]}],
            "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}, binary


def gltf(change=lambda document: None, container="glb", expectation=None, json_tail=b"", **parts):
    document, binary = gltf_parts(**parts)
    change(document)
    if container == "gltf":
        document["buffers"][0].setdefault("uri", "data:application/octet-stream;base64," + base64.b64encode(binary).decode())
        return sample("a.gltf", json.dumps(document), expectation)
    text = json.dumps(document).encode() + json_tail
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    return sample("a.glb", struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON") + text +
                  struct.pack("<I4s", len(binary), b"BIN\0") + binary, expectation)


def put(*path):
    """put("nodes", 0, "mesh", 3) sets document["nodes"][0]["mesh"] = 3."""
    def change(document):
        for key in path[:-2]:
            document = document[key]
        document[path[-2]] = path[-1]
    return change


def all_of(*changes):
    def change(document):
        for each in changes:
            each(document)
    return change


def sparse(document):
    document["bufferViews"].append({"buffer": 0, "byteOffset": 48, "byteLength": 2})
    document["bufferViews"].append({"buffer": 0, "byteOffset": 12, "byteLength": 12})
    document["accessors"][0]["sparse"] = {"count": 1, "indices": {"bufferView": 2, "componentType": 5123},
                                          "values": {"bufferView": 3}}


TEXT = [
    ("lines that end with `\\n`, `\\r\\n`, `\\r` alone, or a mixture", "read",
     [obj((V + F).replace("\n", end)) for end in ("\r\n", "\r")] + [obj(V.replace("\n", "\r\n") + F.replace("\n", "\r")),
      sample("a.ply", ply_text().replace("\n", "\r\n")), sample("a.off", ("OFF\n4 2 0\n" + OFF_POINTS + PLY_ROWS).replace("\n", "\r")),
      sample("a.stl", stl_text().replace("\n", "\r\n"))]),
    ("the mark of UTF-8 in front; zeros or Control-Z behind", "read",
     [obj(b"\xef\xbb\xbf" + (V + F).encode()), obj((V + F).encode() + b"\x1a"), obj((V + F).encode() + bytes(20)),
      sample("a.stl", b"\xef\xbb\xbf" + stl_text().encode()), sample("a.off", b"\xef\xbb\xbfOFF\n4 2 0\n" + (OFF_POINTS + PLY_ROWS).encode())]),
    ("UTF-16, with its mark or without", "read; note `utf16`. Written again it is UTF-8",
     [obj((V + F).encode(code), read(note="utf16")) for code in ("utf-16", "utf-16-le", "utf-16-be")] +
     [obj(b"\xfe\xff" + (V + F).encode("utf-16-be"), read(note="utf16"))]),
    ("`1.5D+00`, exponents of Fortran; `+1`, `.5`, `1.`, `1e0`", "read",
     [obj(V.replace("v 1 0 0", "v 1.0D+00 0 0").replace("v 1 1 0", "v +1. 1d0 .0") + F), obj(V.replace("1", "1e0").replace(" 0", " -0.") + F)]),
    ("`nan`, `1.#QNAN`, `-1.#IND`, `1.#INF` in a normal or texture point",
     "read: nothing uses it, and it stays as it stands when the model is written again",
     [obj(V + f"vn {word} 0 0\nvt {word} 0\n" + F) for word in ("nan", "-1.#IND", "1.#QNAN0", "1.#INF", "-nan(ind)")]),
    ("the same in a position", "refused",
     [obj(V.replace("v 1 1", f"v {word} 1") + F, refused("a.obj:3", "not a finite number")) for word in ("nan", "inf", "1.#INF", "-1.#IND", "1e400")]),
    ("a coordinate beyond 1e100", "refused: nothing can be measured with it",
     [obj(V.replace("v 1 1", f"v {word} 1") + F, refused("a.obj: vertex 2", "beyond 1e100")) for word in ("1e308", "-2e100")] +
     [sample("a.stl", stl_text().replace("1", "1e150").encode(), refused("a.stl: vertex", "beyond 1e100"))]),
    ("decimal commas, thousands separators, commas between numbers",
     "refused: says which of the three it is and what to replace. Exporting with the same setting gives the same file",
     [obj(V.replace("v 1 0 0", "v 1,0 0 0") + F, refused("a.obj:2", "decimal comma", "replace ',' by '.'")),
      obj(V + F + "f 1,003 1 2\n", refused("a.obj:7", "thousands separator")),
      obj(V.replace("v 1 0 0", "v 1, 0, 0") + F, refused("a.obj:2", "separated by blanks", "replace ',' by ' '"))]),
    ("`1'000`, `1.234.567`, semicolons, a minus or blanks of typesetting (U+2212, U+00A0)", "refused: says what to replace",
     [obj(V.replace("v 1 0 0", f"v {word} 0 0") + F, refused("a.obj:2", *texts)) for word, *texts in
      (("1'000", "thousands", "remove the apostrophes"), ("1.234.567", "thousands", "remove the dots"), ("1;0;0", "replace ';' by ' '"),
       ("\u22121", "U+2212", "replace it by '-'"), ("1\u00a0000", "U+00A0", "replace it by a blank"))]),
    ("a face of one or two corners", "left out; note `short_face`",
     [obj(V + F + "f 1 2\nf 3\n", read(note="short_face")),
      sample("a.ply", ply_text(faces=PLY_FACES.replace("face 2", "face 3"), lists=PLY_ROWS + "2 0 1\n"), read(note="short_face"))]),
    ("a face that names a corner twice in a row", "the corner is taken once; note `repeated_corner`",
     [obj(V + "f 1 2 2 3\nf 1 3 4 1\n", read(note="repeated_corner"))]),
    ("a polygon with a hole, joined to its outline by a bridge that is walked there and back", "read: the hole stays open",
     [obj("".join(f"v {x} {y} 0\n" for x, y in ((0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (1, 2), (2, 2), (2, 1))) +
          "f 1 2 3 4 1 5 6 7 8 5\n", read(8, 1, area=8))]),
    ("an archive (gzip, zip, 7z, xz), or another program's format (FBX, 3DS, Blender, STEP, USD, 3MF, DAE, IGES, VRML, DXF, MAX, LWO)",
     "refused by its name, with what helps",
     [obj(gzip.compress((V + F).encode()), refused("gzip", "unpack")), obj(b"PK\x03\x04" + bytes(100), refused("zip", "unpack")),
      obj(b"Kaydara FBX Binary  \0\x1a\0", refused("FBX", "as OBJ")), obj(b"BLENDER-v300", refused("Blender")),
      obj(b"ISO-10303-21;\nHEADER;\n", refused("STEP")), obj(b"#VRML V2.0 utf8\n", refused("VRML")),
      obj(b"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"\">", refused("COLLADA")), obj(b"<X3D profile='x'>", refused("X3D")),
      obj(b"#usda 1.0\n", refused("USD")), obj(b"PXR-USDC" + bytes(80), refused("USD")),
      obj(b"  0\nSECTION\n  2\nHEADER\n", refused("DXF")), obj(b"; FBX 7.4.0 project file\n", refused("FBX")),
      obj(b"7z\xbc\xaf\x27\x1c" + bytes(40), refused("7z")), obj(b"\xfd7zXZ\0" + bytes(40), refused("xz")),
      obj(b"MM\x1c\0\0\0\2\0" + bytes(20), refused("3DS")),
      obj(b"# vtk DataFile Version 3.0\nx\nASCII\n", refused("VTK")), obj(b"$MeshFormat\n2.2 0 8\n", refused("Gmsh")),
      obj(b"MeshVersionFormatted 1\nDimension 3\n", refused("Medit")), obj(b"FORM\0\0\0\x20LWO2" + bytes(24), refused("LightWave")),
      obj(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(80), refused("SolidWorks")), obj(b"**ABCDEFGHIJKLMNOP\n", refused("Parasolid")),
      obj(b"# .PCD v0.7\n", refused("point cloud")), obj(b"a.obj" + bytes(252) + b"ustar\0" + bytes(250), refused("tar", "unpack")),
      obj((V + F).encode("utf-32"), refused("UTF-32", "UTF-8"))]),
    ("an empty file; a page of HTML in its place; a picture; a pointer of Git LFS", "refused by what it is",
     [obj("", refused("empty")), obj("<!DOCTYPE html>\n<html>", refused("HTML", "download")),
      obj(b"\x89PNG\r\n\x1a\n" + bytes(30), refused("PNG")), obj(b"\xff\xd8\xff\xe0" + bytes(30), refused("JPEG")),
      obj("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 3\n", refused("Git LFS", "git lfs pull"))]),
    ("a name that promises another format than the content shows", "read by its content",
     [sample("a.obj", ply_text()), sample("a.stl", ply_text(), read(4)), sample("a.ply", V + F), sample("a.off", stl_text(), read(6))]),
]

OBJ = [
    ("a backslash at the line's end in a list of numbers (`v`, `vt`, `vn`, `f`, `l`, `p`, curves)", "goes on with the next line",
     [obj(V + "f 1 2 \\\n3\nf 1 \\\r\n 3 4\n"), obj("v 0 0 \\\n0\n" + V[8:] + F)]),
    ("a backslash at the end of a name (`usemtl`, `mtllib`, `o`, `g`) or a comment",
     "is part of the name: many characters of Shift-JIS and GBK end in that byte",
     [obj(V.encode() + word + b" \x83\x5c\n" + F.encode()) for word in (b"usemtl", b"g", b"o", b"mtllib", b"#")]),
    ("`1/`, `1//`, `1/1/`, `-1`, normals and texture points that are not there", "read",
     [obj(V + "f 1/ 2// 3/3/\nf 1//9 3/7 4/7/9\n"), obj(V + "f -4 -3 -2\nf -4 -2 -1\n"),
      obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n")]),
    ("`v x y z w`", "w is left out", [obj("".join("v {} {} {} 1.0\n".format(*p) for p in POINTS) + F)]),
    ("`v x y z r g b`, from 0 to 1 or from 0 to 255; with alpha", "read with colours",
     [obj("".join("v {} {} {} 0.5 1 0\n".format(*p) for p in POINTS) + F), obj("".join("v {} {} {} 128 255 0\n".format(*p) for p in POINTS) + F),
      obj("".join("v {} {} {} 0.5 1 0 1\n".format(*p) for p in POINTS) + F)]),
    ("colours of ZBrush in comments (`#MRGB`)", "passed over", [obj(V + "#MRGB ffffffffff00ff00\n" + F)]),
    ("several names after `g`; `o` before `g`; none", "the group has the whole line as its name, and belongs to the object",
     [obj(V + "o a\ng b c\nf 1 2 3\ng\nf 1 3 4\n")]),
    ("faces before their vertices", "read", [obj(F + V)]),
    ("corners that count from 0, or beyond the vertices", "refused",
     [obj(V + "f 0 1 2\n", refused("a.obj:5", "counts from 1")), obj(V + "f 1 2 5\n", refused("a.obj:5", "5", "there are 4")),
      obj(V + "f -1 -2 -9\n", refused("a.obj:5", "-9"))]),
    ("lines, points, curves and free-form surfaces (`l`, `p`, `cstype`, `curv`, `surf`, `parm`, `trim`, `end`) beside faces", "passed over",
     [obj(V + F + "l 1 2 3\np 1\n"), obj(V + "vp 0.5 0.5\ncstype rat bspline\ndeg 3 3\ncurv 0 1 1 2 3 4\nparm u 0 0 \\\n0 1\nsurf 0 1 0 1 1 2 3 4\n"
                                         "trim 0 2 1\nend\n" + F)]),
    ("free-form surfaces, lines or points alone", "refused: a surface of faces is needed",
     [obj(V + "l 1 2 3 4\n", refused("no faces")), obj(V + "p 1 2\n", refused("no faces")),
      obj(V + "cstype bezier\ndeg 3 3\nsurf 0 1 0 1 1 2 3 4\nend\n", refused("free-form", "mesh"))]),
    ("blanks and tabs in front, between and behind", "read",
     [obj("  v\t0 0 0\n\tv 1 0 0\n v 1 1 0\nv 0 1 0 \t\n" + F.replace("f", "\tf"))]),
    ("`usemap`, `lod`, `shadow_obj`, `call` and other settings", "passed over", [obj("mtllib a.mtl\nusemap x\nlod 1\nshadow_obj b.obj\n" + V + F)]),
    ("statements nobody knows", "left out; note `unknown_statement`",
     [obj(V + "xyzzy 1 2\n" + F, read(note="unknown_statement")), obj(V + F + "\x1af 1 2 4\n", read(note="unknown_statement"))]),
    ("zeros within the text", "refused with the line", [obj(V + F + "\0f 1 2 4\n" + F, refused("a.obj:7", "zeros", "damaged"))]),
    ("a polygon of Maya with hundreds of corners on a line", "read",
     [obj("".join(f"v {i} {i * i} 0\n" for i in range(400)) + "f " + " ".join(map(str, range(1, 401))) + "\n", read(400, 1))]),
]

STL = [
    ("`end loop`, `end facet`, `end solid`; upper case; words or colours behind a statement; all on one line", "read",
     [sample("a.stl", stl_text(end_loop="end loop", end_facet="end facet")), sample("a.stl", stl_text().upper()),
      sample("a.stl", stl_text(end_facet="endfacet 12 200 3")), sample("a.stl", stl_text().replace("\n", " ")),
      sample("a.stl", stl_text(end="end solid a b c\n")), sample("a.stl", stl_text(begin="SOLID\n", end="ENDSOLID"))]),
    ("text without the line `solid`", "read; note `no_solid`", [sample("a.stl", stl_text(begin=""), read(6, note="no_solid"))]),
    ("several solids", "read as one mesh", [sample("a.stl", stl_text() + stl_text(), read(12, 4))]),
    ("binary that begins with `solid`", "read as binary", [sample("a.stl", stl_binary(b"solid exported by a CAD program\n")),
      sample("a.stl", stl_binary("solid".encode("utf-16")))]),
    ("binary with colours in its attributes (VisCAM, Materialise)", "read without colours",
     [sample("a.stl", stl_binary(attribute=0xffff)), sample("a.stl", stl_binary(b"COLOR=\xff\0\0\xff,MATERIAL=", attribute=0x7c00))]),
    ("binary whose count of facets was left at 0 or -1", "all facets are read; note `facet_count`",
     [sample("a.stl", stl_binary(count=n), read(6, note="facet_count")) for n in (0, -1)]),
    ("binary with bytes behind the facets", "these are left out; note `trailing_bytes`",
     [sample("a.stl", stl_binary(behind=b"made by hand"), read(6, note="trailing_bytes"))]),
    ("binary that promises more facets than there are", "refused", [sample("a.stl", stl_binary(count=7), refused("cut short"))]),
    ("normals of any kind, `nan` among them", "computed from the corners",
     [sample("a.stl", stl_text(word="facet normal nan nan nan")), sample("a.stl", stl_binary(normal=(float("nan"),) * 3)),
      sample("a.stl", stl_text(word="facet normal 0 0 0"))]),
    ("text with a facet of other than three corners", "refused with the line",
     [sample("a.stl", stl_text().replace("vertex 1 0 0\n", "", 1), refused("a.stl:", "3"))]),
    ("text that ends within a facet, or without the line `endsolid`", "refused: it is cut short",
     [sample("a.stl", stl_text()[:120], refused("cut short")), sample("a.stl", stl_text(end=""), refused("cut short"))]),
]

PLY = [
    ("text with rows over several lines, or several on one", "read: values are counted, not lines",
     [sample("a.ply", ply_text(rows="0 0\n0 1 0 0\n1 1\n0 0\n1 0\n")), sample("a.ply", ply_text(lists="3 0 1 2 3 0 2 3\n"))]),
    ("text with more on a line than the row needs", "the rest is left out, if every row is on its line",
     [sample("a.ply", ply_text(rows="".join("{} {} {} 7\n".format(*p) for p in POINTS)))]),
    ("comments and `obj_info` anywhere in the header", "read",
     [sample("a.ply", ply_text().replace("element face", "comment hello\nobj_info num 1\nelement face"))]),
    ("types as `float`, `float32`, `Float`, `uint8_t`, `double64`", "read",
     [sample("a.ply", ply_text(vertex=f"property {t} x\nproperty {t} y\nproperty {t} z\n")) for t in ("float", "float32", "Float", "double64", "int16", "uint8")]),
    ("binary of either byte order, with any types of coordinates, counts and corners", "read",
     [sample("a.ply", ply_binary(order, *types)) for order in "<>" for types in (
         (), ("d", "double"), ("f", "float", "i", "int", "I", "uint"), ("f", "float32", "B", "uint8", "B", "uint8"), ("h", "short", "H", "ushort", "h", "short"))]),
    ("corners under `vertex_indices`, `vertex_index`, or in the only list of integers", "read",
     [sample("a.ply", ply_text(faces=PLY_FACES.replace("vertex_indices", name))) for name in ("vertex_indices", "vertex_index", "corners")]),
    ("colours as `red`, `r`, `diffuse_red`, in bytes or floats; `intensity`, `quality`, `confidence`", "read; kept",
     [sample("a.ply", ply_text(vertex="property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                                      "property uchar alpha\nproperty float quality\n", rows="".join("{} {} {} 255 0 0 255 0.5\n".format(*p) for p in POINTS)))]),
    ("faces with further properties, texture numbers, flags (MeshLab, CloudCompare, Open3D)", "read; kept",
     [sample("a.ply", ply_text(faces="element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n",
                               lists="3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 0\n")),
      sample("a.ply", ply_text(faces="element face 2\nproperty uchar intensity\nproperty list uchar int vertex_indices\nproperty float q\n", lists="7 3 0 1 2 .5\n7 3 0 2 3 .5\n"))]),
    ("triangle strips; lists and elements of others (`edge`, `camera`, `material`)", "read; passed over",
     [sample("a.ply", ply_text(faces="element tristrips 1\nproperty list int int vertex_indices\n", lists="4 0 1 3 2\n")),
      sample("a.ply", ply_text(faces="element tristrips 1\nproperty list int int vertex_indices\n", lists="7 0 1 2 -1 0 2 3\n")),
      sample("a.ply", ply_text(faces=PLY_FACES + "element edge 1\nproperty int vertex1\nproperty int vertex2\nelement camera 1\nproperty list uchar float m\n",
                               lists=PLY_ROWS + "0 1\n2 1.5 2.5\n"))]),
    ("faces before the vertices", "read",
     [sample("a.ply", "ply\nformat ascii 1.0\n" + PLY_FACES + "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + PLY_ROWS + OFF_POINTS)]),
    ("something behind the last element", "left out; note `trailing_bytes`",
     [sample("a.ply", ply_text() + "9 9 9\n", read(note="trailing_bytes"))]),
    ("a point cloud", "refused", [sample("a.ply", ply_text(faces="", lists=""), refused("no faces"))]),
    ("fewer rows than promised; a corner beyond the vertices; a header without its end", "refused with the place",
     [sample("a.ply", ply_text(lists="3 0 1 2\n"), refused("cut short")), sample("a.ply", ply_text(lists="3 0 1 9\n3 0 1 2\n"), refused("a.ply:", "9", "there are 4")),
      sample("a.ply", ply_text().replace("element vertex", "element vertices"), refused("no element 'vertex'")),
      sample("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", refused("end_header"))]),
]

OFF = [
    ("`OFF642 1280 0`: the counts right behind the header, over lines, or without that of edges", "read",
     [off("OFF4 2 0\n"), off("OFF 4 2 0\n"), off("off\n4 2 0\n"), off("OFF\n4\n2\n0\n"), off("OFF\n4 2\n"), off("4 2 0\n")]),
    ("comments and empty lines anywhere", "read", [off("OFF\n# made by hand\n\n4 2 0 # counts\n", behind="\n# end\n")]),
    ("`4OFF`", "x/w y/w z/w; w becomes 1 when it is written again", [off("4OFF\n4 2 0\n", "".join("{} {} {} 2\n".format(*(2 * x for x in p)) for p in POINTS))]),
    ("`NCOFF` in the format's order or in MeshLab's (colour before normal)", "told by the numbers: whole ones above 1 are colours, three of unit length a normal",
     [off("NCOFF\n4 2 0\n", "".join("{} {} {} 0 0 1 255 0 0 255\n".format(*p) for p in POINTS)), off("NCOFF\n4 2 0\n", "".join("{} {} {} 255 0 0 255 0 0 1\n".format(*p) for p in POINTS))]),
    ("`COFF`, `NOFF`, `STOFF`; colours with three or four channels", "read",
     [off("COFF\n4 2 0\n", "".join("{} {} {} 255 0 0 255\n".format(*p) for p in POINTS)), off("COFF\n4 2 0\n", "".join("{} {} {} 0.5 0 0 1\n".format(*p) for p in POINTS)),
      off("NOFF\n4 2 0\n", "".join("{} {} {} 0 0 1\n".format(*p) for p in POINTS)), off("STOFF\n4 2 0\n", "".join("{} {} {} 0.5 1\n".format(*p) for p in POINTS))]),
    ("numbers behind the vertices of a plain OFF", "left out; note `extra_numbers`",
     [sample("a.off", "OFF\n4 2 0\n" + "".join("{} {} {} 255 0 0\n".format(*p) for p in POINTS) + PLY_ROWS, read(note="extra_numbers"))]),
    ("colours of faces: a number of a map, three or four channels, whole or not", "read",
     [off(lists="3 0 1 2 7\n3 0 2 3 255 0 0\n"), off(lists="3 0 1 2 0.5 0.5 0.5 1\n3 0 2 3 0 0 1\n")]),
    ("binary OFF", "read", [sample("a.off", b"OFF BINARY\n" + struct.pack(">3i", 4, 2, 0) + b"".join(struct.pack(">3f", *p) for p in POINTS) +
                                   b"".join(struct.pack(">5i", 3, *t, 0) for t in TRIANGLES))]),
    ("`nOFF` of other than 3 dimensions; fewer rows than promised", "refused",
     [sample("a.off", "nOFF\n2\n4 2 0\n", refused("3 dimensions")), sample("a.off", "OFF\n4 3 0\n" + OFF_POINTS + PLY_ROWS, refused("cut short"))]),
]

GLTF = [
    ("GLB, and JSON with its buffer in a data URI of any type, in base64 or escapes", "read",
     [gltf(), gltf(container="gltf"), gltf(put("buffers", 0, "uri", "data:application/gltf-buffer;base64," + base64.b64encode(gltf_parts()[1]).decode()), "gltf"),
      gltf(put("buffers", 0, "uri", "data:,".replace(",", ",") + "".join(f"%{b:02x}" for b in gltf_parts()[1])), "gltf")]),
    ("positions and indices as integers (KHR_mesh_quantization), normalized or not; interleaved", "read",
     [gltf(all_of(put("extensionsRequired", ["KHR_mesh_quantization"]), put("extensionsUsed", ["KHR_mesh_quantization"])),
           positions=b"".join(struct.pack("<4h", *(32767 * x for x in p), 0) for p in POINTS), component=5122, normalized=True, stride=8),
      gltf(positions=b"".join(struct.pack("<4B", *p, 0) for p in POINTS), component=5121, stride=4),
      gltf(indices=bytes(sum(TRIANGLES, ())), index_component=5121), gltf(indices=struct.pack("<6I", *sum(TRIANGLES, ())), index_component=5125),
      gltf(positions=b"".join(struct.pack("<4f", *p, 9) for p in POINTS), stride=16)]),
    ("sparse accessors", "read", [gltf(sparse)]),
    ("triangle strips and fans; no indices", "read",
     [gltf(put("meshes", 0, "primitives", 0, "mode", 6), indices=struct.pack("<4H", 0, 1, 2, 3)),
      gltf(put("meshes", 0, "primitives", 0, "mode", 5), indices=struct.pack("<4H", 0, 1, 3, 2)),
      gltf(lambda d: d["meshes"][0]["primitives"][0].pop("indices"), positions=b"".join(struct.pack("<3f", *POINTS[v]) for t in TRIANGLES for v in t), count=6,
           expectation=read(6))]),
    ("a mesh under several nodes, under none of the scene; no scene", "each node shows it once more; read; all root nodes of the first scene, or of the file",
     [gltf(lambda d: (d["nodes"].append({"mesh": 0, "translation": [3, 0, 0]}), d["scenes"][0]["nodes"].append(1)), expectation=read(8, 4)),
      gltf(lambda d: d.pop("scene")), gltf(lambda d: (d.pop("scene"), d.pop("scenes")))]),
    ("extensions of materials, textures, lights (KHR_texture_transform, KHR_materials_..., KHR_lights_punctual), extras", "passed over; `deform` keeps them",
     [gltf(all_of(put("extensionsUsed", ["KHR_texture_transform", "KHR_lights_punctual", "KHR_materials_unlit"]), put("extensions", {"KHR_lights_punctual": {"lights": []}}),
                  put("materials", [{"extensions": {"KHR_materials_unlit": {}}}]), put("extras", {"a": [1]})))]),
    ("points and lines beside triangles; other scenes", "left out; notes `points_and_lines`, `other_scenes`",
     [gltf(lambda d: d["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 0}), expectation=read(note="points_and_lines")),
      gltf(lambda d: d["scenes"].append({"nodes": [], "name": "b"}), expectation=read(note="other_scenes"))]),
    ("compression by Draco or meshopt; instances by EXT_mesh_gpu_instancing", "refused by its name, with what helps",
     [gltf(all_of(put("extensionsRequired", ["KHR_draco_mesh_compression"]), lambda d: (d["accessors"][0].pop("bufferView"), d["meshes"][0]["primitives"][0].update(
         extensions={"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}))), expectation=refused("draco", "without compression")),
      gltf(all_of(put("extensionsRequired", ["EXT_meshopt_compression"]), lambda d: d["bufferViews"][0].update(
          extensions={"EXT_meshopt_compression": {"buffer": 0, "byteLength": 4, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}})),
           expectation=refused("meshopt", "without compression")),
      gltf(lambda d: d["nodes"][0].update(extensions={"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}), expectation=refused("EXT_mesh_gpu_instancing", "as nodes"))]),
    ("an extension that is required and nobody here knows", "the plain part is read; note `unknown_extension`",
     [gltf(put("extensionsRequired", ["VENDOR_other_geometry"]), expectation=read(note="unknown_extension"))]),
    ("glTF 1.0; a chunk that is cut short; a buffer that is not there, on the network or at an absolute path", "refused",
     [gltf(put("asset", {"version": "1.0"}), expectation=refused("version")), sample("a.glb", gltf()[1][:-30], refused("cut short")),
      gltf(put("buffers", 0, "uri", "away.bin"), "gltf", refused("away.bin", "no such file")), gltf(put("buffers", 0, "uri", "/etc/passwd"), "gltf", refused("passwd")),
      gltf(put("buffers", 0, "uri", "https://example.org/a.bin"), "gltf", refused("https"))]),
    ("what contradicts itself: indices beyond the vertices, accessors beyond their buffers, nodes below themselves, two parents", "refused with the place",
     [gltf(indices=struct.pack("<3H", 0, 1, 9), expectation=refused("9", "there are 4")), gltf(put("accessors", 0, "byteOffset", -4), expectation=refused("accessors[0]", "byteOffset")),
      gltf(put("meshes", 0, "primitives", 0, "attributes", "POSITION", -1), expectation=refused("mesh 0, primitive 0", "positions")), gltf(put("accessors", 0, "count", 40), expectation=refused("accessor 0")),
      gltf(put("nodes", 0, "children", [0]), expectation=refused("node 0")), gltf(put("bufferViews", 0, "buffer", 3), expectation=refused("buffer"))]),
    ("a count of corners that makes no whole triangles", "what is left over is left out; note `odd_corners`",
     [gltf(indices=struct.pack("<8H", 0, 1, 2, 0, 2, 3, 1, 2), expectation=read(note="odd_corners"))]),
    ("BOM before the JSON; comments or a comma too many in it", "read; refused with the place",
     [sample("a.gltf", b"\xef\xbb\xbf" + gltf(container="gltf")[1]), sample("a.gltf", gltf(container="gltf")[1].replace(b"{", b"{,", 1), refused("a.gltf"))]),
]

SECTIONS = [("In any text", TEXT), ("OBJ", OBJ), ("STL", STL), ("PLY", PLY), ("OFF", OFF), ("GLB and glTF", GLTF)]


def tables():
    """The page's text for each section."""
    return {title: "| the file | is |\n|---|---|\n" + "".join(f"| {file} | {what} |\n" for file, what, _ in rows) for title, rows in SECTIONS}
