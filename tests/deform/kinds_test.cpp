// What must hold of a bound model whatever the kind of coordinates, for all there are.

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/deformer.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {

void PrintTo(const CoordinateKind* kind, std::ostream* out) {
  *out << kind->name;
}

namespace {

class KindOfCoordinates : public testing::TestWithParam<const CoordinateKind*> {
protected:
  KindOfCoordinates() {
    PolygonMesh quads = make_quad_cube();
    for (Vec3& p : quads.positions) {
      p = Vec3(1.2 * p.x(), p.y() + 0.1 * p.x(), 1.4 * p.z());
    }
    cage_ = quads;
    model_ = PolygonMesh(make_torus(0.25, 16, 8));
    for (Vec3& p : model_.positions) {
      p *= 0.6;
    }
  }

  [[nodiscard]] CoordinateSettings settings() const { return CoordinateSettings(*GetParam()); }
  [[nodiscard]] Deformer bound(WeightStorage storage) const {
    Result<Deformer> deformer =
        Deformer::bind(model_, cage_, {.coordinates = settings(), .storage = storage});
    EXPECT_TRUE(deformer) << deformer.error().message;
    return *std::move(deformer);
  }
  [[nodiscard]] std::vector<Vec3> pose(std::uint64_t seed) const {
    Random random(seed);
    std::vector<Vec3> moved = cage_.positions;
    for (Vec3& p : moved) {
      p += 0.2 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    return moved;
  }
  [[nodiscard]] static double distance(std::span<const Vec3> a, std::span<const Vec3> b) {
    double greatest = a.size() == b.size() ? 0 : 1e300;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      greatest = std::max(greatest, (a[i] - b[i]).norm());
    }
    return greatest;
  }

  PolygonMesh cage_, model_;
};

TEST_P(KindOfCoordinates, MovesTheModelAlikeHoweverItIsStored) {
  const auto coordinates = prepare_coordinates(cage_, settings());
  ASSERT_TRUE(coordinates);
  const std::vector<Vec3> posed = pose(1);
  const auto exact = deform_streaming(**coordinates, std::span(&posed, 1), model_.positions);
  ASSERT_TRUE(exact) << exact.error().message;
  EXPECT_GT(distance(exact->positions[0], model_.positions), 0.01);
  for (const auto& [storage, tolerance] :
       {std::pair(WeightStorage::full, 1e-12), std::pair(WeightStorage::single, 2e-6),
        std::pair(WeightStorage::compact, 2e-3)}) {
    Deformer deformer = bound(storage);
    deformer.set_cage(posed);
    deformer.update();
    EXPECT_LT(distance(deformer.positions(), exact->positions[0]), tolerance);
    deformer.set_cage(cage_.positions);
    deformer.update();
    EXPECT_EQ(distance(deformer.positions(), model_.positions), 0);
  }
}

TEST_P(KindOfCoordinates, ReachesAPoseStepByStep) {
  Deformer steps = bound(WeightStorage::full);
  Deformer whole = bound(WeightStorage::full);
  const std::vector<Vec3> posed = pose(2);
  for (Index v = 0; v < posed.size(); ++v) {
    steps.move_cage_vertex(v, posed[v]);
    steps.update();
  }
  whole.set_cage(posed);
  whole.update();
  EXPECT_LT(distance(steps.positions(), whole.positions()), 1e-12);
}

TEST_P(KindOfCoordinates, ShowsInfluencesThatSumToOne) {
  std::vector<Index> all(cage_.positions.size());
  for (Index v = 0; v < all.size(); ++v) {
    all[v] = v;
  }
  for (const float sum : bound(WeightStorage::full).influence(all)) {
    ASSERT_NEAR(sum, 1, 1e-6);
  }
}

TEST_P(KindOfCoordinates, IsReadBackFromEachFormat) {
  const auto coordinates = prepare_coordinates(cage_, settings());
  ASSERT_TRUE(coordinates);
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("cagewright_kind_" + std::to_string(::getpid()) + "_" + std::string(GetParam()->name));
  const auto expected = solve_all<float>(**coordinates, model_.positions);
  ASSERT_TRUE(expected);
  for (const WeightsFormat format :
       {WeightsFormat::npz, WeightsFormat::csv, WeightsFormat::json, WeightsFormat::dmat}) {
    const auto written =
        bind_to_file(**coordinates, settings(), model_.positions, cage_, path, format);
    ASSERT_TRUE(written) << written.error().message;
    Result<StoredWeights> stored = read_weights(path);
    ASSERT_TRUE(stored) << stored.error().message;
    if (format == WeightsFormat::dmat) {
      stored->settings = settings(); // such a file does not say
    }
    EXPECT_EQ(stored->settings.text(), settings().text());
    EXPECT_EQ(&stored->settings.kind(), GetParam());
    const Status belongs = belongs_to(*stored, model_.positions, cage_);
    EXPECT_TRUE(belongs) << belongs.error().message;
    for (std::size_t t = 0; t < expected->weights.tile_count(); ++t) {
      ASSERT_TRUE(std::ranges::equal(stored->weights.tile(t), expected->weights.tile(t)));
    }
    const auto rule = GetParam()->rule(cage_, stored->settings);
    ASSERT_TRUE(rule);
    Result<Deformer> deformer = Deformer::from_weights(model_, *rule, std::move(stored->weights));
    ASSERT_TRUE(deformer) << deformer.error().message;
    Deformer direct = bound(WeightStorage::single);
    deformer->set_cage(pose(3));
    deformer->update();
    direct.set_cage(pose(3));
    direct.update();
    EXPECT_EQ(distance(deformer->positions(), direct.positions()), 0);
  }
  std::filesystem::remove(path);
}

INSTANTIATE_TEST_SUITE_P(All, KindOfCoordinates,
                         testing::ValuesIn(coordinate_kinds().begin(), coordinate_kinds().end()),
                         [](const auto& tested) { return std::string(tested.param->name); });

} // namespace
} // namespace cagewright
