// The laws that every kind of coordinates keeps, for all of the registry: what a kind says of
// itself decides which it is held to, so that a new one is tested as soon as it has its line there.
//
// Further cages, such as generated ones, are taken from the files that CAGEWRIGHT_LAW_CAGES names,
// separated by colons; cages made by hand from the folder CAGEWRIGHT_MODELS.

#include "coordinates/laws.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/io/read_mesh.h>

#include <tbb/task_arena.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <tuple>

namespace cagewright {

void PrintTo(const CoordinateKind* kind, std::ostream* out) {
  *out << kind->name;
}

namespace {

using namespace cagewright::test;

/// A cage along both diagonals of its quads: kinds take other surfaces between the two.
class CutBothWays {
public:
  explicit CutBothWays(const PolygonMesh& cage) {
    for (std::size_t way = 0; way < 2; ++way) {
      PolygonMesh cut;
      cut.positions = cage.positions;
      for (std::size_t f = 0; f < cage.face_count(); ++f) {
        const std::span<const Index> c = cage.face(f);
        if (c.size() == 4) {
          cut.add_face({c[way], c[way + 1], c[way + 2]});
          cut.add_face({c[way], c[way + 2], c[(way + 3) % 4]});
        } else {
          cut.add_face(c);
        }
      }
      meshes_[way] = to_triangle_mesh(cut);
    }
  }

  [[nodiscard]] bool contains(const Vec3& x) const {
    return is_inside(meshes_[0], x) && is_inside(meshes_[1], x);
  }
  [[nodiscard]] bool excludes(const Vec3& x) const {
    return std::abs(winding(meshes_[0], x)) < 1e-6 && std::abs(winding(meshes_[1], x)) < 1e-6;
  }

private:
  std::array<TriangleMesh, 2> meshes_;
};

/// Kinds that are computed are made coarse: the laws hold however coarse they are.
CoordinateSettings quick(const CoordinateKind& kind) {
  CoordinateSettings settings(kind);
  if (settings.has(accuracy_option.name)) {
    EXPECT_TRUE(settings.set(accuracy_option.name, "0.1"));
  }
  return settings;
}

class Laws : public testing::TestWithParam<std::tuple<const CoordinateKind*, LawCage>> {
protected:
  void SetUp() override {
    const Made made = prepare_coordinates(cage(), quick(kind()));
    ASSERT_TRUE(made) << made.error().message;
    made_ = *made;
  }

  static const CoordinateKind& kind() { return *std::get<0>(GetParam()); }
  static const LawCage& law_cage() { return std::get<1>(GetParam()); }
  static const PolygonMesh& cage() { return law_cage().mesh; }
  static double unit() { return diagonal(cage().positions); }
  [[nodiscard]] const Coordinates& made() const { return *made_; }

  /// What the kind says of itself.
  static bool is_never_negative() {
    return kind().sign.starts_with("positive")
               ? kind().sign == "positive"
               : kind().sign.starts_with("not negative") || kind().sign.starts_with("from 0");
  }
  static bool interpolates() { return kind().on_cage.starts_with("interpolates"); }
  static bool is_inside_alone() { return kind().outside.starts_with("refused, or"); }
  static bool is_everywhere() { return kind().outside == "everywhere"; }
  static bool follows_affine_maps() { return kind().reproduces == "affine maps"; }
  [[nodiscard]] bool has_vertices() const {
    const ColumnGroup first = made().rule()->groups().front();
    return first.name == "vertices" && first.count == cage().positions.size();
  }

  static std::vector<double> of_vertices(std::vector<double> weights) {
    weights.resize(cage().positions.size());
    return weights;
  }

