#include "cage/piece_cages.h"

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// Two cubes side by side, the second so many times as large.
TriangleMesh two_cubes(double size = 1) {
  TriangleMesh other = make_cube();
  for (Vec3& p : other.positions) {
    p = size * p + Vec3(4, 0, 0);
  }
  return joined(make_cube(), other);
}

/// A box of quads round the part. With a bend, two opposite corners of the quad that looks at the
/// other part go towards it by so much: a valley runs between them along the quad's first diagonal,
/// a ridge along its second, and the ridges of the two parts are at right angles. Not judged: what
/// a maker gives is believed.
GeneratedCage box_round(TriangleView part, double bend = 0) {
  const Box3 box = bounding_box(part.positions);
  const PolygonMesh unit = make_quad_cube();
  const Box3 unit_box = bounding_box(unit.positions);
  const int towards = box.center().x() < 2 ? 1 : -1;
  PolygonMesh cage;
  const auto goes_out = [&](Index v) {
    const Vec3 p = unit.positions[v] - unit_box.center();
    return bend > 0 && towards * p.x() > 0 && towards * p.y() * p.z() > 0;
  };
  for (Index v = 0; v < unit.positions.size(); ++v) {
    const Vec3 p = (unit.positions[v] - unit_box.center()).cwiseQuotient(unit_box.sizes());
    cage.positions.emplace_back(box.center() + 1.2 * p.cwiseProduct(box.sizes()));
    cage.positions.back().x() += goes_out(v) ? towards * bend : 0;
  }
  for (std::size_t f = 0; f < unit.face_count(); ++f) {
    std::vector<Index> face(unit.face(f).begin(), unit.face(f).end());
    if (goes_out(face[0])) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
    }
    cage.add_face(face);
  }
  GeneratedCage made;
  made.triangles = to_triangle_mesh(cage);
  made.faces = std::move(cage);
  return made;
}

/// Makes cages with a function, and notes of what.
class Maker : public PartMaker {
public:
  using Make = std::function<Result<GeneratedCage>(TriangleView, const GenerateOptions&)>;
  Maker(TriangleView model, Make make)
      : PartMaker(model, GenerateOptions(), std::nullopt), make_(std::move(make)) {}

  [[nodiscard]] Result<GeneratedCage> make(TriangleView part, const GenerateOptions& options,
                                           const Progress& /*progress*/) const override {
    parts.push_back(part.positions.size());
    return make_(part, options);
  }

  mutable std::vector<std::size_t> parts; ///< how many vertices each had

private:
  Make make_;
};

GenerateOptions options() {
  GenerateOptions result;
  result.vertices = 40;
  return result;
}

TEST(MakePieces, GivesEachGroupThatIsApartItsOwnCage) {
  const TriangleMesh model = two_cubes();
  const Maker maker(model, [](TriangleView part, const GenerateOptions&) {
    return Result<GeneratedCage>(box_round(part));
  });
  const Result<GeneratedCage> made = make_pieces(model, options(), std::nullopt, maker);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->pieces, 2);
  EXPECT_EQ(made->joined, 0);
  EXPECT_EQ(maker.parts, (std::vector<std::size_t>{8, 8}));
}

TEST(MakePieces, JoinsGroupsWhoseCagesCrossOnlyAlongTheSecondDiagonals) {
  const TriangleMesh model = two_cubes();
  const double between = 4 - 1.2 * bounding_box(make_cube().positions).sizes().x();
  const double bend = 0.7 * between; // corners do not meet, ridges do
  const Maker maker(model, [&](TriangleView part, const GenerateOptions&) {
    return Result<GeneratedCage>(box_round(part, part.positions.size() == 8 ? bend : 0));
  });
  const Result<GeneratedCage> made = make_pieces(model, options(), std::nullopt, maker);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->pieces, 1);
  EXPECT_EQ(made->joined, 1);
  ASSERT_EQ(maker.parts.size(), 3U);
  EXPECT_EQ(maker.parts.back(), 16U) << "a cage for both together";
}

TEST(MakePieces, StatesLengthsInDiagonalsOfTheWholeModel) {
  const TriangleMesh model = two_cubes(0.5);
  const Maker maker(model, [](TriangleView part, const GenerateOptions& own) {
    GeneratedCage made = box_round(part);
    const bool is_small = bounding_box(part.positions).center().x() > 2;
    made.gap = is_small ? 0.2 : 0.05; // of its own diagonal
    made.clearance = own.clearance;
    return Result<GeneratedCage>(std::move(made));
  });
  const Result<GeneratedCage> made = make_pieces(model, options(), std::nullopt, maker);
  ASSERT_TRUE(made) << made.error().message;
  const double small = 0.5 * diagonal(make_cube().positions);
  ASSERT_TRUE(made->gap);
  EXPECT_NEAR(*made->gap, 0.2 * small / diagonal(model.positions), 1e-12)
      << "the greatest of both, a length of the small one's";
  EXPECT_NEAR(made->clearance, options().clearance, 1e-12);
}

TEST(MakePieces, PassesOnWhatGoesWrong) {
  const TriangleMesh model = two_cubes();
  const Maker maker(model, [](TriangleView, const GenerateOptions&) {
    return Result<GeneratedCage>(Error::cancelled());
  });
  const Result<GeneratedCage> made = make_pieces(model, options(), std::nullopt, maker);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
