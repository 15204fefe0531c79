#include <cagewright/io/rewrite_positions.h>

#include "io/files.h"
#include <cagewright/io/read_mesh.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

using test::bytes_of;
using test::TemporaryFolder;

const std::string obj = "# made by hand  \r\n"
                        "mtllib skin.mtl\r\n"
                        "o left arm\\\r\n"
                        "v   0 0\t0   1 0.5 0  # the first\r\n"
                        "vt .5 .50\r\n"
                        "v 1.000 \\\r\n 0 0\r\n"
                        "vn 0 0 1.0\r\n"
                        "vn 0 1 0\r\n"
                        "v 0 +1e0 0 1.0\r\n"
                        "\r\n"
                        "usemtl blue\r\n"
                        "s off\r\n"
                        "f 1/1/1 2//2 -1\r\n"
                        "l 1 2\r\n"
                        "unknown v 1 2 3\r\n"
                        "f 3 2/1 1//-2";

const std::vector<Vec3> moved = {{0.1, -2, 1e-300}, {1.0 / 3, 5, 6}, {7, 8, -0.0}};

std::string rewritten(std::string_view name, std::string_view bytes,
                      std::span<const Vec3> positions, std::span<const Vec3> normals = {}) {
  const TemporaryFolder folder;
  const auto original = folder.add(name, bytes);
  const Status status = rewrite_positions(original, positions, normals, folder / "out");
  EXPECT_TRUE(status) << status.error().message;
  EXPECT_EQ(bytes_of(original), bytes);
  return bytes_of(folder / "out");
}

TEST(RewritePositions, ChangesOnlyTheNumbersOfAnObjFile) {
  EXPECT_EQ(rewritten("a.obj", obj, moved), "# made by hand  \r\n"
                                            "mtllib skin.mtl\r\n"
                                            "o left arm\\\r\n"
                                            "v   0.1 -2\t1e-300   1 0.5 0  # the first\r\n"
                                            "vt .5 .50\r\n"
                                            "v 0.3333333333333333 \\\r\n 5 6\r\n"
                                            "vn 0 0 1.0\r\n"
                                            "vn 0 1 0\r\n"
                                            "v 7 8 -0 1.0\r\n"
                                            "\r\n"
                                            "usemtl blue\r\n"
                                            "s off\r\n"
                                            "f 1/1/1 2//2 -1\r\n"
                                            "l 1 2\r\n"
                                            "unknown v 1 2 3\r\n"
                                            "f 3 2/1 1//-2");
}

TEST(RewritePositions, ChangesNormalsWhereTheyAreGiven) {
  const std::string text = rewritten("a.obj", obj, moved, std::vector<Vec3>{{1, 0, 0}, {0, 0, -1}});
  EXPECT_NE(text.find("vn 1 0 0\r\nvn 0 0 -1\r\n"), std::string::npos);
  EXPECT_NE(text.find("vt .5 .50"), std::string::npos);
}

// A side of two triangles that all share one normal, as programs write them: the first `vn`.
const std::string side = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                         "vn 0 0 1\nvn 1 0 0 # of nobody\nvn 0 1 0\n"
                         "f 1//1 2//1 3/7/1\nf -4//-3 3//3 4//99 2 1//-9\n";

TEST(RewritePositions, WritesANormalForEachVertexThatTurnsApart) {
  const std::vector<Vec3> still = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Vec3> normals = {{0, 0, 1}, {0.5, 0, 1}, {0, 0.5, 1}, {0, 1, 0}};
  EXPECT_EQ(rewritten("a.obj", side, still, normals),
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
            "vn 0 0 1\nvn 0.5 0 1\nvn 0 0.5 1\nvn 1 0 0 # of nobody\nvn 0 1 0\n"
            "f 1//1 2//2 3/7/3\nf -4//1 3//5 4//101 2 1//-11\n");
  // Two that stay equal share a line, and corners are left alone where one line is enough.
  EXPECT_EQ(rewritten("a.obj", side, still,
                      std::vector<Vec3>{{0, 0, 1}, {0.5, 0, 1}, {0.5, 0, 1}, {0, 1, 0}}),
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
            "vn 0 0 1\nvn 0.5 0 1\nvn 1 0 0 # of nobody\nvn 0 1 0\n"
            "f 1//1 2//2 3/7/2\nf -4//1 3//4 4//100 2 1//-10\n");
  EXPECT_EQ(rewritten("a.obj", side, still,
                      std::vector<Vec3>{{0, 0, 1}, {0, 1e-9, 1}, {0, 0, 1}, {0, 1, 0}}),
            side);
}

