#include <cagewright/deform/normals.h>

#include "core/maths.h"
#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cagewright {
namespace {

constexpr std::size_t grain = 2048;

Vec3 normalized_or_zero(const Vec3& v) {
  const double square = v.squaredNorm();
  // Tiny and huge models: their squares are beyond the range of double.
  const double length = square > 1e-200 && square < 1e200 ? std::sqrt(square) : v.stableNorm();
  return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

/// Twice the area vector of a polygon (Newell's method, from its first corner).
Vec3 area_vector(std::span<const Vec3> positions, std::span<const Index> face) {
  const Vec3& origin = positions[face[0]];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += (positions[face[i]] - origin).cross(positions[face[i + 1]] - origin);
  }
  return sum;
}

/// Turns `v` as the shortest rotation turns one unit vector into another; leaves it where one of
/// them is zero, and to the last bit where they are equal.
Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
  if (from == to || from.isZero(0) || to.isZero(0)) {
    return v;
  }
  const Vec3 axis = from.cross(to);
  const double cosine = from.dot(to);
  if (cosine < -0.999999) { // half a turn has no axis of its own: what was out is in now
    return -v;
  }
  return v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1 + cosine));
}

} // namespace

NormalSlots smooth_normals(const PolygonMesh& mesh) {
  const std::span<const Index> corners = mesh.corners();
  return {{corners.begin(), corners.end()}, mesh.positions.size(), {}};
}

NormalField::NormalField(const PolygonMesh& mesh, NormalSlots slots, NormalWeighting weighting)
    : corners_(mesh.corners().begin(), mesh.corners().end()), slots_(std::move(slots)),
      weighting_(weighting) {
  assert(slots_.of_corner.size() == corners_.size());
  face_begins_ = {0};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    face_begins_.push_back(face_begins_.back() + mesh.face(f).size());
    face_of_corner_.resize(face_begins_.back(), static_cast<Index>(f));
  }
  slot_begins_.assign(slots_.count + 1, 0);
  for (const Index slot : slots_.of_corner) {
    if (slot != NormalSlots::none) {
      ++slot_begins_[slot + 1];
    }
  }
  std::partial_sum(slot_begins_.begin(), slot_begins_.end(), slot_begins_.begin());
  slot_corners_.resize(slot_begins_.back());
  std::vector<std::size_t> next(slot_begins_.begin(), slot_begins_.end() - 1);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (const Index slot = slots_.of_corner[c]; slot != NormalSlots::none) {
      slot_corners_[next[slot]++] = static_cast<Index>(c);
    }
  }
  face_normals_.assign(mesh.face_count(), Vec3::Zero());
  list_faces_of_tiles();
  changed_faces_.reserve(mesh.face_count());
  changed_slots_.reserve(slots_.count);
  face_changes_.assign(mesh.face_count(), 0);
  slot_changes_.assign(slots_.count, 0);
  normals_.assign(slots_.count, Vec3::Zero());

  std::vector<Vec3> given = std::move(slots_.given); // the first pass computes the means
  slots_.given.clear();
  update(mesh.positions);
  if (!given.empty()) {
    rest_means_ = normals_;
    normals_ = given;
    slots_.given = std::move(given);
  }
}

void NormalField::list_faces_of_tiles() {
  Index vertices = 0;
  for (const Index v : corners_) {
    vertices = std::max(vertices, v + 1);
  }
  const std::size_t tiles = (std::size_t(vertices) + 15) / 16;
  tile_begins_.assign(tiles + 1, 0);
  // Once to count, once to fill; a face with two corners in a tile follows itself in its list.
  std::vector<Index> last(tiles);
  for (const bool fill : {false, true}) {
    std::fill(last.begin(), last.end(), std::numeric_limits<Index>::max());
    std::vector<std::size_t> next(tile_begins_.begin(), tile_begins_.end() - 1);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const std::size_t tile = corners_[c] / 16;
      const Index face = face_of_corner_[c];
      if (std::exchange(last[tile], face) == face) {
        continue;
      }
      if (fill) {
        tile_faces_[next[tile]++] = face;
      } else {
        ++tile_begins_[tile + 1];
      }
    }
    if (!fill) {
      std::partial_sum(tile_begins_.begin(), tile_begins_.end(), tile_begins_.begin());
      tile_faces_.resize(tile_begins_.back());
    }
  }
}

