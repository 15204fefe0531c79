// Properties on real models. They are looked for in the folder that the environment variable
// CAGEWRIGHT_MODELS names.

#include "coordinates/reference.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/deform/deformer.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

namespace cagewright {
namespace {

struct Pair {
  std::string model;
  std::string cage; ///< a file, or empty for a cage of our own

  friend void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.model; }
};

/// A box of quads round the model, or a sphere of triangles that touches nothing.
PolygonMesh box_around(const PolygonMesh& model) {
  PolygonMesh cage = make_quad_cube();
  const Box3 box = bounding_box(model.positions);
  for (Vec3& corner : cage.positions) {
    corner = box.center() + 0.51 * corner.cwiseProduct(box.sizes());
  }
  return cage;
}

class RealModel : public testing::TestWithParam<Pair> {
protected:
  void SetUp() override {
    const char* folder = std::getenv("CAGEWRIGHT_MODELS");
    const std::filesystem::path root = folder != nullptr ? folder : "";
    if (root.empty() || !std::filesystem::exists(root / GetParam().model)) {
      GTEST_SKIP() << "no " << GetParam().model << " in CAGEWRIGHT_MODELS";
    }
    const Result<PolygonMesh> model = read_mesh(root / GetParam().model);
    ASSERT_TRUE(model) << model.error().message;
    model_ = *model;
    cage_ = box_around(model_);
    if (!GetParam().cage.empty()) {
      const Result<PolygonMesh> cage = read_mesh(root / GetParam().cage);
      ASSERT_TRUE(cage) << cage.error().message;
      cage_ = *cage;
    }
    diagonal_ = diagonal(model_.positions);
  }

  PolygonMesh model_, cage_;
  double diagonal_ = 1;
};

TEST_P(RealModel, IsReproducedByItsWeights) {
  const Result<Weights> weights = mean_value_coordinates(cage_, model_.positions);
  ASSERT_TRUE(weights) << weights.error().message;
  for (std::size_t p = 0; p < model_.positions.size(); ++p) {
    const std::vector<double> row = weights->row(p);
    Vec3 x = Vec3::Zero();
    for (std::size_t c = 0; c < row.size(); ++c) {
      x += row[c] * (cage_.positions[c] - model_.positions[p]);
    }
    ASSERT_LT(x.norm(), 1e-13 * diagonal_) << p;
    ASSERT_NEAR(std::accumulate(row.begin(), row.end(), 0.0), 1, 1e-13);
  }
}

TEST_P(RealModel, HasTheWeightsOfTheDefinition) {
  const TriangleMesh cage = to_triangle_mesh(cage_);
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < model_.positions.size(); p += 1 + model_.positions.size() / 40) {
    points.push_back(model_.positions[p]);
  }
  const Result<Weights> weights = mean_value_coordinates(TriangleView(cage), points);
  ASSERT_TRUE(weights);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::vector<double> expected = test::reference_weights(cage, points[p]);
    const double largest = *std::max_element(expected.begin(), expected.end());
    for (std::size_t c = 0; c < expected.size(); ++c) {
      ASSERT_NEAR(weights->at(p, c), expected[c], 1e-12 * largest);
    }
  }
}

TEST_P(RealModel, TurnsWithItsCage) {
  for (const WeightStorage storage : {WeightStorage::single, WeightStorage::full}) {
    Result<Deformer> deformer = Deformer::bind(model_, cage_, {.storage = storage});
    ASSERT_TRUE(deformer) << deformer.error().message;
    EXPECT_EQ(deformer->unbound(), 0U);
    const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, -2, 3).normalized()).toRotationMatrix();
    const Vec3 shift = Vec3(0.3, 0.1, -0.2) * diagonal_;
    std::vector<Vec3> pose = cage_.positions;
    for (Vec3& p : pose) {
      p = turn * p + shift;
    }
    const std::vector<Vec3> normals(deformer->normals().begin(), deformer->normals().end());
    deformer->set_cage(pose);
    deformer->update();
    const double tolerance = storage == WeightStorage::full ? 1e-12 : 1e-6;
    for (std::size_t p = 0; p < model_.positions.size(); ++p) {
      const Vec3 expected = turn * model_.positions[p] + shift;
      ASSERT_LT((deformer->positions()[p] - expected).norm(), tolerance * diagonal_);
    }
    double worst = 0;
    for (std::size_t n = 0; n < normals.size(); ++n) {
      worst = std::max(worst, (deformer->normals()[n] - turn * normals[n]).norm());
    }
    if (storage == WeightStorage::full) {
      EXPECT_LT(worst, 1e-3); // needle-shaped faces turn a rounding error into an angle
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RealModel,
                         testing::Values(Pair{"arm.obj", "arm_cage.obj"}, Pair{"spot.obj", ""},
                                         Pair{"spot_quads.obj", ""}, Pair{"fandisk.off", ""},
                                         Pair{"elephant-with-holes.off", ""}, Pair{"cow.off", ""}),
                         [](const auto& tested) {
                           std::string name = tested.param.model;
                           std::erase_if(name, [](char c) {
                             return !std::isalnum(static_cast<unsigned char>(c));
                           });
                           return name;
                         });

} // namespace
} // namespace cagewright
