#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

using Faces = std::vector<std::vector<Index>>;

PolygonMesh read_off(std::string_view text) {
  Result<PolygonMesh> mesh = test::read(text, MeshFormat::off);
  EXPECT_TRUE(mesh) << mesh.error().message << " in " << text;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

std::string message_of(std::string_view text) {
  return test::message_of(text, MeshFormat::off);
}

TEST(ReadOff, KnowsTheHeadersInUse) {
  for (const std::string header :
       {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF\n3 1\n", "# made by hand\nOFF # one\n\n3 1 3 # two\n",
        "3 1 0\n", "OFF\r\n3 1 0\r\n", "OFF\n3 1 -1\n"}) {
    const PolygonMesh mesh = read_off(header + "0 0 0\n\n1 0 0 # three\n+.5 1e0 -2\n3 0 1 2\n");
    ASSERT_EQ(mesh.positions.size(), 3U) << header;
    EXPECT_EQ(mesh.positions[2], Vec3(0.5, 1, -2));
    EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}}));
  }
}

TEST(ReadOff, TakesCommentsRightAfterNumbers) {
  const PolygonMesh mesh = read_off("OFF\n3 1 0#counts\n0 0 0#a\n1 0 0.5#b\n0 1. 2#c\n3 0 1 2#d\n");
  ASSERT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0.5));
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}}));
  EXPECT_NE(message_of("OFF\n3 1 0\n0 0 1.#QNAN\n1 0 0\n0 1 0\n3 0 1 2\n").find("1.#QNAN"),
            std::string::npos);
}

TEST(ReadOff, SkipsNormalsAndTextureCoordinates) {
  for (const auto& [header, rest] : {std::pair<std::string, std::string>{"NOFF", " 0 0 nan"},
                                     {"STOFF", " .5 .5"},
                                     {"STNOFF", " 0 0 1 .5 .5"},
                                     {"OFF", " 7 8 9"}}) {
    const PolygonMesh mesh = read_off(header + "\n3 1 0\n0 0 0" + rest + "\n1 0 0" + rest +
                                      "\n0 1 0" + rest + "\n3 0 1 2\n");
    EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0)) << header;
    EXPECT_TRUE(mesh.colors.empty());
  }
}

TEST(ReadOff, ReadsColorsOfVertices) {
  const PolygonMesh fractions =
      read_off("COFF\n3 1 0\n0 0 0 1 0 0.5 0.25\n1 0 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_EQ(fractions.colors[0], (std::array<float, 4>{1, 0, 0.5, 0.25}));
  EXPECT_EQ(fractions.colors[2], (std::array<float, 4>{0, 0, 1, 1}));
  const PolygonMesh bytes = read_off("NCOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 255\n1 0 0 0 0 1 0 0 0 0\n"
                                     "0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_EQ(bytes.colors[0], (std::array<float, 4>{1, 0, 0.2F, 1}));
  EXPECT_EQ(bytes.colors[1], (std::array<float, 4>{0, 0, 0, 0}));
  EXPECT_EQ(bytes.colors[2], (std::array<float, 4>{1, 1, 1, 1}));
}

TEST(ReadOff, SkipsColorsOfFacesAndFacesThatAreNone) {
  EXPECT_EQ(test::faces_of(read_off("OFF\n4 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                                    "4 0 1 2 3 0.5 0.5 0.5\n1 0\n2 0 1\n3 2\n1\n0 255 0 0\n")),
            (Faces{{0, 1, 2, 3}, {2, 1, 0}}));
}

struct BadOff {
  const char* text;
  const char* message;
};
void PrintTo(const BadOff& bad, std::ostream* out) {
  *out << bad.message;
}

class ReadOffRefuses : public testing::TestWithParam<BadOff> {};

TEST_P(ReadOffRefuses, WithTheLineAndARemedy) {
  EXPECT_EQ(message_of(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ReadOffRefuses,
    testing::ValuesIn(std::vector<BadOff>{
        {"OFF\n", "file:2: the header should have the number of vertices here, but has "
                  "nothing; export the model again"},
        {"OFF\n3 x 0\n", "file:2: the header should have the number of faces here, but has "
                         "'x'; export the model again"},
        {"OFF\n-3 1 0\n", "file:2: the header should have the number of vertices here, but "
                          "has '-3'; export the model again"},
        {"OFF\n1000000000 1 0\n0 0 0\n",
         "file:2: the header promises 1000000000 vertices and 1 face, but the file ends "
         "before; it is cut short; export the model again"},
        {"OFF\n5000000000 1 0\n0 0 0\n",
         "file: has 5000000000 vertices, more than the 4294967295 that can be counted; "
         "simplify the model"},
        {"OFF\n1 4000000000000 0\n0 0 0\n",
         "file:2: the header promises 1 vertex and 4000000000000 faces, but the file ends "
         "before; it is cut short; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1.00000 0.0000 0.0000\n",
         "file:5: the file ends after 2 of 3 vertices; it is cut short; export the model "
         "again"},
        {"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         "file:7: the file ends after 1 of 2 faces; it is cut short; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n",
         "file:4: vertex 1 needs 3 coordinates, but has 2; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n",
         "file:4: 'inf' is not a finite number; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
         "file:6: face 0 refers to vertex 3, but there are 3; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
         "file:6: face 0 refers to vertex -1, but there are 3; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99999999999999999999\n",
         "file:6: face 0 refers to vertex 99999999999999999999, but there are 3; export the "
         "model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n",
         "file:6: '2.5' is not a vertex number; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0\n",
         "file:6: face 0 should begin with its number of corners, but there is '0'; export "
         "the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999 0 1 2\n",
         "file:6: face 0 needs 99999999 corners, but has 3; export the model again"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n",
         "file: has no faces; a surface is needed: export the model as a mesh, not as points "
         "or curves"}}));

} // namespace
} // namespace cagewright
