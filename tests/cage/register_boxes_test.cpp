#include "cage/register_boxes.h"

#include "cage/unite.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace cagewright {
namespace {

/// A grid of voxels of edge 0.1 around the origin, with parts that are filled one after another.
class Scene {
public:
  Scene() {
    grid_.size = 0.1;
    grid_.dims = {120, 120, 60};
    grid_.origin = -grid_.size / 2 * Vec3(120, 120, 60);
    grid_.kinds.assign(grid_.index(0, 0, 60), VoxelKind::outer);
  }

  /// A part: the free voxels with centers in the box.
  Scene& add(const OrientedBox& part) {
    std::vector<std::uint32_t>& voxels = voxels_.emplace_back();
    std::vector<Vec3> corners;
    for (std::uint32_t v = 0; v < grid_.kinds.size(); ++v) {
      if (!grid_.occupied(v) && part.contains(grid_.center(v))) {
        grid_.kinds[v] = VoxelKind::inner;
        voxels.push_back(v);
        const auto [i, j, k] = grid_.cell(v);
        for (int c = 0; c < 8; ++c) {
          corners.push_back(grid_.corner(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1)));
        }
      }
    }
    boxes_.push_back(box_in_frame(part.axes, corners).padded(0.25 * grid_.size));
    return *this;
  }

  [[nodiscard]] std::vector<BoxContents> contents() const {
    std::vector<BoxContents> contents;
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      contents.push_back({boxes_[b], voxels_[b]});
    }
    return contents;
  }

  [[nodiscard]] const VoxelGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& voxels() const { return voxels_; }

  [[nodiscard]] Registration registered(const RegisterOptions& options = {}) const {
    const Result<Registration> result = register_boxes(grid_, contents(), options);
    EXPECT_TRUE(result);
    return result ? *result : Registration{};
  }

private:
  VoxelGrid grid_;
  std::vector<OrientedBox> boxes_;
  std::vector<std::vector<std::uint32_t>> voxels_;
};

/// A bar from a to b with a square section.
OrientedBox bar(const Vec3& a, const Vec3& b, double width) {
  OrientedBox box;
  box.center = (a + b) / 2;
  box.axes.col(0) = (b - a).normalized();
  box.axes.col(2) = Vec3::UnitZ();
  box.axes.col(1) = box.axes.col(2).cross(box.axes.col(0));
  box.half = Vec3((b - a).norm(), width, width) / 2;
  return box;
}

/// Bars one after another along the points.
Scene chain(const std::vector<Vec3>& points, double width) {
  Scene scene;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    scene.add(bar(points[i], points[i + 1], width));
  }
  return scene;
}

TriangleMesh united(const Registration& registration) {
  const Result<TriangleMesh> mesh = unite(registration.solids, {.separation = 0.02});
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *mesh : TriangleMesh{};
}

/// Whether every corner of every voxel lies in one of the solids: those of a joint are convex and
/// meet in a plane, so the voxels lie in their union.
void expect_contained(const Scene& scene, const Registration& registration) {
  const VoxelGrid& grid = scene.grid();
  int outside = 0;
  for (const auto& part : scene.voxels()) {
    for (const std::uint32_t v : part) {
      const auto [i, j, k] = grid.cell(v);
      for (int c = 0; c < 8; ++c) {
        const Vec3 p = grid.corner(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1));
        outside += std::none_of(registration.solids.begin(), registration.solids.end(),
                                [&](const Hexahedron& s) { return height_above(s, p) < 1e-12; });
      }
    }
  }
  EXPECT_EQ(outside, 0);
}

