#include <cagewright/validate/validate_cage.h>

#include "mesh/shapes.h"
#include "support/models.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace cagewright {
namespace {

using Kinds = std::set<std::string_view>;
using Elements = std::array<Index, 2>;
constexpr Index none = Violation::none;

TriangleMesh scaled(TriangleMesh mesh, double factor, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& p : mesh.positions) {
    p = p * factor + shift;
  }
  return mesh;
}

TriangleMesh flipped(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) {
    std::swap(t[0], t[1]);
  }
  return mesh;
}

/// A small sphere that fits in all cages below.
TriangleMesh small_model() {
  return scaled(make_icosphere(1), 0.25);
}

template <class Cage>
ValidityReport judge(const Cage& cage, TriangleView model, const ValidateOptions& options = {}) {
  return validate_cage(cage, model, options).value();
}

Kinds kinds(const ValidityReport& report) {
  Kinds found;
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (report.counts[k] > 0) {
      found.insert(name_of(static_cast<ViolationKind>(k)));
    }
  }
  return found;
}

/// The elements of all listed violations of a kind.
std::set<Elements> places(const ValidityReport& report, ViolationKind kind) {
  std::set<Elements> found;
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind) {
      found.insert(violation.elements);
    }
  }
  return found;
}

constexpr ValidateOptions pieces_allowed = {.allow_pieces = true};

// ---- Good cages

TEST(ValidateCage, CertifiesABoxRoundASphere) {
  EXPECT_TRUE(judge(make_cube(), small_model()).valid());
  EXPECT_TRUE(judge(make_quad_cube(), small_model()).valid());
  EXPECT_TRUE(judge(PolygonMesh(make_icosphere(2)), small_model()).valid());
}

TEST(ValidateCage, CertifiesAtAnyScaleAndFarFromTheOrigin) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Vec3 shift(1e3 * scale, -1e5 * scale, 7 * scale);
    EXPECT_TRUE(judge(scaled(make_icosphere(2), scale, shift),
                      scaled(make_icosphere(3), 0.9 * scale, shift))
                    .valid());
  }
}

TEST(ValidateCage, CertifiesATorusInATorus) {
  const TriangleMesh cage = make_torus(0.4, 24, 12);
  EXPECT_TRUE(judge(cage, make_torus(0.2, 48, 16)).valid());
}

TEST(ValidateCage, CertifiesAModelThatIsOpenInvertedAndInParts) {
  TriangleMesh open = small_model();
  open.triangles.resize(open.triangles.size() / 2);
  const TriangleMesh parts = joined(flipped(scaled(make_cube(), 0.2, {0.5, 0.5, 0.5})),
                                    scaled(make_torus(0.3, 8, 5), 0.3));
  EXPECT_TRUE(judge(make_cube(), joined(open, parts)).valid());
}

TEST(ValidateCage, CertifiesAHairsBreadth) {
  const double near = std::nextafter(1.0, 0.0);
  EXPECT_TRUE(judge(make_cube(), scaled(make_cube(), near)).valid());
  EXPECT_FALSE(judge(make_cube(), make_cube()).valid());
}

TEST(ValidateCage, CertifiesTwoPiecesWhereTheyAreAllowed) {
  const TriangleMesh cage = joined(make_cube(), scaled(make_cube(), 1, {5, 0, 0}));
  const TriangleMesh model = joined(small_model(), scaled(small_model(), 1, {5, 0, 0}));
  EXPECT_TRUE(judge(cage, model, pieces_allowed).valid());
}

TEST(ValidateCage, CertifiesAHandMadeCage) {
  const auto model = test::real_model({"arm.obj"});
  const auto cage = test::real_polygons({"arm_cage.obj"});
  if (!model || !cage) {
    GTEST_SKIP() << "CAGEWRIGHT_MODELS names no directory with arm.obj and arm_cage.obj";
  }
  EXPECT_EQ(kinds(judge(*cage, *model)), Kinds{});
}

