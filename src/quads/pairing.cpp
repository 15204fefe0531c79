#include "quads/pairing.h"

#include "core/parallel.h"
#include "quads/matching.h"

#include <algorithm>

namespace cagewright {

double cost_of(std::span<const Vec3> x, const DirectionField& field, const Taste& taste,
               const CageFace& face) {
  double cost = face_defect(x, face, taste.wishes) + (face.tentative ? taste.tentative : 0);
  for (int i = 0; i < face.size; ++i) {
    const Index a = face[i];
    const Index b = face[i + 1];
    cost += taste.alignment / 2 * field.misalignment(a, b, x[b] - x[a]);
  }
  return cost;
}

std::vector<PairOfTriangles> neighboring_triangles(const QuadCage& cage) {
  std::vector<PairOfTriangles> pairs;
  for (Index f = 0; f < cage.face_end(); ++f) {
    const CageFace& t = cage.face(f);
    for (int i = 0; i < t.size && t.size == 3; ++i) {
      const Index other = cage.face_left_of(t[i + 1], t[i]);
      if (other == no_index || other < f || cage.face(other).is_quad() ||
          cage.face(other).part != t.part) {
        continue;
      }
      const CageFace& s = cage.face(other);
      int k = 0;
      while (s[k] == t[i] || s[k] == t[i + 1]) {
        ++k;
      }
      pairs.push_back({f, other, CageFace::quad(t[i], s[k], t[i + 1], t[i + 2]).of_part(t.part)});
    }
  }
  return pairs;
}

std::size_t pair_triangles(QuadCage& cage, const QuadGuard& guard, const DirectionField& field,
                           const Taste& taste) {
  std::vector<PairOfTriangles> pairs = neighboring_triangles(cage);
  std::vector<double> costs(pairs.size(), unfit);
  const std::vector<Box3> boxes = face_boxes(cage, cage.positions());
  const bool tentative = taste.wishes.beyond > 0;
  parallel_for(0, pairs.size(), 1, [&](std::size_t i) {
    PairOfTriangles& pair = pairs[i];
    const double cost = cost_of(cage.positions(), field, taste, pair.quad);
    if (cost < unfit &&
        guard.allows(cage, boxes, std::array{pair.left, pair.right}, {&pair.quad, 1}, tentative)) {
      costs[i] = cost_of(cage.positions(), field, taste, pair.quad) -
                 cost_of(cage.positions(), field, taste, cage.face(pair.left)) -
                 cost_of(cage.positions(), field, taste, cage.face(pair.right));
    }
  });
  std::vector<PossiblePair> possible;
  std::vector<CageFace> quads;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (costs[i] <= 0) {
      possible.push_back({pairs[i].left, pairs[i].right, costs[i]});
      quads.push_back(pairs[i].quad);
    }
  }
  std::size_t made = 0;
  std::vector<Box3> now = boxes;
  for (const std::size_t i : most_pairs(cage.face_end(), possible)) {
    const std::array<Index, 2> removed{possible[i].first, possible[i].second};
    std::array<CageFace, 1> added{quads[i]};
    // Quads made before may be in the way of this one's other diagonal.
    if (guard.allows(cage, now, removed, added, tentative)) {
      cage.replace(removed, added);
      now.push_back(box_of(cage.positions(), added[0]));
      ++made;
    }
  }
  return made;
}

} // namespace cagewright
