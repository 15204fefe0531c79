#include "io/gltf_builder.h"
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/read_skeleton.h>
#include <cagewright/io/rewrite_positions.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using test::GltfBuilder;
using Points = std::vector<Vec3>;

const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

PolygonMesh read(const std::string& bytes, Pose pose = Pose::shown) {
  Result<PolygonMesh> mesh = read_mesh(bytes, MeshFormat::gltf, "file", pose);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

void expect_points(const Points& found, const Points& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_LT((found[v] - expected[v]).norm(), 1e-6) << v << ": " << found[v].transpose();
  }
}

// A triangle on two joints below a moved node; the mesh's own node is moved too. Joint 0 (node 2)
// stands at (0 0 1), joint 1 (node 3) is turned a quarter about z and stands at (5 0 1).
struct Rig {
  GltfBuilder file;
  std::string attributes;
  std::string skin;

  explicit Rig(const std::vector<std::uint8_t>& joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
               const std::vector<float>& weights = {1, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0}) {
    attributes = R"("POSITION":)" + std::to_string(file.floats("VEC3", triangle));
    attributes += R"(,"JOINTS_0":)" + std::to_string(file.integers("VEC4", 5121, joints));
    attributes += R"(,"WEIGHTS_0":)" + std::to_string(file.floats("VEC4", weights));
    file.nodes =
        R"([{"mesh":0,"skin":0,"translation":[100,0,0],"scale":[1,1,-3]},)"
        R"({"children":[2,3],"translation":[0,0,1]},{},)"
        R"({"translation":[5,0,0],"rotation":[0,0,0.70710678118654752,0.7071067811865475]}])";
    file.scenes = R"([{"nodes":[0,1]}])";
    skin = R"({"joints":[2,3]})";
  }

  [[nodiscard]] std::string glb() const {
    GltfBuilder whole = file;
    whole.meshes = R"([{"primitives":[{"attributes":{)" + attributes + "}}]}]";
    whole.more += R"(,"skins":[)" + skin + "]";
    return whole.glb();
  }

  [[nodiscard]] std::string message() const { return test::message_of(glb(), MeshFormat::gltf); }
};

TEST(GltfPose, JointsPlaceASkinnedMeshAndItsNodeDoesNot) {
  // Vertex 1 goes to (0 1 0) + (5 0 1); vertex 2 to the mean of (0 1 1) and (4 0 1).
  const PolygonMesh mesh = read(Rig().glb());
  expect_points(mesh.positions, {{0, 0, 1}, {5, 1, 1}, {2, 0.5, 1}});
  EXPECT_EQ(test::faces_of(mesh), (std::vector<std::vector<Index>>{{0, 1, 2}}));
}

TEST(GltfPose, InBindPoseASkinnedMeshStandsAsItIsStored) {
  expect_points(read(Rig().glb(), Pose::bind).positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfPose, InverseBindMatricesComeFirst) {
  Rig rig; // column after column: the first moves by -2 along x, the second doubles
  const std::size_t matrices =
      rig.file.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1,
                               2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0,  0, 0, 1});
  rig.skin = R"({"joints":[2,3],"inverseBindMatrices":)" + std::to_string(matrices) + "}";
  expect_points(read(rig.glb()).positions, {{-2, 0, 1}, {5, 2, 1}, {0.5, 0.5, 1}});
}

