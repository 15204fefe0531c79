#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cagewright {
namespace {

using Faces = std::vector<std::vector<Index>>;
using test::binary;

PolygonMesh read_ply(std::string_view bytes) {
  Result<PolygonMesh> mesh = test::read(bytes, MeshFormat::ply);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

std::string message_of(std::string_view bytes) {
  return test::message_of(bytes, MeshFormat::ply);
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

std::string ascii_ply(const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

template <class Number> std::string big_endian(Number number) {
  std::string bytes = binary(number);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// A triangle whose coordinates and corners have the given types.
template <class Coordinate, class Count, class Corner>
void expect_triangle(const std::string& coordinate, const std::string& count,
                     const std::string& corner) {
  const std::string header = "element vertex 3\nproperty " + coordinate + " x\nproperty " +
                             coordinate + " y\nproperty " + coordinate +
                             " z\nelement face 1\nproperty list " + count + " " + corner +
                             " vertex_index\nend_header\n";
  std::string little = "ply\nformat binary_little_endian 1.0\n" + header;
  std::string big = "ply\nformat binary_big_endian 1.0\n" + header;
  std::string text = "ply\nformat ascii 1.0\n" + header;
  for (const int value : {1, 2, 3, 4, 5, 6, 7, 8, 100}) {
    little += binary(static_cast<Coordinate>(value));
    big += big_endian(static_cast<Coordinate>(value));
    text += std::to_string(value) + (value % 3 == 0 || value == 100 ? "\n" : " ");
  }
  little += binary(static_cast<Count>(3));
  big += big_endian(static_cast<Count>(3));
  for (const int value : {2, 0, 1}) {
    little += binary(static_cast<Corner>(value));
    big += big_endian(static_cast<Corner>(value));
  }
  for (const std::string& bytes : {little, big, text + "3 2 0 1"}) {
    const PolygonMesh mesh = read_ply(bytes);
    ASSERT_EQ(mesh.positions.size(), 3U);
    EXPECT_EQ(mesh.positions[2], Vec3(7, 8, 100));
    EXPECT_EQ(test::faces_of(mesh), (Faces{{2, 0, 1}}));
  }
}

TEST(ReadPly, KnowsEveryTypeInBothByteOrdersAndInText) {
  expect_triangle<float, std::uint8_t, std::int32_t>("float", "uchar", "int");
  expect_triangle<double, std::uint8_t, std::uint32_t>("double", "uint8", "uint32");
  expect_triangle<float, std::uint32_t, std::int16_t>("float32", "uint", "short");
  expect_triangle<double, std::int32_t, std::uint16_t>("float64", "int32", "ushort");
  expect_triangle<std::int8_t, std::int8_t, std::uint8_t>("char", "int8", "uchar");
  expect_triangle<std::int16_t, std::uint16_t, std::int8_t>("int16", "uint16", "char");
  expect_triangle<std::int32_t, std::int16_t, std::uint64_t>("int", "int16", "uint64");
}

TEST(ReadPly, SkipsPropertiesAndElementsOfOthers) {
  const std::string header =
      "comment made by hand\nobj_info nothing\nelement camera 1\nproperty list uchar float view\n"
      "property double focus\nelement vertex 3\nproperty float quality\nproperty double z\n"
      "property double y\nproperty double x\nproperty list uchar short layers\nelement face 1\n"
      "property uchar flags\nproperty list uchar uint vertex_indices\nproperty list uchar float "
      "texcoord\nelement empty 1000000000000\nelement edge 1\nproperty int vertex1\nend_header\n";
  const PolygonMesh text =
      read_ply("ply\nformat ascii 1.0\n" + header +
               "2 0.5 0.5 1\nnan 3 2 1 0\n0 6 5 4 2 7 7\n0 9 8 7 1 7\n5 3 0 1 2 2 .5 .5\n0\n");
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + header;
  bytes += '\2' + binary(0.5F, 0.5F, 1.0) + binary(0.F, 3.0, 2.0, 1.0) + '\0' +
           binary(0.F, 6.0, 5.0, 4.0) + '\2' + binary(std::int16_t{7}, std::int16_t{7}) +
           binary(0.F, 9.0, 8.0, 7.0) + '\1' + binary(std::int16_t{7}) + "\5\3" + binary(0, 1, 2) +
           '\2' + binary(0.5F, 0.5F) + binary(0);
  for (const PolygonMesh& mesh : {text, read_ply(bytes)}) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}}));
  }
}