void expect_quads_coincide(const Registration& registration) {
  for (const Joint& joint : registration.joints) {
    const Hexahedron& a = registration.solids[joint.solid0];
    const Hexahedron& b = registration.solids[joint.solid1];
    EXPECT_TRUE(a.shared[joint.face0]);
    EXPECT_TRUE(b.shared[joint.face1]);
    int same = 0;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 4; ++k) {
        same += a.corner(joint.face0, i) == b.corner(joint.face1, k) ? 1 : 0;
      }
    }
    EXPECT_EQ(same, 4);
    const Vec3 both = face_area(a, joint.face0) + face_area(b, joint.face1);
    EXPECT_NEAR(both.norm(), 0, 1e-12); // seen from opposite sides
  }
}

TEST(RegisterBoxes, JoinsTwoBoxesInALineToATubeOfTwelveVertices) {
  const Scene scene = chain({{-3, 0, 0}, {0, 0, 0}, {3, 0, 0}}, 1);
  const Registration registration = scene.registered();
  ASSERT_EQ(registration.joints.size(), 1);
  expect_quads_coincide(registration);
  expect_contained(scene, registration);
  const TriangleMesh tube = united(registration);
  EXPECT_EQ(tube.positions.size(), 12); // the ends grow by `separation`, the joint stays
  EXPECT_EQ(tube.triangles.size(), 20);
}

TEST(RegisterBoxes, JoinsTwoBoxesAtAnAngleInAMitre) {
  for (const double degrees : {15, 30, 45, 55}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * std::numbers::pi / 180;
    const Scene scene =
        chain({{-3, 0, 0}, {0, 0, 0}, {3 * std::cos(angle), 3 * std::sin(angle), 0}}, 1);
    const Registration registration = scene.registered({.max_growth = 0.25});
    ASSERT_EQ(registration.joints.size(), 1);
    expect_quads_coincide(registration);
    expect_contained(scene, registration);
    const Joint& joint = registration.joints[0];
    const Vec3 normal = face_area(registration.solids[joint.solid0], joint.face0).normalized();
    const double tilt = std::acos(std::abs(normal.x())) * 180 / std::numbers::pi;
    EXPECT_NEAR(tilt, degrees / 2, degrees / 4); // the plane about halves the angle
    const TriangleMesh tube = united(registration);
    EXPECT_EQ(tube.positions.size(), 12);
  }
}

TEST(RegisterBoxes, JoinsALegOfThreeBoxesAtBothEndsOfTheMiddleOne) {
  const Scene scene = chain({{0, 4, 0}, {0, 1.5, 0}, {0.6, -1, 0}, {0.4, -3.5, 0}}, 1);
  const Registration registration = scene.registered();
  EXPECT_EQ(registration.joints.size(), 2);
  expect_quads_coincide(registration);
  expect_contained(scene, registration);
  EXPECT_EQ(united(registration).positions.size(), 16);
}

TEST(RegisterBoxes, LeavesATwistedContinuationItsOwnRectangle) {
  Scene scene;
  scene.add(bar({-3, 0, 0}, {0, 0, 0}, 1));
  OrientedBox turned = bar({0, 0, 0}, {3, 0, 0}, 1);
  turned.axes = turned.axes * Eigen::AngleAxisd(0.2, Vec3::UnitX()).toRotationMatrix();
  const Registration registration = scene.add(turned).registered();
  ASSERT_EQ(registration.joints.size(), 1);
  expect_contained(scene, registration);
  expect_quads_coincide(registration);
}

TEST(RegisterBoxes, KeepsBoxesApartThatDoNotTouch) {
  Scene scene;
  scene.add(bar({-3, 0, 0}, {-0.3, 0, 0}, 1)).add(bar({0.3, 0, 0}, {3, 0, 0}, 1));
  const Registration registration = scene.registered();
  EXPECT_TRUE(registration.joints.empty());
  for (const Hexahedron& solid : registration.solids) {
    EXPECT_TRUE(solid.is_box);
    EXPECT_EQ(solid.shared, (std::array<bool, 6>{}));
  }
}

