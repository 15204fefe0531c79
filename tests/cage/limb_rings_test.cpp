#include "cage/limb_rings.h"

#include "envelope/envelope.h"
#include "mesh/edge_chains.h"
#include "mesh/shapes.h"
#include "support/figures.h"
#include "support/models.h"
#include "support/quads.h"
#include <cagewright/cage/generate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <set>

namespace cagewright {
namespace {

using test::ellipsoid;
using test::quads_of;

constexpr double body_end = 1; // of the figure's body, along x

/// A body with two arms along x: to 2.7 and to -2.7.
TriangleMesh figure() {
  TriangleMesh mesh = ellipsoid({0, 0, 0}, {body_end, 1.6, 0.7});
  mesh = joined(mesh, ellipsoid({1.6, 0, 0}, {1.1, 0.25, 0.25}));
  return joined(mesh, ellipsoid({-1.6, 0, 0}, {1.1, 0.25, 0.25}));
}

TriangleMesh fine_cage(const TriangleMesh& model, bool half = false) {
  EnvelopeOptions options;
  options.clearance = 0.002;
  options.vertices = 100;
  options.half = half;
  Result<Envelope> made = envelope(model, options);
  EXPECT_TRUE(made);
  return std::move(made->mesh);
}

std::vector<EdgeChain> rings_of(const TriangleMesh& mesh, const std::vector<Index>& parts) {
  PolygonMesh polygons;
  polygons.positions = mesh.positions;
  for (const Triangle& t : mesh.triangles) {
    polygons.add_face({t[0], t[1], t[2]});
  }
  return chains_of(edges_between_parts(polygons, parts));
}

TEST(LimbRings, GoRoundTheArmsOfAFigureWhereTheyBegin) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model);
  const LimbRings rings = limb_rings(start, limb_cuts(model), 50);
  EXPECT_EQ(rings.count, 2);
  ASSERT_EQ(rings.parts.size(), start.triangles.size());
  ASSERT_EQ(rings.bands.size(), 3U);
  const std::vector<EdgeChain> chains = rings_of(start, rings.parts);
  ASSERT_EQ(chains.size(), 2U);
  double sides = 1;
  for (const EdgeChain& ring : chains) {
    EXPECT_TRUE(ring.closed && ring.simple);
    sides *= start.positions[ring.vertices[0]].x();
    for (const Index v : ring.vertices) {
      EXPECT_GT(std::abs(start.positions[v].x()), 0.85 * body_end);
      EXPECT_LT(std::abs(start.positions[v].x()), 1.4 * body_end);
    }
  }
  EXPECT_LT(sides, 0); // one on each side
}

Vec3 middle_of(std::span<const Index> ring, std::span<const Vec3> positions) {
  Vec3 sum = Vec3::Zero();
  for (const Index v : ring) {
    sum += positions[v];
  }
  return sum / static_cast<double>(ring.size());
}

TEST(RingsAtJoints, GoRoundTheLimbWhereTheyAreAskedFor) {
  const TriangleMesh start = fine_cage(figure());
  const std::vector<LimbJoint> joints = {{{1.8, 0, 0}, Vec3::Zero()},
                                         {{-1.7, 0.05, 0}, Vec3(-1, 0.2, 0)},
                                         {{0, 5, 0}, Vec3::Zero()}}; // beside the figure
  const LimbRings rings = rings_at_joints(start, joints, 60);
  EXPECT_EQ(rings.count, 2);
  for (const EdgeChain& ring : rings_of(start, rings.parts)) {
    const Vec3 middle = middle_of(ring.vertices, start.positions);
    EXPECT_NEAR(std::abs(middle.x()), 1.75, 0.2);
    EXPECT_NEAR(middle.y(), 0, 0.1);
  }
}