TEST(GltfPose, TakesWeightsOfAllSetsAndAllTypes) {
  Rig rig({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0, 0, 0});
  rig.attributes +=
      R"(,"JOINTS_1":)" +
      std::to_string(rig.file.integers(
          "VEC4", 5123, std::vector<std::uint16_t>{9, 0, 0, 0, 7, 0, 0, 0, 1, 0, 0, 0}));
  rig.attributes +=
      R"(,"WEIGHTS_1":)" +
      std::to_string(rig.file.floats("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0.5F, 0, 0, 0}));
  expect_points(read(rig.glb()).positions, {{0, 0, 1}, {5, 1, 1}, {2, 0.5, 1}});

  Rig fractions;
  fractions.attributes.replace(
      fractions.attributes.rfind(':') + 1, 1,
      std::to_string(fractions.file.integers(
          "VEC4", 5123,
          std::vector<std::uint16_t>{65535, 0, 0, 0, 0, 65535, 0, 0, 32768, 32768, 0, 0},
          R"(,"normalized":true)")));
  expect_points(read(fractions.glb()).positions, {{0, 0, 1}, {5, 1, 1}, {2, 0.5, 1}});
}

TEST(GltfPose, WeightsNeedNotSumToOne) {
  expect_points(
      read(
          Rig({0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, {3, 0, 0, 0, 0, 0.25F, 0, 0, 0, 0, 0, 0}).glb())
          .positions,
      {{0, 0, 1}, {5, 1, 1}, {4, 0, 1}}); // the last follows the first joint it names
}

TEST(GltfPose, JointsAreWhereTheirParentsPutThemInOrOutOfTheScene) {
  Rig rig;
  rig.file.scenes = R"([{"nodes":[0]}])";
  expect_points(read(rig.glb()).positions, {{0, 0, 1}, {5, 1, 1}, {2, 0.5, 1}});
}

TEST(GltfPose, ASkinOfPrimitivesWithoutJointsLeavesThemUnderTheirNode) {
  Rig rig;
  rig.attributes = R"("POSITION":0)";
  for (const Pose pose : {Pose::shown, Pose::bind}) {
    expect_points(read(rig.glb(), pose).positions, {{100, 0, 0}, {101, 0, 0}, {100, 1, 0}});
  }
}

TEST(GltfPose, TrianglesThatJointsMirrorAreTurnedBack) {
  Rig rig;
  rig.file.nodes = R"([{"mesh":0,"skin":0},{"scale":[-1,1,1],"children":[2,3]},{},{}])";
  const PolygonMesh mesh = read(rig.glb());
  expect_points(mesh.positions, {{0, 0, 0}, {-1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(test::faces_of(mesh), (std::vector<std::vector<Index>>{{0, 2, 1}}));
}

TEST(GltfPose, RefusesRigsThatDoNotFit) {
  Rig rig;
  rig.skin = R"({"joints":[2,9]})";
  EXPECT_EQ(rig.message(), "file: node 0 refers to a skin that does not exist, or has no joints; "
                           "export the model again");
  EXPECT_EQ(Rig({0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0}).message(),
            "file: accessor 1: vertex 1 follows a joint beyond the 2 of skin 0; export the model "
            "again");
  Rig few;
  const std::size_t matrices = few.file.floats("MAT4", std::vector<float>(16, 1.F));
  few.skin = R"({"joints":[2,3],"inverseBindMatrices":)" + std::to_string(matrices) + "}";
  EXPECT_EQ(few.message(), "file: skin 0 has 2 joints, but accessor 3 holds 1 inverse bind "
                           "matrices; export the model again");
  Rig cycle;
  cycle.file.scenes = R"([{"nodes":[0]}])";
  cycle.file.nodes = R"([{"mesh":0,"skin":0},{"children":[2]},{"children":[3]},{"children":[1]}])";
  EXPECT_EQ(cycle.message(), "file: node 2 stands below itself; export the model again");
}

TEST(GltfSkeleton, NamesTheJointsWithTheirPlacesAndParents) {
  Rig rig;
  rig.file.nodes =
      R"([{"mesh":0,"skin":0},{"children":[3],"translation":[0,0,1]},)"
      R"({"name":"hand","translation":[5,0,0]},{"name":"arm","children":[4],"translation":[1,0,0]},)"
      R"({"children":[2],"translation":[0,2,0]}])";
  const std::size_t matrices =
      rig.file.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -7, 0,  0, 1,
                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  -8, 0, 1});
  rig.skin = R"({"joints":[2,3],"inverseBindMatrices":)" + std::to_string(matrices) + "}";
  const test::TemporaryFolder folder;
  const auto path = folder.add("a.glb", rig.glb());
  const Result<Skeleton> shown = read_skeleton(path);
  ASSERT_TRUE(shown) << shown.error().message;
  ASSERT_EQ(shown->joints.size(), 2U);
  EXPECT_EQ(shown->joints[0].name, "arm"); // before its child, with a node between them
  EXPECT_EQ(shown->joints[0].position, Vec3(1, 0, 1));
  EXPECT_EQ(shown->joints[0].parent, Joint::none);
  EXPECT_EQ(shown->joints[1].name, "hand");
  EXPECT_EQ(shown->joints[1].position, Vec3(6, 2, 1));
  EXPECT_EQ(shown->joints[1].parent, 0U);
  const Result<Skeleton> bound = read_skeleton(path, Pose::bind);
  ASSERT_TRUE(bound) << bound.error().message;
  EXPECT_EQ(bound->joints[0].position, Vec3(0, 8, 0));
  EXPECT_EQ(bound->joints[1].position, Vec3(7, 0, 0));
  EXPECT_TRUE(
      read_skeleton(folder.add("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))->joints.empty());
}

// Two morph targets, one in whole numbers, one sparse over nothing.
struct Morph {
  GltfBuilder file;
  std::string mesh_weights;
  std::string node_weights;

  Morph() {
    file.floats("VEC3", triangle);
    file.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const std::size_t at = file.view(test::binary(std::uint8_t{2}));
    const std::size_t to = file.view(test::binary(0.F, 4.F, 0.F));
    file.accessor(R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,)"
                  R"("indices":{"bufferView":)" +
                  std::to_string(at) + R"(,"componentType":5121},"values":{"bufferView":)" +
                  std::to_string(to) + "}}}");
  }

  [[nodiscard]] std::string glb() const {
    GltfBuilder whole = file;
    whole.nodes = R"([{"mesh":0)" + node_weights + "}]";
    whole.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},)"
                   R"({"POSITION":2}]}])" +
                   mesh_weights + "}]";
    return whole.glb();
  }
};

TEST(GltfPose, AppliesTheDefaultWeightsOfMorphTargets) {
  Morph morph;
  expect_points(read(morph.glb()).positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  morph.mesh_weights = R"(,"weights":[0.5,1])";
  expect_points(read(morph.glb()).positions, {{0, 0, 0.5}, {1, 0, 0.5}, {0, 5, 0.5}});
  morph.node_weights = R"(,"weights":[-1,0])";
  expect_points(read(morph.glb()).positions, {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}});
  expect_points(read(morph.glb(), Pose::bind).positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfPose, RefusesMorphTargetsThatDoNotFit) {
  Morph morph;
  morph.mesh_weights = R"(,"weights":[1,"1"])";
  EXPECT_EQ(test::message_of(morph.glb(), MeshFormat::gltf),
            "file: node 0 has weights that are no list of numbers; export the model again");
  GltfBuilder file;
  file.floats("VEC3", triangle);
  file.floats("VEC3", {0, 0, 1});
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}],)"
                R"("weights":[1]}])";
  EXPECT_EQ(test::message_of(file.glb(), MeshFormat::gltf),
            "file: accessor 1 of a morph target should have 3 elements, one for each vertex; "
            "export the model again");
}

// Deforms a file and reads what was written.
class Rewritten {
public:
  Rewritten(const std::string& name, const std::string& bytes, Pose pose,
            const std::function<Vec3(std::size_t, const Vec3&)>& move) {
    const auto original = folder_.add(name, bytes);
    const Result<PolygonMesh> rest = read_mesh(original, pose);
    EXPECT_TRUE(rest) << rest.error().message;
    for (std::size_t v = 0; v < rest->positions.size(); ++v) {
      to.push_back(move(v, rest->positions[v]));
    }
    const Result<FileNormals> stored = read_normals(original, pose);
    EXPECT_TRUE(stored) << stored.error().message;
    normals = stored->normals;
    for (Vec3& normal : normals) {
      normal = Vec3(normal + Vec3(0.5, 0.25, 0)).normalized();
    }
    const auto out = folder_ / ("out" + original.extension().string());
    const Status status = rewrite_positions(original, to, normals, out, pose);
    message = status ? "" : status.error().message;
    if (status) {
      bytes_after = test::bytes_of(out);
      const Result<PolygonMesh> mesh = read_mesh(out, pose);
      const Result<FileNormals> again = read_normals(out, pose);
      EXPECT_TRUE(mesh && again) << mesh.error().message;
      expect_points(mesh->positions, to);
      expect_points(again->normals, normals);
      EXPECT_EQ(test::faces_of(*mesh), test::faces_of(*rest));
    }
  }

  Points to;
  Points normals;
  std::string message;
  std::string bytes_after;

  [[nodiscard]] bool has(std::string_view text) const {
    return bytes_after.find(text) != bytes_after.npos;
  }

private:
  test::TemporaryFolder folder_;
};

Vec3 bend(std::size_t v, const Vec3& p) {
  const auto step = static_cast<double>(v % 7);
  return p + Vec3(0.25 * p.y() + 0.125 * step, -0.5, 0.125 * p.x() - 0.0625 * step * step);
}

TEST(GltfRewritten, StandsWhereItShouldInThePoseOfItsJoints) {
  Rig rig;
  rig.attributes +=
      R"(,"NORMAL":)" + std::to_string(rig.file.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0.6F, 0.8F}));
  for (const Pose pose : {Pose::shown, Pose::bind}) {
    const Rewritten out("a.glb", rig.glb(), pose, bend);
    EXPECT_EQ(out.message, "");
    EXPECT_TRUE(out.has(R"("skin":0)"));
  }
}