// Whatever normals are given: reading the file again gives each corner its own.
TEST(RewritePositions, GivesEveryCornerTheNormalMeantForIt) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> one_of(0, 5);
  for (int round = 0; round < 200; ++round) {
    std::ostringstream text;
    text << "vn 0 0 1\n";
    for (int v = 0; v < 6; ++v) {
      text << "v 0 " << v << " 0\nvn 0 1 " << v % 2 << "\n";
    }
    for (int f = 0; f < 8; ++f) {
      text << "f";
      for (int corner = 0; corner < 3 + f % 3; ++corner) {
        text << " " << 1 + one_of(random) << "//" << 1 + one_of(random);
      }
      text << "\n";
    }
    const TemporaryFolder folder;
    const auto original = folder.add("a.obj", text.str());
    const Result<FileNormals> before = read_normals(original);
    ASSERT_TRUE(before);
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < before->normals.size(); ++i) {
      normals.emplace_back(one_of(random) / 2, one_of(random), 1); // some equal, some not
    }
    const Result<PolygonMesh> mesh = read_mesh(original);
    ASSERT_TRUE(mesh);
    ASSERT_TRUE(rewrite_positions(original, mesh->positions, normals, folder / "b.obj"));
    const Result<FileNormals> after = read_normals(folder / "b.obj");
    ASSERT_TRUE(after) << after.error().message;
    ASSERT_EQ(after->of_corner.size(), before->of_corner.size());
    for (std::size_t c = 0; c < before->of_corner.size(); ++c) {
      EXPECT_EQ(after->normals[after->of_corner[c]], normals[before->of_corner[c]]) << text.str();
    }
  }
}

TEST(RewritePositions, GivesTheFileItselfForItsOwnPositions) {
  for (const test::Sample& sample : test::samples()) {
    if (sample.format == MeshFormat::gltf || sample.name == "binary stl") {
      continue; // the facet normals of the sample are zero
    }
    const Result<PolygonMesh> mesh = test::read(sample.bytes, sample.format);
    ASSERT_TRUE(mesh);
    std::string expected = sample.bytes;
    if (sample.format == MeshFormat::obj) {
      expected.erase(expected.find("e0"), 2); // 1e0 becomes 1
    }
    EXPECT_EQ(rewritten("a", sample.bytes, mesh->positions), expected) << sample.name;
  }
}

TEST(RewritePositions, IsReadAsTheNewPositionsAndTheOldFacesInEveryFormat) {
  const TemporaryFolder folder;
  for (const test::Sample& sample : test::samples()) {
    if (sample.format == MeshFormat::gltf) {
      continue;
    }
    const auto original = folder.add("a", sample.bytes);
    const Result<PolygonMesh> before = read_mesh(original);
    ASSERT_TRUE(before);
    std::vector<Vec3> positions = before->positions;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      positions[v] = 2 * positions[v] + Vec3(0.5, -0.25, static_cast<double>(v)); // exact in float
    }
    const Status status = rewrite_positions(original, positions, {}, folder / "out");
    ASSERT_TRUE(status) << status.error().message;
    const Result<PolygonMesh> after = read_mesh(folder / "out");
    ASSERT_TRUE(after) << sample.name << ": " << after.error().message;
    EXPECT_EQ(after->positions, positions) << sample.name;
    EXPECT_EQ(test::faces_of(*after), test::faces_of(*before)) << sample.name;
    EXPECT_EQ(after->colors, before->colors) << sample.name;
  }
}

TEST(RewritePositions, ComputesTheNormalsOfStlAnew) {
  const std::string text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                           "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  EXPECT_EQ(rewritten("a.stl", text, std::vector<Vec3>{{0, 0, 0}, {0, 2, 0}, {0, 0, 2}}),
            "solid a\nfacet normal 1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 2 0\n"
            "vertex 0 0 2\nendloop\nendfacet\nendsolid a\n");
}

TEST(RewritePositions, KeepsOtherElementsOfPly) {
  const std::string header = "ply\nformat ascii 1.0\ncomment mine\nelement extra 2\nproperty list "
                             "uchar int items\nelement vertex 3\nproperty float quality\nproperty "
                             "float z\nproperty float x\nproperty float y\nelement face "
                             "1\nproperty list uchar int vertex_indices\nend_header\n2 7 7\n0\n";
  EXPECT_EQ(rewritten("a.ply", header + "9 3 1 2\n9  6 4 5\n9 9 7 8 \n3 0 1 2\n",
                      std::vector<Vec3>{{10, 20, 30}, {40, 50, 60}, {70, 80, 0.1}}),
            header + "9 30 10 20\n9  60 40 50\n9 0.1 70 80 \n3 0 1 2\n");
}

