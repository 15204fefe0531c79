#include <cagewright/deform/weights_file.h>

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/mean_value.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace cagewright {
namespace {

PolygonMesh make_cage() {
  PolygonMesh cage(make_cube());
  cage.positions.emplace_back(0, 0, 5);
  cage.add_face({4, 5, 7, 6}); // one quad among the triangles
  return cage;
}

std::vector<Vec3> make_points(std::size_t count) {
  Random random(1);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    p = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  return points;
}

class WeightsFile : public testing::Test {
protected:
  void SetUp() override {
    directory_ = std::filesystem::temp_directory_path() /
                 ("cagewright_weights_" + std::to_string(::getpid()) + "_" +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(directory_);
    path_ = directory_ / "weights.npz";
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  MeanValueSolver solver() const { return *MeanValueSolver::create(cage_, {.allow_open = true}); }
  void bind() {
    const Result<PointCounts> counts = bind_to_file(solver(), {}, points_, cage_, path_);
    ASSERT_TRUE(counts) << counts.error().message;
  }
  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void overwrite(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  /// The message with which the file is refused.
  std::string refusal() const {
    const Result<StoredWeights> stored = read_weights(path_);
    return stored ? "accepted" : stored.error().message;
  }

  std::filesystem::path directory_, path_;
  PolygonMesh cage_ = make_cage();
  std::vector<Vec3> points_ = make_points(5003); // more than one block of rows
};

TEST_F(WeightsFile, GivesBackWhatWasBound) {
  bind();
  const Result<StoredWeights> stored = read_weights(path_);
  ASSERT_TRUE(stored) << stored.error().message;
  const auto expected = solve_all<float>(solver(), points_);
  ASSERT_EQ(stored->weights.points(), points_.size());
  for (std::size_t t = 0; t < expected->weights.tile_count(); ++t) {
    ASSERT_TRUE(std::ranges::equal(stored->weights.tile(t), expected->weights.tile(t)));
  }
  EXPECT_EQ(stored->settings.kind().name, "mean_value");
  EXPECT_TRUE(belongs_to(*stored, points_, cage_));
}

TEST_F(WeightsFile, GivesBackWhatWasBoundAsText) {
  points_.resize(700);
  bind();
  const Result<StoredWeights> expected = read_weights(path_);
  for (const WeightsFormat format :
       {WeightsFormat::csv, WeightsFormat::json, WeightsFormat::dmat}) {
    ASSERT_TRUE(bind_to_file(solver(), {}, points_, cage_, path_, format));
    const Result<StoredWeights> stored = read_weights(path_); // by content, not by name
    ASSERT_TRUE(stored) << stored.error().message;
    ASSERT_EQ(stored->weights.points(), points_.size());
    for (std::size_t t = 0; t < expected->weights.tile_count(); ++t) {
      ASSERT_TRUE(std::ranges::equal(stored->weights.tile(t), expected->weights.tile(t)));
    }
    if (format == WeightsFormat::dmat) {
      continue; // names no cage, and weights of this one, with a face too many, give no points back
    }
    EXPECT_TRUE(belongs_to(*stored, points_, cage_));
    std::vector<Vec3> others = points_;
    others[30].x() += 0.5;
    EXPECT_FALSE(belongs_to(*stored, others, cage_));
    others.pop_back();
    EXPECT_FALSE(belongs_to(*stored, others, cage_));
  }
}

TEST_F(WeightsFile, RefusesTextThatIsCutOffOrDamaged) {
  points_.resize(40);
  for (const WeightsFormat format :
       {WeightsFormat::csv, WeightsFormat::json, WeightsFormat::dmat}) {
    ASSERT_TRUE(bind_to_file(solver(), {}, points_, cage_, path_, format));
    const std::string whole = bytes();
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
      overwrite(whole.substr(0, size));
      const Result<StoredWeights> stored = read_weights(path_);
      EXPECT_FALSE(stored && belongs_to(*stored, points_, cage_)) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 197) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x51);
      overwrite(damaged);
      (void)read_weights(path_); // must come back
    }
  }
}

TEST_F(WeightsFile, WritesGroupsOfVertices) {
  points_.resize(10);
  ASSERT_TRUE(bind_to_file(solver(), {}, points_, cage_, path_, WeightsFormat::vertex_groups));
  EXPECT_EQ(bytes().rfind("{\"format\": \"cagewright-vertex-groups\"", 0), 0U);
  EXPECT_NE(refusal().find("groups of vertices"), std::string::npos);
}

TEST_F(WeightsFile, HoldsTheSameBytesEachTime) {
  bind();
  const std::string first = bytes();
  bind();
  EXPECT_EQ(bytes(), first);
}

TEST_F(WeightsFile, IsAZipOfArraysAtMultiplesOf64) {
  bind();
  const std::string file = bytes();
  EXPECT_EQ(file.substr(0, 4), "PK\3\4");
  EXPECT_NE(file.find("weights.npy"), std::string::npos);
  EXPECT_NE(file.find("'descr': '<f4', 'fortran_order': False, 'shape': (5003, 9), }"),
            std::string::npos);
}

TEST_F(WeightsFile, IsRefusedWhenItIsCutOffAnywhere) {
  bind();
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    overwrite(whole.substr(0, size));
    EXPECT_NE(refusal(), "accepted") << size;
  }
}

TEST_F(WeightsFile, IsRefusedWhenABitOfItsDataHasChanged) {
  points_.resize(500);
  bind();
  const std::string whole = bytes();
  const std::size_t directory = whole.find("PK\1\2");
  // Everything up to the zip directory matters but the local headers, which repeat it.
  for (std::size_t at = 200; at < directory; at += 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    overwrite(damaged);
    if (refusal() == "accepted") {
      const std::size_t header = whole.rfind("PK\3\4", at);
      EXPECT_LT(at, header + 50) << at;
    }
  }
  std::string damaged = whole;
  damaged[directory - 10] = static_cast<char>(damaged[directory - 10] ^ 1);
  overwrite(damaged);
  EXPECT_NE(refusal().find("'weights' is damaged: its checksum differs"), std::string::npos)
      << refusal();
}

TEST_F(WeightsFile, NeverCrashesOnDamage) {
  points_.resize(40);
  bind();
  const std::string whole = bytes();
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = whole;
    const std::size_t from = i % 2 == 0 ? whole.size() - 700 : 0; // the directory, or anywhere
    for (int k = 0; k < 3; ++k) {
      damaged[from + random.below(i % 2 == 0 ? 700 : whole.size())] =
          static_cast<char>(random.next());
    }
    overwrite(damaged);
    (void)refusal();
  }
}

