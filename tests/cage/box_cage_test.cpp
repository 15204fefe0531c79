#include "cage/box_cage.h"

#include "core/random.h"
#include "mesh/shapes.h"
#include "mesh/topology.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <mutex>

namespace cagewright {
namespace {

GenerateOptions options_at(int depth, SlicingRule rule = SlicingRule::volume) {
  GenerateOptions options;
  options.resolution = 32; // coarse, so that the tests are quick
  options.depth = depth;
  options.slicing = rule;
  return options;
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) {
    std::swap(t[0], t[1]);
  }
  return mesh;
}

TriangleMesh with_every_tenth_face_missing(TriangleMesh mesh) {
  for (std::size_t f = 0; f < mesh.triangles.size(); f += 9) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(f));
  }
  return mesh;
}

TriangleMesh doubled(TriangleMesh mesh) {
  const std::vector<Triangle> once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  return mesh;
}

TriangleMesh soup(std::size_t count) {
  Random random(17);
  TriangleMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3 center(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int i = 0; i < 3; ++i) {
      mesh.positions.push_back(
          center + 0.2 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    }
    const auto first = static_cast<Index>(3 * t);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TriangleMesh flat_sheet() {
  TriangleMesh sheet;
  for (Index j = 0; j < 5; ++j) {
    for (Index i = 0; i < 9; ++i) {
      sheet.positions.emplace_back(i, j, 0.5 * i);
    }
  }
  for (Index j = 0; j < 4; ++j) {
    for (Index i = 0; i < 8; ++i) {
      const Index a = i + 9 * j;
      sheet.triangles.push_back({a, a + 1, a + 10});
      sheet.triangles.push_back({a, a + 10, a + 9});
    }
  }
  return sheet;
}

struct Model {
  const char* name;
  std::function<TriangleMesh()> make;
};

void PrintTo(const Model& model, std::ostream* out) {
  *out << model.name;
}

const std::vector<Model> models = {
    {"Cube", [] { return make_cube(); }},
    {"Sphere", [] { return make_icosphere(3); }},
    {"Torus", [] { return make_torus(0.25, 48, 24); }},
    {"ThinTorus", [] { return make_torus(0.01, 96, 6); }},
    {"Inverted", [] { return inverted(make_torus(0.3, 32, 16)); }},
    {"Open", [] { return with_every_tenth_face_missing(make_icosphere(3)); }},
    {"Doubled", [] { return doubled(make_icosphere(2)); }},
    {"Linked",
     [] {
       return joined(make_torus(0.2, 32, 16), moved(make_cube(), 0.4, {1, 0, 0}));
     }},
    {"FarApart",
     [] {
       return joined(make_icosphere(2), moved(make_cube(), 0.5, {9, 3, 1}));
     }},
    {"SingleTriangle",
     [] {
       return TriangleMesh{{{0, 0, 0}, {4, 1, 0}, {1, 3, 2}}, {{0, 1, 2}}};
     }},
    {"FlatSheet", [] { return flat_sheet(); }},
    {"Soup", [] { return soup(300); }},
    {"StrayVertex",
     [] {
       TriangleMesh mesh = make_icosphere(2);
       mesh.positions.emplace_back(2, 2, 2);
       return mesh;
     }},
    {"DegenerateFaces",
     [] {
       TriangleMesh mesh = make_icosphere(2);
       mesh.triangles.push_back({3, 3, 3});
       mesh.triangles.push_back({4, 9, 4});
       return mesh;
     }},
};

class BoxCageFor : public testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(Models, BoxCageFor, testing::ValuesIn(models),
                         [](const auto& model) { return model.param.name; });

TEST_P(BoxCageFor, IsValidAtEveryDepthWithBothRules) {
  const TriangleMesh model = GetParam().make();
  for (const SlicingRule rule : {SlicingRule::volume, SlicingRule::published}) {
    for (const int depth : {0, 1, 2, 4, 6}) {
      SCOPED_TRACE(std::string(name_of(rule)) + " depth " + std::to_string(depth));
      const Result<BoxCage> made = make_box_cage(model, options_at(depth, rule));
      ASSERT_TRUE(made) << made.error().message;
      const Result<ValidityReport> report = validate_cage(TriangleView(made->cage), model);
      ASSERT_TRUE(report && report->valid());
      EXPECT_GT(signed_volume(made->cage), 0);
      if (depth == 0) {
        EXPECT_EQ(made->cage.positions.size(), 8U);
      }
    }
  }
}

TEST_P(BoxCageFor, IsTheSameUpToSimilarity) {
  const TriangleMesh model = GetParam().make();
  const Result<BoxCage> reference = make_box_cage(model, options_at(3));
  ASSERT_TRUE(reference) << reference.error().message;
  const double diag = diagonal(model.positions);
  const Vec3 away(1e4 * diag, -3e4 * diag, 2e4 * diag);
  for (const auto& [scale, offset] : {std::pair(1e-6, Vec3(0, 0, 0)), std::pair(1e6, Vec3(0, 0, 0)),
                                      std::pair(1.0, away), std::pair(3e-5, Vec3(3e-5 * away))}) {
    SCOPED_TRACE(scale);
    const Result<BoxCage> made = make_box_cage(moved(model, scale, offset), options_at(3));
    ASSERT_TRUE(made) << made.error().message;
    ASSERT_EQ(made->cage.triangles, reference->cage.triangles);
    for (std::size_t v = 0; v < made->cage.positions.size(); ++v) {
      const Vec3 back = (made->cage.positions[v] - offset) / scale;
      EXPECT_LT((back - reference->cage.positions[v]).norm(), 1e-6 * diag);
    }
  }
}

TEST(BoxCage, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model =
      joined(make_torus(0.25, 48, 24), moved(make_icosphere(3), 0.5, {1, 0, 0}));
  const auto cage_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] {
      Result<BoxCage> made = make_box_cage(model, options_at(5));
      EXPECT_TRUE(made);
      return made ? std::move(made->cage) : TriangleMesh{};
    });
  };
  const TriangleMesh one = cage_with(1);
  for (const int threads : {2, 4}) {
    const TriangleMesh many = cage_with(threads);
    EXPECT_EQ(one.positions, many.positions);
    EXPECT_EQ(one.triangles, many.triangles);
  }
}

