#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>

#include <limits>

namespace cagewright {
namespace {

using Faces = std::vector<std::vector<Index>>;

PolygonMesh read_obj(std::string_view text) {
  Result<PolygonMesh> mesh = test::read(text, MeshFormat::obj);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

std::string message_of(std::string_view text) {
  return test::message_of(text, MeshFormat::obj);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, KnowsEveryFormOfCorner) {
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/1/1 2/2/2 3/3/3", "f -4 -3 -2",
        "f -4/-1/-1 -3//-2 -2/7", "f +1 2/ 3//", "\tf  1\t2  3  ", "f 1 2 3 # done", "f 1 2 3#done",
        "f 1/1 2//2 3/3/3#done", "f 1 \\\n2 \\\r\n 3", "fo 1 2 3"}) {
    EXPECT_EQ(test::faces_of(read_obj(square + face)), (Faces{{0, 1, 2}})) << face;
  }
}

TEST(ReadObj, KeepsPolygonsAndTheirOrder) {
  EXPECT_EQ(test::faces_of(read_obj(square + "f 4 3 2 1\nf 1 2 3\nf 1 2 3 4 1\n")),
            (Faces{{3, 2, 1, 0}, {0, 1, 2}, {0, 1, 2, 3}}));
}

TEST(ReadObj, KeepsDirtyModelsAsTheyAre) {
  const PolygonMesh mesh = read_obj("v 0 0 0\nv 0 0 0\nv 5 5 5\nf 1 1 2\nf 1 1 2\n");
  EXPECT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 0, 1}, {0, 0, 1}}));
}

TEST(ReadObj, AllowsFacesBeforeTheirVertices) {
  EXPECT_EQ(test::faces_of(read_obj("f 2 3 4\n" + square)), (Faces{{1, 2, 3}}));
  EXPECT_EQ(message_of("v 0 0 0\nf 1 2 5\n" + square + "v 0 0 0 # the last"), "read");
  EXPECT_EQ(message_of("f 2 3 5\n" + square),
            "file:1: face refers to vertex 5, but there are 4; export the model again");
}

TEST(ReadObj, KnowsAllLineEnds) {
  for (const char* text :
       {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "\xef\xbb\xbfv 0 0 0\nv 1 0 0\n\n\nv 0 1 0\nf 1 2 3"}) {
    EXPECT_EQ(read_obj(text).positions.size(), 3U);
    EXPECT_EQ(read_obj(text).positions[2], Vec3(0, 1, 0));
  }
  EXPECT_EQ(message_of("v 0 0 0\r\nv 1 0 0\r\nv 0 1\r\n"),
            "file:3: a vertex needs 3 coordinates, but this has 2; export the model again");
  EXPECT_EQ(message_of("v 0 0 0\rv 1 0 0\rv 0 1\r").substr(0, 7), "file:3:");
}

TEST(ReadObj, DoesNotTakeAFolderInACommentForAContinuedLine) {
  EXPECT_EQ(read_obj("# from C:\\models\\\nmtllib C:\\models\\ # \\\n" + square + "f 1 2 3")
                .positions.size(),
            4U);
}

TEST(ReadObj, CountsContinuedLines) {
  EXPECT_EQ(message_of("v 0 \\\n0 \\\n0\nv 1 0 x\n"),
            "file:4: 'x' is not a finite number; export the model again");
  EXPECT_EQ(read_obj("vt 0 \\\n 0\nvn 0 0 \\\n1\n" + square + "f 1 2 3").positions.size(), 4U);
}

TEST(ReadObj, RoundsNumbersCorrectly) {
  const PolygonMesh mesh = read_obj(
      "v 0.1 +.5 -5.\nv 1e+2 1E-2 -0\nv 9007199254740993 4.9e-324 2.2250738585072011e-308\n"
      "v 1e-400 -1e-99999999999999999999 "
      "0.3000000000000000166533453693773481063544750213623046875\n"
      "f 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], Vec3(0.1, 0.5, -5));
  EXPECT_EQ(mesh.positions[1], Vec3(100, 0.01, 0));
  EXPECT_EQ(mesh.positions[2], Vec3(9007199254740992.0, std::numeric_limits<double>::denorm_min(),
                                    0x0.fffffffffffffp-1022));
  EXPECT_EQ(mesh.positions[3], Vec3(0, 0, 0x1.3333333333334p-2));
}

TEST(ReadObj, ReadsColorsOfVertices) {
  const PolygonMesh mesh =
      read_obj("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 0.25 0.5\nv 0 0 1 1.0\nf 1 2 3\n");
  ASSERT_EQ(mesh.colors.size(), 4U);
  EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 0.5, 0, 1}));
  EXPECT_EQ(mesh.colors[1], (std::array<float, 4>{1, 1, 1, 1}));
  EXPECT_EQ(mesh.colors[2], (std::array<float, 4>{0, 0, 0.25, 0.5}));
  EXPECT_EQ(mesh.colors[3], (std::array<float, 4>{1, 1, 1, 1})); // the fourth number is a weight
}

