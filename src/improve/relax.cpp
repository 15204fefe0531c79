#include "improve/relax.h"

#include "core/parallel.h"
#include "improve/block_program.h"
#include "improve/face_terms.h"
#include "improve/trust.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace cagewright {

namespace {

// Constraints ask for a little more than the clearance: what a step errs by, being linear.
constexpr double margin = 1.03;
// Each face is looked at in so many small triangles along a side.
constexpr int cells = 4;

using Positions = std::vector<Vec3>;

class Relaxation {
public:
  Relaxation(WorkingCage& cage, const Guard& guard, const Objective& objective,
             std::span<const Index> movable)
      : cage_(cage), guard_(guard), objective_(objective), at_(cage.mesh.vertex_end()),
        number_(cage.mesh.vertex_end(), no_index), moving_(movable.begin(), movable.end()) {
    for (Index v = 0; v < cage.mesh.vertex_end(); ++v) {
      at_[v] = cage.mesh.position(v);
      if (movable.empty() && cage.mesh.has_vertex(v)) {
        moving_.push_back(v);
      }
    }
    for (Index i = 0; i < moving_.size(); ++i) {
      number_[moving_[i]] = i;
    }
    for (Index f = 0; f < cage.mesh.face_end(); ++f) {
      if (cage.mesh.has_face(f) && moves(cage.mesh.face(f))) {
        faces_.push_back(f);
      }
    }
    for (const Vec3& p : at_) {
      center_ += p / static_cast<double>(at_.size());
    }
    center_ = volume_origin(cage.mesh, center_);
  }

  double run(const RelaxOptions& options, const Progress& progress) {
    progress_ = progress.quiet();
    double& reach = cage_.reach;
    reach = std::min(reach, options.first_step * objective_.diagonal());
    double value = total(at_);
    for (int step = 0; step < options.steps && !progress.cancelled(); ++step) {
      progress(static_cast<double>(step) / options.steps, "relax");
      const Positions goal = moved(at_, reach, true);
      // The constraints curve: what the step has overshot is taken back by a step of its own.
      const Positions corrected = moved(goal, reach / 4, false);
      const Positions next = valid_part(corrected);
      if (progress.cancelled()) {
        break; // what was made last is not to be used
      }
      const double lower = total(next);
      if (lower < value) {
        const StepGain step_gain{value - lower, value - total(goal)};
        take(next);
        value = lower;
        if (step_gain.is_enough(options.least_gain * value)) {
          break;
        }
        reach *= step_gain.reach_factor();
      } else {
        reach *= reach_factor_in_vain;
      }
    }
    return value;
  }

private:
  [[nodiscard]] bool moves(const Triangle& t) const {
    return std::any_of(t.begin(), t.end(), [&](Index v) { return number_[v] != no_index; });
  }

  [[nodiscard]] Corners corners(const Positions& at, Index f) const {
    const Triangle& t = cage_.mesh.face(f);
    return {at[t[0]], at[t[1]], at[t[2]]};
  }

  [[nodiscard]] double total(const Positions& at) const {
    return parallel_reduce_ordered(
        0, faces_.size(), 16, 0.0,
        [&](std::size_t first, std::size_t last) {
          double sum = 0;
          for (std::size_t i = first; i < last && !progress_.cancelled(); ++i) {
            const Corners t = corners(at, faces_[i]);
            sum += (t[0] - center_).dot((t[1] - center_).cross(t[2] - center_)) / 6 +
                   objective_.face(t);
          }
          return sum;
        },
        [](double& sum, double part) { sum += part; });
  }