  static std::vector<Vec3> points_everywhere_inside() {
    std::vector<Vec3> points = points_inside_by_chance(24, 51);
    for (const double distance : {1e-12, 1e-10, 2e-9, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      const std::vector<Vec3> near = points_inside_near(cage(), distance, 6, 52);
      points.insert(points.end(), near.begin(), near.end());
    }
    return inside_both_ways(std::move(points));
  }
  static std::vector<Vec3> points_inside_by_chance(std::size_t count, std::uint64_t seed) {
    return inside_both_ways(points_inside(cage(), count, seed));
  }
  static std::vector<Vec3> inside_both_ways(std::vector<Vec3> points) {
    const CutBothWays inside(cage());
    std::erase_if(points, [&](const Vec3& x) { return !inside.contains(x); });
    return points;
  }

  /// From just beside the cage to ten diagonals away.
  static std::vector<Vec3> points_outside() {
    const CutBothWays both(cage());
    const Box3 box = bounding_box(cage().positions);
    Random random(53);
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i) {
      const Vec3 x =
          box.center() + std::pow(10.0, random.uniform(-1, 1)) * unit() * random_direction(random);
      if (both.excludes(x)) {
        points.push_back(x);
      }
    }
    return points;
  }

public: // checks by their names
  void sums_to_one_and_reproduces() const;
  void has_the_sign_it_claims() const;
  void follows_similarities_and_affine_maps() const;
  void leaves_the_model_at_rest() const;
  void interpolates_if_it_says_so() const;
  void has_weights_outside_if_it_says_so() const;
  void is_the_same_for_each_instruction_set() const;
  void leaves_points_that_are_none_alone() const;
  void is_the_same_whatever_the_other_points() const;

private:
  std::shared_ptr<const Coordinates> made_;
};

/// One case for all: each is a process of its own, and would prepare the cage anew.
TEST_P(Laws, AreKept) {
  const auto keep = [&](const char* law, void (Laws::*check)() const) {
    SCOPED_TRACE(law);
    (this->*check)();
  };
  keep("sums to one and reproduces", &Laws::sums_to_one_and_reproduces);
  keep("has the sign it claims", &Laws::has_the_sign_it_claims);
  keep("follows similarities and affine maps", &Laws::follows_similarities_and_affine_maps);
  keep("leaves the model at rest", &Laws::leaves_the_model_at_rest);
  keep("interpolates if it says so", &Laws::interpolates_if_it_says_so);
  keep("has weights outside if it says so", &Laws::has_weights_outside_if_it_says_so);
  keep("is the same for each instruction set", &Laws::is_the_same_for_each_instruction_set);
  keep("leaves points that are none alone", &Laws::leaves_points_that_are_none_alone);
  keep("is the same whatever the other points", &Laws::is_the_same_whatever_the_other_points);
}

void Laws::sums_to_one_and_reproduces() const {
  const std::vector<Vec3> from = made().rule()->reproduced_from();
  for (const Vec3& x : points_everywhere_inside()) {
    const Solved solved = solve(made(), x);
    ASSERT_EQ(solved.report.undefined | solved.report.outside, 0) << x.transpose();
    const double most = std::max(1.0, largest(solved.weights));
    // On the cage they may be those of the nearest place on it, 1e-9 away.
    const double tolerance = solved.report.on_surface != 0 ? 1.5e-9 : 1e-12;
    if (has_vertices()) {
      EXPECT_NEAR(sum_over_vertices(made(), solved.weights), 1, 1e-12 * most) << x.transpose();
    }
    if (!from.empty()) {
      EXPECT_LT((reproduced(solved.weights, from) - x).norm(), tolerance * most * unit())
          << x.transpose();
    }
  }
}

void Laws::has_the_sign_it_claims() const {
  for (const Vec3& x : points_everywhere_inside()) {
    if (is_never_negative()) {
      const std::vector<double> weights = of_vertices(solve(made(), x).weights);
      EXPECT_GE(*std::ranges::min_element(weights), 0) << x.transpose();
      EXPECT_LE(*std::ranges::max_element(weights), 1 + 1e-12) << x.transpose();
    }
  }
}

void Laws::follows_similarities_and_affine_maps() const {
  const std::vector<Vec3> points = points_inside_by_chance(8, 54);
  expect_similarities_follow(made(), points, unit(), 1e-10);
  if (follows_affine_maps()) {
    expect_affine_maps_follow(made(), points, unit(), 1e-11);
  }
  for (const CoordinateOption* option : kind().options) {
    if (option->while_posing) {
      CoordinateSettings settings = quick(kind());
      ASSERT_TRUE(settings.set(option->name, std::to_string(option->most)));
      const Made posing = prepare_coordinates(cage(), settings);
      ASSERT_TRUE(posing) << posing.error().message;
      if (!(*posing)->rule()->divisor(cage().positions)) {
        std::vector<Vec3> pose(cage().positions.size());
        std::ranges::transform(cage().positions, pose.begin(), some_similarity(2));
        if (!(*posing)->rule()->divisor(pose)) { // else its own tests divide
          expect_similarities_follow(**posing, points, unit(), 1e-10);
        }
      }
    }
  }
}

void Laws::leaves_the_model_at_rest() const {
  for (const Vec3& x : points_everywhere_inside()) {
    EXPECT_EQ(moved(made(), x, cage().positions), x);
  }
}

void Laws::interpolates_if_it_says_so() const {
  if (!interpolates()) {
    return;
  }
  const TriangleMesh mesh = to_triangle_mesh(cage());
  const Made triangles = mesh.triangles.size() == cage().face_count()
                             ? Made(made_)
                             : prepare_coordinates(PolygonMesh(mesh), quick(kind()));
  ASSERT_TRUE(triangles) << triangles.error().message;
  const double bound = 1.5 * (*triangles)->error_bound(); // measured at other places
  const auto off = [&](const Vec3& x, const std::vector<double>& expected) {
    const std::vector<double> found = of_vertices(solve(**triangles, x).weights);
    double most = 0;
    for (std::size_t c = 0; c < found.size(); ++c) {
      most = std::max(most, std::abs(found[c] - expected[c]));
    }
    return most;
  };
  // The exponentials of maximum entropy grow with the size of the cage over that of a face: where
  // that is small, the prior outweighs them only at distances like 1e-100.
  double shortest = unit();
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      shortest = std::min(shortest, (mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]]).norm());
    }
  }
  const bool is_late = kind().name == "maximum_entropy" && shortest < unit() / 20;
  Random random(55);
  for (const OnCage& on : points_on(mesh, 24, 56)) {
    EXPECT_EQ(solve(**triangles, on.x).report.on_surface, 1) << on.x.transpose();
    EXPECT_LT(off(on.x, on.weights), bound + 1e-12) << on.x.transpose();
    for (const double distance : {1e-3, 1e-5, 1e-8, 3e-9, 1e-10, 1e-12}) {
      for (int tries = is_late && distance > 1e-9 ? 20 : 0; tries < 20; ++tries) {
        const Vec3 near = on.x + distance * unit() * random_direction(random);
        if (is_inside(mesh, near)) {
          EXPECT_LT(off(near, on.weights), bound + 300 * distance * std::log(1 / distance) + 1e-12)
              << distance << ": " << on.x.transpose();
          break;
        }
      }
    }
  }
}

