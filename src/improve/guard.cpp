#include "improve/guard.h"

#include "exact/predicates.h"
#include "mesh/disjoint_sets.h"
#include "mesh/solid_angle.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

namespace cagewright {

namespace {

Box3 box_of(const Corners& t) {
  Box3 box(t[0]);
  box.extend(t[1]);
  box.extend(t[2]);
  return box;
}

// One step outward after rounding: the float box contains the double one.
float down(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float up(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

// Vertices at the same place are one: files often store a corner once for each of its faces.
std::vector<Index> weld(std::span<const Vec3> positions) {
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [&](Index a, Index b) {
    const Vec3& p = positions[a];
    const Vec3& q = positions[b];
    return std::tuple(p.x(), p.y(), p.z(), a) < std::tuple(q.x(), q.y(), q.z(), b);
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<Index> representative(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i - 1]] == positions[order[i]];
    representative[order[i]] = same ? representative[order[i - 1]] : order[i];
  }
  return representative;
}

TriangleMesh with_strays(TriangleView model) {
  TriangleMesh result{{model.positions.begin(), model.positions.end()},
                      {model.triangles.begin(), model.triangles.end()}};
  std::vector<bool> used(model.positions.size(), false);
  for (const Triangle& t : model.triangles) {
    used[t[0]] = used[t[1]] = used[t[2]] = true;
  }
  for (Index v = 0; v < used.size(); ++v) {
    if (!used[v]) {
      result.triangles.push_back({v, v, v});
    }
  }
  return result;
}

std::vector<ModelSurface::Part> connected_parts(TriangleView model) {
  const std::vector<Index> welded = weld(model.positions);
  DisjointSets sets(welded.size());
  for (Index v = 0; v < welded.size(); ++v) {
    sets.join(v, welded[v]);
  }
  for (const Triangle& t : model.triangles) {
    sets.join(t);
  }
  std::vector<ModelSurface::Part> parts;
  std::vector<Index> part_of(model.positions.size(), no_index);
  for (const Triangle& t : model.triangles) {
    Index& part = part_of[sets.find(t[0])];
    if (part == no_index) {
      part = static_cast<Index>(parts.size());
      parts.push_back({Box3(), model.positions[t[0]]});
    }
    for (const Index v : t) {
      parts[part].box.extend(model.positions[v]);
    }
  }
  return parts;
}

// True only if the direction separates the points `s` from the points `t`, all relative to one
// origin, whatever the rounding errors in the differences and products.
bool separates(const Vec3& direction, std::span<const Vec3> s, std::span<const Vec3> t) {
  constexpr double rounding = 1e-14; // a few times 2^-53, of sums of three products
  const Vec3 size = direction.cwiseAbs();
  double low_s = std::numeric_limits<double>::infinity();
  double high_s = -low_s;
  double low_t = low_s;
  double high_t = -low_s;
  double largest = 0;
  for (const Vec3& p : s) {
    const double x = direction.dot(p);
    low_s = std::min(low_s, x);
    high_s = std::max(high_s, x);
    largest = std::max(largest, size.dot(p.cwiseAbs()));
  }
  for (const Vec3& p : t) {
    const double x = direction.dot(p);
    low_t = std::min(low_t, x);
    high_t = std::max(high_t, x);
    largest = std::max(largest, size.dot(p.cwiseAbs()));
  }
  // Not of products that underflow.
  const double margin = rounding * largest + std::numeric_limits<double>::min();
  return low_s > high_t + margin || low_t > high_s + margin;
}

// True only if the faces do not cross; it is much quicker than to find out exactly, above all for
// faces in one plane. They must not share an edge.
bool clearly_apart(const Triangle& s, const Corners& at_s, const Triangle& t, const Corners& at_t) {
  int shared_s = -1;
  int shared_t = -1;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (s[i] == t[j]) {
        if (shared_s >= 0) {
          return false;
        }
        shared_s = i;
        shared_t = j;
      }
    }
  }
  const Vec3& origin = shared_s >= 0 ? at_s[shared_s] : at_s[0];
  std::array<Vec3, 3> from_s;
  std::array<Vec3, 3> from_t;
  int count_s = 0;
  int count_t = 0;
  // A corner that both share lies on every plane through it: the others must lie beside.
  for (int i = 0; i < 3; ++i) {
    if (i != shared_s) {
      from_s[count_s++] = at_s[i] - origin;
    }
    if (i != shared_t) {
      from_t[count_t++] = at_t[i] - origin;
    }
  }
  const std::span<const Vec3> all_s(from_s.data(), count_s);
  const std::span<const Vec3> all_t(from_t.data(), count_t);
  if (shared_s >= 0) {
    // Both are cones from the corner: a plane through it has to separate them.
    const Vec3 middle_s = from_s[0].normalized() + from_s[1].normalized();
    const Vec3 middle_t = from_t[0].normalized() + from_t[1].normalized();
    const auto apart = [&](const Vec3& direction) {
      const std::array<Vec3, 1> corner = {Vec3::Zero()};
      return separates(direction, all_s, corner) && separates(direction, all_t, corner) &&
             (direction.dot(all_s[0]) > 0) != (direction.dot(all_t[0]) > 0);
    };
    return apart(middle_s - middle_t) || apart(middle_s.normalized() - middle_t.normalized());
  }
  const Vec3 normal_s = (from_s[1] - from_s[0]).cross(from_s[2] - from_s[0]);
  const Vec3 normal_t = (from_t[1] - from_t[0]).cross(from_t[2] - from_t[0]);
  if (separates(normal_s, all_s, all_t) || separates(normal_t, all_s, all_t)) {
    return true;
  }
  for (int i = 0; i < 3; ++i) {
    if (separates((from_s[(i + 1) % 3] - from_s[i]).cross(normal_s), all_s, all_t) ||
        separates((from_t[(i + 1) % 3] - from_t[i]).cross(normal_t), all_s, all_t)) {
      return true;
    }
  }
  return false;
}

} // namespace

