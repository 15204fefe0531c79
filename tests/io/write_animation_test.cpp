#include <cagewright/io/point_cache.h>
#include <cagewright/io/write_animation.h>

#include "io/files.h"
#include "mesh/shapes.h"
#include <cagewright/io/read_mesh.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace cagewright {
namespace {

using test::TemporaryFolder;
using Json = nlohmann::json;

/// A ball far from the origin that is stretched, then squashed; faces of two materials, with
/// texture points.
MovingMesh stretched() {
  MovingMesh mesh;
  mesh.rest = PolygonMesh(make_icosphere(2));
  for (Vec3& p : mesh.rest.positions) {
    mesh.rest_normals.push_back(p);
    p += Vec3(1000, -200, 30);
  }
  for (const double factor : {1.0, 1.5, 0.25}) {
    std::vector<Vec3> shape = mesh.rest.positions;
    for (Vec3& p : shape) {
      p.x() = 1000 + factor * (p.x() - 1000);
    }
    mesh.shapes.push_back(shape);
    mesh.normals.push_back(mesh.rest_normals);
  }
  mesh.shares = {{1, 0, 0}, {0.5, 0.5, 0}, {-0.1, 0.9, 0.2}, {0, 0, 1}};
  mesh.first_frame = 7;
  mesh.frames_per_second = 25;
  for (std::size_t c = 0; c < mesh.rest.corners().size(); ++c) {
    mesh.attributes.texture_of_corner.push_back(static_cast<Index>(c % 5));
  }
  mesh.attributes.texture_points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.25}};
  mesh.attributes.material_names = {"skin", "eyes"};
  for (std::size_t f = 0; f < mesh.rest.face_count(); ++f) {
    mesh.attributes.face_materials.push_back(f % 3 == 0 ? 1 : 0);
  }
  return mesh;
}

template <class T> T number_at(const std::string& bytes, std::size_t at, std::endian order) {
  std::string raw = bytes.substr(at, sizeof(T));
  if (order != std::endian::native) {
    std::ranges::reverse(raw);
  }
  T value;
  std::memcpy(&value, raw.data(), sizeof(T));
  return value;
}

void expect_frames(const MovingMesh& mesh, const std::string& bytes, std::size_t begin,
                   std::endian order) {
  const std::size_t count = mesh.rest.positions.size();
  ASSERT_EQ(bytes.size(), begin + mesh.shares.size() * count * 12);
  for (std::size_t f = 0; f < mesh.shares.size(); ++f) {
    const std::vector<Vec3> expected = mesh.at(f);
    for (std::size_t v = 0; v < count; ++v) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = begin + ((f * count + v) * 3 + k) * 4;
        ASSERT_EQ(number_at<float>(bytes, at, order),
                  static_cast<float>(expected[v][static_cast<Eigen::Index>(k)]));
      }
    }
  }
}