TEST(GltfRewritten, RefusesWhatJointsFlattenAndTheRemedyWorks) {
  Rig rig; // halfway between two joints that are turned half against each other
  rig.file.nodes = R"([{"mesh":0,"skin":0},{"children":[2,3]},{},{"rotation":[0,0,1,0]}])";
  const Rewritten out("a.glb", rig.glb(), Pose::shown, bend);
  EXPECT_NE(out.message.find("node 0: 1 vertex (the first is 2) cannot be moved there, because the "
                             "joints flatten the mesh; deform the bind pose, or "
                             "write OBJ"),
            std::string::npos)
      << out.message;
  EXPECT_EQ(Rewritten("a.glb", rig.glb(), Pose::bind, bend).message, "");
  const auto along = [](std::size_t v, const Vec3& p) { // what is flat can still slide
    return v == 2 ? Vec3(p + Vec3(0, 0, 2)) : p;
  };
  EXPECT_EQ(Rewritten("a.glb", rig.glb(), Pose::shown, along).message, "");
}

TEST(GltfRewritten, KeepsMorphTargetsAndWhatTheyAdd) {
  Morph morph;
  morph.mesh_weights = R"(,"weights":[0.5,1])";
  EXPECT_EQ(Rewritten("a.glb", morph.glb(), Pose::shown, bend).message, "");

  GltfBuilder file; // with normals that the target turns
  file.floats("VEC3", triangle);
  file.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  file.floats("VEC3", {0.5F, 0, 0, 0, 0.5F, 0, 0, 0, 0});
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},)"
                R"("targets":[{"POSITION":1,"NORMAL":2}]}],"weights":[0.5]}])";
  EXPECT_EQ(Rewritten("a.glb", file.glb(), Pose::shown, bend).message, "");
}

