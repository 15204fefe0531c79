#include "io/files.h"
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/rewrite_positions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using test::binary;
using test::bytes_of;
using test::TemporaryFolder;

// A triangle with its normals, one vertex after the other (24 bytes each); indices; four bytes that
// belong to nothing. The node turns a quarter about z, doubles and moves.
struct Parts {
  std::string nodes = R"([{"mesh":0,"translation":[10,0,0],"scale":[2,2,2],)"
                      R"("rotation":[0,0,0.70710678118654752,0.70710678118654752]}])";
  std::string scene = "[0]";
  std::string position = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
                         R"( "min" : [0, 0.0, 0],"max":[1,1,0]})";
  std::string uri = "";
  std::string bytes = binary(0.F, 0.F, 0.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 1.F,
                             0.F, 0.F, 0.F, 1.F) +
                      binary(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}) + "kept!!";

  [[nodiscard]] std::string json() const {
    return R"({"asset" : {"version":"2.0","copyright":"\"[]}{ é"}, "scenes":[{"nodes":)" + scene +
           R"(}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],)"
           R"("accessors":[)" +
           position +
           R"(,{"bufferView":0,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":72,"byteStride":24},)"
           R"({"buffer":0,"byteOffset":72,"byteLength":6}],)"
           R"("buffers":[{)" +
           uri + R"("byteLength":84}],"extras":{"n":1e-7}})";
  }

  [[nodiscard]] std::string glb() const { return test::make_glb(json(), bytes); }
};

std::string in_base64() { // Parts::bytes
  return "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAgD8AAAAA"
         "AAAAAAAAAAAAAIA/AAABAAIAa2VwdCEh";
}

PolygonMesh read_file(const std::filesystem::path& path) {
  Result<PolygonMesh> mesh = read_mesh(path);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

std::vector<Vec3> bent(std::vector<Vec3> positions) {
  for (Vec3& p : positions) {
    p += Vec3(0.25 * p.y(), -0.5, 0.125 * p.x());
  }
  return positions;
}

void expect_positions(const std::filesystem::path& path, const std::vector<Vec3>& positions) {
  const PolygonMesh mesh = read_file(path);
  ASSERT_EQ(mesh.positions.size(), positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    EXPECT_LT((mesh.positions[v] - positions[v]).norm(), 1e-5) << v;
  }
}

TEST(RewriteGltf, LeavesEveryByteOfAModelAtRest) {
  const TemporaryFolder folder;
  const auto original = folder.add("a.glb", Parts().glb());
  const Result<FileNormals> normals = read_normals(original);
  ASSERT_TRUE(normals) << normals.error().message;
  const Status status = rewrite_positions(original, read_file(original).positions, normals->normals,
                                          folder / "out.glb");
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(bytes_of(folder / "out.glb"), Parts().glb());
}

TEST(RewriteGltf, ChangesPositionsAndBoundsAndNoOtherByte) {
  const TemporaryFolder folder;
  const auto original = folder.add("a.glb", Parts().glb());
  const std::vector<Vec3> to = bent(read_file(original).positions);
  const Status status = rewrite_positions(original, to, {}, folder / "out.glb");
  ASSERT_TRUE(status) << status.error().message;
  expect_positions(folder / "out.glb", to);

  const std::string out = bytes_of(folder / "out.glb");
  const std::string before = Parts().bytes;
  const std::string after = out.substr(out.size() - before.size());
  std::vector<float> stored(18);
  std::memcpy(stored.data(), after.data(), 72);
  std::string least;
  std::string greatest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto bounds = std::minmax({stored[axis], stored[6 + axis], stored[12 + axis]});
    const auto text = [](float x) {
      char digits[32];
      return std::string(digits, std::to_chars(digits, digits + 32, x).ptr);
    };
    least += (axis > 0 ? "," : "") + text(bounds.first);
    greatest += (axis > 0 ? "," : "") + text(bounds.second);
    for (std::size_t v = 0; v < 3; ++v) { // put back, all is as it was
      std::memcpy(&stored[6 * v + axis], before.data() + 24 * v + 4 * axis, 4);
    }
  }
  std::string restored = after;
  std::memcpy(restored.data(), stored.data(), 72);
  EXPECT_EQ(restored, before);
  Parts expected;
  expected.bytes = after;
  expected.position.replace(expected.position.find("[0, 0.0, 0]"), 11, "[" + least + "]");
  expected.position.replace(expected.position.find("[1,1,0]"), 7, "[" + greatest + "]");
  EXPECT_EQ(out, expected.glb());
}

TEST(RewriteGltf, GivesAndTakesNormalsAsTheSceneShowsThem) {
  Parts parts;
  parts.nodes = R"([{"mesh":0,"scale":[1,4,-1]}])"; // mirrored, and stretched along y
  const TemporaryFolder folder;
  const auto original = folder.add("a.glb", parts.glb());
  const Result<FileNormals> normals = read_normals(original);
  ASSERT_TRUE(normals) << normals.error().message;
  ASSERT_EQ(normals->normals.size(), 3U);
  EXPECT_TRUE(normals->normals[0].isApprox(Vec3(0, 0, -1)));
  EXPECT_EQ(normals->of_corner, (std::vector<Index>{0, 2, 1})); // of a triangle turned back
  const std::vector<Vec3> turned = {Vec3(1, 2, -2) / 3, Vec3(0, 1, 0), normals->normals[2]};
  const Status status =
      rewrite_positions(original, read_file(original).positions, turned, folder / "out.glb");
  ASSERT_TRUE(status) << status.error().message;
  const Result<FileNormals> again = read_normals(folder / "out.glb");
  ASSERT_TRUE(again) << again.error().message;
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_LT((again->normals[n] - turned[n]).norm(), 1e-6) << n;
  }
}

