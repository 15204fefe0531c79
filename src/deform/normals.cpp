#include "deform/normals.h"

#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace cagewright {
namespace {

constexpr std::size_t grain = 2048;

Vec3 normalized_or_zero(const Vec3& v) {
  const double length = v.stableNorm();
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
/// them is zero.
Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
  if (from.isZero(0) || to.isZero(0)) {
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
    ++slot_begins_[slot + 1];
  }
  std::partial_sum(slot_begins_.begin(), slot_begins_.end(), slot_begins_.begin());
  slot_corners_.resize(corners_.size());
  std::vector<std::size_t> next(slot_begins_.begin(), slot_begins_.end() - 1);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    slot_corners_[next[slots_.of_corner[c]]++] = static_cast<Index>(c);
  }
  face_normals_.assign(mesh.face_count(), Vec3::Zero());
  changed_faces_.resize(mesh.face_count());
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

void NormalField::update(std::span<const Vec3> positions,
                         std::span<const std::uint8_t> moved_tiles) {
  update_faces(positions, moved_tiles);
  update_slots(positions);
}

void NormalField::update_faces(std::span<const Vec3> positions,
                               std::span<const std::uint8_t> moved_tiles) {
  parallel_for(0, face_normals_.size(), grain, [&](std::size_t f) {
    const std::span<const Index> face =
        std::span(corners_).subspan(face_begins_[f], face_begins_[f + 1] - face_begins_[f]);
    changed_faces_[f] = moved_tiles.empty() || std::any_of(face.begin(), face.end(), [&](Index v) {
                          return moved_tiles[v / 16] != 0;
                        });
    if (changed_faces_[f] != 0) {
      const Vec3 area = area_vector(positions, face);
      face_normals_[f] = weighting_ == NormalWeighting::area ? area : normalized_or_zero(area);
    }
  });
}

void NormalField::update_slots(std::span<const Vec3> positions) {
  parallel_for(0, normals_.size(), grain, [&](std::size_t slot) {
    const auto begin = slot_corners_.begin() + static_cast<std::ptrdiff_t>(slot_begins_[slot]);
    const auto end = slot_corners_.begin() + static_cast<std::ptrdiff_t>(slot_begins_[slot + 1]);
    if (std::none_of(begin, end,
                     [&](Index c) { return changed_faces_[face_of_corner_[c]] != 0; })) {
      return;
    }
    const Vec3 mean = mean_normal(slot, positions);
    normals_[slot] =
        slots_.given.empty() ? mean : turned(slots_.given[slot], rest_means_[slot], mean);
  });
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
      weight = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
    }
    sum += weight * face_normals_[face];
  }
  return normalized_or_zero(sum);
}

} // namespace cagewright
