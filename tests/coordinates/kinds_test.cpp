#include <cagewright/coordinates/kinds.h>

#include "coordinates/laws.h"
#include <cagewright/coordinates/green.h>
#include <cagewright/coordinates/mean_value.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace cagewright {
namespace {

TEST(CoordinateKinds, AreNamedOnceAndDescribed) {
  std::set<std::string_view> names;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    EXPECT_TRUE(names.insert(kind->name).second) << kind->name;
    EXPECT_EQ(find_coordinate_kind(kind->name), kind);
    for (const std::string_view text :
         {kind->idea, kind->quads, kind->sign, kind->reproduces, kind->on_cage, kind->outside,
          kind->locality, kind->made_by, kind->cost}) {
      EXPECT_FALSE(text.empty()) << kind->name;
    }
    EXPECT_TRUE(kind->prepare != nullptr && kind->rule != nullptr) << kind->name;
  }
  EXPECT_EQ(CoordinateSettings().kind().name, "mean_value");
  EXPECT_EQ(find_coordinate_kind("teapot"), nullptr);
}

/// Options of one name are one option: command lines and files know them by it.
TEST(CoordinateKinds, ShareTheirOptions) {
  std::set<std::string_view> names;
  for (const CoordinateOption* option : coordinate_options()) {
    EXPECT_TRUE(names.insert(option->name).second) << option->name;
    EXPECT_FALSE(option->help.empty());
  }
}

TEST(CoordinateKinds, HaveTheColumnsThatTheirRulesSay) {
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const CoordinateSettings settings(*kind);
    const auto made = prepare_coordinates(test::golden_cube(), settings);
    ASSERT_TRUE(made) << kind->name << ": " << made.error().message;
    const auto rule = kind->rule(test::golden_cube(), settings);
    ASSERT_TRUE(rule) << kind->name;
    EXPECT_EQ((*made)->columns(), (*rule)->columns()) << kind->name;
    EXPECT_FALSE((*rule)->groups().front().name.empty()) << kind->name;
  }
}

TEST(CoordinateKinds, LeaveAModelAtRestInACageAtRest) {
  const PolygonMesh cage = test::golden_cube();
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const auto rule = kind->rule(cage, CoordinateSettings(*kind));
    ASSERT_TRUE(rule);
    std::vector<Vec3> moves((*rule)->columns(), Vec3::Ones());
    (*rule)->move(cage.positions, moves);
    EXPECT_TRUE(std::ranges::all_of(moves, [](const Vec3& m) { return m.isZero(0); }))
        << kind->name;
  }
}

TEST(CoordinateKinds, RefuseCagesThatAreNone) {
  PolygonMesh beyond;
  beyond.positions.emplace_back(0, 0, 0);
  beyond.add_face({0, 1, 2});
  for (const CoordinateKind* kind : coordinate_kinds()) {
    for (const PolygonMesh& cage : {PolygonMesh(), beyond}) {
      const auto made = prepare_coordinates(cage, CoordinateSettings(*kind));
      ASSERT_FALSE(made) << kind->name;
      EXPECT_EQ(made.error().code, ErrorCode::invalid_cage) << kind->name;
    }
  }
}

TEST(CoordinateSettings, AreReadBackFromTheirText) {
  for (const CoordinateKind* kind : coordinate_kinds()) {
    CoordinateSettings settings(*kind);
    for (const CoordinateOption* option : kind->options) {
      const std::string value = option->words.empty()
                                    ? std::to_string((option->least + option->most) / 2)
                                    : std::string(option->words.back());
      EXPECT_TRUE(settings.set(option->name, value)) << kind->name << ' ' << option->name;
    }
    const Result<CoordinateSettings> again = CoordinateSettings::parse(kind->name, settings.text());
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->text(), settings.text());
    EXPECT_TRUE(again->same_weights(settings));
  }
}

TEST(CoordinateSettings, SayWhatIsAllowed) {
  const auto unknown = CoordinateSettings::of("teapot");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message.substr(0, 56),
            "no coordinates are called 'teapot'; there are mean_value");
  CoordinateSettings settings;
  Status status = settings.set("quads", "both");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "quads: 'both' is not allowed; give center|diagonal");
  status = settings.set("teapot", "1");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message,
            "teapot: mean_value coordinates have no such option, but quads");
}

/// A kind takes no more than this, and a line in the registry.
class NearestVertex : public Coordinates {
public:
  explicit NearestVertex(const PolygonMesh& cage) : Coordinates(vertex_columns(cage.positions)) {}

private:
  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const override {
    const std::span<const Vec3> cage = rule()->cage_at_rest();
    for (std::size_t i = 0; i < 16; ++i) {
      std::size_t nearest = 0;
      for (std::size_t c = 0; c < cage.size(); ++c) {
        weights[c * stride + i] = 0;
        if (i < points.size() &&
            (cage[c] - points[i]).norm() < (cage[nearest] - points[i]).norm()) {
          nearest = c;
        }
      }
      weights[nearest * stride + i] = i < points.size() ? 1 : 0;
    }
    return {};
  }
};

TEST(Coordinates, OfANewKindNeedNothingElse) {
  const NearestVertex nearest(test::golden_cube());
  const std::vector<Vec3> points = {Vec3(0.1, 0.1, 0.9), Vec3(0.9, 0.9, 0.9)};
  const auto solved = solve_all<float>(nearest, points);
  ASSERT_TRUE(solved);
  EXPECT_EQ(solved->weights.at(0, 4), 1);
  EXPECT_EQ(solved->weights.at(1, 7), 1);
}

} // namespace
} // namespace cagewright
