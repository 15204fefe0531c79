#include <cagewright/cage/generate.h>

#include "support/models.h"
#include "support/pairing.h"
#include "support/posed_figure.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <optional>

namespace cagewright {
namespace {

using test::posed_figure;

GenerateOptions paired(int vertices) {
  GenerateOptions options;
  options.vertices = vertices;
  options.rounds = 1;
  options.envelope_resolution = 32;
  options.symmetry = Symmetry::topology;
  return options;
}

TEST(PairedCage, OfAPosedFigureIsValidWithinTheBudgetAndPaired) {
  const TriangleMesh model = posed_figure(1, 3).mesh;
  const Result<GeneratedCage> made = generate(model, paired(60));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
  EXPECT_LE(made->faces.positions.size(), 60U);
  EXPECT_TRUE(validate_cage(made->faces, model)->valid());
  ASSERT_TRUE(made->mirror);
  EXPECT_FALSE(made->mirror->in_plane);
  test::expect_paired(*made);
}

TEST(PairedCage, OfQuadsIsPairedToo) {
  const TriangleMesh model = posed_figure(0.6, 3).mesh;
  GenerateOptions options = paired(60);
  options.quads = true;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
  EXPECT_TRUE(made->quads);
  EXPECT_TRUE(validate_cage(made->faces, model)->valid());
  test::expect_paired(*made);
}

TEST(PairedCage, OfAHumanIsAboutAsTightAsWithout) {
  const std::optional<TriangleMesh> human = test::real_model({"human.ply"});
  if (!human) {
    GTEST_SKIP() << "human.ply is not there";
  }
  GenerateOptions options = paired(100);
  const Result<GeneratedCage> made = generate(*human, options);
  options.symmetry = Symmetry::off;
  const Result<GeneratedCage> without = generate(*human, options);
  ASSERT_TRUE(made && without);
  EXPECT_TRUE(made->is_as_asked()) << test::first_remark(*made);
  EXPECT_LE(made->faces.positions.size(), 100U);
  EXPECT_FALSE(made->mirror->in_plane);
  test::expect_paired(*made);
  constexpr double about = 1.05;
  EXPECT_LT(made->figures.volume, about * without->figures.volume);
}

TEST(PairedCage, OfAFigureThatStandsStraightIsItsOwnMirrorImage) {
  const Result<GeneratedCage> made = generate(posed_figure(0, 3).mesh, paired(40));
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_TRUE(made->mirror);
  EXPECT_TRUE(made->mirror->in_plane);
  test::expect_paired_exactly(*made);
}

TEST(PairedCage, OfWhatHasNoLeftAndRightIsOrdinaryAndSaysWhy) {
  const TriangleMesh model = posed_figure(1, 3, 0).mesh;
  const Result<GeneratedCage> made = generate(model, paired(40));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->mirror);
  EXPECT_FALSE(made->is_as_asked());
  ASSERT_FALSE(made->remarks.empty());
  EXPECT_EQ(made->remarks.front().reason, Reason::not_mirrored);
  EXPECT_FALSE(made->remarks.front().message.empty());
  EXPECT_TRUE(validate_cage(made->faces, model)->valid());
}

TEST(PairedCage, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model = posed_figure(0.8, 3).mesh;
  const auto make = [&](int threads) {
    tbb::task_arena arena(threads);
    Result<GeneratedCage> made = Error::cancelled();
    arena.execute([&] { made = generate(model, paired(30)); });
    return made;
  };
  const Result<GeneratedCage> one = make(1);
  const Result<GeneratedCage> three = make(3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->faces.positions, three->faces.positions);
  EXPECT_EQ(one->triangles.triangles, three->triangles.triangles);
}

} // namespace
} // namespace cagewright