TEST(ReadPly, ReadsColorsOfVertices) {
  const auto with_colors = [](const std::string& type, const std::string& rows) {
    std::string header = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz;
    for (const std::string channel : {"red", "green", "blue", "alpha"}) {
      header += "property " + type + " " + channel + "\n";
    }
    return read_ply(header +
                    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + rows +
                    "3 0 1 2\n");
  };
  const PolygonMesh bytes =
      with_colors("uchar", "0 0 0 255 51 0 0\n1 0 0 1 1 1 255\n0 1 0 0 0 0 0\n");
  EXPECT_EQ(bytes.colors[0], (std::array<float, 4>{1, 0.2F, 0, 0}));
  EXPECT_EQ(bytes.colors[1][0], 1 / 255.F); // a dark byte, not a full fraction
  const PolygonMesh floats =
      with_colors("float", "0 0 0 1 .25 0 1\n1 0 0 2 -1 nan 1\n0 1 0 0 0 0 0\n");
  EXPECT_EQ(floats.colors[0], (std::array<float, 4>{1, 0.25, 0, 1}));
  EXPECT_EQ(floats.colors[1], (std::array<float, 4>{1, 0, 0, 1}));
}

TEST(ReadPly, ReadsTriangleStrips) {
  const PolygonMesh mesh =
      read_ply("ply\nformat ascii 1.0\nelement vertex 5\n" + xyz +
               "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n10 0 1 2 3 3 -1 4 3 2 1\n");
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}, {2, 1, 3}, {4, 3, 2}, {2, 3, 1}}));
}

TEST(ReadPly, KnowsAllLineEndsOfHeaders) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + xyz +
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t at = 0; (at = header.find('\n', at)) != header.npos; at += end.size()) {
      header.replace(at, 1, end);
    }
    // The first coordinate begins with the byte of a line end.
    const std::string first = "\n\r\n\x3f";
    const PolygonMesh mesh = read_ply(
        header + first + binary(0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F) + '\3' + binary(0, 1, 2));
    EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  }
}

TEST(ReadPly, ReadsFacesBeforeVertices) {
  const std::string begin = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
                            "vertex_indices\nelement vertex 3\n" +
                            xyz + "end_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(test::faces_of(read_ply(begin + "3 2 1 0\n" + points)), (Faces{{2, 1, 0}}));
  EXPECT_EQ(message_of(begin + "3 2 1 3\n" + points),
            "file:10: face 0 refers to vertex 3, but there are 3; export the model again");
}

struct BadPly {
  std::string bytes;
  std::string message;
};
void PrintTo(const BadPly& bad, std::ostream* out) {
  *out << bad.message;
}

class ReadPlyRefuses : public testing::TestWithParam<BadPly> {};

TEST_P(ReadPlyRefuses, WithThePlaceAndARemedy) {
  EXPECT_EQ(message_of(GetParam().bytes), GetParam().message);
}

const std::string little = "ply\nformat binary_little_endian 1.0\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string three_points = binary(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F);

