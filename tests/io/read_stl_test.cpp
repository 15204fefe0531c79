#include <cagewright/io/mesh_format.h>
#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>

#include <limits>

namespace cagewright {
namespace {

using test::binary;

std::string message_of(std::string_view bytes) {
  return test::message_of(bytes, MeshFormat::stl);
}

std::string binary_stl(std::string header, std::uint32_t promised, int facets, float last = 0) {
  header.resize(80, '\0');
  std::string bytes = header + binary(promised);
  for (int f = 0; f < facets; ++f) {
    bytes += binary(0.F, 0.F, 1.F, 0.F, 0.F, 0.1F, 1.F, 0.F, 0.F, 0.F, 1.F, last);
    bytes += binary(std::uint16_t{0});
  }
  return bytes;
}

TEST(ReadStl, KeepsThreeVerticesForEachFacet) {
  const Result<PolygonMesh> mesh = test::read(binary_stl("", 2, 2), MeshFormat::stl);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions.size(), 6U);
  EXPECT_EQ(mesh->positions[0], Vec3(0, 0, 0.1F)); // the float itself, not the decimal number
  EXPECT_EQ(test::faces_of(*mesh), (std::vector<std::vector<Index>>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(ReadStl, IsNotMisledByABinaryFileThatBeginsWithSolid) {
  for (const char* header : {"solid", "solid made by a program", "SOLID\nfacet normal"}) {
    const Result<PolygonMesh> mesh = test::read(binary_stl(header, 1, 1), MeshFormat::stl);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->face_count(), 1U);
  }
}

// Without a zero byte among them the bytes of a binary file look like text; its size tells it
// apart, and stays what it is when the file is written again with other coordinates.
TEST(ReadStl, KnowsABinaryFileByItsSize) {
  constexpr std::uint32_t unset = 0xffffffff;
  const float f = 1.2345678F; // no byte of it is zero
  std::string bytes = "solid" + std::string(75, ' ') + binary(unset);
  bytes += binary(f, f, f, f, f, f, 2 * f, f, f, f, 2 * f, f) + binary(std::uint16_t{0x2020});
  ASSERT_EQ(bytes.find('\0'), std::string::npos);
  EXPECT_EQ(message_of(bytes), "read");
  EXPECT_EQ(test::read(bytes, MeshFormat::stl)->positions[1].x(), 2 * f);
  EXPECT_EQ(format_of_content(bytes), MeshFormat::stl);
}

TEST(ReadStl, AllowsBytesAfterTheLastFacet) {
  EXPECT_EQ(message_of(binary_stl("", 1, 1) + "made by hand"), "read");
}

TEST(ReadStl, ReadsTextInAnyCaseAndLayout) {
  const Result<PolygonMesh> mesh =
      test::read("SOLID my model vertex\n  FACET NORMAL nan nan nan OUTER LOOP\nouter loop\n"
                 "Vertex 0 0 1e-1\nvertex 1 0 0 vertex 0 1 0\nendloop endfacet\r\nendsolid\n"
                 "solid second\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                 "vertex 0 1 0\nendloop\nendfacet\nendsolid second\n",
                 MeshFormat::stl);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions[0], Vec3(0, 0, 0.1)); // text is not rounded to float
  EXPECT_EQ(test::faces_of(*mesh), (std::vector<std::vector<Index>>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(ReadStl, RefusesWhatIsCutShort) {
  EXPECT_EQ(message_of(std::string(50, 'x')),
            "file: byte 50: the file ends within the STL header of 84 bytes; it is cut short or no "
            "STL file; export the model again");
  EXPECT_EQ(message_of(binary_stl("", 3, 2)),
            "file: byte 80: the header promises 3 facets, but there is room for 2; the file is cut "
            "short or no STL file; export the model again");
  EXPECT_EQ(message_of(binary_stl("", 0xffffffff, 2) + "x").substr(0, 61),
            "file: byte 80: the header promises 4294967295 facets, but the");
  EXPECT_EQ(message_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
            "file:5: the file ends without 'endsolid'; it is cut short; export the model again");
}

TEST(ReadStl, RefusesCoordinatesThatAreNotFinite) {
  EXPECT_EQ(message_of(binary_stl("", 2, 2, std::numeric_limits<float>::quiet_NaN())),
            "file: byte 120: facet 0 has a coordinate that is not a finite number; export the "
            "model again");
  EXPECT_EQ(message_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n"),
            "file:4: 'nan' is not a finite number; export the model again");
}

TEST(ReadStl, RefusesFacetsThatAreNoTriangles) {
  const std::string begin = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  EXPECT_EQ(message_of(begin + "endloop\nendfacet\nendsolid\n"),
            "file:7: a facet has 3 vertices, but this has 2; export the model again");
  EXPECT_EQ(message_of(begin + "vertex 1 0\nendloop\n"),
            "file:6: a vertex needs 3 coordinates; export the model again");
  EXPECT_EQ(message_of("solid a\nface normal 0 0 1\n"),
            "file:2: 'face' is no STL statement; export the model again");
}

TEST(ReadStl, RefusesAFileWithoutFacets) {
  EXPECT_NE(message_of(binary_stl("", 0, 0)).find("has no faces"), std::string::npos);
  EXPECT_NE(message_of("solid a\nendsolid a\n").find("has no faces"), std::string::npos);
}

} // namespace
} // namespace cagewright