// A quad in signed shorts with normals in signed bytes, as KHR_mesh_quantization allows.
GltfBuilder quantized() {
  GltfBuilder file;
  file.integers("VEC3", 5122,
                std::vector<std::int16_t>{-32767, -32767, 0, 32767, -32767, 0, 32767, 32767, 0,
                                          -32767, 32767, 0},
                R"(,"normalized":true,"min":[-32767,-32767,0],"max":[32767,32767,0])");
  file.integers("VEC3", 5120, std::vector<std::int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127},
                R"(,"normalized":true)");
  file.integers("SCALAR", 5123, std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}])";
  file.nodes = R"([{"mesh":0,"scale":[2,2,2]}])";
  file.more = R"(,"extensionsUsed":["KHR_mesh_quantization"],)"
              R"("extensionsRequired":["KHR_mesh_quantization"])";
  return file;
}

TEST(GltfRewritten, QuantizedPositionsBecomeFloatsInAViewOfTheirOwn) {
  const std::string before = quantized().glb();
  const Rewritten out("a.glb", before, Pose::shown, bend);
  EXPECT_EQ(out.message, "");
  EXPECT_TRUE(out.has(quantized().bytes())); // all of the old stays, the new comes after it
  EXPECT_FALSE(out.has("5122"));
  EXPECT_FALSE(out.has("[-32767,-32767,0]"));
  const Rewritten same("a.glb", before, Pose::shown,
                       [](std::size_t, const Vec3& p) { return p; }); // only normals turn
  EXPECT_TRUE(same.has("5122"));
}

