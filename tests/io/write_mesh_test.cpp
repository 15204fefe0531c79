#include <cagewright/io/write_mesh.h>

#include "io/files.h"
#include <cagewright/io/read_mesh.h>

#include "core/random.h"
#include "mesh/reach.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace cagewright {
namespace {

using test::TemporaryFolder;

// Every kind of double that is read: both zeros, subnormals, the ends of the range, and random
// bits.
PolygonMesh make_awkward_mesh() {
  PolygonMesh mesh;
  using limits = std::numeric_limits<double>;
  mesh.positions = {{0.0, -0.0, 0.1},
                    {limits::denorm_min(), -limits::min(), 1e100},
                    {-1e100, limits::epsilon(), 0x0.fffffffffffffp-1022},
                    {1.0 / 3, 1e22, 9007199254740993.0},
                    {123456, 1e-5, 5e-324}};
  Random random(3);
  while (mesh.positions.size() < 5000) {
    const Vec3 p(std::bit_cast<double>(random.next()), std::bit_cast<double>(random.next()),
                 random.uniform(-1, 1));
    if (is_within_reach(p)) {
      mesh.positions.push_back(p);
    }
  }
  mesh.add_face({0, 1, 2});
  mesh.add_face({3, 4, 0, 2});
  mesh.add_face({4999, 4, 3, 2, 1, 0});
  mesh.add_face({1, 1, 2});
  for (int i = 0; i < 2000; ++i) {
    const auto v = [&] { return static_cast<Index>(random.below(mesh.positions.size())); };
    mesh.add_face({v(), v(), v()});
  }
  return mesh;
}

void expect_same_bits(const Vec3& a, const Vec3& b) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i]))
        << a[i] << " became " << b[i];
  }
}

void expect_same(const PolygonMesh& a, const PolygonMesh& b) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t v = 0; v < a.positions.size(); ++v) {
    expect_same_bits(a.positions[v], b.positions[v]);
  }
  EXPECT_EQ(test::faces_of(a), test::faces_of(b));
}

PolygonMesh written_and_read(const PolygonMesh& mesh, const std::string& name,
                             const WriteOptions& options = {}) {
  const TemporaryFolder folder;
  const Status written = write_mesh(mesh, folder / name, options);
  EXPECT_TRUE(written) << written.error().message;
  EXPECT_EQ(folder.names(), std::vector<std::string>{name}); // nothing else is left
  Result<PolygonMesh> read = read_mesh(folder / name);
  EXPECT_TRUE(read) << read.error().message;
  return read ? *std::move(read) : PolygonMesh();
}

TEST(WriteMesh, GivesTheSameDoublesAndFacesWhenRead) {
  const PolygonMesh mesh = make_awkward_mesh();
  expect_same(mesh, written_and_read(mesh, "a.obj"));
  expect_same(mesh, written_and_read(mesh, "a.OFF"));
  expect_same(mesh, written_and_read(mesh, "a.ply"));
  expect_same(mesh, written_and_read(mesh, "a.Ply", {.ascii_ply = true}));
}

TEST(WriteMesh, GivesTheSameCornersOfTrianglesAsStl) {
  Random random(5);
  TriangleMesh torus = make_torus(0.3, 12, 8);
  for (Vec3& p : torus.positions) {
    p += Vec3(random.uniform(), random.uniform(), random.uniform()) * 1e-9;
  }
  const PolygonMesh read = written_and_read(PolygonMesh(torus), "a.stl");
  ASSERT_EQ(read.face_count(), torus.triangles.size());
  for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      expect_same_bits(read.positions[3 * t + corner], torus.positions[torus.triangles[t][corner]]);
    }
  }
}

TEST(WriteMesh, CutsPolygonsForStl) {
  PolygonMesh quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.add_face({0, 1, 2, 3});
  const Result<std::string> text = format_mesh(quad, MeshFormat::stl);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "solid cagewright\n"
                   "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
                   "endloop\nendfacet\n"
                   "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n"
                   "endloop\nendfacet\n"
                   "endsolid cagewright\n");
}

TEST(WriteMesh, KeepsColors) {
  PolygonMesh mesh(make_tetrahedron());
  mesh.colors = {{1, 0.5, 0.1F, 1}, {0, 0, 0, 0.3F}, {1 / 3.F, 0, 0, 1}, {1, 1, 1, 1}};
  EXPECT_EQ(written_and_read(mesh, "a.ply").colors, mesh.colors);
  EXPECT_EQ(written_and_read(mesh, "a.ply", {.ascii_ply = true}).colors, mesh.colors);
  EXPECT_EQ(written_and_read(mesh, "a.off").colors, mesh.colors);
  mesh.colors[1][3] = 1; // OBJ has no alpha
  EXPECT_EQ(written_and_read(mesh, "a.obj").colors, mesh.colors);
}

TEST(WriteMesh, WritesColorsOfPlyAsBytesWhereTheyAre) {
  PolygonMesh mesh(make_tetrahedron());
  mesh.colors.assign(4, {51 / 255.F, 1, 0, 1});
  const Result<std::string> text = format_mesh(mesh, MeshFormat::ply, {.ascii_ply = true});
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("property uchar red"), std::string::npos);
  EXPECT_NE(text->find(" 51 255 0 255\n"), std::string::npos);
  EXPECT_EQ(written_and_read(mesh, "a.ply").colors, mesh.colors);
}

TEST(WriteMesh, KeepsGroupsInObj) {
  PolygonMesh mesh(make_cube());
  mesh.group_names = {"left arm", "body"};
  mesh.face_groups = {0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 1, 0};
  const PolygonMesh read = written_and_read(mesh, "a.obj");
  EXPECT_EQ(read.group_names, mesh.group_names);
  EXPECT_EQ(read.face_groups, mesh.face_groups);
  expect_same(mesh, read);
  mesh.group_names = {"", "a\nf 1 1 1"}; // a name cannot smuggle in a face
  EXPECT_EQ(written_and_read(mesh, "a.obj").group_names,
            (std::vector<std::string>{"default", "a?f 1 1 1"}));
}

TEST(WriteMesh, KeepsFacesOfMoreCornersThanAByteCanCount) {
  PolygonMesh mesh(make_icosphere(3));
  std::vector<Index> corners(300);
  for (Index i = 0; i < 300; ++i) {
    corners[i] = i;
  }
  mesh.add_face(corners);
  expect_same(mesh, written_and_read(mesh, "a.ply"));
}

TEST(WriteMesh, RefusesFormatsItDoesNotWrite) {
  const TemporaryFolder folder;
  const PolygonMesh mesh(make_cube());
  for (const char* name : {"a.fbx", "a"}) {
    const Status status = write_mesh(mesh, folder / name);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::unsupported);
    EXPECT_NE(status.error().message.find("use .obj, .ply, .off, .stl, .glb or .gltf"),
              std::string::npos);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(WriteMesh, RefusesPositionsThatAreNotFinite) {
  const TemporaryFolder folder;
  PolygonMesh mesh(make_cube());
  mesh.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
  const Status status = write_mesh(mesh, folder / "a.obj");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::cannot_write);
  EXPECT_EQ(status.error().message,
            (folder / "a.obj").string() +
                ": vertex 3 of the mesh is not finite; check where it was computed");
  EXPECT_TRUE(folder.names().empty());
}

} // namespace
} // namespace cagewright