TEST(RewritePositions, RefusesWhatDoesNotBelongTogether) {
  const TemporaryFolder folder;
  const auto original = folder.add("a.obj", obj);
  const auto message = [&](std::span<const Vec3> positions, std::span<const Vec3> normals) {
    const Status status = rewrite_positions(original, positions, normals, folder / "out.obj");
    EXPECT_FALSE(status);
    return status ? "written" : status.error().message.substr(original.string().size());
  };
  EXPECT_EQ(message(std::span(moved).first(2), {}),
            ": has 3 vertices, but 2 are to be written; check that this is the model they were "
            "made from");
  EXPECT_EQ(message(moved, moved), ": has 2 normals, but 3 are to be written; check that this is "
                                   "the model they were made from");
  std::vector<Vec3> broken = moved;
  broken[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(rewrite_positions(original, broken, {}, folder / "out.obj"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.obj"});
}

// In each file the second vertex has other things between its position and its normal.
TEST(RewritePositions, ChangesNormalsOfPlyAndOff) {
  const std::string header = "element vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nproperty uchar red\nproperty float nx\n"
                             "property float ny\nproperty float nz\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n";
  std::string little = "ply\nformat binary_little_endian 1.0\n" + header;
  for (const float x : {0.F, 1.F, 2.F}) {
    little += test::binary(x, x * x, 0.F, std::uint8_t{7}, 0.F, 0.F, 1.F);
  }
  little += test::binary(std::uint8_t{3}, 0, 1, 2);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.ply", "ply\nformat ascii 1.0\n" + header +
                    "0 0 0 7 0 0 1\n1 0 0 8 0 0 1\n0 1 0 9 0 0 1\n3 0 1 2\n"},
      {"b.ply", little},
      {"c.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1 # kept\n0 1 0 0 0 1\n3 0 1 2\n"}};
  const std::vector<Vec3> to = {{0.5, -2, 1}, {0.25, 5, 6}, {7, 8, 3}};
  const std::vector<Vec3> turned = {{1, 0, 0}, {0, 0.5, -1}, {0, 1, 0}};
  for (const auto& [name, bytes] : files) {
    const TemporaryFolder folder;
    const auto original = folder.add(name, bytes);
    const Result<FileNormals> before = read_normals(original);
    ASSERT_TRUE(before) << before.error().message;
    EXPECT_EQ(before->normals, std::vector<Vec3>(3, Vec3(0, 0, 1))) << name;
    EXPECT_EQ(before->of_corner, (std::vector<Index>{0, 1, 2})) << name;
    const Status status = rewrite_positions(original, to, turned, folder / ("out-" + name));
    ASSERT_TRUE(status) << status.error().message;
    const Result<FileNormals> after = read_normals(folder / ("out-" + name));
    ASSERT_TRUE(after) << after.error().message;
    EXPECT_EQ(after->normals, turned) << name;
    const Result<PolygonMesh> mesh = read_mesh(folder / ("out-" + name));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions, to) << name;
  }
}

TEST(ReadNormals, TellsWhichCornerUsesWhich) {
  const TemporaryFolder folder;
  const Result<FileNormals> normals = read_normals(folder.add("a.obj", obj));
  ASSERT_TRUE(normals) << normals.error().message;
  EXPECT_EQ(normals->normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}}));
  constexpr Index none = FileNormals::none;
  EXPECT_EQ(normals->of_corner, (std::vector<Index>{0, 1, none, none, none, 0}));
}

TEST(ReadNormals, GivesEachVertexItsOwnOfASharedOne) {
  const TemporaryFolder folder;
  const Result<FileNormals> normals = read_normals(folder.add("a.obj", side));
  ASSERT_TRUE(normals) << normals.error().message;
  constexpr Index none = FileNormals::none;
  EXPECT_EQ(normals->normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(normals->in_file, (std::vector<Index>{0, 0, 0, 2}));
  EXPECT_EQ(normals->of_corner, (std::vector<Index>{0, 1, 2, 0, 3, none, none}));
}

TEST(ReadNormals, GivesNoneForAFileWithoutThem) {
  const TemporaryFolder folder;
  const Result<FileNormals> normals =
      read_normals(folder.add("a.obj", "v 0 0 0\nf 1//7 1//0 1//-1\n"));
  ASSERT_TRUE(normals) << normals.error().message;
  EXPECT_TRUE(normals->normals.empty());
  EXPECT_TRUE(normals->of_corner.empty());
}

} // namespace
} // namespace cagewright