FaceBoxes::FaceBoxes(const CageMesh& cage) {
  Box3 box;
  for (Index v = 0; v < cage.vertex_end(); ++v) {
    box.extend(cage.position(v));
  }
  origin_ = box.center();
  for (Index f = 0; f < cage.face_end(); ++f) {
    update(cage, f);
  }
}

void FaceBoxes::update(const CageMesh& cage, Index face) {
  constexpr float never = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (face >= low_[k].size()) {
      low_[k].resize(face + 1, never);
      high_[k].resize(face + 1, -never);
    }
    low_[k][face] = never;
    high_[k][face] = -never;
    if (cage.has_face(face)) {
      for (const Index v : cage.face(face)) {
        const double x = cage.position(v)[k] - origin_[k];
        low_[k][face] = std::min(low_[k][face], down(x));
        high_[k][face] = std::max(high_[k][face], up(x));
      }
    }
  }
}

void FaceBoxes::find(const Box3& box, std::vector<Index>& found) const {
  float low[3];
  float high[3];
  for (int k = 0; k < 3; ++k) {
    low[k] = down(box.min()[k] - origin_[k]);
    high[k] = up(box.max()[k] - origin_[k]);
  }
  constexpr std::size_t block = 64; // tested without branches, so that the compiler vectorises
  std::array<unsigned char, block> hit{};
  const std::size_t count = low_[0].size();
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t size = std::min(block, count - begin);
    unsigned char any = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t f = begin + i;
      const auto overlaps = [&](int k) {
        return static_cast<int>(low_[k][f] <= high[k]) & static_cast<int>(high_[k][f] >= low[k]);
      };
      hit[i] = static_cast<unsigned char>(overlaps(0) & overlaps(1) & overlaps(2));
      any |= hit[i];
    }
    for (std::size_t i = 0; any != 0 && i < size; ++i) {
      if (hit[i] != 0) {
        found.push_back(static_cast<Index>(begin + i));
      }
    }
  }
}