// ---- One defect each

TEST(ValidateCage, RejectsACageWithoutFaces) {
  EXPECT_EQ(kinds(judge(TriangleMesh(), small_model())), Kinds{"no_faces"});
}

TEST(ValidateCage, ListsFacesWithImpossibleCorners) {
  PolygonMesh cage(make_cube());
  cage.add_face({0, 1});
  cage.add_face({0, 1, 4000000000U});
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"bad_corner"});
  EXPECT_EQ(places(report, ViolationKind::bad_corner),
            (std::set<Elements>{{12, none}, {13, none}}));
}

TEST(ValidateCage, ListsAVertexThatIsNotANumber) {
  TriangleMesh cage = make_cube();
  cage.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(places(report, ViolationKind::not_finite), (std::set<Elements>{{3, none}}));
}

TEST(ValidateCage, ListsAnUnusedVertex) {
  TriangleMesh cage = make_cube();
  cage.positions.emplace_back(0, 0, 0);
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"unused_vertex"});
  EXPECT_EQ(places(report, ViolationKind::unused_vertex), (std::set<Elements>{{8, none}}));
}

TEST(ValidateCage, ListsStackedVertices) {
  // Two tetrahedra that touch in a corner, each with a vertex of its own there.
  const TriangleMesh tetrahedron = scaled(make_tetrahedron(), 1);
  const Vec3 corner = tetrahedron.positions[0];
  TriangleMesh other = tetrahedron;
  for (Vec3& p : other.positions) {
    p = 2 * corner - p;
  }
  const TriangleMesh cage = joined(tetrahedron, flipped(other));
  const ValidityReport report = judge(cage, TriangleMesh(), pieces_allowed);
  EXPECT_EQ(kinds(report), Kinds{"coincident_vertices"});
  EXPECT_EQ(places(report, ViolationKind::coincident_vertices),
            (std::set<Elements>{{0, static_cast<Index>(tetrahedron.positions.size())}}));
}

TEST(ValidateCage, ListsTheOpenEdgesOfAMissingFace) {
  TriangleMesh cage = make_icosphere(1);
  const Triangle gone = cage.triangles[7];
  cage.triangles.erase(cage.triangles.begin() + 7);
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"open_edge"});
  EXPECT_EQ(places(report, ViolationKind::open_edge),
            (std::set<Elements>{{gone[1], gone[0]}, {gone[2], gone[1]}, {gone[0], gone[2]}}));
  EXPECT_TRUE(report.containment_approximate);
}

TEST(ValidateCage, ListsTheEdgesOfAFlippedFace) {
  TriangleMesh cage = make_icosphere(1);
  const Triangle t = cage.triangles[7];
  std::swap(cage.triangles[7][0], cage.triangles[7][1]);
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"flipped_edge"});
  const auto edge = [](Index a, Index b) { return Elements{std::min(a, b), std::max(a, b)}; };
  EXPECT_EQ(places(report, ViolationKind::flipped_edge),
            (std::set<Elements>{edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])}));
}

/// A cube with a second one on its edge 1-5 (x = 1, y = -1), the two faces of each meeting there.
TriangleMesh cubes_sharing_an_edge() {
  TriangleMesh cage = make_cube();
  TriangleMesh other = scaled(make_cube(), 1, {2, -2, 0});
  for (Triangle& t : other.triangles) {
    for (Index& v : t) {
      // The other's edge x = 1, y = -1 is that between its vertices 2 and 6.
      v = v == 2 ? 1 : v == 6 ? 5 : v + 8 - (v > 2 ? 1 : 0) - (v > 6 ? 1 : 0);
    }
  }
  other.positions.erase(other.positions.begin() + 6);
  other.positions.erase(other.positions.begin() + 2);
  cage.positions.insert(cage.positions.end(), other.positions.begin(), other.positions.end());
  cage.triangles.insert(cage.triangles.end(), other.triangles.begin(), other.triangles.end());
  return cage;
}

