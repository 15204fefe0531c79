#include <cagewright/cage/generate.h>

#include "core/maths.h"
#include "mesh/shapes.h"
#include "support/models.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using Map = std::function<Vec3(const Vec3&)>;

PolygonMesh mapped(PolygonMesh mesh, const Map& map) {
  for (Vec3& p : mesh.positions) {
    p = map(p);
  }
  return mesh;
}

TriangleMesh mapped(TriangleMesh mesh, const Map& map) {
  for (Vec3& p : mesh.positions) {
    p = map(p);
  }
  return mesh;
}

Vec3 shrunk(const Vec3& p) {
  return 0.85 * p + Vec3(0.02, -0.01, 0.03);
}

Vec3 bent(const Vec3& p) {
  const double angle = 0.4 * p.x();
  return {p.x(), maths::cos(angle) * p.y() - maths::sin(angle) * p.z(),
          maths::sin(angle) * p.y() + maths::cos(angle) * p.z() + 0.15 * p.x() * p.x()};
}

bool has_same_faces(const PolygonMesh& a, const PolygonMesh& b) {
  return a.face_count() == b.face_count() && std::ranges::equal(a.corners(), b.corners());
}

struct Example {
  TriangleMesh model = make_torus(0.3, 32, 16);
  PolygonMesh cage;

  explicit Example(bool quads) {
    const Result<GeneratedCage> made =
        generate(model, {.vertices = 40, .quads = quads, .symmetry = Symmetry::off, .rounds = 1});
    cage = made ? made->faces : PolygonMesh();
  }
};

class OwnCage : public testing::TestWithParam<bool> {};

// The cages are those of the model itself, moved so that much of it is outside: the result has to
// be about as tight as they were.
TEST_P(OwnCage, IsLaidRoundTheModelAgain) {
  const Example example(GetParam());
  ASSERT_GT(example.cage.face_count(), 0U);
  const double before = signed_volume(to_triangle_mesh(example.cage));
  for (const Map& map : {Map([](const Vec3& p) { return p; }), Map(shrunk), Map(bent)}) {
    const PolygonMesh start = mapped(example.cage, map);
    const Result<GeneratedCage> made = generate(example.model, {.start = &start});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->is_own);
    EXPECT_TRUE(made->is_as_asked());
    EXPECT_TRUE(has_same_faces(made->faces, start));
    EXPECT_TRUE(validate_cage(made->faces, example.model)->valid());
    EXPECT_LT(made->figures.volume, 1.1 * before);
    EXPECT_EQ(made->quads.has_value(), GetParam());
  }
}

TEST_P(OwnCage, FollowsAnEditedModel) {
  const Example example(GetParam());
  const TriangleMesh edited = mapped(example.model, bent);
  ASSERT_FALSE(validate_cage(example.cage, edited)->valid());
  const Result<GeneratedCage> made = generate(edited, {.start = &example.cage});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(has_same_faces(made->faces, example.cage));
  EXPECT_TRUE(validate_cage(made->faces, edited)->valid());
}

INSTANTIATE_TEST_SUITE_P(TrianglesAndQuads, OwnCage, testing::Bool());

TEST(OwnCageGiven, IsMadeTightWhereItIsLoose) {
  const TriangleMesh model = make_icosphere(3);
  const PolygonMesh start =
      mapped(PolygonMesh(make_icosphere(1)), [](const Vec3& p) { return Vec3(3 * p); });
  const Result<GeneratedCage> made = generate(model, {.clearance = 0.01, .start = &start});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_LT(made->figures.volume, 1.3 * signed_volume(model));
  EXPECT_EQ(made->clearance, 0.01);
}

TEST(OwnCageGiven, DoesNotDependOnUnitOrPlaceOrThreads) {
  const Example example(false);
  const PolygonMesh start = mapped(example.cage, shrunk);
  const Result<GeneratedCage> made = generate(example.model, {.start = &start});
  ASSERT_TRUE(made);
  Result<GeneratedCage> alone = Error::cancelled();
  tbb::task_arena(1).execute([&] { alone = generate(example.model, {.start = &start}); });
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->faces.positions, made->faces.positions);

  const Map far = [](const Vec3& p) { return Vec3(1000 * p + Vec3(5e4, -2e4, 1e4)); };
  const PolygonMesh far_start = mapped(start, far);
  const TriangleMesh far_model = mapped(example.model, far);
  const Result<GeneratedCage> moved = generate(far_model, {.start = &far_start});
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_NEAR(moved->figures.volume / made->figures.volume, 1e9, 1e7);
}

