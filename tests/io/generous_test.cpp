// Files as people have them: what is read although it is written otherwise than the format says,
// what is said of it, and what is refused with which remedy. docs/formats.md tells the same.
#include "io/files.h"
#include <cagewright/io/model_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using enum MeshFormat;

/// A file that is a square of two triangles or one quad: 4 vertices (0 0 0), (1 0 0), (1 1 0),
/// (0 1 0), or 6 in STL.
struct ReadCase {
  std::string what;
  MeshFormat format;
  std::string text;
  std::string note; ///< the code of the only note, or nothing
};
void PrintTo(const ReadCase& c, std::ostream* out) {
  *out << name_of(c.format) << ": " << c.what;
}

const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string faces = "f 1 2 3\nf 1 3 4\n";
const std::string ply_head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
                             "float y\nproperty float z\n";
const std::string ply_faces =
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::string lists = "3 0 1 2\n3 0 2 3\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string stl_text(const std::string& text) {
  const std::string loop = "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n";
  return with(with(text, "LOOP1", loop), "LOOP2",
              "outer loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n");
}
const std::string plain_stl =
    stl_text("solid a\nfacet normal 0 0 1\nLOOP1endfacet\nfacet normal 0 0 1\n"
             "LOOP2endfacet\nendsolid a\n");

std::string binary_stl(const std::string& header, std::uint32_t count, const std::string& behind) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += test::binary(count);
  for (const auto& facet :
       {std::array{0.F, 0.F, 1.F, 0.F, 1.F, 1.F}, std::array{0.F, 0.F, 1.F, 1.F, 0.F, 1.F}}) {
    bytes += test::binary(0.F, 0.F, 0.F);
    for (std::size_t i = 0; i < 6; i += 2) {
      bytes += test::binary(facet[i], facet[i + 1], 0.F);
    }
    bytes += test::binary(std::uint16_t{0x7fff});
  }
  return bytes + behind;
}

class ReadsGenerously : public testing::TestWithParam<ReadCase> {};

TEST_P(ReadsGenerously, AndSaysSoOnce) {
  const Result<ModelFile> file = ModelFile::parse(GetParam().text, GetParam().format, "file");
  ASSERT_TRUE(file) << file.error().message;
  const PolygonMesh& mesh = file->mesh();
  ASSERT_EQ(mesh.positions.size(), GetParam().format == MeshFormat::stl ? 6U : 4U);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions.back(), Vec3(0, 1, 0));
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    triangles += mesh.face(i).size() - 2;
  }
  EXPECT_EQ(triangles, 2U);
  std::string codes;
  for (const FileNote& note : file->notes()) {
    codes += note.code;
    EXPECT_TRUE(note.message.starts_with("file:")) << note.message;
    EXPECT_EQ(note.message.find('\n'), std::string::npos);
  }
  EXPECT_EQ(codes, GetParam().note);
  // Moved and written again it is read as well, at the new places, and says no more than before.
  std::vector<Vec3> moved = mesh.positions;
  for (Vec3& position : moved) {
    position += Vec3(0.25, -0.5, 4);
  }
  const test::TemporaryFolder folder;
  const char* extension = GetParam().format == MeshFormat::obj   ? "out.obj"
                          : GetParam().format == MeshFormat::ply ? "out.ply"
                          : GetParam().format == MeshFormat::off ? "out.off"
                                                                 : "out.stl";
  const Status written = file->rewrite(moved, {}, folder / extension);
  ASSERT_TRUE(written) << written.error().message;
  const Result<ModelFile> again = ModelFile::open(folder / extension);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->mesh().positions, moved);
  EXPECT_EQ(test::faces_of(again->mesh()), test::faces_of(mesh));
}

