#include "envelope/envelope.h"

#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace cagewright {
namespace {

struct Model {
  const char* name;
  TriangleMesh mesh;
};

void PrintTo(const Model& model, std::ostream* out) {
  *out << model.name;
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

TriangleMesh without_every_third_face(TriangleMesh mesh) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (f % 3 != 0) {
      mesh.triangles[kept++] = mesh.triangles[f];
    }
  }
  mesh.triangles.resize(kept);
  return mesh;
}

std::vector<Model> models() {
  const TriangleMesh sphere = make_icosphere(3);
  TriangleMesh stray = sphere;
  stray.positions.emplace_back(2, 2, 2);
  return {{"Sphere", sphere},
          {"Torus", make_torus(0.3, 40, 20)},
          {"Cube", make_cube()},
          {"OneTriangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
          {"OpenSphere", without_every_third_face(sphere)},
          {"TwoSpheres", joined(sphere, moved(sphere, 0.5, {3, 1, 0}))},
          {"StrayVertex", stray},
          {"Tiny", moved(sphere, 1e-6, {0, 0, 0})},
          {"Distant", moved(sphere, 1, {1e4, -1e4, 1e4})}};
}

class EnvelopeOf : public testing::TestWithParam<Model> {};

TEST_P(EnvelopeOf, IsAValidCageThatKeepsTheClearance) {
  const TriangleMesh& model = GetParam().mesh;
  for (const double clearance : {0.002, 0.03}) {
    const Result<Envelope> made = envelope(model, {.resolution = 30, .clearance = clearance});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(validate_cage(made->mesh, model)->valid());
    const double distance = mesh_distance(TriangleBvh(made->mesh), TriangleBvh(model)).distance;
    EXPECT_GE(distance, clearance * bounding_box(TriangleView(model)).diagonal().norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EnvelopeOf, testing::ValuesIn(models()),
                         [](const auto& model) { return model.param.name; });

TEST(Envelope, HasTheGenusOfTheModel) {
  EXPECT_EQ(envelope(make_icosphere(3), {.resolution = 30})->genus, 0);
  EXPECT_EQ(envelope(make_torus(0.3, 60, 30), {.resolution = 30})->genus, 1);
}

TEST(Envelope, FillsTheHoleOfATorusThatClosingCannotEnter) {
  const TriangleMesh torus = make_torus(0.6, 60, 30); // a hole of radius 0.4, diagonal 4.7
  EXPECT_EQ(envelope(torus, {.resolution = 40})->genus, 1);
  EXPECT_EQ(envelope(torus, {.resolution = 40, .closing = 0.05})->genus, 1);
  const Result<Envelope> filled = envelope(torus, {.resolution = 40, .closing = 0.12});
  EXPECT_EQ(filled->genus, 0);
  EXPECT_TRUE(validate_cage(filled->mesh, torus)->valid());
}

TEST(Envelope, JoinsPieces) {
  const TriangleMesh sphere = make_icosphere(2);
  const TriangleMesh pair = joined(sphere, moved(sphere, 1, {5, 0, 0}));
  EXPECT_EQ(envelope(pair, {.resolution = 40})->bridges, 1);
  EXPECT_EQ(envelope(sphere, {.resolution = 40})->bridges, 0);
}

TEST(Envelope, ChoosesAResolutionThatShowsTheTruth) {
  // Two plates so near that a coarse grid sees a handle or none at all.
  const Result<Envelope> made = envelope(make_torus(0.3, 60, 30), {.vertices = 60});
  EXPECT_EQ(made->genus, 1);
  EXPECT_GE(made->resolution, 24);
}

TEST(Envelope, IsTheSameOnOneThreadAsOnMany) {
  const TriangleMesh model = make_torus(0.3, 60, 30);
  const Result<Envelope> many = envelope(model);
  tbb::task_arena(1).execute([&] {
    const Result<Envelope> one = envelope(model);
    EXPECT_EQ(one->mesh.positions, many->mesh.positions);
    EXPECT_EQ(one->mesh.triangles, many->mesh.triangles);
  });
}

TEST(Envelope, RefusesOptionsOutOfRange) {
  EXPECT_EQ(envelope(make_cube(), {.clearance = 0}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(envelope(make_cube(), {.resolution = 1}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(envelope(TriangleMesh()).error().code, ErrorCode::unfit_model);
}

TEST(Envelope, StopsWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  EXPECT_EQ(envelope(make_cube(), {}, Progress(stop)).error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