INSTANTIATE_TEST_SUITE_P(
    Each, ReadPlyRefuses,
    testing::ValuesIn(std::vector<BadPly>{
        {"plyers", "file: does not begin with a line 'ply'; check that this is a PLY file"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n",
         "file:4: the header has no 'end_header'; the file is cut short; export the model "
         "again"},
        {"ply\nelement vertex 0\nend_header\n",
         "file: the header has no line 'format'; export the model again"},
        {"ply\nformat utf8 1.0\nend_header\n",
         "file:2: the format 'utf8' is not one of PLY's; export the model again"},
        {"ply\nformat ascii 1.0\nelement vertex many\nend_header\n",
         "file:3: an element needs a name and a count, but the count is 'many'; export the "
         "model again"},
        {"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n",
         "file:3: an element needs a name and a count, but the count is '-1'; export the "
         "model again"},
        {"ply\nformat ascii 1.0\nproperty float x\nend_header\n",
         "file:3: a property stands before any element; export the model again"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n",
         "file:4: the type 'half' is not one of PLY's; export the model again"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperly float x\nend_header\n",
         "file:4: 'properly' is no PLY header statement; export the model again"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
         "y\nend_header\n0 0\n",
         "file: the element 'vertex' has no property 'z'; export the model again"},
        {little + "element vertex 3\n" + xyz + "element face 1\nproperty int a\nend_header\n" +
             three_points + binary(1),
         "file: the element 'face' has no list 'vertex_indices'; export the model again"},
        {little + "element vertex 4000000000\n" + xyz + faces + three_points,
         "file: the header promises 4000000000 rows of the element 'vertex', but the file "
         "ends before; it is cut short; export the model again"},
        {little + "element vertex 4294967296\n" + xyz + faces + three_points,
         "file: has 4294967296 vertices, more than the 4294967295 that can be counted; "
         "simplify the model"},
        {little + "element vertex 99999999999999999999\n" + xyz + faces,
         "file:3: an element needs a name and a count, but the count is "
         "'99999999999999999999'; export the model again"},
        {little + "element vertex 3\n" + xyz + faces + three_points + '\3' + binary(0, 1),
         "file: byte 205: a list promises 3 items, but the file ends before; it is cut short; "
         "export the model again"},
        {little + "element vertex 3\n" + xyz + faces + three_points + '\3' + binary(0, 1, 3),
         "file: byte 205: face 0 refers to vertex 3, but there are 3; export the model again"},
        {little + "element vertex 3\n" + xyz + faces + three_points + '\3' + binary(0, 1, -1),
         "file: byte 205: face 0 refers to vertex -1, but there are 3; export the model "
         "again"},
        {little + "element vertex 3\n" + xyz + faces + three_points + '\2' + binary(0, 1),
         "file: has no faces; a surface is needed: export the model as a mesh, not as points "
         "or curves"},
        {little + "element vertex 1\n" + xyz + faces +
             binary(0.F, std::numeric_limits<float>::infinity(), 0.F) + '\3' + binary(0, 0, 0),
         "file: byte 169: vertex 0 has a coordinate that is not a finite number; export the "
         "model again"},
        {little + "element vertex 1\n" + xyz +
             "element face 1\nproperty list uint int vertex_indices\nend_header\n" +
             binary(0.F, 0.F, 0.F, 0xffffffffU, 0, 0, 0),
         "file: byte 180: a list promises 4294967295 items, but the file ends before; it is "
         "cut short; export the model again"},
        {little + "element vertex 1\n" + xyz +
             "element face 1\nproperty list int int vertex_indices\nend_header\n" +
             binary(0.F, 0.F, 0.F, -3, 0, 0, 0),
         "file: byte 179: a list cannot have -3 items; export the model again"},
        {ascii_ply("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
         "file:11: the line ends within row 1 of the element 'vertex'; export the model "
         "again"},
        {ascii_ply("0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n"),
         "file:11: 'zero' is not a finite number; export the model again"},
        {ascii_ply("0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"),
         "file:11: vertex 1 has a coordinate that is not a finite number; export the model "
         "again"},
        {ascii_ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n"),
         "file:13: face 0 refers to vertex 2.5, but there are 3; export the model again"},
        {ascii_ply("0 0 0\n1 0 0\n0.00 1.000 0.000\n"),
         "file:13: the file ends after 0 of 1 rows of the element 'face'; it is cut short; export "
         "the model again"},
        {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n0 0 0\n",
         "file: has no faces; a surface is needed: export the model as a mesh, not as points "
         "or curves"}}));

} // namespace
} // namespace cagewright