TEST(ValidateCage, ListsAnEdgeOfFourFaces) {
  const ValidityReport report = judge(cubes_sharing_an_edge(), small_model());
  EXPECT_EQ(kinds(report), Kinds{"nonmanifold_edge"});
  EXPECT_EQ(places(report, ViolationKind::nonmanifold_edge), (std::set<Elements>{{1, 5}}));
}

TEST(ValidateCage, ListsAPinchedVertex) {
  TriangleMesh cage = make_cube();
  const TriangleMesh other = scaled(make_cube(), 1, {2, 2, 2});
  for (const Triangle& t : other.triangles) {
    // The other's vertex 0 is the first one's 7.
    cage.triangles.push_back(
        {t[0] == 0 ? 7 : t[0] + 7, t[1] == 0 ? 7 : t[1] + 7, t[2] == 0 ? 7 : t[2] + 7});
  }
  cage.positions.insert(cage.positions.end(), other.positions.begin() + 1, other.positions.end());
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"nonmanifold_vertex"});
  EXPECT_EQ(places(report, ViolationKind::nonmanifold_vertex), (std::set<Elements>{{7, none}}));
}

TEST(ValidateCage, ListsACollinearFace) {
  TriangleMesh cage = make_icosphere(1);
  const Triangle t = cage.triangles[0];
  const auto middle = static_cast<Index>(cage.positions.size());
  cage.positions[t[0]] = Vec3(0, 0, 1);
  cage.positions[t[1]] = Vec3(0.5, 0, 1);
  cage.positions.push_back(Vec3(0.25, 0, 1));
  cage.triangles[0] = {t[0], middle, t[2]};
  cage.triangles.push_back({middle, t[1], t[2]});
  cage.triangles.push_back({t[0], t[1], middle});
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(report.count(ViolationKind::degenerate_face), 1U);
  EXPECT_EQ(places(report, ViolationKind::degenerate_face),
            (std::set<Elements>{{static_cast<Index>(cage.triangles.size() - 1), none}}));
}

TEST(ValidateCage, ListsAFaceThatNamesAVertexTwice) {
  TriangleMesh cage = make_cube();
  cage.triangles.push_back({0, 1, 0});
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"degenerate_face"});
  EXPECT_EQ(places(report, ViolationKind::degenerate_face), (std::set<Elements>{{12, none}}));
}

TEST(ValidateCage, ListsARepeatedFace) {
  TriangleMesh cage = make_cube();
  const Triangle t = cage.triangles[4];
  cage.triangles.push_back({t[1], t[0], t[2]});
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(places(report, ViolationKind::duplicate_face), (std::set<Elements>{{12, none}}));
}

TEST(ValidateCage, ListsFacesOfOnePieceThatCross) {
  // One vertex of a sphere pushed right through to the other side.
  TriangleMesh cage = make_icosphere(2);
  cage.positions[0] *= -1.5;
  const ValidityReport report = judge(cage, TriangleMesh());
  EXPECT_EQ(kinds(report), Kinds{"self_intersection"});
  for (const Violation& violation : report.violations) {
    const auto touches = [&](Index f) {
      const Triangle& t = cage.triangles[f];
      return std::find(t.begin(), t.end(), Index{0}) != t.end();
    };
    EXPECT_TRUE(touches(violation.elements[0]) || touches(violation.elements[1]));
    EXPECT_LT(violation.elements[0], violation.elements[1]);
  }
}

TEST(ValidateCage, ListsNeighborsFoldedOnEachOther) {
  // The apex of a pyramid laid into the plane of its base: faces that share an edge overlap.
  TriangleMesh cage;
  cage.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}};
  cage.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const ValidityReport report = judge(cage, TriangleMesh());
  EXPECT_EQ(kinds(report), Kinds{"self_intersection"});
  EXPECT_EQ(places(report, ViolationKind::self_intersection),
            (std::set<Elements>{{0, 1}, {0, 2}, {0, 3}}));
}

