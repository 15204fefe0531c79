#include "mesh/shapes.h"
#include "mesh/topology.h"
#include "spatial/bvh.h"
#include "support/figures.h"
#include "support/pairing.h"
#include "validate/greatest_gap.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace cagewright {
namespace {

using test::ellipsoid;
using test::expect_paired_exactly;

// Two balls, each the other's mirror image in the plane x = 2, and one between them.
TriangleMesh balls() {
  TriangleMesh mesh =
      joined(ellipsoid({3, 0, 0}, {0.4, 0.4, 0.5}), ellipsoid({1, 0, 0}, {0.4, 0.4, 0.5}));
  return joined(mesh, ellipsoid({2, 0, 1.2}, {0.5, 0.4, 0.4}));
}

// The one at x > 0 is larger by `more` on its outer side.
TriangleMesh pair_of_balls(double more = 0) {
  return joined(ellipsoid({1, 0, 0}, {0.4, 0.4, 0.4 + more}),
                ellipsoid({-1, 0, 0}, {0.4, 0.4, 0.4}));
}

GenerateOptions options(int vertices, Symmetry symmetry = Symmetry::automatic) {
  GenerateOptions result;
  result.vertices = vertices;
  result.rounds = 1;
  result.pieces = Pieces::apart;
  result.resolution = 32;
  result.symmetry = symmetry;
  return result;
}

void expect_valid(const GeneratedCage& made, const TriangleMesh& model) {
  const ValidateOptions in_pieces{.allow_pieces = true, .first_only = true};
  const Result<ValidityReport> report = validate_cage(made.faces, model, in_pieces);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->valid());
  EXPECT_GE(mesh_distance(TriangleBvh(made.triangles), TriangleBvh(model)).distance,
            (1 - 1e-9) * made.clearance * diagonal(model.positions));
}

TEST(MirroredPieces, ArePairedExactlyWithinTheBudget) {
  const TriangleMesh model = balls();
  for (const Method method : {Method::envelope, Method::boxes_improved}) {
    for (const bool quads : {false, true}) {
      GenerateOptions wanted = options(55);
      wanted.method = method;
      wanted.quads = quads;
      const Result<GeneratedCage> made = generate(model, wanted);
      ASSERT_TRUE(made) << made.error().message;
      EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
      EXPECT_LE(made->triangles.positions.size(), 55U);
      EXPECT_EQ(made->pieces, 3);
      EXPECT_EQ(made->joined, 0);
      EXPECT_EQ(topology(TriangleView(made->triangles)).components, 3U);
      EXPECT_NEAR(made->mirror->plane.offset, 2, 1e-9);
      EXPECT_EQ(made->clearance, wanted.clearance);
      expect_valid(*made, model);
      expect_paired_exactly(*made);
    }
  }
}

// Rings of edges round limbs are vertices of the cage on both sides.
TEST(MirroredPieces, HaveTheirLimbRingsOnBothSides) {
  TriangleMesh model;
  for (const double side : {1.0, -1.0}) { // a body with a long arm
    model = joined(model, joined(ellipsoid({3 * side, 0, 0}, {0.8, 0.8, 0.8}),
                                 ellipsoid({3 * side, 0, 1.6}, {0.25, 0.25, 1.4})));
  }
  GenerateOptions wanted = options(120);
  wanted.quads = true;
  const Result<GeneratedCage> made = generate(model, wanted);
  ASSERT_TRUE(made) << made.error().message;
  expect_paired_exactly(*made);
  expect_valid(*made, model);
  std::set<std::set<Index>> rings;
  for (const std::vector<Index>& ring : made->limb_rings) {
    rings.emplace(ring.begin(), ring.end());
  }
  for (const std::set<Index>& ring : rings) {
    std::set<Index> image;
    for (const Index v : ring) {
      ASSERT_LT(v, made->triangles.positions.size());
      image.insert(made->mirror->vertex_partners[v]);
    }
    EXPECT_TRUE(rings.contains(image));
  }
}

TEST(MirroredPieces, ShareACageWhereTheirSidesAreTooNear) {
  for (const double gap : {0.001, 0.05, 0.2}) { // from narrower than the clearance on
    TriangleMesh model = joined(ellipsoid({0.4 + gap / 2, 0, 0}, {0.4, 0.4, 0.4}),
                                ellipsoid({-0.4 - gap / 2, 0, 0}, {0.4, 0.4, 0.4}));
    model = joined(model, ellipsoid({0, 2, 0}, {0.3, 0.3, 0.3}));
    const Result<GeneratedCage> made = generate(model, options(60));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(static_cast<std::size_t>(made->pieces),
              topology(TriangleView(made->triangles)).components);
    EXPECT_GE(made->pieces, 2);
    expect_valid(*made, model);
    expect_paired_exactly(*made);
  }
}

TEST(MirroredPieces, EncloseAModelThatIsNotItsOwnMirrorImage) {
  const TriangleMesh model = pair_of_balls(0.3);
  const Result<GeneratedCage> as_it_is = generate(model, options(40));
  ASSERT_TRUE(as_it_is) << as_it_is.error().message;
  EXPECT_EQ(as_it_is->pieces, 2);
  for (const Symmetry symmetry : {Symmetry::x, Symmetry::y}) {
    const Result<GeneratedCage> made = generate(model, options(40, symmetry));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->pieces, 2);
    EXPECT_EQ(made->mirror->plane.axis(), symmetry == Symmetry::x ? 0 : 1);
    expect_valid(*made, model);
    expect_paired_exactly(*made);
  }
}

TEST(MirroredPieces, KeepNearTheModelItself) {
  const TriangleMesh model = pair_of_balls(0.05); // on one side only
  GenerateOptions wanted = options(0, Symmetry::x);
  wanted.max_gap = 0.06;
  const Result<GeneratedCage> made = generate(model, wanted);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
  ASSERT_TRUE(made->gap);
  EXPECT_LE(*made->gap, 0.06);
  const double size = diagonal(model.positions);
  const GreatestGap gap = greatest_gap(made->triangles, TriangleBvh(model), 1e-4 * size);
  EXPECT_LE(gap.lower, *made->gap * size);
  expect_paired_exactly(*made);

  wanted.max_gap = 0.01; // less than what one side has and the other has not
  const Result<GeneratedCage> farther = generate(model, wanted);
  ASSERT_TRUE(farther) << farther.error().message;
  EXPECT_FALSE(farther->is_as_asked());
  EXPECT_FALSE(test::first_remark(*farther).empty());
  EXPECT_GT(*farther->gap, 0.01);
  expect_valid(*farther, model);
}

TEST(MirroredPieces, AreFinerWhereADensitySaysSoOnBothSides) {
  const TriangleMesh model = balls();
  std::vector<double> density;
  for (const Vec3& p : model.positions) {
    density.push_back(p.x() > 2.5 && p.z() > 0 ? 30 : 1);
  }
  GenerateOptions wanted = options(90, Symmetry::x);
  wanted.density = density;
  const Result<GeneratedCage> made = generate(model, wanted);
  ASSERT_TRUE(made) << made.error().message;
  expect_paired_exactly(*made);
  expect_valid(*made, model);
  const auto count = [&](double sign) {
    return std::count_if(made->triangles.positions.begin(), made->triangles.positions.end(),
                         [&](const Vec3& p) { return p.x() > 2.5 && sign * p.z() > 0; });
  };
  EXPECT_GT(count(1), count(-1));
}

} // namespace
} // namespace cagewright
