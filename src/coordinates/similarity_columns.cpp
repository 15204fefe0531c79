#include "coordinates/similarity_columns.h"

#include "coordinates/similarity.h"
#include <cagewright/mesh/measures.h>

#include <cassert>

namespace cagewright {

SimilarityColumns::SimilarityColumns(std::span<const Vec3> cage_at_rest)
    : ColumnRule(cage_at_rest), middle_(Vec3::Zero()), unit_(diagonal(cage_at_rest)) {
  for (const Vec3& c : cage_at_rest) {
    middle_ += c / static_cast<double>(cage_at_rest.size());
  }
}

std::vector<ColumnGroup> SimilarityColumns::groups() const {
  return {{"vertices", cage_at_rest().size()}, {"position", 3}};
}

void SimilarityColumns::move(std::span<const Vec3> cage, std::span<Vec3> moves) const {
  const std::span<const Vec3> rest = cage_at_rest();
  assert(cage.size() == rest.size() && moves.size() == rest.size() + 3);
  const Similarity best = best_similarity(rest, cage);
  const Mat3 map = best.scale * best.turn;
  // The weights of the vertices sum to 1: they carry the translation.
  for (std::size_t c = 0; c < rest.size(); ++c) {
    moves[c] = (cage[c] - rest[c]) - (map - Mat3::Identity()) * (rest[c] - middle_);
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    moves[rest.size() + static_cast<std::size_t>(axis)] =
        unit_ * (map - Mat3::Identity()).col(axis);
  }
}

} // namespace cagewright