ModelSurface::ModelSurface(TriangleView model, double unit)
    : mesh(with_strays(model)), tree(mesh),
      diagonal(unit > 0 ? unit : bounding_box(TriangleView(mesh)).diagonal().norm()),
      box(bounding_box(model.positions)), parts(connected_parts(mesh)) {}

std::optional<ClosestPoints> Guard::too_near(const CageMesh& cage, const Patch& patch) const {
  for (const Triangle& t : patch.added) {
    if (const auto pair = model_->tree.too_near(corners_after(cage, patch, t), clearance_)) {
      return pair;
    }
  }
  return std::nullopt;
}

bool Guard::crosses(const CageMesh& cage, const FaceBoxes& boxes, const Patch& patch) const {
  std::vector<Corners> corners;
  std::vector<Box3> bounds;
  Box3 all;
  for (const Triangle& t : patch.added) {
    corners.push_back(corners_after(cage, patch, t));
    if (is_degenerate(corners.back()[0], corners.back()[1], corners.back()[2])) {
      return true;
    }
    bounds.push_back(box_of(corners.back()));
    all.extend(bounds.back());
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (faces_cross(patch.added[i], corners[i], patch.added[j], corners[j])) {
        return true;
      }
    }
  }
  std::vector<Index> near;
  boxes.find(all, near);
  for (const Index f : near) {
    if (std::find(patch.removed.begin(), patch.removed.end(), f) != patch.removed.end()) {
      continue;
    }
    const Triangle& t = cage.face(f);
    const Corners at{cage.position(t[0]), cage.position(t[1]), cage.position(t[2])};
    const Box3 box = box_of(at);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (bounds[i].intersects(box) && faces_cross(patch.added[i], corners[i], t, at)) {
        return true;
      }
    }
  }
  return false;
}

bool Guard::loses_a_part(const CageMesh& cage, const Patch& patch) const {
  Box3 box;
  for (const Index f : patch.removed) {
    for (const Index v : cage.face(f)) {
      box.extend(cage.position(v));
    }
  }
  if (patch.vertex != no_index) {
    box.extend(patch.position);
  }
  if (cage.is_half()) {
    box.extend(mirrored(box.max()));
    box.extend(mirrored(box.min()));
  }
  for (const ModelSurface::Part& part : model_->parts) {
    if (!box.contains(part.box)) {
      continue;
    }
    double angle = 0; // of the closed surface: old faces, and the new ones inside out
    for (const Index f : patch.removed) {
      angle += solid_angle(cage, part.point, corners_of(cage, f));
    }
    for (const Triangle& t : patch.added) {
      angle -= solid_angle(cage, part.point, corners_after(cage, patch, t));
    }
    if (std::abs(angle) > 2 * std::numbers::pi) {
      return true;
    }
  }
  return false;
}

Corners corners_after(const CageMesh& cage, const Patch& patch, const Triangle& t) {
  const auto at = [&](Index v) { return v == patch.vertex ? patch.position : cage.position(v); };
  return {at(t[0]), at(t[1]), at(t[2])};
}

bool faces_cross(const Triangle& s, const Corners& at_s, const Triangle& t, const Corners& at_t) {
  if (clearly_apart(s, at_s, t, at_t)) {
    return false;
  }
  std::array<Vec3, 6> positions;
  std::copy(at_s.begin(), at_s.end(), positions.begin());
  std::copy(at_t.begin(), at_t.end(), positions.begin() + 3);
  Triangle second{3, 4, 5};
  for (int i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      if (t[i] == s[j]) {
        second[i] = j;
      }
    }
  }
  return faces_cross(positions, Triangle{0, 1, 2}, second);
}

double solid_angle(const Vec3& p, const Corners& t) {
  return solid_angle(p, t[0], t[1], t[2]);
}

double solid_angle(const CageMesh& cage, const Vec3& p, const Corners& t) {
  // The mirror image of t is seen from p as t is from the mirror image of p.
  return solid_angle(p, t) + (cage.is_half() ? solid_angle(mirrored(p), t) : 0);
}

} // namespace cagewright
