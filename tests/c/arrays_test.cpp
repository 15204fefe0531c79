// What callers point to is read where it is: their memory, not a copy, wherever its form allows.
#include "arrays.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cagewright::c {
namespace {

struct Tetrahedron {
  std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<std::uint32_t> corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

  [[nodiscard]] cw_mesh_view view() const {
    return cw_triangle_mesh(xyz.data(), 4, corners.data(), 4);
  }
};

TEST(Arrays, OfPackedNumbersAreNotCopied) {
  const Tetrahedron shape;
  const cw_mesh_view view = shape.view();
  const Result<MeshArgument> mesh = MeshArgument::of(&view, "the model");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(static_cast<const void*>(mesh->triangles().positions.data()), shape.xyz.data());
  EXPECT_EQ(static_cast<const void*>(mesh->triangles().triangles.data()), shape.corners.data());
  EXPECT_TRUE(mesh->face_of().empty());
}

TEST(Arrays, OfSignedIndicesAreNotCopiedEither) {
  const Tetrahedron shape;
  cw_mesh_view view = shape.view();
  view.faces.type = CW_INT32;
  view.faces.row_stride = 12;
  view.faces.column_stride = 4;
  const Result<MeshArgument> mesh = MeshArgument::of(&view, "the model");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(static_cast<const void*>(mesh->triangles().triangles.data()), shape.corners.data());
}

TEST(Arrays, ThatAreNotAlignedAreCopied) {
  const Tetrahedron shape;
  std::vector<char> bytes(shape.xyz.size() * sizeof(double) + 1);
  std::copy_n(reinterpret_cast<const char*>(shape.xyz.data()), bytes.size() - 1, bytes.data() + 1);
  cw_mesh_view view = shape.view();
  view.positions.data = bytes.data() + 1;
  const Result<MeshArgument> mesh = MeshArgument::of(&view, "the model");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles().positions[3], Vec3(0, 0, 1));
}

TEST(Arrays, StayValidWhenTheArgumentMoves) {
  const Tetrahedron shape;
  const std::vector<std::int64_t> wide(shape.corners.begin(), shape.corners.end());
  cw_mesh_view view = shape.view();
  view.faces = {wide.data(), CW_INT64, 4, 3, 0, 0};
  view.positions.row_stride = -24; // backwards, from the last
  view.positions.column_stride = 8;
  view.positions.data = shape.xyz.data() + 9;
  Result<MeshArgument> made = MeshArgument::of(&view, "the model");
  ASSERT_TRUE(made) << made.error().message;
  const MeshArgument mesh = std::move(*made);
  EXPECT_EQ(mesh.triangles().positions[0], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.triangles().positions[3], Vec3(0, 0, 0));
  EXPECT_EQ(mesh.triangles().triangles[3], (Triangle{1, 2, 3}));
  EXPECT_EQ(mesh.polygons().face_count(), 4U);
}

TEST(Arrays, NameTheFaceOfATriangle) {
  const std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::vector<std::int16_t> rows = {0, 1, 2, 3, 0, 2, 1, -1};
  const cw_mesh_view view = {cw_points(xyz.data(), 4),
                             {rows.data(), CW_INT16, 2, 4, 0, 0},
                             {nullptr, CW_UINT64, 0, 0, 0, 0}};
  const Result<MeshArgument> mesh = MeshArgument::of(&view, "the model");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(std::vector<Index>(mesh->face_of().begin(), mesh->face_of().end()),
            (std::vector<Index>{0, 0, 1}));
  EXPECT_EQ(mesh->polygons().face(0).size(), 4U);
}

TEST(Arrays, RefuseOffsetsThatMakeNoSense) {
  const Tetrahedron shape;
  for (const std::vector<std::int32_t>& offsets :
       {std::vector<std::int32_t>{0, 6, 3, 12}, {-3, 6, 12}, {0, 15, 12}}) {
    cw_mesh_view view = shape.view();
    view.faces = {shape.corners.data(), CW_UINT32, 12, 1, 0, 0};
    view.offsets = {offsets.data(), CW_INT32, offsets.size(), 1, 0, 0};
    const Result<MeshArgument> mesh = MeshArgument::of(&view, "the model");
    ASSERT_FALSE(mesh);
    EXPECT_NE(mesh.error().message.find("offsets rise from 0"), std::string::npos)
        << mesh.error().message;
  }
}

} // namespace
} // namespace cagewright::c