TEST(GltfRewritten, SparsePositionsBecomeFloatsInAViewOfTheirOwn) {
  for (const std::string base : {"", R"("bufferView":0,)"}) {
    GltfBuilder file;
    file.view(test::binary(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F));
    const std::size_t at = file.view(test::binary(std::uint16_t{1}, std::uint16_t{2}));
    const std::size_t to = file.view(test::binary(3.F, 0.F, 0.F, 0.F, 3.F, 1.F));
    file.accessor("{" + base + R"("componentType":5126,"count":3,"type":"VEC3",)" +
                  R"("name":"kept","sparse":{"count":2,"indices":{"bufferView":)" +
                  std::to_string(at) + R"(,"componentType":5123},"values":{"bufferView":)" +
                  std::to_string(to) + "}}}");
    file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0}}]}])";
    const Rewritten out("a.glb", file.glb(), Pose::shown, bend);
    EXPECT_EQ(out.message, "");
    EXPECT_FALSE(out.has("sparse"));
    EXPECT_TRUE(out.has("kept"));
  }
}

TEST(GltfRewritten, NewViewsGoWhereThereIsRoom) {
  const std::string data = quantized().bytes();
  const auto uri = R"("uri":"data:application/gltf-buffer,)" + [&] {
    std::string text;
    for (const char c : data) {
      constexpr const char* digits = "0123456789abcdef";
      text += '%';
      text += digits[(static_cast<unsigned char>(c) >> 4U)];
      text += digits[(static_cast<unsigned char>(c) & 15U)];
    }
    return text;
  }() + "\",";
  EXPECT_EQ(Rewritten("a.gltf", quantized().json(uri), Pose::shown, bend).message, "");
  // In a GLB file without a binary chunk.
  EXPECT_EQ(
      Rewritten("a.glb", test::make_glb(quantized().json(uri), ""), Pose::shown, bend).message, "");

  const test::TemporaryFolder folder; // beside the file
  folder.add("data.bin", data);
  const auto original = folder.add("a.gltf", quantized().json(R"("uri":"data.bin",)"));
  const Result<PolygonMesh> rest = read_mesh(original);
  ASSERT_TRUE(rest) << rest.error().message;
  Points to = rest->positions;
  to[0].z() += 1;
  const Status status = rewrite_positions(original, to, {}, folder / "out.gltf");
  ASSERT_TRUE(status) << status.error().message;
  expect_points(read_mesh(folder / "out.gltf")->positions, to);
  EXPECT_EQ(folder.names(),
            (std::vector<std::string>{"a.gltf", "data.bin", "out.bin", "out.gltf"}));
}

