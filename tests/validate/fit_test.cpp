#include <cagewright/validate/fit.h>

#include "mesh/shapes.h"
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <numbers>

namespace cagewright {
namespace {

/// A body that is no other way up the same: long, broad, flat, and heavier at one end.
TriangleMesh model() {
  TriangleMesh mesh = make_icosphere(2);
  for (Vec3& p : mesh.positions) {
    const double thick = 1 + 0.5 * p.x();
    p = Vec3(4 * p.x() + 3, 2 * thick * p.y() + 10, thick * p.z() - 1 + 0.4 * p.x() * p.x());
  }
  return mesh;
}

/// Round the model, 1.2 times as large.
PolygonMesh cage() {
  PolygonMesh mesh{model()};
  const Vec3 center(3, 10, -1);
  for (Vec3& p : mesh.positions) {
    p = center + 1.2 * (p - center);
  }
  return mesh;
}

template <class Change> PolygonMesh changed(Change change) {
  PolygonMesh mesh = cage();
  for (Vec3& p : mesh.positions) {
    p = change(p);
  }
  return mesh;
}

void expect_mended(const PolygonMesh& wrong, const char* word) {
  const auto fit = fit_cage(wrong, model());
  ASSERT_TRUE(fit) << word;
  EXPECT_NE(fit->description.find(word), std::string::npos) << fit->description;
  EXPECT_TRUE(validate_cage((*fit)(wrong), model())->valid()) << fit->description;
}

TEST(FitCage, LeavesACageThatFits) {
  EXPECT_FALSE(fit_cage(cage(), model()));
}

TEST(FitCage, FindsTheUnit) {
  for (const double unit : {0.01, 100.0, 0.001, 1000.0, 2.54, 25.4, 0.0254, 0.3048}) {
    expect_mended(changed([&](const Vec3& p) { return Vec3(unit * p); }), "scaled by ");
  }
}

TEST(FitCage, FindsTheUpAxis) {
  expect_mended(changed([](const Vec3& p) { return Vec3(p.x(), p.z(), -p.y()); }),
                "turned by 90 degrees about the x axis (y up to z up)");
  expect_mended(changed([](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }),
                "turned by -90 degrees about the x axis (z up to y up)");
  expect_mended(changed([](const Vec3& p) { return Vec3(p.y(), -p.x(), p.z()); }),
                "about the z axis");
}

TEST(FitCage, FindsTheShift) {
  expect_mended(changed([](const Vec3& p) { return Vec3(p + Vec3(20, 0, 0)); }), "shifted by (-20");
}

TEST(FitCage, FindsThemTogether) {
  expect_mended(changed([](const Vec3& p) { return Vec3(100 * Vec3(p.x(), p.z(), -p.y())); }),
                "scaled by 0.01 (centimetres against metres) and turned by 90");
  expect_mended(changed([](const Vec3& p) { return Vec3(100 * (p - Vec3(3, 10, -1))); }),
                "shifted");
}

/// As tight as cages are made, and farther off on one side: its box is not about the model's
/// middle.
PolygonMesh lopsided_cage() {
  PolygonMesh mesh{model()};
  for (Vec3& p : mesh.positions) {
    const double times = p.x() > 3 ? 1.3 : 1.04;
    p = Vec3(3 + times * (p.x() - 3), 10 + 1.04 * (p.y() - 10), -1 + 1.1 * (p.z() + 1));
  }
  return mesh;
}

TEST(FitCage, FindsThePlaceOfATightCage) {
  ASSERT_TRUE(validate_cage(lopsided_cage(), model())->valid());
  for (const bool scaled : {false, true}) {
    for (const bool turned : {false, true}) {
      PolygonMesh wrong = lopsided_cage();
      for (Vec3& p : wrong.positions) {
        p += Vec3(-40, 7, 30);
        p = turned ? Vec3(p.x(), -p.z(), p.y()) : p;
        p *= scaled ? 100 : 1;
      }
      expect_mended(wrong, "shifted by ");
    }
  }
}

TEST(FitCage, SaysNothingOfAnotherCage) {
  // Round one half of the model only: no change as a whole mends that.
  const PolygonMesh half = changed(
      [](const Vec3& p) { return Vec3(p.x() < 3 ? p.x() : 3 + 0.01 * (p.x() - 3), p.y(), p.z()); });
  EXPECT_FALSE(fit_cage(half, model()));
  EXPECT_FALSE(fit_cage(PolygonMesh(), model()));
  EXPECT_FALSE(fit_cage(cage(), TriangleMesh()));
}

} // namespace
} // namespace cagewright