TEST(ValidateCage, ListsFacesOfTwoPiecesThatCross) {
  const TriangleMesh cage = joined(make_cube(), scaled(make_cube(), 1, {1.5, 0.1, 0.2}));
  const ValidityReport report = judge(cage, small_model(), pieces_allowed);
  EXPECT_EQ(kinds(report), Kinds{"self_intersection"});
  for (const Violation& violation : report.violations) {
    EXPECT_LT(violation.elements[0], 12U);
    EXPECT_GE(violation.elements[1], 12U);
    EXPECT_LE(violation.place.x(), 1.0);
    EXPECT_GE(violation.place.x(), 0.5);
  }
}

TEST(ValidateCage, ListsPiecesThatTouchInOnePoint) {
  // A tetrahedron whose tip stands on the middle of the cube's top.
  TriangleMesh tip;
  tip.positions = {{0.1, 0.2, 1}, {1, 0, 3}, {-1, 1, 3}, {-1, -1, 3}};
  tip.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  const TriangleMesh cage = joined(make_cube(), flipped(tip));
  ValidateOptions options = pieces_allowed;
  ValidityReport report = judge(cage, small_model(), options);
  EXPECT_EQ(report.count(ViolationKind::self_intersection), 3U);
  report =
      judge(joined(make_cube(), flipped(scaled(tip, 1, {0, 0, 1e-15}))), small_model(), options);
  EXPECT_EQ(report.count(ViolationKind::self_intersection), 0U);
}

TEST(ValidateCage, ListsAnInvertedCage) {
  const ValidityReport report = judge(flipped(make_cube()), small_model());
  EXPECT_EQ(kinds(report), Kinds{"inverted_piece"});
  EXPECT_EQ(places(report, ViolationKind::inverted_piece), (std::set<Elements>{{0, none}}));
}

TEST(ValidateCage, ListsASecondPiece) {
  const TriangleMesh cage = joined(make_cube(), scaled(make_cube(), 1, {5, 0, 0}));
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(kinds(report), Kinds{"several_pieces"});
  EXPECT_EQ(places(report, ViolationKind::several_pieces), (std::set<Elements>{{12, none}}));
}

TEST(ValidateCage, ListsACavity) {
  const TriangleMesh cage =
      joined(scaled(make_cube(), 1), flipped(scaled(make_cube(), 0.2, {0.6, 0.6, 0.6})));
  const ValidityReport report = judge(cage, small_model(), pieces_allowed);
  EXPECT_EQ(kinds(report), Kinds{"nested_piece"});
  EXPECT_EQ(places(report, ViolationKind::nested_piece), (std::set<Elements>{{12, none}}));
}

TEST(ValidateCage, FindsAModelInACavityOutside) {
  const TriangleMesh cage = joined(make_cube(), flipped(scaled(make_cube(), 0.5)));
  const ValidityReport report = judge(cage, small_model(), pieces_allowed);
  EXPECT_EQ(kinds(report), (Kinds{"nested_piece", "vertex_outside"}));
  EXPECT_EQ(report.count(ViolationKind::vertex_outside), small_model().positions.size());
}

TEST(ValidateCage, ListsAVertexOutside) {
  TriangleMesh model = small_model();
  const auto stray = static_cast<Index>(model.positions.size());
  model.positions.emplace_back(0, 1.5, 0);
  model.triangles.clear(); // points: all are judged
  const ValidityReport report = judge(make_cube(), model);
  EXPECT_EQ(kinds(report), Kinds{"vertex_outside"});
  EXPECT_EQ(places(report, ViolationKind::vertex_outside), (std::set<Elements>{{stray, none}}));
}