INSTANTIATE_TEST_SUITE_P(
    Obj, ReadsGenerously,
    testing::ValuesIn(std::vector<ReadCase>{
        {"as it should be", obj, vertices + faces, ""},
        {"a material in Shift-JIS that ends in a backslash", obj,
         vertices + "usemtl \x94\x5c\n" + faces, ""},
        {"the same with \\r\\n", obj, vertices + "usemtl \x94\x5c\r\n" + faces, ""},
        {"a library in GBK that ends in a backslash", obj, "mtllib \x81\x5c\n" + vertices + faces,
         ""},
        {"an object and a group that end in a backslash", obj,
         "o \x83\x5c\n" + vertices + "g \x83\x5c\n" + faces, ""},
        {"a smoothing group and a comment that end in one", obj,
         "# C:\\models\\\n" + vertices + "s \\\n" + faces, ""},
        {"an extension that ends in one", obj, vertices + "maplib a\\\n" + faces, ""},
        {"a list carried on", obj, vertices + "f 1 \\\n2 \\\r\n3\nf 1 3 4\\\n\n", ""},
        {"a keyword carried on", obj, vertices + "f\\\n 1 2 3\nf 1 3 4\n", ""},
        {"curves carried on", obj, vertices + "curv 0 1 \\\n1 2\n" + faces, ""},
        {"faces of one and two corners", obj, vertices + "f 1\nf 1 2\n" + faces + "f 2/1\n",
         "short_face"},
        {"a corner twice in a row", obj, vertices + "f 1 2 2 3 4 4\n", "repeated_corner"},
        {"the first corner again", obj, vertices + "f 1 2 3 4 1\n", "repeated_corner"},
        {"the same corner by a negative number", obj, vertices + "f 1 -4 2 3 4\n",
         "repeated_corner"},
        {"mixed line ends", obj, "v 0 0 0\rv 1 0 0\r\nv 1 1 0\nv 0 1 0\r" + faces, ""},
        {"\\r alone", obj, with(vertices + faces, "\n", "\r"), ""},
        {"\\r\\r\\n, as bad transfers leave it", obj, with(vertices + faces, "\n", "\r\r\n"), ""},
        {"the mark of UTF-8", obj, "\xef\xbb\xbf" + vertices + faces, ""},
        {"zeros behind the text", obj, vertices + faces + std::string(100, '\0'), ""},
        {"Control-Z behind the text", obj, vertices + faces + "\x1a", ""},
        {"normals that are none", obj,
         vertices + "vn 1.#QNAN0 0 0\nvn -1.#IND 1.#INF nan\nvn 0 0\n" + faces, ""},
        {"texture points that are none", obj, vertices + "vt nan(ind) -nan\nvt\n" + faces, ""},
        {"exponents of Fortran", obj,
         "v 0.0D+00 0d0 0D0\nv 1.0D+00 0 0\nv .1D1 10d-1 0\nv 0 1D0 0\n" + faces, ""},
        {"colours from 0 to 255", obj, with(vertices, " 0\n", " 0 255 128 0\n") + faces, ""},
        {"a fourth coordinate", obj, with(vertices, " 0\n", " 0 1.0\n") + faces, ""},
        {"an object, then groups", obj, "o a\ng b c\n" + vertices + faces, ""},
        {"several groups in turns", obj, vertices + "g a b\nf 1 2 3\ng b a\nf 1 3 4\n", ""},
    }));

INSTANTIATE_TEST_SUITE_P(
    Stl, ReadsGenerously,
    testing::ValuesIn(std::vector<ReadCase>{
        {"as it should be", stl, plain_stl, ""},
        {"end loop, end facet, end solid", stl,
         with(with(with(plain_stl, "endloop", "end loop"), "endfacet", "end facet"), "endsolid",
              "end solid"),
         ""},
        {"words behind endfacet", stl, with(plain_stl, "endfacet", "endfacet color 0.5 0.5 1"), ""},
        {"lines of colour", stl, with(plain_stl, "endloop\n", "endloop\ncolor 1 0 0\n"), ""},
        {"no line solid", stl, with(with(plain_stl, "endsolid a\n", ""), "solid a\n", ""),
         "no_solid"},
        {"any case", stl, with(with(plain_stl, "facet", "FaCet"), "vertex", "Vertex"), ""},
        {"all on one line", stl, with(plain_stl, "\n", " "), ""},
        {"\\r alone", stl, with(plain_stl, "\n", "\r"), ""},
        {"normals that are none", stl, with(plain_stl, "0 0 1", "1.#QNAN nan -1.#IND"), ""},
        {"facets without normal", stl, with(plain_stl, "facet normal 0 0 1", "facet"), ""},
        {"a name of many words", stl, with(plain_stl, "solid a", "solid facet vertex loop"), ""},
        {"binary", stl, binary_stl("made by hand", 2, ""), ""},
        {"binary that begins with solid", stl, binary_stl("solid made by hand", 2, ""), ""},
        {"binary, the count left at 0", stl, binary_stl("x", 0, ""), "facet_count"},
        {"binary, the count left at -1", stl, binary_stl("x", 0xffffffff, ""), "facet_count"},
        {"binary, bytes behind the facets", stl, binary_stl("x", 2, "the end"), "trailing_bytes"},
    }));

