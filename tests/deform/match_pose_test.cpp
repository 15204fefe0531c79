#include <cagewright/deform/match_pose.h>

#include "mesh/shapes.h"
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cagewright {
namespace {

PolygonMesh cube() {
  PolygonMesh mesh;
  for (const double z : {-1, 1}) {
    for (const double y : {-1, 1}) {
      for (const double x : {-1, 1}) {
        mesh.positions.emplace_back(x, y, z);
      }
    }
  }
  mesh.add_face({0, 2, 3, 1});
  mesh.add_face({4, 5, 7, 6});
  mesh.add_face({0, 1, 5, 4});
  mesh.add_face({2, 6, 7, 3});
  mesh.add_face({0, 4, 6, 2});
  mesh.add_face({1, 3, 7, 5});
  return mesh;
}

Vec3 moved(const Vec3& p) {
  return {2 * p.x() + p.y(), p.y() + 0.25 * p.z(), p.z() + 3};
}

PolygonMesh posed(PolygonMesh mesh) {
  for (Vec3& p : mesh.positions) {
    p = moved(p);
  }
  return mesh;
}

/// The same mesh with other faces.
template <class Faces> PolygonMesh with_faces(const PolygonMesh& mesh, const Faces& faces) {
  PolygonMesh result;
  result.positions = mesh.positions;
  for (const std::vector<Index>& face : faces) {
    result.add_face(face);
  }
  return result;
}

std::vector<std::vector<Index>> faces_of(const PolygonMesh& mesh) {
  std::vector<std::vector<Index>> faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
  }
  return faces;
}

/// Every face with vertices of its own.
PolygonMesh split(const PolygonMesh& mesh) {
  PolygonMesh result;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) {
      face.push_back(static_cast<Index>(result.positions.size()));
      result.positions.push_back(mesh.positions[v]);
    }
    result.add_face(face);
  }
  return result;
}

PolygonMesh cut(const PolygonMesh& mesh) {
  return PolygonMesh(to_triangle_mesh(mesh));
}

void expect_matched(const PolygonMesh& rest, const PolygonMesh& pose, bool with_note) {
  const Result<MatchedPose> matched = match_pose(rest, pose, "pose.obj");
  ASSERT_TRUE(matched) << matched.error().message;
  ASSERT_EQ(matched->positions.size(), rest.positions.size());
  for (std::size_t v = 0; v < rest.positions.size(); ++v) {
    EXPECT_EQ(matched->positions[v], moved(rest.positions[v])) << v;
  }
  EXPECT_EQ(!matched->note.empty(), with_note) << matched->note;
}

void expect_refused(const PolygonMesh& rest, const PolygonMesh& pose, const char* words) {
  const Result<MatchedPose> matched = match_pose(rest, pose, "pose.obj");
  ASSERT_FALSE(matched) << words;
  EXPECT_EQ(matched.error().code, ErrorCode::mismatch);
  EXPECT_NE(matched.error().message.find(words), std::string::npos) << matched.error().message;
}

TEST(MatchPose, TakesTheSameCage) {
  expect_matched(cube(), posed(cube()), false);
}

TEST(MatchPose, TakesFacesThatBeginElsewhereOrAreListedInAnotherOrder) {
  auto faces = faces_of(cube());
  std::ranges::reverse(faces);
  for (std::vector<Index>& face : faces) {
    std::rotate(face.begin(), face.begin() + 1, face.end());
  }
  expect_matched(cube(), posed(with_faces(cube(), faces)), false);
}

TEST(MatchPose, TakesFacesThatAreCutOtherwise) {
  expect_matched(cube(), posed(cut(cube())), true);
  expect_matched(cut(cube()), posed(cube()), true);
  // Along the other diagonals.
  std::vector<std::vector<Index>> other;
  for (const std::vector<Index>& face : faces_of(cube())) {
    other.push_back({face[1], face[2], face[3]});
    other.push_back({face[1], face[3], face[0]});
  }
  expect_matched(with_faces(cube(), other), posed(cut(cube())), true);
}

TEST(MatchPose, TakesSplitAndMergedVertices) {
  expect_matched(cube(), posed(split(cube())), true);
  expect_matched(split(cube()), posed(cube()), true);
  expect_matched(cube(), posed(split(cut(cube()))), true);
  expect_matched(split(cut(cube())), posed(cut(cube())), true);
}

TEST(MatchPose, TakesVerticesInAnotherOrderByTheirFaces) {
  PolygonMesh pose;
  const std::vector<Index> order = {3, 1, 7, 0, 2, 6, 5, 4}; // the new number of each
  pose.positions.resize(8);
  for (Index v = 0; v < 8; ++v) {
    pose.positions[order[v]] = moved(cube().positions[v]);
  }
  for (std::vector<Index> face : faces_of(cube())) {
    for (Index& v : face) {
      v = order[v];
    }
    pose.add_face(face);
  }
  expect_matched(cube(), pose, true);
}

TEST(MatchPose, IgnoresLooseVertices) {
  PolygonMesh pose = posed(cube());
  pose.positions.insert(pose.positions.begin(), Vec3(9, 9, 9));
  std::vector<std::vector<Index>> faces = faces_of(cube());
  for (std::vector<Index>& face : faces) {
    for (Index& v : face) {
      ++v;
    }
  }
  expect_matched(cube(), with_faces(pose, faces), true);
}

TEST(MatchPose, RefusesAnotherCageWithBothCountsAndARemedy) {
  PolygonMesh more = posed(cube());
  more.positions.emplace_back(5, 5, 5);
  more.add_face({0, 1, 8});
  expect_refused(cube(), more, "has 9 vertices and 7 faces, the cage at rest 8 vertices and 6");
  expect_refused(cube(), more, "pose a copy");
  // Two vertices exchanged, the faces in another order: nothing tells which is which.
  PolygonMesh swapped = posed(cube());
  std::swap(swapped.positions[0], swapped.positions[7]);
  std::vector<std::vector<Index>> faces = faces_of(cube());
  for (std::vector<Index>& face : faces) {
    for (Index& v : face) {
      v = v == 0 ? 7 : v == 7 ? 0 : v;
    }
  }
  std::ranges::reverse(faces);
  expect_refused(cube(), with_faces(swapped, faces), "vertex order");
}

} // namespace
} // namespace cagewright
