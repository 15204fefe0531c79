#include "cage/canonical_model.h"

#include "mesh/shapes.h"
#include "support/figures.h"
#include "support/models.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace cagewright {
namespace {

/// A body with an arm: not its own mirror image.
TriangleMesh figure() {
  return joined(test::ellipsoid({0, 0, 0}, {1, 0.6, 1.7}),
                test::ellipsoid({1.1, 0.3, 0.4}, {0.9, 0.3, 0.25}));
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

/// The vertices backwards, the triangles in another order and begun at another corner.
TriangleMesh shuffled(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  std::reverse(result.positions.begin(), result.positions.end());
  const auto last = static_cast<Index>(mesh.positions.size() - 1);
  for (Triangle& t : result.triangles) {
    t = {last - t[1], last - t[2], last - t[0]};
  }
  std::rotate(result.triangles.begin(), result.triangles.begin() + 100, result.triangles.end());
  return result;
}

CanonicalModel canonical(const TriangleMesh& model) {
  const Result<UnitFrame> frame = unit_frame(model);
  return canonical_model(model, *frame, canonical_grid(0.002));
}

TEST(CanonicalModel, IsTheSameOfCopies) {
  const TriangleMesh model = figure();
  const CanonicalModel own = canonical(model);
  for (const TriangleMesh& copy :
       {moved(model, 1, {0.1, -7.3, 2.9}), moved(model, 0.0377, Vec3::Zero()), shuffled(model)}) {
    const CanonicalModel other = canonical(copy);
    EXPECT_EQ(other.mesh.positions, own.mesh.positions);
    EXPECT_EQ(other.mesh.triangles, own.mesh.triangles);
  }
}

TEST(CanonicalModel, IsTheModelToWithinTheGrid) {
  const TriangleMesh model = figure();
  const CanonicalModel own = canonical(model);
  ASSERT_EQ(own.mesh.positions.size(), model.positions.size());
  for (std::size_t v = 0; v < model.positions.size(); ++v) {
    const Vec3 off = own.mesh.positions[v] - own.frame.to_unit(model.positions[own.vertices[v]]);
    EXPECT_LE(off.norm(), canonical_grid(0.002));
  }
  EXPECT_NEAR(signed_volume(own.mesh) * std::pow(own.frame.diagonal, 3), signed_volume(model),
              1e-4);
}

TEST(CanonicalModel, HasAGridFarBelowTheClearance) {
  for (const double clearance : {0.1, 0.002, 1e-4, 1e-6}) {
    EXPECT_GT(canonical_grid(clearance), 0);
    EXPECT_LE(canonical_grid(clearance), clearance / 256);
  }
}

TEST(CanonicalModel, GivesCopiesTheSameCage) {
  const TriangleMesh model = figure();
  GenerateOptions options;
  options.vertices = 24;
  options.symmetry = Symmetry::off;
  const Result<GeneratedCage> own = generate(model, options);
  ASSERT_TRUE(own) << own.error().message;
  const double scale = 0.0377;
  const Vec3 offset(0.3, -1.1, 2.7);
  for (const TriangleMesh& copy :
       {moved(model, scale, offset), shuffled(moved(model, scale, offset))}) {
    const Result<GeneratedCage> other = generate(copy, options);
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_EQ(other->triangles.triangles, own->triangles.triangles);
    const TriangleMesh expected = moved(own->triangles, scale, offset);
    ASSERT_EQ(other->triangles.positions.size(), expected.positions.size());
    for (std::size_t v = 0; v < expected.positions.size(); ++v) {
      EXPECT_LT((other->triangles.positions[v] - expected.positions[v]).norm(), 1e-12);
    }
    EXPECT_EQ(other->clearance, options.clearance);
  }
}

TEST(CanonicalModel, KeepsAPlaneThroughTheUsersOrigin) {
  // Its own mirror image in x = 0 but for a wart, so that the middle of its box is elsewhere.
  const TriangleMesh body = test::ellipsoid({0, 0, 0}, {1, 0.6, 1.7});
  const TriangleMesh model = joined(body, test::ellipsoid({1, 0, 0}, {0.02, 0.02, 0.02}));
  ASSERT_NE(bounding_box(model.positions).center().x(), 0);
  GenerateOptions options;
  options.vertices = 30;
  options.symmetry = Symmetry::automatic;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_TRUE(made->mirror);
  EXPECT_GE(made->mirror->plane.axis(), 0);
  EXPECT_EQ(made->mirror->plane.offset, 0);
  for (std::size_t v = 0; v < made->triangles.positions.size(); ++v) {
    Vec3 image = made->triangles.positions[made->mirror->vertex_partners[v]];
    const int axis = made->mirror->plane.axis();
    image[axis] = 0 - image[axis];
    EXPECT_EQ(made->triangles.positions[v], image);
  }
}

TEST(StartOfACage, IsChosenByWhatBecomesOfIt) {
  const std::optional<TriangleMesh> camel = test::real_model({"camel.off"});
  if (!camel) {
    GTEST_SKIP() << "needs the packaged models";
  }
  GenerateOptions options;
  options.vertices = 100;
  options.symmetry = Symmetry::off;
  const Result<GeneratedCage> made = generate(*camel, options);
  ASSERT_TRUE(made) << made.error().message;
  // From the start that the number of vertices suggests a third of the space between the legs is
  // inside.
  EXPECT_LT(measure_cage(made->triangles, *camel).webbing, 0.2);
}

} // namespace
} // namespace cagewright