  // The positions after one quadratic program: of the objective, or only of the constraints.
  [[nodiscard]] Positions moved(const Positions& at, double reach, bool towards_goal) const {
    struct Piece {
      std::vector<BlockConstraint> constraints;
      FaceTerms terms;
    };
    std::vector<Piece> pieces(faces_.size());
    parallel_for(0, faces_.size(), 1, progress_, [&](std::size_t i) {
      Piece& piece = pieces[i];
      const Corners t = corners(at, faces_[i]);
      add_constraints(faces_[i], t, reach, piece.constraints);
      if (towards_goal) {
        piece.terms = terms_of(t);
      }
    });
    BlockQuadratic quadratic(moving_.size());
    std::vector<BlockConstraint> constraints;
    // The program is scaled to lengths of the diagonal and to gradients near one.
    const double unit = objective_.diagonal();
    const double scale = static_cast<double>(cage_.mesh.face_count()) /
                         (objective_.weights().typical_emphasis * unit * unit * unit);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Triangle& t = cage_.mesh.face(faces_[i]);
      for (BlockConstraint c : pieces[i].constraints) {
        c.bound /= unit;
        if (fix_corners(c)) {
          constraints.push_back(c);
        }
      }
      for (int k = 0; k < 3; ++k) {
        const Index row = number_[t[k]];
        if (row == no_index) {
          continue;
        }
        quadratic.gradient[row] += scale * unit * pieces[i].terms.gradient[k];
        for (int m = 0; m <= k; ++m) {
          if (number_[t[m]] != no_index) {
            quadratic.terms.push_back(
                {row, number_[t[m]], scale * unit * unit * pieces[i].terms.hessian[k][m]});
          }
        }
      }
    }
    for (Index v = 0; v < moving_.size(); ++v) {
      // Directions in which nothing changes are held by a weak spring.
      quadratic.terms.push_back({v, v, (towards_goal ? 2.0 : 50.0) * Mat3::Identity()});
      const bool on_plane = cage_.mesh.on_plane(moving_[v]);
      if (on_plane) { // held as by a wall
        constexpr double wall = 1e6;
        quadratic.terms.push_back({v, v, Vec3(wall, 0, 0).asDiagonal()});
        quadratic.gradient[v].x() = 0;
      }
      for (int k = on_plane ? 1 : 0; k < 3; ++k) {
        const bool near_plane = k == 0 && cage_.mesh.is_half();
        const double down =
            near_plane ? std::min(reach, at[moving_[v]].x() - plane_gap * guard_.clearance())
                       : reach;
        constraints.push_back({{v, v, v}, {1, 0, 0}, Vec3::Unit(k), -down / unit});
        constraints.push_back({{v, v, v}, {1, 0, 0}, -Vec3::Unit(k), -reach / unit});
      }
      if (const SeamBand* band = cage_.mesh.band_of(moving_[v])) {
        add_band(*band, at[moving_[v]], v, unit, constraints);
      }
    }
    // Multipliers are near 0.1: this is well within the margin that the constraints ask for.
    const double slack = towards_goal ? 1e-6 : 0.05 * guard_.clearance() / unit;
    const std::vector<Vec3> step = minimize(quadratic, constraints, {.slack = slack}, progress_);
    Positions result = at;
    for (Index v = 0; v < moving_.size(); ++v) {
      Vec3& p = result[moving_[v]];
      const double off_plane = plane_gap / 2 * guard_.clearance();
      const double before = p.x();
      p += unit * step[v];
      if (cage_.mesh.on_plane(moving_[v])) {
        p.x() = 0;
      } else if (cage_.mesh.is_half()) {
        p.x() = std::max(p.x(), std::min(before, off_plane));
      }
    }
    return result;
  }

  [[nodiscard]] FaceTerms terms_of(const Corners& t) const {
    FaceTerms terms = volume_and_gap(objective_, t, center_);
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = normal.norm() / 2;
    if (!(area > 0)) {
      return terms;
    }
    const Vec3 n = normal / (2 * area);
    const double x = shape_defect(t);
    const double scaled = 4 * std::numbers::sqrt3 * area;
    const double weight = objective_.shape_weight();
    std::array<Vec3, 3> slope;
    for (int k = 0; k < 3; ++k) {
      const Vec3& a = t[k];
      const Vec3& b = t[(k + 1) % 3];
      const Vec3& c = t[(k + 2) % 3];
      const Vec3 area_slope = n.cross(c - b) / 2;
      slope[k] = 2 * (2 * a - b - c) / scaled - (x + good_shape) / area * area_slope;
      terms.gradient[k] += 2 * weight * x * slope[k];
    }
    for (int k = 0; k < 3 && x > 0; ++k) {
      for (int m = 0; m < 3; ++m) {
        const double springs = (k == m ? 2.0 : -1.0) * 2 * x / scaled;
        terms.hessian[k][m] +=
            2 * weight * (springs * Mat3::Identity() + slope[k] * slope[m].transpose());
      }
    }
    return terms;
  }