TEST(BoxCage, JoinsPiecesUnlessAskedNotTo) {
  const TriangleMesh model = joined(make_icosphere(2), moved(make_icosphere(2), 1, {6, 0, 0}));
  GenerateOptions options = options_at(2);
  const Result<BoxCage> together = make_box_cage(model, options);
  ASSERT_TRUE(together) << together.error().message;
  EXPECT_EQ(together->made->boxes.bridges, 1);
  EXPECT_EQ(topology(TriangleView(together->cage)).components, 1U);
  options.pieces = Pieces::apart;
  const Result<BoxCage> apart = make_box_cage(model, options);
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_EQ(topology(TriangleView(apart->cage)).components, 2U);
}

TEST(BoxCage, ReportsProgressThatNeverFalls) {
  double last = 0;
  bool falls = false;
  std::mutex guard;
  const Progress progress({}, [&](double fraction, std::string_view) {
    const std::scoped_lock lock(guard);
    falls = falls || fraction < last;
    last = fraction;
  });
  ASSERT_TRUE(make_box_cage(make_torus(0.25, 48, 24), options_at(4), 0, progress));
  EXPECT_FALSE(falls);
  EXPECT_GT(last, 0.5);
  EXPECT_LE(last, 1);
}

TEST(BoxCage, StopsWhereverItIsAskedTo) {
  for (const double when : {0.0, 0.2, 0.34, 0.5}) {
    StopFlag stop;
    const Progress progress(stop, [&](double fraction, std::string_view) {
      if (fraction >= when) {
        stop.request_stop();
      }
    });
    const Result<BoxCage> made =
        make_box_cage(make_torus(0.25, 48, 24), options_at(4), 0, progress);
    ASSERT_FALSE(made) << when;
    EXPECT_EQ(made.error().code, ErrorCode::cancelled);
  }
}

TEST(BoxCage, RefusesModelsWithoutExtent) {
  const std::vector<Triangle> face = {{0, 1, 2}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<TriangleMesh> unfit = {
      {{}, {}},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}},
      {{{2, 3, 4}, {2, 3, 4}, {2, 3, 4}}, face},
      {{{0, 0, 0}, {1, 1, 1}, {7, 7, 7}}, face},
      {{{0, 0, 0}, {1, nan, 1}, {0, 7, 7}}, face},
      {{{1e12, 0, 0}, {1e12 + 1, 0, 0}, {1e12, 1, 0}}, face},
      {{{-1e308, 0, 0}, {1e308, 1e308, 0}, {0, 0, 1e308}}, face},
  };
  for (const TriangleMesh& model : unfit) {
    const Result<BoxCage> made = make_box_cage(model);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::unfit_model) << made.error().message;
  }
}

TEST(BoxCage, RefusesOptionsOutOfRange) {
  GenerateOptions options;
  options.resolution = 4;
  EXPECT_EQ(make_box_cage(make_cube(), options).error().code, ErrorCode::invalid_option);
  options = {};
  options.depth = 99;
  EXPECT_EQ(make_box_cage(make_cube(), options).error().code, ErrorCode::invalid_option);
}

TEST(BoxCage, KeepsTheHoleOfATorusOnceItIsCut) {
  GenerateOptions options = options_at(3);
  const Result<BoxCage> whole = make_box_cage(make_torus(0.2, 48, 24), options_at(0));
  const Result<BoxCage> cut = make_box_cage(make_torus(0.2, 48, 24), options);
  ASSERT_TRUE(whole && cut);
  EXPECT_EQ(topology(TriangleView(whole->cage)).genus, 0);
  EXPECT_EQ(topology(TriangleView(cut->cage)).genus, 1);
  EXPECT_LT(signed_volume(cut->cage), 0.75 * signed_volume(whole->cage));
}

} // namespace
} // namespace cagewright
