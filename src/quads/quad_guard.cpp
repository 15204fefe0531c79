#include "quads/quad_guard.h"

#include "core/parallel.h"
#include "exact/predicates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

Corners at(std::span<const Vec3> positions, const Triangle& t) {
  return {positions[t[0]], positions[t[1]], positions[t[2]]};
}

Box3 box_of(const Corners& t) {
  Box3 box(t[0]);
  box.extend(t[1]);
  box.extend(t[2]);
  return box;
}

bool has_side(const CageFace& face, Index a, Index b) {
  for (int i = 0; i < face.size; ++i) {
    if (face[i] == a && face[i + 1] == b) {
      return true;
    }
  }
  return false;
}

bool crosses(std::span<const Vec3> positions, const Triangle& p, const CageFace& t) {
  const Corners at_p = at(positions, p);
  const Box3 box = box_of(at_p);
  for (const Triangle& q : FaceParts(t)) {
    const Corners at_q = at(positions, q);
    if (box.intersects(box_of(at_q)) && faces_cross(p, at_p, q, at_q)) {
      return true;
    }
  }
  return false;
}

bool cross(std::span<const Vec3> positions, const CageFace& s, const CageFace& t) {
  if (!fit_together(s, t)) {
    return true;
  }
  const FaceParts parts(s);
  return std::any_of(parts.begin(), parts.end(),
                     [&](const Triangle& p) { return crosses(positions, p, t); });
}

} // namespace

std::optional<bool> KnownClear::find(const Triangle& sorted) const {
  const auto it = known_.find(sorted);
  return it != known_.end() ? std::optional(it->second) : std::nullopt;
}

void KnownClear::add(const Triangle& sorted, bool is_clear) {
  known_.emplace(sorted, is_clear);
}

bool fit_together(const CageFace& s, const CageFace& t) {
  std::array<Index, 4> shared{};
  int count = 0;
  for (const Index v : s.span()) {
    if (t.has(v)) {
      shared[count++] = v;
    }
  }
  return count < 2 ||
         (count == 2 && ((has_side(s, shared[0], shared[1]) && has_side(t, shared[1], shared[0])) ||
                         (has_side(s, shared[1], shared[0]) && has_side(t, shared[0], shared[1]))));
}

Box3 box_of(std::span<const Vec3> positions, const CageFace& face) {
  Box3 box;
  for (const Index v : face.span()) {
    box.extend(positions[v]);
  }
  return box;
}

std::vector<Box3> face_boxes(const QuadCage& cage, std::span<const Vec3> positions) {
  std::vector<Box3> boxes;
  for (Index f = 0; f < cage.face_end(); ++f) {
    boxes.push_back(box_of(positions, cage.face(f)));
  }
  return boxes;
}

bool loses_a_part(const ModelSurface& model, const QuadCage& cage,
                  std::span<const Vec3> positions) {
  std::vector<std::uint8_t> lost(model.parts.size(), 0);
  parallel_for(0, lost.size(), 1, [&](std::size_t i) {
    const Vec3& p = model.parts[i].point;
    const Vec3 mirrored(-p.x(), p.y(), p.z());
    double angle = 0;
    for (Index f = 0; f < cage.face_end(); ++f) {
      if (cage.has_face(f)) {
        const FaceParts face(cage.face(f));
        for (int k = 0; k < std::min(2, face.count); ++k) {
          const Corners t = at(positions, face.triangles[k]);
          angle += solid_angle(p, t);
          angle += cage.has_border() ? solid_angle(mirrored, t) : 0;
        }
      }
    }
    lost[i] = static_cast<std::uint8_t>(angle < 2 * std::numbers::pi);
  });
  return std::find(lost.begin(), lost.end(), 1) != lost.end();
}

bool QuadGuard::is_clear(std::span<const Vec3> positions, const CageFace& face) const {
  const FaceParts parts(face);
  for (const Triangle& part : parts) {
    if (!keeps_clear(positions, part)) {
      return false;
    }
  }
  if (parts.count < 4) {
    return true;
  }
  return !encloses_a_part(positions, face);
}

bool QuadGuard::keeps_clear(std::span<const Vec3> positions, const Triangle& part) const {
  if (known_ == nullptr) {
    return !model_->tree.too_near(at(positions, part), clearance_);
  }
  Triangle sorted = part;
  std::sort(sorted.begin(), sorted.end());
  if (const std::optional<bool> known = known_->find(sorted)) {
    return *known;
  }
  const bool is_clear = !model_->tree.too_near(at(positions, sorted), clearance_);
  known_->add(sorted, is_clear);
  return is_clear;
}

bool QuadGuard::encloses_a_part(std::span<const Vec3> positions, const CageFace& quad) const {
  const FaceParts parts(quad, FaceParts::Of::all);
  const Box3 box = cagewright::box_of(positions, quad);
  for (const ModelSurface::Part& piece : model_->parts) {
    if (box.contains(piece.box)) {
      double angle = 0;
      for (int k = 0; k < 4; ++k) {
        angle += (k < 2 ? 1 : -1) * solid_angle(piece.point, at(positions, parts.triangles[k]));
      }
      if (std::abs(angle) > 2 * std::numbers::pi) {
        return true;
      }
    }
  }
  return false;
}