TEST(WriteAnimation, WritesPointCaches) {
  const TemporaryFolder folder;
  const MovingMesh mesh = stretched();
  const auto points = static_cast<std::int32_t>(mesh.rest.positions.size());

  ASSERT_TRUE(write_animation(mesh, folder / "ball.pc2"));
  const std::string pc2 = test::bytes_of(folder / "ball.pc2");
  constexpr std::endian little = std::endian::little;
  EXPECT_EQ(pc2.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(number_at<std::int32_t>(pc2, 12, little), 1);
  EXPECT_EQ(number_at<std::int32_t>(pc2, 16, little), points);
  EXPECT_EQ(number_at<float>(pc2, 20, little), 7);
  EXPECT_EQ(number_at<float>(pc2, 24, little), 1);
  EXPECT_EQ(number_at<std::int32_t>(pc2, 28, little), 4);
  expect_frames(mesh, pc2, 32, little);

  ASSERT_TRUE(write_animation(mesh, folder / "BALL.MDD"));
  const std::string mdd = test::bytes_of(folder / "BALL.MDD");
  constexpr std::endian big = std::endian::big;
  EXPECT_EQ(number_at<std::int32_t>(mdd, 0, big), 4);
  EXPECT_EQ(number_at<std::int32_t>(mdd, 4, big), points);
  EXPECT_FLOAT_EQ(number_at<float>(mdd, 8, big), 7.0F / 25);
  EXPECT_FLOAT_EQ(number_at<float>(mdd, 20, big), 10.0F / 25);
  expect_frames(mesh, mdd, 24, big);
}

TEST(PointCacheWriter, HoldsToWhatItWasTold) {
  const TemporaryFolder folder;
  const std::vector<Vec3> frame = {Vec3(0, 0, 0), Vec3(1, 2, 3)};
  const auto message = [](const auto& status) {
    return status ? std::string("no error") : status.error().message;
  };
  EXPECT_FALSE(PointCacheWriter::create(folder / "a.abc", 2, 1));
  EXPECT_FALSE(PointCacheWriter::create(folder / "a.pc2", 2, 0));
  EXPECT_FALSE(PointCacheWriter::create(folder / "a.pc2", 2, 1, {1, 0}));
  {
    auto cache = PointCacheWriter::create(folder / "a.pc2", 2, 2);
    ASSERT_TRUE(cache) << message(cache);
    EXPECT_FALSE(cache->append({frame.data(), 1})) << "one position of two";
    EXPECT_TRUE(cache->append(frame));
    EXPECT_NE(message(cache->commit()).find("1 frames of 2"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing half done appears";
  auto cache = PointCacheWriter::create(folder / "a.mdd", 2, 1);
  ASSERT_TRUE(cache) << message(cache);
  EXPECT_TRUE(cache->append(frame));
  EXPECT_FALSE(cache->append(frame)) << "one more than was told";
  EXPECT_TRUE(cache->commit());
  EXPECT_EQ(test::bytes_of(folder / "a.mdd").size(), 8U + 4 + 24);
}

/// What a GLB file holds.
class Glb {
public:
  explicit Glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 8, std::endian::little), bytes.size());
    const auto length = number_at<std::uint32_t>(bytes, 12, std::endian::little);
    json = Json::parse(bytes.substr(20, length));
    binary_ = bytes.substr(20 + length + 8);
  }
  [[nodiscard]] std::vector<float> floats(const Json& accessor) const {
    const Json& a = json["accessors"][accessor.get<std::size_t>()];
    const std::size_t width = a["type"] == "VEC3" ? 3 : a["type"] == "VEC2" ? 2 : 1;
    std::vector<float> values(width * a["count"].get<std::size_t>());
    std::memcpy(values.data(), binary_.data() + offset(a), values.size() * 4);
    return values;
  }
  [[nodiscard]] std::vector<std::uint32_t> indices(const Json& accessor) const {
    const Json& a = json["accessors"][accessor.get<std::size_t>()];
    std::vector<std::uint32_t> values(a["count"].get<std::size_t>());
    std::memcpy(values.data(), binary_.data() + offset(a), values.size() * 4);
    return values;
  }
  Json json;

private:
  [[nodiscard]] std::size_t offset(const Json& a) const {
    return json["bufferViews"][a["bufferView"].get<std::size_t>()]["byteOffset"];
  }
  std::string binary_;
};

TEST(WriteAnimation, WritesMorphTargetsThatMeetEveryFrame) {
  const TemporaryFolder folder;
  const MovingMesh mesh = stretched();
  ASSERT_TRUE(write_animation(mesh, folder / "ball.glb"));
  const Glb glb(test::bytes_of(folder / "ball.glb"));
  const Json& primitives = glb.json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U) << "one for each material";
  const Json& materials = glb.json["materials"];
  EXPECT_EQ(materials[primitives[0]["material"].get<std::size_t>()]["name"], "eyes");
  const Json& sampler = glb.json["animations"][0]["samplers"][0];
  const std::vector<float> times = glb.floats(sampler["input"]);
  const std::vector<float> weights = glb.floats(sampler["output"]);
  ASSERT_EQ(times.size(), 4U);
  EXPECT_FLOAT_EQ(times[3], 3.0F / 25);
  ASSERT_EQ(weights.size(), 12U);
  const auto translation = glb.json["nodes"][0]["translation"].get<std::vector<double>>();
  const std::vector<float> rest = glb.floats(primitives[0]["attributes"]["POSITION"]);
  std::size_t triangles = 0;
  for (const Json& primitive : primitives) {
    triangles += glb.indices(primitive["indices"]).size() / 3;
    ASSERT_EQ(primitive["targets"].size(), 3U);
    EXPECT_EQ(glb.floats(primitive["attributes"]["TEXCOORD_0"]).size() / 2, rest.size() / 3);
  }
  EXPECT_EQ(triangles, mesh.rest.face_count());
  // Each vertex of the file is, at each frame, where one of the mesh is: found by where it rests.
  for (std::size_t f = 0; f < 4; ++f) {
    const std::vector<Vec3> expected = mesh.at(f);
    std::vector<Vec3> shown;
    for (std::size_t v = 0; v < rest.size() / 3; ++v) {
      Vec3 p(translation[0] + rest[3 * v], translation[1] + rest[3 * v + 1],
             translation[2] + rest[3 * v + 2]);
      const auto nearest = std::ranges::min_element(mesh.rest.positions, {},
                                                    [&](const Vec3& q) { return (q - p).norm(); });
      const auto of_mesh = static_cast<std::size_t>(nearest - mesh.rest.positions.begin());
      ASSERT_LT((*nearest - p).norm(), 1e-6) << "to float precision about the middle";
      for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<float> target = glb.floats(primitives[0]["targets"][k]["POSITION"]);
        p += static_cast<double>(weights[3 * f + k]) *
             Vec3(target[3 * v], target[3 * v + 1], target[3 * v + 2]);
      }
      ASSERT_LT((p - expected[of_mesh]).norm(), 1e-5) << "frame " << f;
    }
  }
  // And it is a model like others.
  const auto read = read_mesh(folder / "ball.glb");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->face_count(), mesh.rest.face_count());
}

TEST(WriteAnimation, RefusesWhatNoFileCanHold) {
  const TemporaryFolder folder;
  const MovingMesh mesh = stretched();
  const auto refusal = [&](const MovingMesh& m, const char* name) {
    const Status s = write_animation(m, folder / name);
    return s ? std::string() : s.error().message;
  };
  EXPECT_NE(refusal(mesh, "ball.fbx").find(".glb, .pc2 or .mdd"), std::string::npos);
  MovingMesh shorter = mesh;
  shorter.shapes[1].pop_back();
  EXPECT_NE(refusal(shorter, "a.pc2").find("shape 1 has 161 vertices"), std::string::npos)
      << refusal(shorter, "a.pc2");
  MovingMesh infinite = mesh;
  infinite.shapes[2][5].y() = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(infinite, "a.glb").find("not finite"), std::string::npos);
  infinite.shapes[2][5].y() = 1e39; // a float cannot hold it
  EXPECT_NE(refusal(infinite, "a.mdd").find("too large"), std::string::npos);
  MovingMesh still = mesh;
  still.shares.clear();
  EXPECT_NE(refusal(still, "a.mdd").find("no frame"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace cagewright
