#include "mesh/shape_limits.h"
#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include "support/figures.h"
#include "support/models.h"
#include "support/pairing.h"
#include "support/quads.h"
#include "validate/greatest_gap.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace cagewright {
namespace {

using test::ellipsoid;
using test::quads_of;

/// A body with two arms, its own mirror image in the plane x = 3.
TriangleMesh figure() {
  TriangleMesh mesh = ellipsoid({3, 0, 0}, {1, 1.6, 0.7});
  mesh = joined(mesh, ellipsoid({4.4, 0.6, 0.2}, {0.9, 0.25, 0.25}));
  return joined(mesh, ellipsoid({1.6, 0.6, 0.2}, {0.9, 0.25, 0.25}));
}

TEST(QuadCageWithinABudget, IsPairedExactlyWhenMirrored) {
  const TriangleMesh model = figure();
  GenerateOptions options = quads_of(40);
  options.symmetry = Symmetry::automatic;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made && made->mirror);
  EXPECT_LE(made->faces.positions.size(), 40U);
  test::expect_paired_exactly(*made);
  EXPECT_TRUE(validate_cage(made->faces, model)->valid());
}

// A ring round the rod between them lies beside the plane that the rod crosses: no vertex of the
// plane may be drawn into the ring.
TEST(QuadCageWithinABudget, IsMirroredThoughARingLiesNearThePlane) {
  const TriangleMesh model =
      joined(ellipsoid({1, 0, 0}, {0.4, 0.4, 0.4}), ellipsoid({-1, 0, 0}, {0.4, 0.4, 0.4}));
  for (const int vertices : {50, 60}) {
    GenerateOptions options;
    options.quads = true;
    options.vertices = vertices;
    options.symmetry = Symmetry::automatic;
    const Result<GeneratedCage> made = generate(model, options);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->mirror) << test::first_remark(*made);
    EXPECT_TRUE(validate_cage(made->faces, model)->valid());
  }
}

TEST(QuadCageWithinABudget, CountsAQuadAsOneFace) {
  const TriangleMesh model = figure();
  GenerateOptions options = quads_of(0);
  options.faces = 40;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
  EXPECT_LE(made->faces.face_count(), 40U);
  EXPECT_GT(made->triangles.triangles.size(), 40U);
}

// Three of its vertices are of no face and far away. What reaches out to them is thin, or left in
// triangles, at the usual weights: half of the faces would be quads.
TEST(QuadCageWithinABudget, IsTriedAgainWithMoreWeightOnShape) {
  const std::optional<TriangleMesh> model = test::real_model({"prim.off"});
  if (!model) {
    GTEST_SKIP() << "prim.off is not there";
  }
  GenerateOptions options;
  options.quads = true;
  options.vertices = 32;
  options.symmetry = Symmetry::automatic;
  const Result<GeneratedCage> made = generate(*model, options);
  ASSERT_TRUE(made && made->quads);
  EXPECT_LE(made->faces.positions.size(), 32U);
  EXPECT_GE(made->quads->share, 0.3);
  EXPECT_LE(made->quads->thin, shape_limits::few_thin);
  EXPECT_TRUE(validate_cage(made->faces, *model)->valid());
}

TEST(QuadCageWithinABudget, MayBeInPieces) {
  TriangleMesh model = ellipsoid({0, 0, 0}, {1, 0.5, 0.5});
  model = joined(model, ellipsoid({0, 2, 0}, {1, 0.5, 0.5}));
  GenerateOptions options = quads_of(40);
  options.pieces = Pieces::apart;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->pieces, 2);
  EXPECT_LE(made->faces.positions.size(), 40U);
  EXPECT_GT(made->quads->share, 0.5);
  const Result<ValidityReport> report = validate_cage(made->faces, model, {.allow_pieces = true});
  EXPECT_TRUE(report && report->valid());
}

TEST(QuadCageWithinABudget, KeepsAGreatestGapWhenMirrored) {
  const TriangleMesh model = ellipsoid({0, 0, 0}, {1, 0.6, 0.6});
  GenerateOptions options = quads_of(0);
  options.max_gap = 0.1;
  options.symmetry = Symmetry::x;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made && made->gap && made->mirror);
  EXPECT_TRUE(made->is_as_asked());
  EXPECT_LE(*made->gap, 0.1);
  const double diag = diagonal(model.positions);
  const GreatestGap gap = greatest_gap(made->triangles, TriangleBvh(model), 1e-4 * diag);
  EXPECT_LE(gap.lower, *made->gap * diag);
  EXPECT_GT(made->quads->share, 0.5);
  const Result<ValidityReport> report = validate_cage(made->faces, model);
  EXPECT_TRUE(report && report->valid());
}

TEST(QuadCageWithinABudget, KeepsAGreatestGap) {
  const TriangleMesh model = ellipsoid({0, 0, 0}, {1, 0.6, 0.6});
  GenerateOptions options = quads_of(0);
  options.max_gap = 0.1;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made && made->gap);
  EXPECT_LE(*made->gap, 0.1);
}

} // namespace
} // namespace cagewright