INSTANTIATE_TEST_SUITE_P(
    Ply, ReadsGenerously,
    testing::ValuesIn(std::vector<ReadCase>{
        {"as it should be", ply, ply_head + ply_faces + points + lists, ""},
        {"rows over several lines", ply,
         ply_head + ply_faces + with(points, " 0\n", "\n0\n") + lists, ""},
        {"each value on a line", ply, ply_head + ply_faces + with(points + lists, " ", "\n"), ""},
        {"all rows on one line", ply, ply_head + ply_faces + with(points + lists, "\n", " "), ""},
        {"more on a line than the row needs", ply,
         ply_head + ply_faces + with(points, "\n", " 7 8\n") + lists, ""},
        {"\\r\\n and empty lines", ply,
         with(ply_head + ply_faces, "\n", "\r\n") + with(points + lists, "\n", "\r\n\r\n"), ""},
        {"\\r alone", ply, with(ply_head + ply_faces + points + lists, "\n", "\r"), ""},
        {"\\r\\n in the header's first line only", ply,
         "ply\r\n" + ply_head.substr(4) + ply_faces + points + lists, ""},
        {"comments anywhere", ply,
         with(ply_head + ply_faces, "property float y", "comment x\nobj_info y\nproperty float y") +
             points + lists,
         ""},
        {"types by other names", ply,
         with(with(ply_head + ply_faces, "float", "Float32"), "uchar int", "uint8_t INT32") +
             points + lists,
         ""},
        {"corners as floats", ply,
         ply_head + with(ply_faces, "uchar int", "float double") + points + lists, ""},
        {"vertex_index", ply,
         ply_head + with(ply_faces, "vertex_indices", "vertex_index") + points + lists, ""},
        {"corners under another name", ply,
         ply_head + with(ply_faces, "vertex_indices", "corners") + points + lists, ""},
        {"a list before the coordinates", ply,
         with(ply_head, "property float x", "property list uchar float w\nproperty float x") +
             ply_faces + "2 8 9 0 0 0\n0 1 0 0\n1 5 1 1 0\n0 0 1 0\n" + lists,
         ""},
        {"elements of others", ply,
         with(ply_head, "element vertex", "element camera 1\nproperty float a\nelement vertex") +
             ply_faces + "3\n" + points + lists,
         ""},
        {"faces of two corners", ply,
         ply_head + with(ply_faces, "face 2", "face 3") + points + "2 0 1\n" + lists, "short_face"},
        {"a corner twice in a row", ply,
         ply_head + with(ply_faces, "face 2", "face 1") + points + "6 0 1 1 2 3 0\n",
         "repeated_corner"},
        {"lines behind the last element", ply, ply_head + ply_faces + points + lists + "1 2 3\n",
         "trailing_bytes"},
    }));