TEST(RegisterBoxes, KeepsBoxesApartWhoseFacesDifferInSizeOrTurnAway) {
  Scene step;
  step.add(bar({-3, 0, 0}, {0, 0, 0}, 2)).add(bar({0, 0, 0}, {3, 0, 0}, 1)); // areas as 4 to 1
  EXPECT_TRUE(step.registered().joints.empty());
  const Scene corner = chain({{-3, 0, 0}, {0, 0, 0}, {0.3, 3, 0}}, 1); // near a right angle
  EXPECT_TRUE(corner.registered().joints.empty());
}

TEST(RegisterBoxes, DoesNotGrowIntoAPartThatItDoesNotTouch) {
  Scene scene; // a leg with a step in it: joined, the upper half grows wider by the step
  scene.add(bar({0, 3, 0}, {0, 0, 0}, 1)).add(bar({0.25, 0, 0}, {0.25, -3, 0}, 1));
  EXPECT_EQ(scene.registered().joints.size(), 1);
  scene.add(bar({0.85, 3, 0}, {0.85, 0.3, 0}, 0.3)); // another leg, two voxels beside it
  const Registration registration = scene.registered();
  EXPECT_TRUE(registration.joints.empty());
  EXPECT_EQ(registration.verdicts[static_cast<std::size_t>(JointVerdict::runs_into)], 1);
}

TEST(RegisterBoxes, ClosesARingOfEightBoxes) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 8; ++i) {
    points.emplace_back(4 * std::cos(i * std::numbers::pi / 4),
                        4 * std::sin(i * std::numbers::pi / 4), 0);
  }
  const Scene scene = chain(points, 1);
  const Registration registration = scene.registered();
  EXPECT_EQ(registration.joints.size(), 8);
  expect_contained(scene, registration);
  const TriangleMesh ring = united(registration);
  EXPECT_EQ(ring.positions.size(), 32);
  EXPECT_EQ(ring.triangles.size(), 64); // as many as 2 V: a torus
}

TEST(RegisterBoxes, CountsEveryPairOfFacesThatWasAlike) {
  const Registration registration =
      chain({{0, 4, 0}, {0, 1.5, 0}, {0.6, -1, 0}, {0.4, -3.5, 0}}, 1).registered();
  EXPECT_EQ(registration.verdicts[static_cast<std::size_t>(JointVerdict::joined)],
            static_cast<int>(registration.joints.size()));
  for (int v = 0; v < joint_verdicts; ++v) {
    EXPECT_NE(name_of(static_cast<JointVerdict>(v)), "unknown");
  }
}

TEST(RegisterBoxes, RejectsAVoxelOutsideTheGrid) {
  const Scene scene = chain({{-3, 0, 0}, {0, 0, 0}}, 1);
  const std::vector<std::uint32_t> wrong = {static_cast<std::uint32_t>(scene.grid().kinds.size())};
  const std::vector<BoxContents> contents = {{OrientedBox{}, wrong}};
  EXPECT_EQ(register_boxes(scene.grid(), contents).error().code, ErrorCode::invalid_option);
}

TEST(RegisterBoxes, StopsWhenAskedTo) {
  const Scene scene = chain({{-3, 0, 0}, {0, 0, 0}, {3, 0, 0}}, 1);
  StopFlag stop;
  stop.request_stop();
  EXPECT_EQ(register_boxes(scene.grid(), scene.contents(), {}, Progress(stop)).error().code,
            ErrorCode::cancelled);
}

TEST(KeepApart, MakesTheBoxesAsTheyAre) {
  const Scene scene = chain({{-3, 0, 0}, {0, 0, 0}, {2, 2, 0}}, 1);
  const Registration registration = keep_apart(scene.contents());
  ASSERT_EQ(registration.solids.size(), 2);
  for (std::size_t b = 0; b < 2; ++b) {
    const auto corners = scene.contents()[b].box.corners();
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_NEAR((registration.solids[b].corners[i] - corners[i]).norm(), 0, 1e-14);
    }
  }
}

} // namespace
} // namespace cagewright