bool QuadGuard::is_free(const QuadCage& cage, std::span<const Index> faces,
                        const Triangle& part) const {
  const std::vector<Vec3>& x = cage.positions();
  return !is_degenerate(x[part[0]], x[part[1]], x[part[2]]) && keeps_clear(x, part) &&
         std::none_of(faces.begin(), faces.end(),
                      [&](Index f) { return crosses(x, part, cage.face(f)); });
}

bool QuadGuard::is_crossed(const QuadCage& cage, std::span<const Vec3> positions,
                           std::span<const Box3> boxes, const CageFace& face, Index itself,
                           std::span<const Index> without, std::span<const CageFace> with) const {
  for (const Triangle& part : FaceParts(face)) {
    if (is_degenerate(positions[part[0]], positions[part[1]], positions[part[2]])) {
      return true;
    }
  }
  const Box3 box = cagewright::box_of(positions, face);
  for (Index f = 0; f < boxes.size(); ++f) {
    if (f != itself && boxes[f].intersects(box) && cage.has_face(f) &&
        std::find(without.begin(), without.end(), f) == without.end() &&
        cross(positions, face, cage.face(f))) {
      return true;
    }
  }
  return is_crossed_by(positions, face, with);
}

bool QuadGuard::is_crossed_by(std::span<const Vec3> positions, const CageFace& face,
                              std::span<const CageFace> others) {
  return std::any_of(others.begin(), others.end(),
                     [&](const CageFace& other) { return cross(positions, face, other); });
}

bool QuadGuard::loses_a_part(const QuadCage& cage, std::span<const Index> removed,
                             std::span<const CageFace> added) const {
  const std::vector<Vec3>& x = cage.positions();
  Box3 box;
  for (const Index f : removed) {
    box.extend(cagewright::box_of(cage.positions(), cage.face(f)));
  }
  const auto angle_of = [&](const Vec3& p, const CageFace& face) {
    const FaceParts parts(face);
    const Vec3 image(-p.x(), p.y(), p.z());
    double angle = 0;
    for (int k = 0; k < std::min(2, parts.count); ++k) {
      angle += solid_angle(p, at(x, parts.triangles[k]));
      angle += cage.has_border() ? solid_angle(image, at(x, parts.triangles[k])) : 0;
    }
    return angle;
  };
  for (const ModelSurface::Part& part : model_->parts) {
    if (!box.contains(part.box)) {
      continue;
    }
    double angle = 0;
    for (const Index f : removed) {
      angle += angle_of(part.point, cage.face(f));
    }
    for (const CageFace& face : added) {
      angle -= angle_of(part.point, face);
    }
    if (std::abs(angle) > 2 * std::numbers::pi) {
      return true;
    }
  }
  return false;
}

bool QuadGuard::is_sound(const QuadCage& cage, std::span<const Vec3> positions,
                         std::span<const Box3> boxes, CageFace quad, Index itself) const {
  quad.tentative = false;
  return shape_of(corners_of(positions, quad)).within(limits_) &&
         !is_crossed(cage, positions, boxes, quad, itself) && is_clear(positions, quad);
}

bool QuadGuard::may_stand(const QuadCage& cage, std::span<const Box3> boxes, Index f) const {
  const std::vector<Vec3>& x = cage.positions();
  const CageFace& face = cage.face(f);
  return (!face.is_quad() || shape_of(corners_of(x, face)).within(limits_)) &&
         keeps_halves_apart(cage, {&face, 1}) && !is_crossed(cage, x, boxes, face, f) &&
         is_clear(x, face);
}

bool QuadGuard::keeps_halves_apart(const QuadCage& cage, std::span<const CageFace> added) {
  if (!cage.has_border()) {
    return true;
  }
  for (const CageFace& face : added) {
    for (int i = 0; i < face.size; ++i) {
      for (int j = i + 1; j < face.size; ++j) {
        const Index a = face[i];
        const Index b = face[j];
        if (cage.on_border(a) && cage.on_border(b) && !cage.is_border(a, b)) {
          return false;
        }
      }
    }
  }
  return true;
}

bool QuadGuard::fits(const QuadCage& cage, std::span<const Box3> boxes,
                     std::span<const Index> without, std::span<const CageFace> with, CageFace& face,
                     bool tentative) const {
  const std::vector<Vec3>& positions = cage.positions();
  const auto fits_so = [&] {
    const bool is_firm_quad = face.is_quad() && !face.tentative;
    return (!is_firm_quad || shape_of(corners_of(positions, face)).within(limits_)) &&
           !is_crossed(cage, positions, boxes, face, no_index, without, with) &&
           is_clear(positions, face);
  };
  face.tentative = false;
  if (fits_so()) {
    return true;
  }
  if (!tentative || !face.is_quad()) {
    return false;
  }
  face.tentative = true;
  if (fits_so()) {
    return true;
  }
  face = face.turned(1);
  return fits_so();
}

bool QuadGuard::allows(const QuadCage& cage, std::span<const Box3> boxes,
                       std::span<const Index> removed, std::span<CageFace> added,
                       bool tentative) const {
  if (!keeps_halves_apart(cage, added)) {
    return false;
  }
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (!fits(cage, boxes, removed, added.first(i), added[i], tentative)) {
      return false;
    }
  }
  return !loses_a_part(cage, removed, added);
}

} // namespace cagewright