TEST(RingsAtJoints, AreInCagesOfTriangles) {
  const std::vector<LimbJoint> joints = {{{1.9, 0, 0}, Vec3::Zero()}, {{-1.9, 0, 0}, Vec3::Zero()}};
  GenerateOptions options;
  options.vertices = 60;
  options.rounds = 2;
  options.joints = joints;
  const Result<GeneratedCage> made = generate(figure(), options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_LE(made->faces.positions.size(), 60U);
  EXPECT_EQ(made->limb_rings.size(), 2U);
  for (const std::vector<Index>& ring : made->limb_rings) {
    EXPECT_NEAR(std::abs(middle_of(ring, made->faces.positions).x()), 1.9, 0.2);
  }
}

/// A trunk with two straight arms, all of boxes: blocks go round it without a loss.
TriangleMesh boxy_figure() {
  const auto box = [](const Vec3& center, const Vec3& half) {
    TriangleMesh mesh = make_cube();
    for (Vec3& p : mesh.positions) {
      p = center + p.cwiseProduct(half);
    }
    return mesh;
  };
  TriangleMesh mesh = box({0, 0, 0}, {1, 1.6, 0.7});
  mesh = joined(mesh, box({2.4, 0, 0}, {1.5, 0.3, 0.3}));
  return joined(mesh, box({-2.4, 0, 0}, {1.5, 0.3, 0.3}));
}

TEST(RingsAtJoints, AreInCagesOfQuadsThatBlocksWouldFitAsWell) {
  const std::vector<LimbJoint> joints = {{{2.4, 0, 0}, Vec3::Zero()}, {{-2.4, 0, 0}, Vec3::Zero()}};
  GenerateOptions options;
  options.vertices = 60;
  options.quads = true;
  options.joints = joints;
  const Result<GeneratedCage> made = generate(boxy_figure(), options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_LE(made->faces.positions.size(), 60U);
  std::size_t at_joints = 0;
  for (const std::vector<Index>& ring : made->limb_rings) {
    const double x = middle_of(ring, made->faces.positions).x();
    at_joints += std::abs(std::abs(x) - 2.4) < 0.2 ? 1 : 0;
  }
  EXPECT_EQ(at_joints, 2U);
}

TEST(Limbs, OfAFigureAreItsArms) {
  const TriangleMesh start = fine_cage(figure());
  const std::vector<Limb> limbs = find_limbs(start, limb_cuts(figure()), 50);
  ASSERT_EQ(limbs.size(), 2U);
  for (const Limb& limb : limbs) {
    EXPECT_GT(limb.joint.along.x() * limb.joint.position.x(), 0) << "outward";
    EXPECT_NEAR(limb.joint.along.norm(), 1, 1e-12);
    EXPECT_NEAR(limb.width, 0.5, 0.35);
    EXPECT_LT(limb.faces.size(), start.triangles.size() / 3);
  }
}

TEST(LimbRings, LieInTheirBands) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model);
  const LimbRings rings = limb_rings(start, limb_cuts(model), 50);
  ASSERT_EQ(rings.count, 2);
  for (const EdgeChain& ring : rings_of(start, rings.parts)) {
    const bool in_one =
        std::any_of(rings.bands.begin() + 1, rings.bands.end(), [&](const SeamBand& band) {
          return std::all_of(ring.vertices.begin(), ring.vertices.end(), [&](Index v) {
            return std::abs(band.height(start.positions[v])) <= band.half_width * (1 + 1e-9);
          });
        });
    EXPECT_TRUE(in_one);
  }
}

TEST(LimbRings, OfHalfAFigureCountBothArms) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model, true);
  const LimbRings rings = limb_rings(start, limb_cuts(model), 50);
  EXPECT_EQ(rings.count, 2);
  const std::vector<EdgeChain> chains = rings_of(start, rings.parts);
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_TRUE(chains[0].closed);
}

TEST(LimbRings, AreChainsWhereALimbLiesInTheMirrorPlane) {
  TriangleMesh model = figure();
  for (Vec3& p : model.positions) {
    p = Vec3(p.y(), p.x(), p.z()); // the arms along y
  }
  const TriangleMesh start = fine_cage(model, true);
  const LimbRings rings = limb_rings(start, limb_cuts(model), 50);
  EXPECT_EQ(rings.count, 2);
  for (const EdgeChain& chain : rings_of(start, rings.parts)) {
    EXPECT_FALSE(chain.closed);
    EXPECT_EQ(start.positions[chain.vertices.front()].x(), 0);
    EXPECT_EQ(start.positions[chain.vertices.back()].x(), 0);
  }
  for (std::size_t part = 1; part < rings.bands.size(); ++part) {
    EXPECT_EQ(rings.bands[part].normal.x(), 0); // or the whole ring would have a corner there
  }
}

TEST(LimbRings, AreNoneRoundABallABoxOrATorus) {
  for (const TriangleMesh& model : {make_icosphere(2), make_cube(), make_torus(0.3, 20, 10)}) {
    EXPECT_EQ(limb_rings(fine_cage(model), limb_cuts(model), 100).count, 0);
  }
}

