// What a file holds beside the shape, from one format to another.
#include "io/files.h"
#include <cagewright/io/model_file.h>
#include <cagewright/io/write_mesh.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cagewright {
namespace {

using test::TemporaryFolder;

// Every vertex has one normal and one texture point.
const std::string obj =
    "mtllib skin.mtl\no body\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
    "vt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 0.6 0.8\nusemtl red\ng front\nf 1/1/1 2/2/1 "
    "3/3/1\nusemtl blue\ng back\nf 1/1/1 3/3/1 4/4/2\ns 1\nl 1 2\n";
const std::string ply =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty "
    "double "
    "y\nproperty double z\nproperty double nx\nproperty double ny\nproperty double nz\nproperty "
    "uchar "
    "red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty double "
    "s\nproperty double t\nproperty double quality\nelement face 2\nproperty list uchar int "
    "vertex_indices\nproperty int label\nend_header\n"
    "0 0 0 0 0 1 255 0 0 255 0 0 0.5\n1 0 0 0 0 1 0 255 0 255 1 0 0.25\n"
    "1 1 0 0 0 1 0 0 255 255 1 1 -1\n0 1 0 0 0.6 0.8 9 9 9 255 0 1 2\n3 0 1 2 7\n3 0 2 3 -8\n";

ModelFile parse(const std::string& text, MeshFormat format) {
  Result<ModelFile> file = ModelFile::parse(text, format, "file");
  EXPECT_TRUE(file) << file.error().message;
  return *std::move(file);
}

FormattedMesh formatted(const ModelFile& file, MeshFormat format) {
  const Result<FormattedMesh> result =
      format_mesh(file.mesh(), *file.attributes(), format, {.ascii_ply = true});
  EXPECT_TRUE(result);
  return *result;
}

using Words = std::vector<std::string>;

TEST(Attributes, OfObjAreReadAndWrittenAgain) {
  const ModelFile file = parse(obj, MeshFormat::obj);
  const MeshAttributes all = *file.attributes();
  EXPECT_EQ(all.texture_of_corner, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(all.normal_of_corner, (std::vector<Index>{0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(all.material_names, (Words{"red", "blue"}));
  EXPECT_EQ(all.face_materials, (std::vector<Index>{0, 1}));
  EXPECT_EQ(all.material_files, (Words{"skin.mtl"}));
  EXPECT_EQ(file.mesh().group_names, (Words{"front", "back"}));
  EXPECT_EQ(all.group_objects, (Words{"body", "body"}));
  EXPECT_EQ(all.others, (Words{"smoothing groups", "lines"}));
  const ModelFile again = parse(formatted(file, MeshFormat::obj).bytes, MeshFormat::obj);
  const MeshAttributes same = *again.attributes();
  EXPECT_EQ(same.texture_points, all.texture_points);
  EXPECT_EQ(same.texture_of_corner, all.texture_of_corner);
  EXPECT_EQ(same.normals, all.normals);
  EXPECT_EQ(same.normal_of_corner, all.normal_of_corner);
  EXPECT_EQ(same.face_materials, all.face_materials);
  EXPECT_EQ(same.material_files, all.material_files);
  EXPECT_EQ(same.group_objects, all.group_objects);
  EXPECT_EQ(again.mesh().group_names, file.mesh().group_names);
}

TEST(Attributes, OfObjGoToPlyAsFarAsItCan) {
  const FormattedMesh written = formatted(parse(obj, MeshFormat::obj), MeshFormat::ply);
  EXPECT_EQ(written.lost, (Words{"materials", "groups", "smoothing groups", "lines"}));
  const MeshAttributes all = *parse(written.bytes, MeshFormat::ply).attributes();
  EXPECT_EQ(all.texture_points,
            (std::vector<std::array<double, 2>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(all.normals[3], Vec3(0, 0.6, 0.8));
}

TEST(Attributes, OfPlyAreReadAndWrittenAgain) {
  const ModelFile file = parse(ply, MeshFormat::ply);
  const FormattedMesh written = formatted(file, MeshFormat::ply);
  EXPECT_TRUE(written.lost.empty());
  EXPECT_EQ(written.bytes, ply);
}

TEST(Attributes, OfPlyGoToObjAndOffAsFarAsTheyCan) {
  const ModelFile file = parse(ply, MeshFormat::ply);
  const FormattedMesh to_obj = formatted(file, MeshFormat::obj);
  EXPECT_EQ(to_obj.lost,
            (Words{"the values 'quality' of vertices", "the values 'label' of faces"}));
  EXPECT_NE(to_obj.bytes.find("f 1/1/1 3/3/3 4/4/4\n"), std::string::npos) << to_obj.bytes;
  EXPECT_NE(to_obj.bytes.find("vt 1 1\n"), std::string::npos);
  EXPECT_NE(to_obj.bytes.find("vn 0 0.6 0.8\n"), std::string::npos);
  EXPECT_NE(to_obj.bytes.find("# made by hand\n"), std::string::npos);
  const FormattedMesh to_off = formatted(file, MeshFormat::off);
  EXPECT_EQ(to_off.lost, to_obj.lost);
  const ModelFile off = parse(to_off.bytes, MeshFormat::off);
  const MeshAttributes all = *off.attributes();
  EXPECT_EQ(all.normals, file.attributes()->normals);
  EXPECT_EQ(all.texture_points, file.attributes()->texture_points);
  EXPECT_EQ(off.mesh().colors, file.mesh().colors);
}

TEST(Attributes, AreNamedWhereStlLosesThem) {
  EXPECT_EQ(formatted(parse(ply, MeshFormat::ply), MeshFormat::stl).lost,
            (Words{"texture coordinates", "normals", "vertex colours",
                   "the values 'quality' of vertices", "the values 'label' of faces"}));
}

TEST(Attributes, OfHardEdgesAndSeamsAreNamedOrGoToCorners) {
  const std::string seam = obj + "f 4/1/1 3/2/2 1/4/2\n";
  const FormattedMesh to_ply = formatted(parse(seam, MeshFormat::obj), MeshFormat::ply);
  EXPECT_EQ(to_ply.lost[0], "normals of hard edges");
  EXPECT_NE(to_ply.bytes.find("property list uchar double texcoord\n"), std::string::npos);
  EXPECT_NE(to_ply.bytes.find("3 3 2 0 6 0 0 1 0 0 1\n"), std::string::npos) << to_ply.bytes;
  const FormattedMesh to_off = formatted(parse(seam, MeshFormat::obj), MeshFormat::off);
  EXPECT_EQ(to_off.lost[0], "texture coordinates");
}

TEST(Attributes, OfCornersComeBackFromPly) {
  const ModelFile seam = parse(obj + "f 4/1/1 3/2/2 1/4/2\n", MeshFormat::obj);
  const std::string written = formatted(seam, MeshFormat::ply).bytes;
  const MeshAttributes back = *parse(written, MeshFormat::ply).attributes();
  const MeshAttributes all = *seam.attributes();
  ASSERT_EQ(back.texture_of_corner.size(), all.texture_of_corner.size());
  for (std::size_t c = 0; c < all.texture_of_corner.size(); ++c) {
    EXPECT_EQ(back.texture_points[back.texture_of_corner[c]],
              all.texture_points[all.texture_of_corner[c]]);
  }
  EXPECT_TRUE(back.others.empty());
}

TEST(Attributes, OfCornersThatAreNamedTwiceGoWithThem) {
  const MeshAttributes all =
      *parse("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
             "property float z\nelement face 2\nproperty list uchar float texcoord\nproperty list "
             "uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
             "10 0 0 1 0 .5 .5 1 1 0 1 5 0 1 1 2 3\n4 0 0 1 1 3 0 1 2\n",
             MeshFormat::ply)
           .attributes();
  ASSERT_EQ(all.texture_of_corner.size(), 7U);
  EXPECT_EQ(all.texture_points[all.texture_of_corner[2]], (std::array<double, 2>{1, 1}));
  EXPECT_EQ(all.texture_of_corner[4], MeshAttributes::none); // two points for three corners
}

TEST(Attributes, OfStripsAreNamed) {
  const ModelFile file = parse(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nproperty int label\nproperty "
      "uchar red\nproperty uchar green\nproperty uchar blue\nelement tristrips 1\nproperty list "
      "uchar int vertex_indices\nproperty float weight\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 7 1 2 3\n4 0 1 2 3 0.5\n",
      MeshFormat::ply);
  EXPECT_EQ(file.mesh().face_count(), 3U);
  EXPECT_EQ(file.attributes()->others, (Words{"the values 'weight' of strips", "face colours",
                                              "the values 'label' of faces"}));
  const std::string written = formatted(file, MeshFormat::ply).bytes; // and no value is missed
  EXPECT_EQ(parse(written, MeshFormat::ply).mesh().face_count(), 3U);
}

TEST(Attributes, FollowAMoveIntoAnotherFormatWithTheNormalsGiven) {
  const ModelFile file = parse(ply, MeshFormat::ply);
  const TemporaryFolder folder;
  const std::vector<Vec3> moved(4, Vec3(1, 2, 3));
  const std::vector<Vec3> normals(4, Vec3(0, 1, 0));
  const Result<std::vector<FileNote>> notes = file.write_moved(moved, normals, folder / "a.obj");
  ASSERT_TRUE(notes) << notes.error().message;
  ASSERT_EQ(notes->size(), 1U);
  EXPECT_EQ((*notes)[0].code, "lost");
  EXPECT_TRUE((*notes)[0].message.ends_with("a.obj: OBJ cannot hold all: left out are the values "
                                            "'quality' of vertices, the values 'label' "
                                            "of faces"))
      << (*notes)[0].message;
  const std::string text = test::bytes_of(folder / "a.obj");
  EXPECT_NE(text.find("v 1 2 3 1 0 0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("vn 0 1 0\n"), std::string::npos);
  EXPECT_EQ(text.find("vn 0 0 1\n"), std::string::npos);
}

} // namespace
} // namespace cagewright
