#include <cagewright/cage/generate_for_polygons.h>

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <cmath>

namespace cagewright {
namespace {

GenerateOptions quick() {
  GenerateOptions options;
  options.vertices = 60;
  options.rounds = 0;
  options.symmetry = Symmetry::off;
  options.envelope_resolution = 24;
  options.clearance = 0.001;
  return options;
}

/// A ring of quads with corners in disorder: each quad is bent, its middle here or there.
PolygonMesh bent_ring(std::uint64_t seed, double disorder) {
  constexpr Index around = 8;
  constexpr Index across = 5;
  Random random(seed);
  PolygonMesh mesh;
  for (Index i = 0; i < around; ++i) {
    for (Index k = 0; k < across; ++k) {
      const double a = 6.283185307179586 * i / around;
      const double b = 6.283185307179586 * k / across;
      const double r = 1 + 0.3 * std::cos(b);
      const auto shift = [&] { return disorder * (random.uniform() - 0.5); };
      mesh.positions.emplace_back(r * std::cos(a) + shift(), r * std::sin(a) + shift(),
                                  0.3 * std::sin(b) + shift());
    }
  }
  for (Index i = 0; i < around; ++i) {
    for (Index k = 0; k < across; ++k) {
      const Index j = (i + 1) % around;
      const Index l = (k + 1) % across;
      mesh.add_face({i * across + k, j * across + k, j * across + l, i * across + l});
    }
  }
  return mesh;
}

TEST(GenerateForPolygons, EnclosesBentQuadsHoweverTheyAreCut) {
  int not_enough = 0; // of one way to cut them
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const PolygonMesh model = bent_ring(seed, 1);
    const Triangulation cuttings = every_cutting(model);
    const TriangleView all{model.positions, cuttings.triangles};
    const Result<GeneratedCage> plain = generate(to_triangle_mesh(model), quick());
    ASSERT_TRUE(plain) << plain.error().message;
    not_enough += validate_cage(plain->faces, all)->valid() ? 0 : 1;
    const Result<GeneratedCage> made = generate_for_polygons(model, quick());
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(validate_cage(made->faces, all)->valid()) << seed;
    EXPECT_LT(made->figures.volume_ratio, 10);
    EXPECT_GT(made->figures.volume_ratio, 1);
  }
  EXPECT_GT(not_enough, 0);
}

TEST(GenerateForPolygons, MakesTheSameCageOfFlatPolygons) {
  const TriangleMesh triangles = make_torus(0.3, 24, 12);
  const Result<GeneratedCage> plain = generate(triangles, quick());
  const Result<GeneratedCage> made = generate_for_polygons(PolygonMesh(triangles), quick());
  ASSERT_TRUE(plain && made);
  EXPECT_EQ(plain->faces.positions, made->faces.positions);
}

} // namespace
} // namespace cagewright