void Laws::has_weights_outside_if_it_says_so() const {
  const std::vector<Vec3> from = made().rule()->reproduced_from();
  for (const Vec3& x : points_outside()) {
    const Solved solved = solve(made(), x);
    if (is_everywhere()) {
      EXPECT_EQ(solved.report.undefined | solved.report.outside, 0) << x.transpose();
      const double scale = std::max(1.0, largest(solved.weights)) * ((x.norm() + unit()) / unit());
      EXPECT_LT((reproduced(solved.weights, from) - x).norm(), 1e-11 * scale * unit())
          << x.transpose();
    } else {
      EXPECT_EQ(solved.report.outside, 1) << x.transpose();
      EXPECT_EQ(largest(solved.weights), 0) << x.transpose();
    }
  }
}

void Laws::is_the_same_for_each_instruction_set() const {
  expect_alike_on_all_targets(made(), points_inside_by_chance(6, 58), 1e-11);
}

void Laws::leaves_points_that_are_none_alone() const {
  const Solved solved = solve(made(), Vec3(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5));
  EXPECT_EQ(solved.report.undefined, 1);
  EXPECT_EQ(largest(solved.weights), 0);
}

/// Sixteen points are computed side by side; those that need care, or are none, are not their
/// neighbors' business.
void Laws::is_the_same_whatever_the_other_points() const {
  std::vector<Vec3> points = points_everywhere_inside();
  const std::vector<Vec3> outside = points_outside();
  points.insert(points.end(), outside.begin(), outside.end());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 5; i < points.size(); i += 11) {
    points[i] = i % 2 == 0 ? cage().positions[i % cage().positions.size()] : Vec3(nan, 0, 0);
  }
  const std::size_t columns = made().columns();
  std::vector<double> tile(16 * columns);
  for (std::size_t first = 0; first < points.size(); first += 16) {
    const std::size_t count = std::min<std::size_t>(16, points.size() - first);
    // From one tile to the next they stand at another place.
    std::rotate(points.begin() + static_cast<std::ptrdiff_t>(first),
                points.begin() + static_cast<std::ptrdiff_t>(first + first / 16 % count),
                points.begin() + static_cast<std::ptrdiff_t>(first + count));
    const TileReport report = made().solve(std::span(points).subspan(first, count), tile);
    for (std::size_t i = 0; i < count; ++i) {
      const Solved alone = solve(made(), points[first + i]);
      EXPECT_EQ(report.on_surface >> i & 1, alone.report.on_surface);
      EXPECT_EQ(report.outside >> i & 1, alone.report.outside);
      EXPECT_EQ(report.undefined >> i & 1, alone.report.undefined);
      std::vector<double> own(columns);
      for (std::size_t k = 0; k < columns; ++k) {
        own[k] = tile[16 * k + i];
      }
      if (own != alone.weights) { // mean value takes a careful branch where one of them needs it
        EXPECT_LT(relative_difference(own, alone.weights), 1e-12) << points[first + i].transpose();
      }
    }
  }
}