TEST_F(WeightsFile, IsRefusedInOneLineWhateverItHolds) {
  bind();
  std::string damaged = bytes();
  damaged[damaged.find("'<i8'") + 2] = '\n'; // the type of an array
  overwrite(damaged);
  EXPECT_EQ(refusal(), path_.string() + ": array 'version' is not as expected (one value of type "
                                        "<?8); bind the model again");
}

TEST_F(WeightsFile, SaysWhatItIsNot) {
  overwrite("this is text");
  EXPECT_EQ(refusal(), path_.string() + ": not a .npz file, or cut off: it does not end with a zip "
                                        "directory; bind the model again");
  overwrite(std::string("PK\5\6", 4) + std::string(18, '\0')); // an empty archive
  EXPECT_EQ(refusal(), path_.string() + ": not a weights file of cagewright bind: it has no array "
                                        "'version'; bind the model again");
  overwrite("PK\5\6 and no more");
  EXPECT_NE(refusal(), "accepted");
  overwrite("PK\5\6");
  EXPECT_NE(refusal(), "accepted");
  std::filesystem::remove(path_);
  EXPECT_EQ(refusal(), path_.string() + ": there is no such file; check the name and the folder");
  std::filesystem::create_directory(path_);
  EXPECT_EQ(refusal(),
            path_.string() + ": not a regular file; give the file that bind has written");
}

TEST_F(WeightsFile, LeavesNothingBehindWhenCancelled) {
  StopFlag stop;
  stop.request_stop();
  const Result<PointCounts> counts =
      bind_to_file(solver(), {}, points_, cage_, path_, Progress(stop));
  ASSERT_FALSE(counts);
  EXPECT_EQ(counts.error().code, ErrorCode::cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
}

TEST_F(WeightsFile, CannotBeWrittenWhereThereIsNoDirectory) {
  const Result<PointCounts> counts =
      bind_to_file(solver(), {}, points_, cage_, directory_ / "no" / "w.npz");
  ASSERT_FALSE(counts);
  EXPECT_EQ(counts.error().code, ErrorCode::cannot_write);
}

TEST_F(WeightsFile, BelongsToOneModelAndOneCage) {
  bind();
  const StoredWeights stored = *read_weights(path_);
  const auto refused = [&](const std::vector<Vec3>& points, const PolygonMesh& cage) {
    const Status status = belongs_to(stored, points, cage);
    return status ? "accepted" : status.error().message;
  };
  EXPECT_EQ(refused(make_points(5000), cage_),
            "the weights are for a model of 5003 vertices, but this one has 5000: bind it again");
  std::vector<Vec3> moved = points_;
  moved[4711].x() += 1e-15;
  EXPECT_EQ(refused(moved, cage_), "the weights are for another shape of the model, or its "
                                   "vertices in another order: bind it again");
  std::vector<Vec3> swapped = points_;
  std::swap(swapped[1], swapped[2]);
  EXPECT_NE(refused(swapped, cage_), "accepted");
  PolygonMesh bent = cage_;
  bent.positions[3].z() = 7;
  EXPECT_EQ(refused(points_, bent), "the weights are for another cage: its vertex 3 was "
                                    "elsewhere; bind the model again");
  PolygonMesh larger = cage_;
  larger.add_face({0, 1, 2});
  EXPECT_EQ(refused(points_, larger),
            "the weights are for another cage: the cage has 14 faces, the cage at rest 13");
}

TEST(SameTopology, SaysHowCagesDiffer) {
  const PolygonMesh rest(make_cube());
  const auto refused = [&](const PolygonMesh& other) {
    const Status status = same_topology(rest, other, "pose.obj");
    return status ? "accepted" : status.error().message;
  };
  EXPECT_EQ(refused(rest), "accepted");
  PolygonMesh other = rest;
  other.positions.emplace_back(0, 0, 0);
  EXPECT_EQ(refused(other), "pose.obj has 9 vertices, the cage at rest 8");
  TriangleMesh turned = make_cube();
  std::swap(turned.triangles[2][0], turned.triangles[2][1]);
  EXPECT_EQ(refused(PolygonMesh(turned)).substr(0, 36), "face 2 of pose.obj has the vertices ");
}

} // namespace
} // namespace cagewright