TEST(ValidateCage, ListsTheVertexThatSticksOut) {
  TriangleMesh model = small_model();
  model.positions[4] *= 8;
  const ValidityReport report = judge(make_cube(), model);
  EXPECT_EQ(kinds(report), (Kinds{"vertex_outside", "face_contact"}));
  EXPECT_EQ(places(report, ViolationKind::vertex_outside), (std::set<Elements>{{4, none}}));
}

TEST(ValidateCage, ListsAModelBesideTheCage) {
  const TriangleMesh model = scaled(small_model(), 1, {3, 0, 0});
  const ValidityReport report = judge(make_cube(), model);
  EXPECT_EQ(kinds(report), Kinds{"vertex_outside"});
  EXPECT_EQ(report.count(ViolationKind::vertex_outside), model.positions.size());
}

TEST(ValidateCage, ListsAVertexThatLiesExactlyOnTheCage) {
  // In a face, on an edge, at a corner.
  for (const Vec3& place : {Vec3(1, 0.3, -0.2), Vec3(1, 1, 0.25), Vec3(1, 1, 1)}) {
    TriangleMesh model = small_model();
    const auto stray = static_cast<Index>(model.positions.size());
    model.positions.push_back(place);
    TriangleMesh points = model;
    points.triangles.clear();
    const ValidityReport report = judge(make_cube(), points);
    EXPECT_EQ(kinds(report), Kinds{"vertex_on_cage"});
    ASSERT_EQ(report.violations.size(), 1U);
    EXPECT_EQ(report.violations[0].elements[0], stray);
    EXPECT_EQ(report.violations[0].place, place);

    model.triangles.push_back({0, 1, stray});
    EXPECT_EQ(kinds(judge(make_cube(), model)), (Kinds{"vertex_on_cage", "face_contact"}));
  }
}

TEST(ValidateCage, ListsAFaceThatPokesThroughBetweenItsVertices) {
  // A cage with a dent that a large triangle spans, all three vertices inside.
  TriangleMesh cage = make_icosphere(2);
  const Vec3 dent = cage.positions[0];
  cage.positions[0] *= 0.1;
  TriangleMesh model;
  const Vec3 u = dent.unitOrthogonal();
  const Vec3 v = dent.cross(u);
  model.positions = {0.5 * dent + 0.6 * u, 0.5 * dent + 0.6 * v, 0.5 * dent - 0.6 * (u + v)};
  model.triangles = {{0, 1, 2}};
  const ValidityReport report = judge(cage, model);
  EXPECT_EQ(kinds(report), Kinds{"face_contact"});
  for (const Elements& pair : places(report, ViolationKind::face_contact)) {
    EXPECT_EQ(pair[0], 0U);
    const Triangle& t = cage.triangles[pair[1]];
    EXPECT_NE(std::find(t.begin(), t.end(), Index{0}), t.end());
  }
}

TEST(ValidateCage, ListsAQuadThatIsValidUnderOneDiagonalOnly) {
  // A box whose top is bent: along one diagonal a ridge above the model, along the other a valley
  // through it.
  PolygonMesh cage = make_quad_cube();
  cage.positions[4].z() = 3; // the top, the last face, is 4 5 7 6
  cage.positions[7].z() = 3;
  const TriangleMesh model = scaled(make_cube(), 0.3, {0, 0, 1.2});
  const ValidityReport report = judge(cage, model);
  EXPECT_EQ(kinds(report), (Kinds{"vertex_outside", "face_contact"}));
  for (const Elements& pair : places(report, ViolationKind::face_contact)) {
    EXPECT_EQ(pair[1], 5U);
  }
  // Cut along the ridge it is a valid cage of triangles.
  TriangleMesh ridge = to_triangle_mesh(make_quad_cube());
  ridge.positions = cage.positions;
  std::erase_if(ridge.triangles, [](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [](Index v) { return v >= 4; });
  });
  ridge.triangles.push_back({4, 5, 7});
  ridge.triangles.push_back({4, 7, 6});
  EXPECT_TRUE(judge(ridge, model).valid());
}

