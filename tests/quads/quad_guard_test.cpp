#include "quads/quad_guard.h"

#include "mesh/shapes.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

/// A quad bent upward along the diagonal from 0 to 2, over a model that is one small tetrahedron.
struct Scene {
  explicit Scene(const Vec3& at, double size = 0.01) : surface(crumb(at, size)) {}

  static TriangleMesh crumb(const Vec3& at, double size) {
    TriangleMesh mesh = make_tetrahedron();
    for (Vec3& p : mesh.positions) {
      p = at + size * p;
    }
    return mesh;
  }
  [[nodiscard]] bool is_clear(bool tentative) const {
    CageFace quad = CageFace::quad(0, 1, 2, 3);
    quad.tentative = tentative;
    return QuadGuard(surface, 1e-4, {}).is_clear(positions, quad);
  }

  std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, -0.3}, {1, 1, 0}, {0, 1, -0.3}};
  ModelSurface surface;
};

TEST(QuadGuard, SeesAModelOnEitherDiagonal) {
  EXPECT_TRUE(Scene(Vec3(0.5, 0.5, 0.5)).is_clear(false));
  EXPECT_FALSE(Scene(Vec3(0.5, 0.5, 0)).is_clear(false));    // on the first
  EXPECT_FALSE(Scene(Vec3(0.5, 0.5, -0.3)).is_clear(false)); // on the second
}

TEST(QuadGuard, SeesAPartOfTheModelBetweenTheTwoCuttings) {
  EXPECT_FALSE(Scene(Vec3(0.5, 0.5, -0.15)).is_clear(false));
  EXPECT_TRUE(Scene(Vec3(0.5, 0.5, -0.45)).is_clear(false));
}

TEST(QuadGuard, AsksOfATentativeQuadOnlyItsFirstDiagonal) {
  EXPECT_FALSE(Scene(Vec3(0.5, 0.5, 0)).is_clear(true));
  EXPECT_TRUE(Scene(Vec3(0.5, 0.5, -0.3)).is_clear(true));
}

/// Two quads of a cage that meet along one side, each with its own bend.
TEST(QuadGuard, SeesFacesThatMeetAlongADiagonal) {
  // A tetrahedron as two triangles and the quad over them: the quad's first diagonal is the side
  // that the two triangles share.
  const TriangleMesh mesh = make_tetrahedron();
  QuadCage cage(mesh);
  const CageFace a = cage.face(0);
  int shared = 0;
  const CageFace b = cage.face(1);
  while (a.has(b[shared])) {
    ++shared;
  }
  const Index apex = b[shared];
  int k = 0;
  while (b.has(a[k])) {
    ++k;
  }
  const CageFace quad = CageFace::quad(a[k], a[k + 1], apex, a[k + 2]);
  cage.replace(std::array<Index, 2>{0, 1}, std::array{quad});
  const Scene far(Vec3(9, 9, 9));
  const QuadGuard guard(far.surface, 1e-4, {});
  EXPECT_TRUE(guard.is_crossed(cage, cage.positions(), face_boxes(cage, cage.positions()), quad,
                               cage.face_end() - 1));
}

TEST(QuadGuard, LetsTheFacesOfAClosedSurfaceTouchAtTheirSides) {
  const TriangleMesh mesh = make_icosphere(1);
  const QuadCage cage(mesh);
  const Scene far(Vec3(9, 9, 9));
  const QuadGuard guard(far.surface, 1e-4, {});
  const std::vector<Box3> boxes = face_boxes(cage, cage.positions());
  for (Index f = 0; f < cage.face_end(); ++f) {
    EXPECT_FALSE(guard.is_crossed(cage, cage.positions(), boxes, cage.face(f), f));
  }
}

} // namespace
} // namespace cagewright