INSTANTIATE_TEST_SUITE_P(
    Off, ReadsGenerously,
    testing::ValuesIn(std::vector<ReadCase>{
        {"as it should be", off, "OFF\n4 2 0\n" + points + lists, ""},
        {"counts behind the header", off, "OFF4 2 0\n" + points + lists, ""},
        {"counts of COFF right behind it", off,
         "COFF4 2 0\n" + with(points, "\n", " 1 0 0 1\n") + lists, ""},
        {"counts over lines", off, "OFF\n4\n2\n0\n" + points + lists, ""},
        {"no count of edges", off, "OFF\n4 2\n" + points + lists, ""},
        {"comments anywhere", off,
         "# a\nOFF # b\n# c\n4 2 0 # d\n" + with(points + lists, "\n", " # e\n# f\n"), ""},
        {"homogeneous coordinates", off,
         "4OFF\n4 2 0\n0 0 0 1\n2 0 0 2\n.5 .5 0 .5\n0 -1 0 -1\n" + lists, ""},
        {"nOFF of three dimensions", off, "nOFF\n3\n4 2 0\n" + points + lists, ""},
        {"colours the header does not tell of", off,
         "OFF\n4 2 0\n" + with(points, "\n", " 255 0 0 255\n") + lists, "extra_numbers"},
        {"colours of faces", off, "OFF\n4 2 0\n" + points + "3 0 1 2 7\n3 0 2 3 0.5 0.5 0.5 1\n",
         ""},
        {"lines and points", off, "OFF\n4 4 0\n" + points + "1 0\n2 0 1\n" + lists, "short_face"},
        {"NCOFF in the order of MeshLab", off,
         "NCOFF\n4 2 0\n" + with(points, "\n", " 10 200 30 255 0 0 1\n") + lists, ""},
    }));

TEST(ReadsGenerously, TellsTheFirstPlaceAndHowManyMore) {
  const Result<ModelFile> file =
      ModelFile::parse(vertices + "f 1 2\n" + faces + "f 1\nf 4\n", obj, "a.obj");
  ASSERT_TRUE(file);
  ASSERT_EQ(file->notes().size(), 1U);
  EXPECT_EQ(file->notes()[0].message,
            "a.obj:5: a face of 2 corners is no surface and is left out (and 2 more)");
}

TEST(ReadsGenerously, KeepsColoursAndNormalsOfNcoffApartInEitherOrder) {
  for (const std::string row : {" 10 200 30 255 0 0 1\n", " 0 0 1 10 200 30 255\n",
                                " 10 200 30 0 0 1\n", " 0 0 1 10 200 30\n"}) {
    const Result<ModelFile> file =
        ModelFile::parse("NCOFF\n4 2 0\n" + with(points, "\n", row) + lists, off, "file");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->mesh().colors[0],
              (std::array<float, 4>{10 / 255.F, 200 / 255.F, 30 / 255.F, 1}));
    const Result<FileNormals> normals = file->normals();
    ASSERT_TRUE(normals);
    EXPECT_EQ(normals->normals, std::vector<Vec3>(4, Vec3(0, 0, 1))) << row;
    const test::TemporaryFolder folder;
    ASSERT_TRUE(file->rewrite(file->mesh().positions, std::vector<Vec3>(4, Vec3(0, 1, 0)),
                              folder / "a.off"));
    const std::string turned = with(row, "0 0 1", "0 1 0");
    EXPECT_EQ(test::bytes_of(folder / "a.off"),
              "NCOFF\n4 2 0\n" + with(points, "\n", turned) + lists);
  }
}

TEST(ReadsGenerously, LeavesANormalThatIsNoneAsItStands) {
  const std::string text =
      vertices + "vn 1.#QNAN0 0 0\nvn 0 0 1\nf 1//1 2//2 3//2\nf 1//1 3//2 4//2\n";
  const Result<ModelFile> file = ModelFile::parse(text, obj, "file");
  ASSERT_TRUE(file);
  std::vector<Vec3> normals = file->normals()->normals;
  ASSERT_EQ(normals.size(), 4U);
  EXPECT_EQ(normals[0], Vec3(0, 0, 0));
  normals[2] = Vec3(0, 1, 0); // one turns apart, and the lines are counted anew
  const test::TemporaryFolder folder;
  ASSERT_TRUE(file->rewrite(file->mesh().positions, normals, folder / "a.obj"));
  EXPECT_EQ(test::bytes_of(folder / "a.obj"),
            vertices + "vn 1.#QNAN0 0 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//2 3//3\nf 1//1 3//3 4//2\n");
}

