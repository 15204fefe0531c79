/// \file
/// What is claimed of cages that are their own mirror images.
#pragma once

#include <cagewright/cage/generate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace cagewright::test {

/// What is not as it was asked for or might be expected: the first of it, or nothing.
inline std::string first_remark(const GeneratedCage& made) {
  return made.remarks.empty() ? std::string() : made.remarks.front().message;
}

/// The corners of a face, begun at the least.
inline std::vector<Index> key(std::span<const Index> face) {
  std::vector<Index> corners(face.begin(), face.end());
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Partners are mutual, and the faces of the partners of a face's corners are its partner's.
inline void expect_paired(const GeneratedCage& made) {
  ASSERT_TRUE(made.mirror) << first_remark(made);
  const MirrorPairing& mirror = *made.mirror;
  ASSERT_EQ(mirror.vertex_partners.size(), made.faces.positions.size());
  for (Index v = 0; v < mirror.vertex_partners.size(); ++v) {
    ASSERT_LT(mirror.vertex_partners[v], mirror.vertex_partners.size());
    EXPECT_EQ(mirror.vertex_partners[mirror.vertex_partners[v]], v);
  }
  ASSERT_EQ(mirror.face_partners.size(), made.faces.face_count());
  for (Index f = 0; f < mirror.face_partners.size(); ++f) {
    std::vector<Index> image;
    for (const Index v : made.faces.face(f)) {
      image.insert(image.begin(), mirror.vertex_partners[v]);
    }
    EXPECT_EQ(key(image), key(made.faces.face(mirror.face_partners[f])));
    EXPECT_NE(mirror.face_partners[f], f);
  }
}

/// Every vertex and every face has its partner, across one of the world's axes, without rounding.
inline void expect_paired_exactly(const GeneratedCage& made) {
  ASSERT_TRUE(made.mirror) << first_remark(made);
  const MirrorPairing& mirror = *made.mirror;
  const int axis = mirror.plane.axis();
  ASSERT_GE(axis, 0);
  EXPECT_EQ(mirror.error, 0);
  const std::vector<Vec3>& at = made.triangles.positions;
  ASSERT_EQ(mirror.vertex_partners.size(), at.size());
  for (Index v = 0; v < at.size(); ++v) {
    const Index partner = mirror.vertex_partners[v];
    Vec3 sum = at[v] + at[partner];
    EXPECT_EQ(sum[axis], 2 * mirror.plane.offset);
    sum -= 2 * at[v];
    sum[axis] = 0;
    EXPECT_EQ(sum, Vec3(Vec3::Zero()));
    EXPECT_EQ(partner == v, at[v][axis] == mirror.plane.offset);
  }
  expect_paired(made);
}

} // namespace cagewright::test