std::string name_of_case(const testing::TestParamInfo<Laws::ParamType>& tested) {
  return std::string(std::get<0>(tested.param)->name) + "In" + std::get<1>(tested.param).name;
}

/// Kinds that can be told how exact to be take long for the torus, and have it in tests of their
/// own.
std::vector<std::tuple<const CoordinateKind*, LawCage>> kinds_in_cages() {
  std::vector<std::tuple<const CoordinateKind*, LawCage>> all;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    for (const LawCage& cage : law_cages()) {
      if (cage.name != "Torus" || !CoordinateSettings(*kind).has(accuracy_option.name)) {
        all.emplace_back(kind, cage);
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Laws, testing::ValuesIn(kinds_in_cages()), name_of_case);

/// Those of files that are there.
std::vector<LawCage> cages_of_characters() {
  std::vector<std::filesystem::path> paths;
  if (const char* folder = std::getenv("CAGEWRIGHT_MODELS")) {
    for (const char* name : {"arm_cage.obj", "human_cage.obj"}) {
      paths.emplace_back(std::filesystem::path(folder) / name);
    }
  }
  if (const char* more = std::getenv("CAGEWRIGHT_LAW_CAGES")) {
    std::string_view names = more;
    while (!names.empty()) {
      const std::size_t end = std::min(names.find(':'), names.size());
      paths.emplace_back(names.substr(0, end));
      names.remove_prefix(std::min(end + 1, names.size()));
    }
  }
  std::vector<LawCage> cages;
  for (const std::filesystem::path& path : paths) {
    if (Result<PolygonMesh> cage = std::filesystem::exists(path)
                                       ? read_mesh(path)
                                       : Result<PolygonMesh>(Error::cancelled())) {
      std::string name = path.stem().string();
      std::ranges::replace_if(
          name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      cages.push_back({name, *std::move(cage)});
    }
  }
  return cages;
}

INSTANTIATE_TEST_SUITE_P(Characters, Laws,
                         testing::Combine(testing::ValuesIn(coordinate_kinds().begin(),
                                                            coordinate_kinds().end()),
                                          testing::ValuesIn(cages_of_characters())),
                         name_of_case);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Laws);

class EveryKind : public testing::TestWithParam<const CoordinateKind*> {
protected:
  static Made make(const PolygonMesh& cage) {
    return prepare_coordinates(cage, quick(*GetParam()));
  }
};

TEST_P(EveryKind, DoesNotDependOnHowTheCageIsWritten) {
  const Made made = make(make_star());
  ASSERT_TRUE(made) << made.error().message;
  if ((*made)->rule()->groups().front().name != "vertices" ||
      (*made)->rule()->reproduced_from().empty()) {
    return; // matrices turn with the cage; and columns are compared by what they reproduce
  }
  // Kinds that are fitted or solved for depend on where the cage is looked at, by less than they
  // say of their errors.
  const double fitted = GetParam()->made_by == "least squares over the cage" ? 1e-6 : 1e-10;
  expect_invariance(make, make_star(), points_inside(make_star(), 4, 57),
                    fitted + (*made)->error_estimate());
}

/// Four weights that reproduce points are the barycentric coordinates.
TEST_P(EveryKind, IsBarycentricInATetrahedronIfItHasNoOtherColumns) {
  const Made made = make(skewed(PolygonMesh(make_tetrahedron())));
  ASSERT_TRUE(made) << made.error().message;
  if ((*made)->rule()->reproduced_from().size() == 4) {
    expect_barycentric_in_a_tetrahedron(make, 1e-12);
  }
}

TEST_P(EveryKind, DoesNotDependOnTheNumberOfThreads) {
  const auto on = [](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] {
      const Made made = make(make_l());
      return made ? solve(**made, Vec3(0.3, 0.4, 0.6)).weights : std::vector<double>();
    });
  };
  EXPECT_FALSE(on(1).empty());
  EXPECT_EQ(on(1), on(4));
}