TEST(LimbRings, AreFewerWhereThereAreFewVertices) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model);
  const std::vector<LimbCut> cuts = limb_cuts(model);
  EXPECT_EQ(limb_rings(start, cuts, 19).count, 0);
  EXPECT_EQ(limb_rings(start, cuts, 39).count, 1);
  EXPECT_GT(limb_rings(start, cuts, 200).count, 2);
}

TEST(LimbRings, AreNotLookedForWhereThereMayBeNone) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model);
  EXPECT_TRUE(find_limb_rings(start, model, 0).parts.empty());
  EXPECT_TRUE(find_limb_rings(start, model, 19).parts.empty());
  EXPECT_EQ(find_limb_rings(start, model, 50).count, 2);
}

TEST(LimbRings, AreTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model = figure();
  const TriangleMesh start = fine_cage(model);
  const auto parts_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return limb_rings(start, limb_cuts(model), 100).parts; });
  };
  EXPECT_EQ(parts_with(1), parts_with(4));
}

TEST(LimbCuts, AreNoneOfNothing) {
  EXPECT_TRUE(limb_cuts(TriangleMesh()).empty());
}

/// Every ring is a closed loop of edges that parts the faces into two.
void expect_rings_that_separate(const GeneratedCage& made) {
  const PolygonMesh& cage = made.faces;
  std::map<std::array<Index, 2>, std::size_t> face_left_of;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      face_left_of[{face[i], face[(i + 1) % face.size()]}] = f;
    }
  }
  for (const std::vector<Index>& ring : made.limb_rings) {
    EXPECT_GE(ring.size(), 4U);
    std::set<std::array<Index, 2>> seam;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::array<Index, 2> edge{ring[i], ring[(i + 1) % ring.size()]};
      ASSERT_TRUE(face_left_of.contains(edge));
      seam.insert(edge);
      seam.insert({edge[1], edge[0]});
    }
    std::set<std::size_t> beyond{face_left_of.at({ring[0], ring[1]})};
    for (std::vector<std::size_t> next(beyond.begin(), beyond.end()); !next.empty();) {
      const std::span<const Index> face = cage.face(next.back());
      next.pop_back();
      for (std::size_t i = 0; i < face.size(); ++i) {
        const std::array<Index, 2> across{face[(i + 1) % face.size()], face[i]};
        if (!seam.contains(across) && beyond.insert(face_left_of.at(across)).second) {
          next.push_back(face_left_of.at(across));
        }
      }
    }
    EXPECT_FALSE(beyond.contains(face_left_of.at({ring[1], ring[0]})));
  }
}

/// The figure with its arms aslant, so that blocks do not fit it.
TriangleMesh raised(TriangleMesh figure) {
  for (Vec3& p : figure.positions) {
    const double out = std::max(0.0, std::abs(p.x()) - body_end);
    p.y() += 0.7 * out;
    p.z() += 0.4 * out;
  }
  return figure;
}

TEST(CageOfQuads, HasRingsRoundTheArmsOfAFigure) {
  const TriangleMesh model = raised(figure());
  for (const Symmetry symmetry : {Symmetry::off, Symmetry::x}) {
    GenerateOptions options = quads_of(70);
    options.symmetry = symmetry;
    const Result<GeneratedCage> made = generate(model, options);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->is_as_asked());
    expect_rings_that_separate(*made);
    const auto is_round_arm = [&](const std::vector<Index>& ring, double side) {
      return std::all_of(ring.begin(), ring.end(), [&](Index v) {
        const double x = side * made->faces.positions[v].x();
        return x > 0.7 * body_end && x < 2 * body_end;
      });
    };
    for (const double side : {1.0, -1.0}) {
      EXPECT_TRUE(
          std::any_of(made->limb_rings.begin(), made->limb_rings.end(),
                      [&](const std::vector<Index>& ring) { return is_round_arm(ring, side); }));
    }
    const Result<ValidityReport> report = validate_cage(made->faces, model);
    EXPECT_TRUE(report && report->valid());
  }
}

TEST(CageOfQuads, HasRingsRoundTheLegsAndTheNeckOfACow) {
  const std::optional<TriangleMesh> model = test::real_model({"cow.off"});
  if (!model) {
    GTEST_SKIP() << "no such model in CAGEWRIGHT_MODELS";
  }
  GenerateOptions options = quads_of(100);
  options.symmetry = Symmetry::automatic;
  const Result<GeneratedCage> made = generate(*model, options);
  ASSERT_TRUE(made);
  EXPECT_GE(made->limb_rings.size(), 5U);
  expect_rings_that_separate(*made);
}

} // namespace
} // namespace cagewright