// Two nodes show one mesh: one of them mirrored.
GltfBuilder instanced() {
  GltfBuilder file;
  file.floats("VEC3", triangle);
  file.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  file.meshes = R"([{"name":"leaf","primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}])";
  file.nodes =
      R"([{"mesh":0,"name":"a"},{"mesh":0,"name":"b","scale":[-1,1,2],"translation":[5,0,0]}])";
  file.scenes = R"([{"nodes":[0,1]}])";
  return file;
}

TEST(GltfRewritten, InstancesThatBendApartGetMeshesOfTheirOwn) {
  const Rewritten out("a.glb", instanced().glb(), Pose::shown, bend);
  EXPECT_EQ(out.message, "");
  EXPECT_TRUE(out.has(R"("mesh":1)"));
}

TEST(GltfRewritten, AnInstanceThatStaysKeepsItsMesh) {
  const auto only_second = [](std::size_t v, const Vec3& p) { return v < 3 ? p : bend(v, p); };
  const test::TemporaryFolder folder;
  const auto original = folder.add("a.glb", instanced().glb());
  Points to = read_mesh(original)->positions;
  for (std::size_t v = 0; v < to.size(); ++v) {
    to[v] = only_second(v, to[v]);
  }
  const Status status = rewrite_positions(original, to, {}, folder / "out.glb");
  ASSERT_TRUE(status) << status.error().message;
  const Result<PolygonMesh> mesh = read_mesh(folder / "out.glb");
  expect_points(mesh->positions, to);
  EXPECT_EQ(mesh->positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh->group_names, (std::vector<std::string>{"a", "b"}));
}

TEST(GltfRewritten, MeshesThatShareAnAccessorOrItsBytesMoveApart) {
  GltfBuilder file;
  file.floats("VEC3", triangle);
  file.accessor(R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})");
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0}}]},)"
                R"({"primitives":[{"attributes":{"POSITION":0}}]},)"
                R"({"primitives":[{"attributes":{"POSITION":1}}]}])";
  file.nodes = R"([{"mesh":0},{"mesh":1},{"mesh":2}])";
  for (const char* nodes : {"[0,1]", "[0,2]", "[2,1,0]"}) {
    file.scenes = R"([{"nodes":)" + std::string(nodes) + "}]";
    EXPECT_EQ(Rewritten("a.glb", file.glb(), Pose::shown, bend).message, "") << nodes;
  }
}

TEST(GltfRewritten, MeshesOfOtherScenesStay) {
  GltfBuilder file;
  file.floats("VEC3", triangle);
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0}}]},)"
                R"({"primitives":[{"attributes":{"POSITION":0}}]}])";
  file.nodes = R"([{"mesh":0},{"mesh":1}])";
  file.scenes = R"([{"nodes":[0]},{"nodes":[1]}])";
  const Rewritten out("a.glb", file.glb(), Pose::shown, bend);
  EXPECT_EQ(out.message, "");
  std::string other = out.bytes_after;
  other.replace(other.find(R"("scene":0)"), 9, R"("scene":1)");
  expect_points(read(other).positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfRewritten, LinesOverTheVerticesOfTrianglesGoAlong) {
  GltfBuilder file;
  file.integers("VEC3", 5122, std::vector<std::int16_t>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0}},)"
                R"({"mode":2,"attributes":{"POSITION":0}}]}])";
  const Rewritten out("a.glb", file.glb(), Pose::shown, bend);
  EXPECT_EQ(out.message, "");
  EXPECT_FALSE(out.has("5122")); // one accessor for both
}

TEST(GltfRewritten, LeavesOutACompressedCopyOfWhatHasChanged) {
  GltfBuilder file;
  file.floats("VEC3", triangle);
  file.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"extensions":)"
                R"({"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}},)"
                R"("KHR_other":{}}}]}])";
  const Rewritten out("a.glb", file.glb(), Pose::shown, bend);
  EXPECT_EQ(out.message, "");
  EXPECT_FALSE(out.has("draco"));
  EXPECT_TRUE(out.has("KHR_other"));
}

} // namespace
} // namespace cagewright
