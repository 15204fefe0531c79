// Meshes to new glTF files. That others than our reader understand them: tests/cli/convert_test.py.
#include "io/files.h"
#include "mesh/shapes.h"
#include <cagewright/io/model_file.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using Words = std::vector<std::string>;

ModelFile parse(const std::string& text, MeshFormat format) {
  Result<ModelFile> file = ModelFile::parse(text, format, "file");
  EXPECT_TRUE(file) << file.error().message;
  return *std::move(file);
}

FormattedMesh as_gltf(const ModelFile& file, bool as_json = false) {
  const Result<FormattedMesh> result =
      format_mesh(file.mesh(), *file.attributes(), MeshFormat::gltf, {.gltf_json = as_json});
  EXPECT_TRUE(result) << result.error().message;
  return *result;
}

const std::string quads =
    "o body\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
    "0.25\nvn 0 0 2\nvn 0 -3 0\nusemtl red\ng top\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl blue\n"
    "g side\nf 1/1/2 5/2/2 6/3/2 2/4/2\nusemtl red\nf 4 5 1\n";

TEST(WriteGltf, KeepsPositionsToFloatsAndTheOrderOfTriangles) {
  const PolygonMesh ball(make_icosphere(3));
  for (const bool as_json : {false, true}) {
    const std::string bytes =
        format_mesh(ball, {}, MeshFormat::gltf, {.gltf_json = as_json})->bytes;
    EXPECT_EQ(bytes.starts_with("glTF"), !as_json);
    const ModelFile file = parse(bytes, MeshFormat::gltf);
    ASSERT_EQ(file.mesh().positions.size(), ball.positions.size());
    EXPECT_TRUE(std::ranges::equal(file.mesh().corners(), ball.corners()));
    for (std::size_t v = 0; v < ball.positions.size(); ++v) {
      EXPECT_LE((file.mesh().positions[v] - ball.positions[v]).norm(), 1e-7);
    }
  }
}

TEST(WriteGltf, IsAsExactFarFromTheOrigin) {
  PolygonMesh far(make_icosphere(2));
  const Vec3 shift(4.0e6, -1.2e7, 3.0e5);
  for (Vec3& p : far.positions) {
    p += shift;
  }
  const ModelFile file = parse(format_mesh(far, {}, MeshFormat::gltf, {})->bytes, MeshFormat::gltf);
  for (std::size_t v = 0; v < far.positions.size(); ++v) {
    EXPECT_LE((file.mesh().positions[v] - far.positions[v]).norm(), 1e-6);
  }
}

TEST(WriteGltf, KeepsTexturePointsNormalsGroupsAndNamesOfMaterials) {
  const ModelFile file = parse(quads, MeshFormat::obj);
  const FormattedMesh written = as_gltf(file);
  EXPECT_EQ(written.lost, (Words{"faces of more than three corners (cut into triangles)"}));
  const ModelFile again = parse(written.bytes, MeshFormat::gltf);
  const PolygonMesh& mesh = again.mesh();
  ASSERT_EQ(mesh.face_count(), 5U);
  EXPECT_EQ(mesh.group_names, (Words{"top", "side"}));
  const MeshAttributes all = *again.attributes();
  EXPECT_EQ(all.others, Words{});
  EXPECT_EQ(all.material_names, (Words{"red", "blue"}));
  EXPECT_EQ(all.face_materials, (std::vector<Index>{0, 0, 0, 1, 1})); // by material in a group
  const auto look = [](const PolygonMesh& of, const MeshAttributes& dress, std::size_t corner) {
    const Vec3& p = of.positions[of.corners()[corner]];
    const auto& t = dress.texture_points[dress.texture_of_corner[corner]];
    const Vec3 n = dress.normals[dress.normal_of_corner[corner]].normalized();
    return std::array{p.x(), p.y(), p.z(), t[0], t[1], n.x(), n.y(), n.z()};
  };
  const MeshAttributes before = *file.attributes();
  std::set<std::array<double, 8>> looks;
  for (std::size_t c = 0; c < 8; ++c) {
    looks.insert(look(file.mesh(), before, c));
  }
  for (std::size_t c = 0; c < mesh.corners().size(); ++c) {
    if (c / 3 != 2) { // the triangle that had neither
      EXPECT_TRUE(looks.contains(look(mesh, all, c))) << c;
    }
  }
  EXPECT_EQ(all.normals[all.normal_of_corner[6]], Vec3(1, 0, 0)); // its own direction
}

TEST(WriteGltf, SplitsVerticesOnlyWhereTheirCornersDiffer) {
  const std::string smooth = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\n"
                             "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n";
  EXPECT_EQ(parse(as_gltf(parse(smooth, MeshFormat::obj)).bytes, MeshFormat::gltf)
                .mesh()
                .positions.size(),
            4U);
}

TEST(WriteGltf, KeepsColorsExactlyWhereTheyAreBytes) {
  PolygonMesh mesh(make_icosphere(0));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.colors.push_back({static_cast<float>(v) / 255, 1, 0, 0.2F});
  }
  EXPECT_EQ(
      parse(format_mesh(mesh, {}, MeshFormat::gltf, {})->bytes, MeshFormat::gltf).mesh().colors,
      mesh.colors);
  mesh.colors[0][0] = 0.123456F;
  EXPECT_EQ(
      parse(format_mesh(mesh, {}, MeshFormat::gltf, {})->bytes, MeshFormat::gltf).mesh().colors,
      mesh.colors);
}

TEST(WriteGltf, TakesNamesInAnyEncoding) {
  PolygonMesh mesh(make_icosphere(0));
  mesh.group_names = {"\x83\x5c \"\xff\\"};
  mesh.face_groups.assign(mesh.face_count(), 0);
  const ModelFile file =
      parse(format_mesh(mesh, {}, MeshFormat::gltf, {})->bytes, MeshFormat::gltf);
  ASSERT_EQ(file.mesh().group_names.size(), 1U);
  EXPECT_EQ(file.mesh().group_names[0], "\xc2\x83\x5c \"\xc3\xbf\\");
}

TEST(WriteGltf, RefusesWhatFloatsCannotHold) {
  PolygonMesh mesh(make_icosphere(0));
  mesh.positions[3] = Vec3(0, 1e300, 0);
  const Result<FormattedMesh> result = format_mesh(mesh, {}, MeshFormat::gltf, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::cannot_write);
}

TEST(WriteGltf, TurnsOneContainerIntoTheOtherAndBack) {
  const test::TemporaryFolder folder;
  const ModelFile made = parse(quads, MeshFormat::obj);
  ASSERT_TRUE(write_mesh(made.mesh(), *made.attributes(), folder / "a.glb"));
  const Result<ModelFile> glb = ModelFile::open(folder / "a.glb");
  ASSERT_TRUE(glb);
  ASSERT_TRUE(glb->rewrite(glb->mesh().positions, {}, folder / "b.GLTF"));
  EXPECT_TRUE(test::bytes_of(folder / "b.GLTF").starts_with("{"));
  const Result<ModelFile> json = ModelFile::open(folder / "b.GLTF");
  ASSERT_TRUE(json) << json.error().message;
  EXPECT_EQ(json->mesh().positions, glb->mesh().positions);
  EXPECT_EQ(json->attributes()->texture_points, glb->attributes()->texture_points);
  ASSERT_TRUE(json->rewrite(json->mesh().positions, {}, folder / "c.glb"));
  EXPECT_EQ(test::bytes_of(folder / "c.glb"), test::bytes_of(folder / "a.glb"));
}

} // namespace
} // namespace cagewright