TEST(ValidateCage, FindsAModelThatIsInsideUnderOneDiagonalOnly) {
  PolygonMesh cage = make_quad_cube();
  cage.positions[4].z() = 3;
  cage.positions[7].z() = 3;
  // Small enough to float between the two diagonals, touching neither.
  const TriangleMesh model = scaled(make_cube(), 0.01, {0, 0, 2});
  EXPECT_EQ(kinds(judge(cage, model)), Kinds{"vertex_outside"});
}

TEST(ValidateCage, ListsAQuadThatFoldsOverUnderOneDiagonal) {
  // A planar dart: cut along the diagonal outside it, its halves overlap.
  PolygonMesh cage;
  cage.positions = {{0, 0, 0}, {2, 1, 0}, {0.5, 1, 0}, {-1, 3, 0}, {0.5, 1, -2}};
  cage.add_face({0, 1, 2, 3});
  cage.add_face({1, 0, 4});
  cage.add_face({2, 1, 4});
  cage.add_face({3, 2, 4});
  cage.add_face({0, 3, 4});
  const ValidityReport report = judge(cage, TriangleMesh());
  EXPECT_EQ(places(report, ViolationKind::folded_face), (std::set<Elements>{{0, none}}));
  EXPECT_EQ(report.count(ViolationKind::self_intersection), 0U);
}

// ---- Cages from elsewhere

/// Every face with vertices of its own.
PolygonMesh split(const TriangleMesh& mesh) {
  PolygonMesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<Index>(result.positions.size());
    for (const Index v : t) {
      result.positions.push_back(mesh.positions[v]);
    }
    result.add_face({first, first + 1, first + 2});
  }
  return result;
}

TEST(ValidateCage, JudgesSplitVerticesMergedWhereAsked) {
  PolygonMesh cage = split(make_icosphere(1));
  cage.positions.emplace_back(9, 9, 9); // loose
  EXPECT_FALSE(judge(cage, small_model()).valid());
  const ValidityReport report = judge(cage, small_model(), {.weld = true});
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.merged_vertices, 240U - 42U);
  EXPECT_EQ(report.loose_vertices, 1U);
  const ValidityReport whole = judge(make_icosphere(1), small_model(), {.weld = true});
  EXPECT_TRUE(whole.valid());
  EXPECT_EQ(whole.merged_vertices, 0U);
}

TEST(ValidateCage, MergingDoesNotHideWhatIsWrong) {
  TriangleMesh open = make_icosphere(1);
  open.triangles.pop_back();
  EXPECT_EQ(judge(split(open), small_model(), {.weld = true}).count(ViolationKind::open_edge), 3U);
  TriangleMesh torn = make_icosphere(1);
  PolygonMesh cage = split(torn);
  cage.positions[0] *= 1 + 1e-15; // off by a hair: no longer the same position
  EXPECT_GT(judge(cage, small_model(), {.weld = true}).count(ViolationKind::open_edge), 0U);
}

TEST(ValidateCage, NamesTJunctions) {
  // The top of a cube is cut in two, its neighbors are not.
  PolygonMesh cage;
  cage.positions = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1},
                    {1, -1, 1},   {1, 1, 1},   {-1, 1, 1}, {0, -1, 1},  {0, 1, 1}};
  cage.add_face({0, 3, 2, 1});
  cage.add_face({0, 1, 5, 4});
  cage.add_face({1, 2, 6, 5});
  cage.add_face({2, 3, 7, 6});
  cage.add_face({3, 0, 4, 7});
  cage.add_face({4, 8, 9, 7});
  cage.add_face({8, 5, 6, 9});
  const ValidityReport report = judge(cage, small_model());
  EXPECT_EQ(places(report, ViolationKind::t_junction), (std::set<Elements>{{8, 1}, {9, 3}}));
  EXPECT_GT(report.count(ViolationKind::open_edge), 0U);
}