TEST(ReadObj, ScalesColorsThatAreBytes) {
  const PolygonMesh mesh = read_obj("v 0 0 0 255 51 0\nv 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 0.2F, 0, 1}));
  EXPECT_EQ(mesh.colors[1], (std::array<float, 4>{1, 1, 1, 1}));
}

TEST(ReadObj, ReadsObjectsAndGroups) {
  const PolygonMesh mesh = read_obj(square + "f 1 2 3\no left arm \nf 1 2 3\nf 1 2 4\ng hand\n"
                                             "o empty\ng left arm\nf 2 3 4\ng\nf 1 3 4\n");
  EXPECT_EQ(mesh.group_names,
            (std::vector<std::string>{"default", "left arm", "left arm", "empty"}));
  EXPECT_EQ(mesh.face_groups, (std::vector<Index>{0, 1, 1, 2, 3}));
  EXPECT_TRUE(read_obj(square + "f 1 2 3\n").group_names.empty());
}

TEST(ReadObj, SkipsWhatIsNoSurface) {
  EXPECT_EQ(read_obj(square + "vp 0\nl 1 2\np 1\ns off\nusemtl skin\ncstype bezier\nf 1 2 3\n")
                .face_count(),
            1U);
}

struct BadObj {
  const char* text;
  const char* message;
};
void PrintTo(const BadObj& bad, std::ostream* out) {
  *out << bad.message;
}

class ReadObjRefuses : public testing::TestWithParam<BadObj> {};

TEST_P(ReadObjRefuses, WithTheLineAndARemedy) {
  EXPECT_EQ(message_of(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ReadObjRefuses,
    testing::ValuesIn(std::vector<BadObj>{
        {"", "file: the file is empty; export the model again"},
        {"v 0 0 0\n", "file: has no faces; a surface is needed: export the model as a mesh, "
                      "not as points or curves"},
        {"v 0 0 0\nl 1 1\n", "file: has no faces; a surface is needed: export the model as a "
                             "mesh, not as points or curves"},
        {"\nhello world\n", "file:2: 'hello' is no OBJ statement, and the file has no faces; "
                            "check that this is an OBJ file"},
        {"v 0 nan 0\n", "file:1: 'nan' is not a finite number; export the model again"},
        {"v 0 0 -inf\n", "file:1: '-inf' is not a finite number; export the model again"},
        {"v 0 0 1e999\n", "file:1: '1e999' is not a finite number; export the model again"},
        {"v 0 0 1.#QNAN\n", "file:1: '1.#QNAN' is not a finite number; export the model again"},
        {"v 0 0 1,5\n",
         "file:1: '1,5' has a decimal comma; replace ',' by '.' in the file, or export with '.' as "
         "the decimal sign (exporting with the same setting gives the same file)"},
        {"v 0 0 0x10\n", "file:1: '0x10' is not a finite number; export the model again"},
        {"v 0 0 +-1\n", "file:1: '+-1' is not a finite number; export the model again"},
        {"v 0\n", "file:1: a vertex needs 3 coordinates, but this has 1; export the model again"},
        {"v 0 0 0\nf 1 1\nf\n", "file: has no faces; a surface is needed: export the model as a "
                                "mesh, not as points or curves"},
        {"v 0 0 0\nf 1 1 0\n", "file:2: face refers to vertex 0, but OBJ counts from 1; add 1 to "
                               "the corners of all faces "
                               "where they are written"},
        {"v 0 0 0\nf 1 1 2\n",
         "file:2: face refers to vertex 2, but there is 1; export the model again"},
        {"v 0 0 0\nf -1 -1 -2\n", "file:2: face refers to vertex -2, but only 1 stand before "
                                  "it; export the model again"},
        {"v 0 0 0\nf 1 1 2147483649\n",
         "file:2: face refers to vertex 2147483649, but there is 1; export the model again"},
        {"v 0 0 0\nf 1 1 4294967297\n",
         "file:2: face refers to vertex 4294967297, but there is 1; export the model again"},
        {"v 0 0 0\nf 1 1 -9223372036854775808\n",
         "file:2: face refers to vertex -9223372036854775808, but only 1 stand before it; "
         "export the model again"},
        {"v 0 0 0\nf 1 1 99999999999999999999/1\n",
         "file:2: face refers to vertex 99999999999999999999, but there is 1; export the "
         "model again"},
        {"v 0 0 0\nf 1 1 one\n", "file:2: 'one' is not a corner of a face; export the model again"},
        {"v 0 0 0\nf 1 1 1.5\n", "file:2: '1.5' is not a corner of a face; export the model again"},
        {"v 0 0 0\nf 1/1/1/1 1 1\n",
         "file:2: '1/1/1/1' is not a corner of a face; export the model again"},
        {"v 0 0 0\nf 1 1 /1\n",
         "file:2: '/1' is not a corner of a face; export the model again"}}));

TEST(ReadObj, ShowsOnlyTheBeginningOfAnOverlongWord) {
  const std::string message = message_of("v 0 0 " + std::string(1 << 20, 'x'));
  EXPECT_EQ(message, "file:1: '" + std::string(40, 'x') +
                         "...' is not a finite number; export the model again");
}

TEST(ReadObj, ShowsControlCharactersAsQuestionMarks) {
  EXPECT_EQ(message_of("v 0 0 \x1b[31m\x07\n"),
            "file:1: '?[31m?' is not a finite number; export the model again");
}

TEST(ReadObj, ReadsFacesOfManyCornersOnOneLine) {
  std::string text = square + "f";
  for (int i = 0; i < 100000; ++i) {
    text += " 1 2 3 4";
  }
  EXPECT_EQ(read_obj(text).face(0).size(), 400000U);
}

} // namespace
} // namespace cagewright
