#include "app/edit/cage_watch.h"

#include "core/random.h"
#include "mesh/shapes.h"
#include "quads.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace cagewright::app {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& p : mesh.positions) {
    p = p * factor + shift;
  }
  return mesh;
}

struct Case {
  const char* name;
  PolygonMesh cage;
  TriangleMesh model;
};

std::vector<Case> cases() {
  const TriangleMesh ball = scaled(make_icosphere(2), 0.7);
  return {{"quads round a ball", test::quad_cube(3), ball},
          {"triangles round a ball", PolygonMesh(scaled(make_icosphere(1), 1.1)), ball},
          {"a torus in quads", test::quad_torus(10, 5), scaled(make_torus(0.2, 16, 8), 1)},
          {"two parts", test::quad_cube(2),
           joined(scaled(make_icosphere(1), 0.3, {0.5, 0, 0}),
                  scaled(make_icosphere(1), 0.3, {-0.5, 0.1, 0}))}};
}

/// What validate_cage() says about faces.
std::set<Index> faces_of(const ValidityReport& report) {
  std::set<Index> faces;
  for (const Violation& v : report.violations) {
    if (v.kind == ViolationKind::self_intersection) {
      faces.insert(v.elements.begin(), v.elements.end());
    } else if (v.kind == ViolationKind::face_contact) {
      faces.insert(v.elements[1]);
    } else if (v.kind == ViolationKind::degenerate_face) {
      faces.insert(v.elements[0]);
    }
  }
  return faces;
}

TEST(CageWatch, AgreesWithTheJudgeOnRandomMoves) {
  Random random(15);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    CageWatch watch(c.cage, std::make_shared<const WatchedModel>(c.model));
    int valid = 0;
    int invalid = 0;
    for (int i = 0; i < 120; ++i) {
      std::vector<Index> vertices;
      std::vector<Vec3> to;
      for (std::uint64_t n = 1 + random.below(3); n-- > 0;) {
        const auto v = static_cast<Index>(random.below(c.cage.positions.size()));
        if (std::find(vertices.begin(), vertices.end(), v) != vertices.end()) {
          continue;
        }
        vertices.push_back(v);
        // Often home again, so that valid states are seen, too.
        const double reach = random.below(2) == 0 ? 0.02 : 0.6;
        to.push_back(c.cage.positions[v] + reach * Vec3(random.uniform(-1, 1),
                                                        random.uniform(-1, 1),
                                                        random.uniform(-1, 1)));
      }
      if (i % 3 == 0) {
        vertices.clear();
        to = c.cage.positions;
        for (Index v = 0; v < to.size(); ++v) {
          vertices.push_back(v);
        }
      }
      watch.move(vertices, to);
      const auto report = validate_cage(watch.cage(), c.model, {.max_listed = 100000});
      ASSERT_TRUE(report);
      EXPECT_EQ(watch.is_valid(), report->valid());
      const std::vector<Index> bad = watch.bad_faces();
      EXPECT_EQ(std::set<Index>(bad.begin(), bad.end()), faces_of(*report));
      (report->valid() ? valid : invalid) += 1;
    }
    EXPECT_GT(valid, 10);
    EXPECT_GT(invalid, 10);
  }
}

TEST(CageWatch, SeesAModelLeftOutside) {
  const TriangleMesh ball = scaled(make_icosphere(1), 0.1);
  const PolygonMesh cage = test::quad_cube();
  CageWatch watch(cage, std::make_shared<const WatchedModel>(ball));
  EXPECT_TRUE(watch.is_valid());
  std::vector<Index> all;
  std::vector<Vec3> away;
  for (Index v = 0; v < 8; ++v) {
    all.push_back(v);
    away.emplace_back(cage.positions[v] + Vec3(5, 0, 0)); // over it, touching nothing at the end
  }
  watch.move(all, away);
  EXPECT_FALSE(watch.is_valid());
  EXPECT_EQ(watch.points_outside().size(), 1U);
  EXPECT_TRUE(watch.bad_faces().empty());
  watch.move(all, cage.positions);
  EXPECT_TRUE(watch.is_valid());
}

TEST(CageWatch, SeesACageTurnedInsideOut) {
  const PolygonMesh cage = test::quad_cube();
  CageWatch watch(cage, nullptr);
  std::vector<Index> all = {0, 1, 2, 3, 4, 5, 6, 7};
  std::vector<Vec3> mirrored = cage.positions;
  for (Vec3& p : mirrored) {
    p.x() = -p.x();
  }
  watch.move(all, mirrored);
  EXPECT_FALSE(watch.is_valid());
}

TEST(CageWatch, StopsAtContactAndStaysValid) {
  Random random(16);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    CageWatch watch(c.cage, std::make_shared<const WatchedModel>(c.model));
    ASSERT_TRUE(watch.is_valid());
    int stopped = 0;
    int free = 0;
    for (int i = 0; i < 40; ++i) {
      const auto v = static_cast<Index>(random.below(c.cage.positions.size()));
      const Vec3 start = watch.cage().positions[v];
      const Vec3 target =
          start + random.uniform(0, 2) *
                      Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const double fraction = watch.advance(std::span(&v, 1), std::span(&target, 1));
      ASSERT_TRUE(validate_cage(watch.cage(), c.model)->valid());
      const Vec3 at = watch.cage().positions[v];
      EXPECT_TRUE(at.isApprox(start + fraction * (target - start), 1e-9));
      if (fraction < 1) {
        ++stopped;
        // A little further is not allowed.
        CageWatch further = watch;
        const Vec3 next = start + std::min(1.0, fraction + 0.01) * (target - start);
        further.move(std::span(&v, 1), std::span(&next, 1));
        EXPECT_FALSE(further.is_valid());
      } else {
        EXPECT_EQ(at, target);
        ++free;
      }
    }
    EXPECT_GT(stopped, 3);
    EXPECT_GT(free, 3);
  }
}

TEST(CageWatch, DoesNotHoldBackTheMendingOfAnInvalidCage) {
  const PolygonMesh cage = test::quad_cube();
  const TriangleMesh ball = scaled(make_icosphere(1), 0.5);
  CageWatch watch(cage, std::make_shared<const WatchedModel>(ball));
  const Index v = 0;
  const Vec3 inside = Vec3(0.1, 0.1, 0.1);
  watch.move(std::span(&v, 1), std::span(&inside, 1));
  ASSERT_FALSE(watch.is_valid());
  const Vec3 still_bad = cage.positions[v] * 0.2;
  EXPECT_EQ(watch.advance(std::span(&v, 1), std::span(&still_bad, 1)), 1);
  EXPECT_EQ(watch.advance(std::span(&v, 1), std::span(&cage.positions[v], 1)), 1);
  EXPECT_TRUE(watch.is_valid());
}

TEST(CageWatch, TellsOfACageThatIsNotClosed) {
  PolygonMesh open = test::quad_cube();
  PolygonMesh five;
  five.positions = open.positions;
  for (std::size_t f = 0; f < 5; ++f) {
    five.add_face(open.face(f));
  }
  CageWatch watch(five, nullptr);
  EXPECT_FALSE(watch.has_sound_topology());
  EXPECT_FALSE(watch.is_valid());
}

} // namespace
} // namespace cagewright::app