TEST(ReadsGenerously, CountsNormalsAnewOfCornersThatAreLeftOut) {
  const std::string text =
      vertices + "vn 0 0 1\nvn 1 0 0\nf 1//2 2//2\nf 1//1 1//2 2//1 3//1 4//1\nf -4//-1 -3//-1\n";
  const Result<ModelFile> file = ModelFile::parse(text, obj, "file");
  ASSERT_TRUE(file);
  std::vector<Vec3> normals = file->normals()->normals;
  ASSERT_EQ(normals.size(), 4U);
  normals[1] = Vec3(0, 1, 0);
  const test::TemporaryFolder folder;
  ASSERT_TRUE(file->rewrite(file->mesh().positions, normals, folder / "a.obj"));
  EXPECT_EQ(test::bytes_of(folder / "a.obj"),
            vertices + "vn 0 0 1\nvn 0 1 0\nvn 1 0 0\nf 1//3 2//3\nf 1//1 1//3 2//2 3//1 4//1\n"
                       "f -4//3 -3//3\n");
}

/// What is not plain is refused with the cause.
struct RefusedCase {
  MeshFormat format;
  std::string text;
  std::string message; ///< a part of it
};
void PrintTo(const RefusedCase& c, std::ostream* out) {
  *out << c.message;
}

class Refuses : public testing::TestWithParam<RefusedCase> {};

TEST_P(Refuses, AndNamesTheCause) {
  const Result<ModelFile> file = ModelFile::parse(GetParam().text, GetParam().format, "file");
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message.find(GetParam().message), std::string::npos)
      << file.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    All, Refuses,
    testing::ValuesIn(std::vector<RefusedCase>{
        {obj, "v 0,5 0 0\n", "file:1: '0,5' has a decimal comma; replace ',' by '.' in the file"},
        {obj, "v -1,5e-3 0 0\n", "'-1,5e-3' has a decimal comma"},
        {obj, "v 1,234.5 0 0\n", "'1,234.5' has a thousands separator; remove ','"},
        {obj, "v 0.5, 1, 0\n", "numbers are separated by blanks; replace ',' by ' '"},
        {obj, "v 0.5,1,0\n", "numbers are separated by blanks"},
        {obj, vertices + "f 1,000 2 3\n", "file:5: '1,000' has a thousands separator"},
        {obj, vertices + "f 1.000/1/1 2 3\n", "'1.000/1/1' has a thousands separator"},
        {obj, vertices + "f 1'234'567 2 3\n", "has a thousands separator"},
        {obj, vertices + "f 1,2,3\n", "'1,2,3' is not a corner of a face"},
        {obj, vertices + "f 0 1 2\n", "face refers to vertex 0, but OBJ counts from 1; add 1"},
        {ply, ply_head + ply_faces + with(points, "1 0 0", "1,5 0 0") + lists,
         "file:11: '1,5' has a decimal"},
        {off, "OFF\n4 2 0\n" + with(points, "1 0 0", "1,5 0 0") + lists,
         "file:4: '1,5' has a decimal comma"},
        {stl, with(plain_stl, "1 0 0", "1,5 0 0"), "file:5: '1,5' has a decimal comma"},
        {off, "nOFF\n4\n4 2 0\n", "points of 4 dimensions (nOFF)"},
        {off, "4OFF\n4 2 0\n0 0 0 0\n0 0 0 1\n0 0 0 1\n0 0 0 1\n" + lists, "lies at infinity"},
        {stl, binary_stl("x", 3, ""),
         "byte 80: the header promises 3 facets, but there is room for 2"},
    }));

TEST(Refuses, DecimalCommasWithARemedyThatWorks) {
  const std::string comma = with(with(vertices, "1", "0,5"), "0 0 0", "0,0 0,0 0,0") + faces;
  ASSERT_FALSE(ModelFile::parse(comma, obj, "file"));
  EXPECT_TRUE(ModelFile::parse(with(comma, ",", "."), obj, "file"));
}

} // namespace
} // namespace cagewright
