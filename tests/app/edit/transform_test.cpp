#include "app/edit/transform.h"

#include "app/edit/select.h"
#include "core/random.h"
#include "quads.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cagewright::app {
namespace {

using test::quad_cube;
using test::quad_torus;

Transform translation(const Vec3& by) {
  Transform t;
  t.shift = by;
  return t;
}

Transform rotation(const Vec3& pivot, const Vec3& axis, double angle) {
  Transform t;
  t.kind = TransformKind::rotate;
  t.pivot = pivot;
  t.axis = axis.normalized();
  t.angle = angle;
  return t;
}

Transform scaling(const Vec3& pivot, const Vec3& factors) {
  Transform t;
  t.kind = TransformKind::scale;
  t.pivot = pivot;
  t.factors = factors;
  return t;
}

TEST(Transform, MovesSelectedVerticesAndNoOthers) {
  const PolygonMesh cube = quad_cube(2);
  const CageGraph graph(cube);
  const TransformTarget target(cube.positions, {1, 4}, graph);
  const std::vector<Vec3> moved = target.moved(translation({0.1, 0.2, 0.3}));
  for (Index v = 0; v < moved.size(); ++v) {
    const Vec3 step = v == 1 || v == 4 ? Vec3(0.1, 0.2, 0.3) : Vec3(Vec3::Zero());
    EXPECT_TRUE(moved[v].isApprox(cube.positions[v] + step));
  }
}

TEST(Transform, DoingNothingChangesNoBit) {
  const PolygonMesh torus = quad_torus();
  const CageGraph graph(torus);
  const TransformTarget target(torus.positions, select_all(SelectionMode::vertex, graph).vertices,
                               graph);
  EXPECT_EQ(target.moved(translation(Vec3::Zero())), torus.positions);
  EXPECT_EQ(target.moved(rotation({1, 2, 3}, Vec3::UnitX(), 0)), torus.positions);
  EXPECT_EQ(target.moved(scaling({1, 2, 3}, Vec3::Ones())), torus.positions);
}

TEST(Transform, RotationsKeepDistancesAndScalingsRatios) {
  const PolygonMesh torus = quad_torus();
  const CageGraph graph(torus);
  const TransformTarget target(torus.positions, select_all(SelectionMode::vertex, graph).vertices,
                               graph);
  const std::vector<Vec3> turned = target.moved(rotation({3, 1, 0}, {1, 2, 3}, 0.7));
  const std::vector<Vec3> grown = target.moved(scaling({3, 1, 0}, Vec3::Constant(1.7)));
  for (Index v = 1; v < turned.size(); ++v) {
    const double before = (torus.positions[v] - torus.positions[0]).norm();
    EXPECT_NEAR((turned[v] - turned[0]).norm(), before, 1e-12);
    EXPECT_NEAR((grown[v] - grown[0]).norm(), 1.7 * before, 1e-12);
  }
}

TEST(Transform, FollowersMoveLessWithDistance) {
  const PolygonMesh cube = quad_cube(4);
  const CageGraph graph(cube);
  for (const Falloff kind : {Falloff::smooth, Falloff::linear, Falloff::sharp}) {
    TransformOptions options;
    options.proportional = {.enabled = true, .radius = 1.5, .falloff = kind};
    const TransformTarget target(cube.positions, {0}, graph, options);
    const std::vector<Vec3> moved = target.moved(translation({0, 0, 0.5}));
    for (Index a = 0; a < moved.size(); ++a) {
      const double distance = (cube.positions[a] - cube.positions[0]).norm();
      const double step = (moved[a] - cube.positions[a]).norm();
      EXPECT_EQ(step > 0, distance < 1.5 - 1e-12);
      for (Index b = 0; b < moved.size(); ++b) {
        if ((cube.positions[b] - cube.positions[0]).norm() > distance + 1e-12) {
          EXPECT_LE((moved[b] - cube.positions[b]).norm(), step + 1e-15);
        }
      }
    }
    EXPECT_DOUBLE_EQ((moved[0] - cube.positions[0]).norm(), 0.5);
  }
}

TEST(Transform, ConnectedFollowersAreFoundAlongEdges) {
  // Two cubes close together: through the air the second is near, along edges out of reach.
  PolygonMesh two = quad_cube(2);
  const PolygonMesh cube = quad_cube(2);
  const auto first = static_cast<Index>(two.positions.size());
  for (const Vec3& p : cube.positions) {
    two.positions.emplace_back(p + Vec3(2.1, 0, 0));
  }
  for (std::size_t f = 0; f < cube.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : cube.face(f)) {
      corners.push_back(v + first);
    }
    two.add_face(corners);
  }
  const CageGraph graph(two);
  Index right = 0; // the middle of the side that faces the other cube
  for (Index v = 0; v < first; ++v) {
    if (two.positions[v].isApprox(Vec3(1, 0, 0))) {
      right = v;
    }
  }
  TransformOptions options;
  options.proportional = {.enabled = true, .radius = 1.2};
  const auto moves_second = [&] {
    const TransformTarget target(two.positions, {right}, graph, options);
    for (Index v = first; v < two.positions.size(); ++v) {
      if (target.weights()[v] > 0) {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(moves_second());
  options.proportional.connected_only = true;
  EXPECT_FALSE(moves_second());
}

TEST(Transform, SymmetricEditsKeepTheCageSymmetricToTheBit) {
  const PolygonMesh cube = quad_cube(4);
  const CageGraph graph(cube);
  Random random(9);
  std::vector<Vec3> positions = cube.positions;
  for (int round = 0; round < 60; ++round) {
    const std::optional<Symmetry> symmetry = find_symmetry(positions, 0, 1e-6);
    ASSERT_TRUE(symmetry);
    ASSERT_EQ(std::count(symmetry->partner.begin(), symmetry->partner.end(), Symmetry::none), 0);
    std::vector<Index> chosen;
    for (Index v = 0; v < positions.size(); ++v) {
      if (random.uniform() < 0.1) {
        chosen.push_back(v);
      }
    }
    TransformOptions options;
    options.symmetry = symmetry;
    options.proportional.enabled = round % 2 == 0;
    options.proportional.radius = random.uniform(0.2, 1.5);
    const TransformTarget target(positions, chosen, graph, options);
    const Vec3 some(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                    random.uniform(-0.05, 0.05));
    const Transform transform =
        round % 3 == 0   ? translation(some)
        : round % 3 == 1 ? rotation(some, Vec3(some.z(), 1, some.x()), random.uniform(-0.2, 0.2))
                         : scaling(some, Vec3(Vec3::Ones() + some));
    positions = target.moved(transform);
    for (Index v = 0; v < positions.size(); ++v) {
      const Index partner = symmetry->partner[v];
      if (partner == v) {
        EXPECT_EQ(positions[v].x(), 0) << "stays on the plane";
      } else {
        EXPECT_EQ(positions[partner], symmetry->mirror(positions[v]));
      }
    }
  }
}

TEST(Transform, SymmetryMovesThePartnerThatIsNotSelected) {
  const PolygonMesh cube = quad_cube();
  const CageGraph graph(cube);
  TransformOptions options;
  options.symmetry = find_symmetry(cube.positions, 0, 1e-6);
  const TransformTarget target(cube.positions, {0}, graph, options);
  const std::vector<Vec3> moved = target.moved(translation({0.2, 0.3, 0.4}));
  const Index partner = options.symmetry->partner[0];
  ASSERT_NE(partner, 0U);
  EXPECT_TRUE((moved[partner] - cube.positions[partner]).isApprox(Vec3(-0.2, 0.3, 0.4)));
}

TEST(Transform, FindsNoSymmetryWhereThereIsNone) {
  Random random(10);
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) {
    points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  }
  EXPECT_FALSE(find_symmetry(points, 0, 1e-4));
}

TEST(Transform, IndividualPivotsKeepEachPartWhereItIs) {
  const PolygonMesh cube = quad_cube(2);
  const CageGraph graph(cube);
  // Two opposite sides.
  std::vector<Index> sides;
  for (Index v = 0; v < cube.positions.size(); ++v) {
    if (std::abs(cube.positions[v].z()) == 1) {
      sides.push_back(v);
    }
  }
  TransformOptions options;
  options.pivot = Pivot::individual;
  const TransformTarget target(cube.positions, sides, graph, options);
  const std::vector<Vec3> moved = target.moved(scaling(Vec3::Zero(), Vec3::Constant(0.5)));
  for (const Index v : sides) {
    EXPECT_EQ(moved[v].z(), cube.positions[v].z());
    EXPECT_NEAR(moved[v].x(), cube.positions[v].x() / 2, 1e-15);
  }
}

TEST(Transform, LocalAxesAreThoseOfTheSelectedFace) {
  const PolygonMesh cube = quad_cube();
  const CageGraph graph(cube);
  for (Index f = 0; f < cube.face_count(); ++f) {
    std::vector<Index> corners(cube.face(f).begin(), cube.face(f).end());
    std::sort(corners.begin(), corners.end());
    const Mat3 axes = local_axes(cube, graph, corners);
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
    EXPECT_NEAR(axes.determinant(), 1, 1e-12);
    EXPECT_NEAR(axes.col(2).dot(cube.positions[corners[0]]), 1, 1e-12) << "outward";
  }
}

} // namespace
} // namespace cagewright::app