/// With what is prepared for the cage. Processors that multiply and add in one round alike, but for
/// kinds that divide by approximations.
TEST_P(EveryKind, AgreesOnProcessorsOfOtherInstructions) {
  const std::vector<Vec3> points = points_inside(make_l(), 6, 59);
  const auto weights_on = [&](std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    const Made made = make(make_l());
    std::vector<double> all;
    for (const Vec3& x : points) {
      const std::vector<double> own = made ? solve(**made, x).weights : std::vector<double>();
      all.insert(all.end(), own.begin(), own.end());
    }
    hwy::SetSupportedTargetsForTest(0);
    return all;
  };
  const bool divides_nearly = GetParam()->name.find("mean_value") != std::string_view::npos;
  const std::vector<double> expected = weights_on(0);
  ASSERT_FALSE(expected.empty());
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::vector<double> found = weights_on(target);
    const bool is_best = target <= HWY_AVX2; // and wider ones
    if (is_best && (hwy::SupportedTargets() & HWY_AVX2) != 0 && !divides_nearly) {
      EXPECT_EQ(found, expected) << hwy::TargetName(target);
    } else {
      EXPECT_LT(relative_difference(found, expected), 1e-11) << hwy::TargetName(target);
    }
  }
}

TEST_P(EveryKind, RefusesOpenCages) {
  PolygonMesh open;
  open.positions = golden_cube().positions;
  open.add_face({0, 2, 3, 1});
  const Made made = prepare_coordinates(open, CoordinateSettings(*GetParam()));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid_cage);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind,
                         testing::ValuesIn(coordinate_kinds().begin(), coordinate_kinds().end()),
                         [](const auto& tested) { return std::string(tested.param->name); });

} // namespace
} // namespace cagewright