TEST(ValidateCage, AcceptsInnerShellsWhereAsked) {
  const TriangleMesh shell = scaled(make_cube(), 0.2, {0.6, 0.6, 0.6});
  const ValidateOptions allowed = {.allow_inner_shells = true};
  EXPECT_TRUE(judge(joined(make_cube(), flipped(shell)), small_model(), allowed).valid());
  EXPECT_EQ(kinds(judge(joined(make_cube(), shell), small_model(), allowed)),
            Kinds{"inverted_piece"});
  EXPECT_EQ(
      kinds(judge(joined(make_cube(), scaled(make_cube(), 1, {5, 0, 0})), small_model(), allowed)),
      Kinds{"several_pieces"});
  // What a shell encloses is inside all the same.
  EXPECT_TRUE(judge(joined(make_cube(), flipped(scaled(make_cube(), 0.5))), small_model(), allowed)
                  .valid());
}

TEST(ValidateCage, LeavesOutModelVerticesOfNoFace) {
  TriangleMesh model = small_model();
  model.positions.emplace_back(1e6, 0, 0);
  const ValidityReport report = judge(make_cube(), model);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.loose_model_vertices, 1U);
}

// ---- How it reports

TEST(ValidateCage, CountsAllAndListsNoMoreThanAsked) {
  const TriangleMesh model = scaled(make_icosphere(3), 1, {9, 0, 0});
  const ValidityReport report = judge(make_cube(), model, {.max_listed = 3});
  EXPECT_EQ(report.count(ViolationKind::vertex_outside), model.positions.size());
  EXPECT_EQ(report.violations.size(), 3U);
  EXPECT_EQ(report.violations[2].elements[0], 2U);
}

TEST(ValidateCage, StopsAtTheFirstFailingCheckWhenAsked) {
  TriangleMesh cage = make_cube();
  cage.triangles.pop_back();
  const TriangleMesh model = scaled(small_model(), 1, {9, 0, 0});
  const ValidityReport report = judge(cage, model, {.first_only = true});
  EXPECT_EQ(kinds(report), Kinds{"open_edge"});
  EXPECT_FALSE(report.valid());
}

TEST(ValidateCage, CanBeCancelled) {
  StopFlag stop;
  stop.request_stop();
  const auto report = validate_cage(make_cube(), small_model(), {}, Progress(stop));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::cancelled);
}

TEST(ValidateCage, TellsSidesOfALatticeExactly) {
  // Model vertices on the lattice that the cage's vertices are on too.
  const TriangleMesh cage = scaled(make_cube(), 4);
  TriangleMesh model;
  for (int i = 0; i < 11 * 11 * 11; ++i) {
    model.positions.emplace_back(i % 11 - 5, i / 11 % 11 - 5, i / 121 - 5);
  }
  const ValidityReport report = judge(cage, model);
  EXPECT_EQ(report.count(ViolationKind::vertex_outside), 11U * 11 * 11 - 9 * 9 * 9);
  EXPECT_EQ(report.count(ViolationKind::vertex_on_cage), 9U * 9 * 9 - 7 * 7 * 7);
}

TEST(IsEmbedded, AcceptsPiecesButNothingElse) {
  EXPECT_TRUE(is_embedded(make_torus(0.3, 12, 8)));
  EXPECT_TRUE(is_embedded(joined(make_cube(), scaled(make_cube(), 1, {3, 0, 0}))));
  EXPECT_FALSE(is_embedded(joined(make_cube(), scaled(make_cube(), 1, {1, 0.5, 0.3}))));
  EXPECT_FALSE(is_embedded(cubes_sharing_an_edge()));
  EXPECT_FALSE(is_embedded(flipped(make_cube())));
  EXPECT_FALSE(is_embedded(TriangleMesh()));
}

} // namespace
} // namespace cagewright