void NormalField::update(std::span<const Vec3> positions,
                         std::span<const std::uint8_t> moved_tiles) {
  const auto moved = static_cast<std::size_t>(
      std::count_if(moved_tiles.begin(), moved_tiles.end(), [](auto t) { return t != 0; }));
  if (moved_tiles.empty() || 2 * moved > moved_tiles.size()) { // lists would cost more
    parallel_for(0, face_normals_.size(), grain, [&](std::size_t f) { update_face(f, positions); });
    parallel_for(0, normals_.size(), grain, [&](std::size_t s) { update_slot(s, positions); });
    return;
  }
  find_changed(moved_tiles);
  parallel_for(0, changed_faces_.size(), grain,
               [&](std::size_t i) { update_face(changed_faces_[i], positions); });
  parallel_for(0, changed_slots_.size(), grain,
               [&](std::size_t i) { update_slot(changed_slots_[i], positions); });
}

/// Lists the faces at moved tiles and the slots at their corners, each once.
void NormalField::find_changed(std::span<const std::uint8_t> moved_tiles) {
  changed_faces_.clear();
  changed_slots_.clear();
  const std::size_t tiles = std::min(moved_tiles.size(), tile_begins_.size() - 1);
  for (std::size_t t = 0; t < tiles; ++t) {
    if (moved_tiles[t] == 0) {
      continue;
    }
    for (std::size_t i = tile_begins_[t]; i < tile_begins_[t + 1]; ++i) {
      const Index face = tile_faces_[i];
      if (std::exchange(face_changes_[face], std::uint8_t(1)) == 0) {
        changed_faces_.push_back(face);
      }
    }
  }
  for (const Index face : changed_faces_) {
    face_changes_[face] = 0;
    for (std::size_t c = face_begins_[face]; c < face_begins_[face + 1]; ++c) {
      const Index slot = slots_.of_corner[c];
      if (slot != NormalSlots::none && std::exchange(slot_changes_[slot], std::uint8_t(1)) == 0) {
        changed_slots_.push_back(slot);
      }
    }
  }
  for (const Index slot : changed_slots_) {
    slot_changes_[slot] = 0;
  }
}

void NormalField::update_face(std::size_t f, std::span<const Vec3> positions) {
  const std::span<const Index> face =
      std::span(corners_).subspan(face_begins_[f], face_begins_[f + 1] - face_begins_[f]);
  const Vec3 area = area_vector(positions, face);
  face_normals_[f] = weighting_ == NormalWeighting::area ? area : normalized_or_zero(area);
}

void NormalField::update_slot(std::size_t slot, std::span<const Vec3> positions) {
  if (slot_begins_[slot] == slot_begins_[slot + 1]) {
    return;
  }
  const Vec3 mean = mean_normal(slot, positions);
  normals_[slot] =
      slots_.given.empty() ? mean : turned(slots_.given[slot], rest_means_[slot], mean);
}

Vec3 NormalField::mean_normal(std::size_t slot, std::span<const Vec3> positions) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = slot_begins_[slot]; i < slot_begins_[slot + 1]; ++i) {
    const Index corner = slot_corners_[i];
    const Index face = face_of_corner_[corner];
    double weight = 1;
    if (weighting_ == NormalWeighting::angle) {
      const std::size_t begin = face_begins_[face];
      const std::size_t size = face_begins_[face + 1] - begin;
      const std::size_t k = corner - begin;
      const Vec3& here = positions[corners_[corner]];
      const Vec3 to_next = positions[corners_[begin + (k + 1) % size]] - here;
      const Vec3 to_last = positions[corners_[begin + (k + size - 1) % size]] - here;
      weight = maths::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
    }
    sum += weight * face_normals_[face];
  }
  return normalized_or_zero(sum);
}

} // namespace cagewright