TEST(RewriteGltf, ChangesBuffersInsideTheJson) {
  Parts parts;
  parts.uri = R"("uri":"data:application\/octet-stream;base64,)" + in_base64() + R"(",)";
  const TemporaryFolder folder;
  const auto original = folder.add("a.gltf", parts.json());
  const std::vector<Vec3> to = bent(read_file(original).positions);
  const Status status = rewrite_positions(original, to, {}, folder / "out.gltf");
  ASSERT_TRUE(status) << status.error().message;
  expect_positions(folder / "out.gltf", to);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.gltf", "out.gltf"}));
  EXPECT_NE(bytes_of(folder / "out.gltf").find("a2VwdCEh\""), std::string::npos); // kept!!
}

TEST(RewriteGltf, WritesBuffersOfTheirOwnUnderANewName) {
  Parts parts;
  parts.uri = R"("uri":"the%20data.bin",)";
  const TemporaryFolder folder;
  folder.add("the data.bin", parts.bytes);
  const auto original = folder.add("a.gltf", parts.json());
  const std::vector<Vec3> to = bent(read_file(original).positions);
  for (const char* name : {"the data.gltf", "out.gltf", "a.gltf"}) { // the last: over the original
    const Status status = rewrite_positions(original, to, {}, folder / name);
    ASSERT_TRUE(status) << status.error().message;
    expect_positions(folder / name, to);
    EXPECT_EQ(bytes_of(folder / "the data.bin"), parts.bytes);
  }
  EXPECT_EQ(folder.names(),
            (std::vector<std::string>{"a.bin", "a.gltf", "out.bin", "out.gltf", "the data-1.bin",
                                      "the data.bin", "the data.gltf"}));
}

TEST(RewriteGltf, TakesBuffersAlongToAnotherFolder) {
  Parts parts;
  parts.uri = R"("uri":"data.bin",)";
  const TemporaryFolder folder;
  const TemporaryFolder other;
  folder.add("data.bin", parts.bytes);
  const auto original = folder.add("a.gltf", parts.json());
  const std::vector<Vec3> rest = read_file(original).positions;
  const Status status = rewrite_positions(original, rest, {}, other / "b.gltf");
  ASSERT_TRUE(status) << status.error().message;
  expect_positions(other / "b.gltf", rest);
}

TEST(RewriteGltf, NodesThatGoOnAgreeingKeepTheirMesh) {
  Parts parts;
  parts.nodes = R"([{"mesh":0},{"mesh":0,"translation":[5,0,0]}])";
  parts.scene = "[0,1]";
  const TemporaryFolder folder;
  const auto original = folder.add("a.glb", parts.glb());
  std::vector<Vec3> to = read_file(original).positions;
  ASSERT_EQ(to.size(), 6U);
  for (Vec3& p : to) {
    p += Vec3(0, 2, 1);
  }
  const Status status = rewrite_positions(original, to, {}, folder / "out.glb");
  ASSERT_TRUE(status) << status.error().message;
  expect_positions(folder / "out.glb", to);

  EXPECT_EQ(bytes_of(folder / "out.glb").find(R"("mesh":1)"), std::string::npos);
}

TEST(RewriteGltf, RefusesWhatCannotBeChangedInPlace) {
  const auto message = [](const Parts& parts, std::string_view out) {
    const TemporaryFolder folder;
    const auto original = folder.add("a.glb", parts.glb());
    const Status status =
        rewrite_positions(original, bent(read_file(original).positions), {}, folder / out);
    EXPECT_FALSE(status);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.glb"}));
    return status ? "" : status.error().message;
  };
  Parts flat;
  flat.nodes = R"([{"mesh":0,"scale":[1,1,0]}])";
  EXPECT_NE(message(flat, "out.glb").find("node 0 flattens"), std::string::npos);
}

TEST(RewriteGltf, RefusesOtherCountsAndNumbersThatAreNone) {
  const TemporaryFolder folder;
  const auto original = folder.add("a.glb", Parts().glb());
  std::vector<Vec3> to = read_file(original).positions;
  to[1].x() = std::numeric_limits<double>::quiet_NaN();
  Status status = rewrite_positions(original, to, {}, folder / "out.glb");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::cannot_write);
  to.pop_back();
  to[1].x() = 0;
  status = rewrite_positions(original, to, {}, folder / "out.glb");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::mismatch);
}

TEST(RewriteGltf, RefusesAFileThatIsCutShortAnywhere) {
  const TemporaryFolder folder;
  const std::string whole = Parts().glb();
  const std::vector<Vec3> to(3, Vec3(1, 2, 3));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto original = folder.add("a.glb", whole.substr(0, size));
    EXPECT_FALSE(rewrite_positions(original, to, {}, folder / "out.glb")) << size;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
  }
}

} // namespace
} // namespace cagewright
