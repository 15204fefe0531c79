#include "mesh/shapes.h"
#include "support/models.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/cage_metrics.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace cagewright {
namespace {

TriangleMesh bar(const Vec3& from, const Vec3& to, double thick) {
  TriangleMesh mesh = make_cube();
  const Vec3 along = to - from;
  const Vec3 z = along.normalized();
  const Vec3 x = z.unitOrthogonal();
  const Vec3 y = z.cross(x);
  for (Vec3& p : mesh.positions) {
    p = (from + to) / 2 + p.z() / 2 * along + thick / 2 * (p.x() * x + p.y() * y);
  }
  return mesh;
}

// Loose bones in the shape of someone standing: none touches another.
TriangleMesh skeleton() {
  TriangleMesh bones = bar({0, 0, 1.6}, {0, 0, 1.8}, 0.15);
  const auto add = [&](Vec3 from, Vec3 to, double thick) {
    for (const double side : {1, -1}) {
      from.x() *= side;
      to.x() *= side;
      bones = joined(bones, bar(from + 0.02 * (to - from), to - 0.02 * (to - from), thick));
    }
  };
  for (int i = 0; i < 20; ++i) {
    const double z = 0.95 + 0.03 * i;
    bones = joined(bones, bar({-0.012, 0, z}, {0.012, 0, z}, 0.02));
  }
  for (int i = 0; i < 10; ++i) {
    const double z = 1.2 + 0.025 * i;
    const double wide = 0.10 + 0.05 * std::sin(0.3 * (i + 1));
    add({0.03, -0.02, z}, {wide, -0.02, z - 0.02}, 0.008);
    add({wide, -0.01, z - 0.02}, {wide, 0.08, z - 0.05}, 0.008);
    add({wide, 0.09, z - 0.05}, {0.02, 0.13, z - 0.06}, 0.008);
  }
  add({0.18, 0, 1.40}, {0.28, 0, 1.12}, 0.025);
  add({0.29, 0, 1.10}, {0.37, 0.02, 0.87}, 0.015);
  add({0.31, -0.03, 1.10}, {0.39, -0.01, 0.87}, 0.015);
  add({0.11, 0, 0.90}, {0.10, 0.02, 0.50}, 0.03);
  add({0.10, 0, 0.46}, {0.09, 0, 0.09}, 0.025);
  for (int k = 0; k < 5; ++k) {
    const double y = -0.03 + 0.018 * k;
    for (int j = 0; j < 4; ++j) {
      add({0.39 + 0.01 * j, y, 0.85 - 0.05 * j}, {0.40 + 0.01 * j, y, 0.81 - 0.05 * j}, 0.009);
    }
    const double x = 0.05 + 0.017 * k;
    for (int j = 0; j < 3; ++j) {
      add({x, 0.03 + 0.045 * j, 0.03}, {x, 0.065 + 0.045 * j, 0.03}, 0.009);
    }
  }
  return bones;
}

// Rods along the edges of a lattice, in pieces that cross each other: many handles.
TriangleMesh lattice(int cells) {
  TriangleMesh rods;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      rods = joined(rods, bar(Vec3(-0.1, i, j), Vec3(cells + 0.1, i, j), 0.2));
      rods = joined(rods, bar(Vec3(i, -0.1, j), Vec3(i, cells + 0.1, j), 0.21));
      rods = joined(rods, bar(Vec3(i, j, -0.1), Vec3(i, j, cells + 0.1), 0.22));
    }
  }
  return rods;
}

struct Figures {
  double volume = 0;
  double farthest = 0; // in diagonals
};

Figures of_cage(const TriangleMesh& model, int vertices) {
  GenerateOptions options;
  options.vertices = vertices;
  const Result<GeneratedCage> made = generate(model, options);
  EXPECT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->is_as_asked());
  const CageMetrics metrics = measure_cage(TriangleView(made->triangles), model);
  return {metrics.volume, metrics.max_distance};
}

// Each within a hundredth of what fewer vertices enclose, or less.
void expect_tighter(const TriangleMesh& model, const std::vector<int>& budgets) {
  double before = std::numeric_limits<double>::infinity();
  for (const int vertices : budgets) {
    const double volume = of_cage(model, vertices).volume;
    EXPECT_LE(volume, 1.01 * before) << vertices << " vertices";
    before = std::min(before, volume);
  }
}

TEST(MoreVertices, GiveATighterCageOfLooseBones) {
  const TriangleMesh bones = skeleton();
  expect_tighter(bones, {25, 50, 100});
}

TEST(MoreVertices, GiveATighterCageOfALattice) {
  expect_tighter(lattice(3), {25, 50, 100});
}

TEST(MoreVertices, GiveATighterCageOfAFigure) {
  const auto model = test::real_model({"rigged_figure.glb", "pig.off"});
  if (!model) {
    GTEST_SKIP() << "no real model";
  }
  expect_tighter(*model, {25, 50, 100, 200});
}

} // namespace
} // namespace cagewright