  // Half spaces that keep the face clear of the model for small moves: one for the highest point
  // of the model below each small triangle of the face, one for the nearest to each of its corners.
  // What is on an edge is looked at by one of its two faces, for both.
  void add_constraints(Index f, const Corners& t, double reach,
                       std::vector<BlockConstraint>& constraints) const {
    if (!(triangle_area(t) > 0)) {
      return;
    }
    const KeepClear clear{.model = objective_.model().tree,
                          .keep = margin * guard_.clearance(),
                          .clearance = guard_.clearance(),
                          .reach = reach};
    const Triangle& face = cage_.mesh.face(f);
    const Triangle vertices = numbered(face);
    clear.add_triangle(vertices, t, cells, constraints);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const bool alone = cage_.mesh.face_left_of(face[next], face[k]) == no_index;
      if (face[k] < face[next] || alone) {
        for (int i = 1; i < cells; ++i) {
          std::array<double, 3> share{};
          share[next] = static_cast<double>(i) / cells;
          share[k] = 1 - share[next];
          clear.add_point(vertices, share, share[k] * t[k] + share[next] * t[next], constraints);
        }
      }
      if (cage_.mesh.around(face[k]).front() == f) {
        std::array<double, 3> share{};
        share[k] = 1;
        clear.add_point(vertices, share, t[k], constraints);
      }
    }
  }

  // Takes the corners that stay out of the constraint. \returns false if none is left
  static bool fix_corners(BlockConstraint& c) {
    const Index any = std::min({c.vertex[0], c.vertex[1], c.vertex[2]}); // none is the greatest
    double left = 0;
    for (int k = 0; k < 3; ++k) {
      if (c.vertex[k] == no_index) {
        c.vertex[k] = any;
        c.weight[k] = 0;
      }
      left += c.weight[k];
    }
    return any != no_index && left > 0;
  }

  [[nodiscard]] Triangle numbered(const Triangle& t) const {
    return {number_[t[0]], number_[t[1]], number_[t[2]]};
  }

  // As much of the way from the present positions to the goal as leaves the cage valid: vertices of
  // faces in trouble go half of their way, again and again, and in the end nowhere.
  [[nodiscard]] Positions valid_part(const Positions& goal) const {
    std::vector<double> share(at_.size(), 1);
    Positions next = goal;
    std::vector<bool> changed(at_.size(), true);
    for (;;) {
      const std::vector<Index> bad = faces_in_trouble(next, changed);
      if (bad.empty()) {
        return loses_a_part(next) ? at_ : next;
      }
      std::vector<Index> vertices;
      for (const Index f : bad) {
        const Triangle& t = cage_.mesh.face(f);
        vertices.insert(vertices.end(), t.begin(), t.end());
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      std::fill(changed.begin(), changed.end(), false);
      for (const Index v : vertices) {
        constexpr double least = 0.1;
        changed[v] = true;
        share[v] = share[v] > least ? share[v] / 2 : 0;
        next[v] = share[v] > 0 ? Vec3(at_[v] + share[v] * (goal[v] - at_[v])) : at_[v];
      }
    }
  }

  // Those among the faces with a changed vertex: what they do to others shows at them.
  [[nodiscard]] std::vector<Index> faces_in_trouble(const Positions& next,
                                                    const std::vector<bool>& changed) const {
    CageMesh moved = cage_.mesh;
    for (const Index v : moving_) {
      moved.set_position(v, next[v]);
    }
    const FaceBoxes boxes(moved);
    const auto has_changed = [&](const Triangle& t) {
      return changed[t[0]] || changed[t[1]] || changed[t[2]];
    };
    const auto is_still = [&](const Triangle& t) {
      return next[t[0]] == at_[t[0]] && next[t[1]] == at_[t[1]] && next[t[2]] == at_[t[2]];
    };
    // What was moved back to its old place was well there, and cannot yield: what is near it now
    // has to be looked at again.
    std::vector<std::uint8_t> due(moved.face_end(), 0);
    std::vector<Index> near;
    for (const Index f : faces_) {
      const Triangle& t = moved.face(f);
      due[f] = due[f] != 0 || has_changed(t) ? 1 : 0;
      if (has_changed(t) && is_still(t)) {
        near.clear();
        boxes.find(
            Box3(moved.position(t[0])).extend(moved.position(t[1])).extend(moved.position(t[2])),
            near);
        for (const Index g : near) {
          due[g] = 1;
        }
      }
    }
    std::vector<std::uint8_t> bad(faces_.size(), 0);
    parallel_for(0, faces_.size(), 1, progress_, [&](std::size_t i) {
      const Triangle& t = moved.face(faces_[i]);
      if (is_still(t) || due[faces_[i]] == 0) {
        return; // as before the step, when all was well; others report what they do to it
      }
      Patch patch; // the face by itself, taken out and put back
      patch.removed = {faces_[i]};
      patch.added = {t};
      bad[i] = static_cast<std::uint8_t>(
          misshapen(moved, faces_[i]) ||
          objective_.widens_gap(corners_of(cage_.mesh, faces_[i]), corners_of(moved, faces_[i])) ||
          guard_.too_near(moved, patch).has_value() || guard_.crosses(moved, boxes, patch));
    });
    std::vector<Index> result;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (bad[i] != 0) {
        result.push_back(faces_[i]);
      }
    }
    return result;
  }

  // Needles and folds are no better than crossings, unless they were there before.
  [[nodiscard]] bool misshapen(const CageMesh& moved, Index f) const {
    const ShapeLimits limits;
    const Corners now = corners_of(moved, f);
    const Corners before = corners_of(cage_.mesh, f);
    if (shape_defect(now) > std::max(limits.worst_defect, shape_defect(before)) ||
        shape_quality(now) < std::min(limits.least_quality, shape_quality(before))) {
      return true;
    }
    const Triangle& t = moved.face(f);
    for (int k = 0; k < 3; ++k) {
      const Index p = t[(k + 1) % 3];
      const double b = bend(now, corners_across(moved, now, p, t[k]));
      if (b < limits.sharpest_bend &&
          b < bend(before, corners_across(cage_.mesh, before, p, t[k]))) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool loses_a_part(const Positions& next) const {
    const std::vector<ModelSurface::Part>& parts = guard_.model().parts;
    std::vector<std::uint8_t> lost(parts.size(), 0);
    parallel_for(0, parts.size(), 1, progress_, [&](std::size_t i) {
      double angle = 0;
      for (Index f = 0; f < cage_.mesh.face_end(); ++f) {
        if (cage_.mesh.has_face(f)) {
          angle += solid_angle(cage_.mesh, parts[i].point, corners(next, f));
        }
      }
      lost[i] = static_cast<std::uint8_t>(angle < 2 * std::numbers::pi);
    });
    return std::find(lost.begin(), lost.end(), 1) != lost.end();
  }

  void take(const Positions& next) {
    at_ = next;
    for (const Index v : moving_) {
      cage_.mesh.set_position(v, next[v]);
    }
    for (const Index f : faces_) {
      cage_.boxes.update(cage_.mesh, f);
    }
  }

  WorkingCage& cage_;
  const Guard& guard_;
  const Objective& objective_;
  Positions at_;              // the present, valid positions of all vertices
  std::vector<Index> number_; // in the programs; none of vertices that stay
  std::vector<Index> moving_;
  std::vector<Index> faces_; // at moving vertices
  Vec3 center_ = Vec3::Zero();
  Progress progress_; // of the run
};

} // namespace

double relax(WorkingCage& cage, const Guard& guard, const Objective& objective,
             const RelaxOptions& options, const Progress& progress) {
  return Relaxation(cage, guard, objective, options.movable).run(options, progress);
}

} // namespace cagewright