TEST(OwnCageGiven, IsTurnedAndWeldedAndTold) {
  const TriangleMesh model = make_icosphere(2);
  const TriangleMesh around = make_icosphere(1);
  PolygonMesh start; // every corner a vertex of its own, inside out
  for (const Triangle& t : around.triangles) {
    const auto first = static_cast<Index>(start.positions.size());
    for (const Index v : {t[0], t[2], t[1]}) {
      start.positions.push_back(1.1 * around.positions[v]);
    }
    start.add_face({first, first + 1, first + 2});
  }
  start.positions.emplace_back(5, 5, 5); // no face has it
  const Result<GeneratedCage> made = generate(model, {.start = &start});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->faces.positions.size(), around.positions.size());
  EXPECT_TRUE(made->is_as_asked());
  ASSERT_EQ(made->remarks.size(), 1U);
  EXPECT_EQ(made->remarks[0].reason, Reason::start_changed);
  for (const char* part : {"merged", "left out", "turned to face outward"}) {
    EXPECT_NE(made->remarks[0].message.find(part), std::string::npos) << made->remarks[0].message;
  }
}

TEST(OwnCageGiven, IsRefusedWhereMovingItsVerticesCannotMendIt) {
  const TriangleMesh model = make_icosphere(2);
  TriangleMesh open = make_icosphere(1);
  open.triangles.pop_back();
  const PolygonMesh start(open);
  const Result<GeneratedCage> made = generate(model, {.start = &start});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid_cage);
  EXPECT_NE(made.error().message.find("it is open: 3 edges"), std::string::npos)
      << made.error().message;

  PolygonMesh two(make_icosphere(0));
  const auto count = static_cast<Index>(two.positions.size());
  const PolygonMesh one = two;
  for (const Vec3& p : one.positions) {
    two.positions.push_back(p + Vec3(9, 0, 0));
  }
  for (std::size_t f = 0; f < one.face_count(); ++f) {
    const auto t = one.face(f);
    two.add_face({t[0] + count, t[1] + count, t[2] + count});
  }
  const Result<GeneratedCage> pieces = generate(model, {.start = &two});
  ASSERT_FALSE(pieces);
  EXPECT_NE(pieces.error().message.find("2 pieces"), std::string::npos) << pieces.error().message;
}

TEST(OwnCageGiven, OfTooFewFacesIsRefusedNotWrong) {
  // A torus cannot be enclosed by moving the corners of another torus through itself: whatever
  // comes out is valid, or an error.
  const TriangleMesh model = make_torus(0.3, 24, 12);
  const PolygonMesh start(
      mapped(make_torus(0.3, 5, 3), [](const Vec3& p) { return Vec3(p.z(), 0.1 * p.x(), p.y()); }));
  const Result<GeneratedCage> made = generate(model, {.start = &start});
  if (made) {
    EXPECT_TRUE(validate_cage(made->faces, model)->valid());
  } else {
    EXPECT_EQ(made.error().code, ErrorCode::no_valid_cage);
  }
}

TEST(OwnCageGiven, ByHandRoundRealModelsBecomesTight) {
  int tried = 0;
  for (const auto& [model_name, cage_name] : {std::pair("giraffe.obj", "giraffe_cage.obj"),
                                              std::pair("octopus.obj", "octopus_cage.obj")}) {
    const auto model = test::real_model({model_name});
    const auto cage = test::real_polygons({cage_name});
    if (!model || !cage) {
      continue;
    }
    ++tried;
    const double before = signed_volume(to_triangle_mesh(*cage));
    PolygonMesh start = *cage;
    const Vec3 middle = bounding_box(*model).center();
    start = mapped(start, [&](const Vec3& p) { return Vec3(middle + 0.9 * (p - middle)); });
    const Result<GeneratedCage> made = generate(*model, {.start = &start});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(validate_cage(made->faces, *model)->valid());
    EXPECT_LT(made->figures.volume, before);
  }
  if (tried == 0) {
    GTEST_SKIP() << "needs the models that have cages made by hand";
  }
}

} // namespace
} // namespace cagewright
