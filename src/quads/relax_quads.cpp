#include "quads/relax_quads.h"

#include "core/maths.h"
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
// Each part is looked at in so many small triangles along a side.
constexpr int cells = 3;

using Positions = std::vector<Vec3>;

/// Six times the volume between a quad's two cuttings, signed.
double six_volumes(const QuadCorners& q) {
  return (q[1] - q[0]).dot((q[2] - q[0]).cross(q[3] - q[0]));
}

/// What is measured of a quad with diagonals d and e, in lengths of l^2 = (d^2 + e^2) / 2.
struct QuadTerms {
  QuadTerms(const QuadCorners& q, const RelaxQuadsOptions& options)
      : diagonals{q[2] - q[0], q[3] - q[1]}, skew(q[0] - q[1] + q[2] - q[3]) {
    const double d = diagonals[0].squaredNorm();
    const double e = diagonals[1].squaredNorm();
    squared = std::max((d + e) / 2, 1e-300);
    unequal = (d - e) / squared;
    warp = six_volumes(q) / (squared * std::sqrt(squared));
    excess = std::copysign(std::max(0.0, std::abs(warp) - options.free_warp), warp);
    normal = diagonals[0].cross(diagonals[1]);
    normal /= std::max(normal.norm(), 1e-300);
    for (int k = 0; k < 4; ++k) {
      const Vec3 next = q[(k + 1) % 4] - q[k];
      const Vec3 last = q[(k + 3) % 4] - q[k];
      sides[k] = std::max(next.norm() * last.norm(), 1e-300);
      flatness[k] = std::max(0.0, options.free_sine - normal.dot(next.cross(last)) / sides[k]);
    }
  }

  /// The sum of the squares of `flatness`.
  [[nodiscard]] double flat_corners() const {
    double sum = 0;
    for (const double f : flatness) {
      sum += f * f;
    }
    return sum;
  }

  Vec3 normal;                      ///< of the vector area
  std::array<double, 4> sides{};    ///< the product of those at each corner
  std::array<double, 4> flatness{}; ///< of each corner: what its sine is below free_sine
  std::array<Vec3, 2> diagonals;
  Vec3 skew;
  double squared = 0; ///< l^2
  double unequal = 0; ///< (d^2 - e^2) / l^2: 0 for a rectangle
  double warp = 0;    ///< six volumes / l^3: sin(bend) / 4 of a bent square
  double excess = 0;  ///< the warp beyond what is free
};

class Relaxation {
public:
  Relaxation(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
             const RelaxQuadsOptions& options)
      : cage_(cage), guard_(guard), objective_(objective), options_(options),
        at_(cage.positions()) {
    for (Index v = 0; v < cage.vertex_end(); ++v) {
      number_.push_back(cage.around(v).empty() ? no_index : static_cast<Index>(living_.size()));
      if (!cage.around(v).empty()) {
        living_.push_back(v);
        center_ += at_[v];
      }
    }
    center_ /= static_cast<double>(std::max<std::size_t>(1, living_.size()));
    if (cage.has_border()) {
      center_.x() = 0; // from the mirror plane the other half's volume is not missed
    }
    for (Index f = 0; f < cage.face_end(); ++f) {
      if (cage.has_face(f)) {
        faces_.push_back(f);
      }
    }
    keep_ = margin * std::max(options.keep * objective.diagonal(), guard.clearance());
  }

  double run(const Progress& progress) {
    progress_ = progress.quiet();
    double reach = options_.first_step * objective_.diagonal();
    double value = total(at_);
    for (int step = 0; step < options_.steps && !progress.cancelled(); ++step) {
      progress(static_cast<double>(step) / options_.steps, "relax quads");
      const Positions goal = moved(at_, reach, true);
      // The constraints curve: what the step has overshot is taken back by a step of its own.
      const Positions next = valid_part(moved(goal, reach / 4, false));
      if (progress.cancelled()) {
        break; // what was made last is not to be used
      }
      const double lower = total(next);
      // What is to be kept away further than before may cost something, though not anything: where
      // there is no room to be had the cage would be creased ever more.
      const bool makes_room = keep_ > 2 * guard_.clearance();
      if (lower < value || (makes_room && lower < (1 + options_.most_rise) * value)) {
        const StepGain step_gain{value - lower, value - total(goal)};
        at_ = next;
        cage_.set_positions(at_);
        make_sound();
        value = lower;
        if (step_gain.is_enough(options_.least_gain * value) && !makes_room) {
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
  // Tentative quads become true ones where they can.
  void make_sound() {
    const std::vector<Box3> boxes = face_boxes(cage_, at_);
    for (const Index f : faces_) {
      CageFace face = cage_.face(f);
      if (face.tentative && guard_.is_sound(cage_, at_, boxes, face, f)) {
        face.tentative = false;
        cage_.set_face(f, face);
      }
    }
  }

  static Corners corners(const Positions& at, const Triangle& t) {
    return {at[t[0]], at[t[1]], at[t[2]]};
  }

  [[nodiscard]] double value_of(const Positions& at, const CageFace& face) const {
    const FaceParts parts(face, FaceParts::Of::all);
    const double share = parts.count == 4 ? 0.5 : 1;
    double sum = 0;
    for (const Triangle& part : parts) {
      const Corners t = corners(at, part);
      double gap = 0;
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = (4 * t[k] + t[(k + 1) % 3] + t[(k + 2) % 3]) / 6;
        gap += objective_.gap(objective_.nearest(p)) / 3;
      }
      sum += share * ((t[0] - center_).dot((t[1] - center_).cross(t[2] - center_)) / 6 +
                      triangle_area(t) * gap);
      const double x = counted_defect(face, t);
      sum += part_weight(face) * x * x;
    }
    if (face.is_quad()) {
      const QuadTerms terms(corners_of(at, face), options_);
      sum += weight_of(face) *
             (options_.even * terms.skew.squaredNorm() / terms.squared +
              options_.square * terms.unequal * terms.unequal +
              options_.corner * terms.flat_corners() + options_.flat * terms.excess * terms.excess);
    }
    return sum;
  }

  // The square of the shape defect of a triangle, or of what it is above `free_defect` of a part of
  // a quad, is taken times part_weight().
  [[nodiscard]] double counted_defect(const CageFace& face, const Corners& t) const {
    const double x = shape_defect(t);
    return face.is_quad() ? std::max(0.0, x - options_.free_defect) : x;
  }
  [[nodiscard]] double part_weight(const CageFace& face) const {
    return (face.is_quad() ? options_.slender / 2 : 1) * objective_.shape_weight();
  }

  [[nodiscard]] double weight_of(const CageFace& face) const {
    return (face.tentative ? options_.tentative : 1) * objective_.shape_weight();
  }

  [[nodiscard]] double total(const Positions& at) const {
    return parallel_reduce_ordered(
        0, faces_.size(), 8, 0.0,
        [&](std::size_t first, std::size_t last) {
          double sum = 0;
          for (std::size_t i = first; i < last; ++i) {
            sum += value_of(at, cage_.face(faces_[i]));
          }
          return sum;
        },
        [](double& sum, double part) { sum += part; });
  }

  struct Piece {
    std::vector<BlockConstraint> constraints;
    std::array<Vec3, 4> gradient;
    std::array<std::array<Mat3, 4>, 4> hessian;

    Piece() {
      gradient.fill(Vec3::Zero());
      for (auto& row : hessian) {
        row.fill(Mat3::Zero());
      }
    }
  };

  // The positions after one quadratic program: of the objective, or only of the constraints.
  [[nodiscard]] Positions moved(const Positions& at, double reach, bool towards_goal) const {
    std::vector<Piece> pieces(faces_.size());
    const KeepClear clear{guard_.model().tree, keep_, guard_.clearance(), reach, reach / 2};
    parallel_for(0, faces_.size(), 1, progress_, [&](std::size_t i) {
      Piece& piece = pieces[i];
      const CageFace& face = cage_.face(faces_[i]);
      const FaceParts parts(face, FaceParts::Of::all);
      const Vec3 normal = area_vector(at, face);
      for (int k = 0; k < parts.count; ++k) {
        const Triangle& part = parts.triangles[k];
        const Corners t = corners(at, part);
        if ((t[1] - t[0]).cross(t[2] - t[0]).dot(normal) > 0) {
          clear.add_triangle({number_[part[0]], number_[part[1]], number_[part[2]]}, t, cells,
                             piece.constraints);
        }
        if (towards_goal) {
          constexpr std::array<int, 4> first = {0, 2, 1, 3};
          add_part(t, first[k], face, piece);
        }
      }
      add_side_constraints(at, faces_[i], clear, piece.constraints);
      if (face.is_quad()) {
        add_limits(at, face, reach, piece.constraints);
      }
      if (towards_goal && face.is_quad()) {
        add_shape(corners_of(at, face), weight_of(face), piece);
      }
    });
    BlockQuadratic quadratic(living_.size());
    std::vector<BlockConstraint> constraints;
    // The program is scaled to lengths of the diagonal and to gradients near one.
    const double unit = objective_.diagonal();
    const double scale = static_cast<double>(faces_.size()) /
                         (objective_.weights().typical_emphasis * unit * unit * unit);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const CageFace& face = cage_.face(faces_[i]);
      for (BlockConstraint c : pieces[i].constraints) {
        c.bound /= unit;
        constraints.push_back(c);
      }
      for (int k = 0; k < face.size; ++k) {
        quadratic.gradient[number_[face[k]]] += scale * unit * pieces[i].gradient[k];
        for (int m = 0; m <= k; ++m) {
          quadratic.terms.push_back(
              {number_[face[k]], number_[face[m]], scale * unit * unit * pieces[i].hessian[k][m]});
        }
      }
    }
    for (Index v = 0; v < living_.size(); ++v) {
      // Directions in which nothing changes are held by a weak spring.
      quadratic.terms.push_back({v, v, (towards_goal ? 2.0 : 50.0) * Mat3::Identity()});
      for (int k = 0; k < 3; ++k) {
        const bool held = k == 0 && cage_.on_border(living_[v]);
        const double room = held ? 1e-9 : reach / unit;
        constraints.push_back({{v, v, v}, {1, 0, 0}, Vec3::Unit(k), -room});
        constraints.push_back({{v, v, v}, {1, 0, 0}, -Vec3::Unit(k), -room});
      }
      if (const SeamBand* band = cage_.band_of(living_[v])) {
        add_band(*band, at[living_[v]], v, unit, constraints);
      }
    }
    // Multipliers are near 0.1: this is well within the margin that the constraints ask for.
    const double soft = 0.05 * guard_.clearance() / unit;
    std::vector<Vec3> step =
        minimize(quadratic, constraints, {.slack = towards_goal ? 1e-6 : soft}, progress_);
    const auto is_zero = [](const Vec3& v) { return v == Vec3::Zero(); };
    if (towards_goal && std::all_of(step.begin(), step.end(), is_zero)) {
      step = minimize(quadratic, constraints, {.slack = soft},
                      progress_); // they contradict each other
    }
    Positions result = at;
    for (Index v = 0; v < living_.size(); ++v) {
      Vec3 way = unit * step[v];
      if (cage_.on_border(living_[v])) {
        way.x() = 0;
      }
      result[living_[v]] += way;
    }
    return result;
  }

  // The engine's objective on one part, and the shape; `first` is the face's corner that the part
  // begins with.
  void add_part(const Corners& t, int first, const CageFace& face, Piece& piece) const {
    const bool of_quad = face.is_quad();
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = normal.norm() / 2;
    if (!(area > 0)) {
      return;
    }
    const auto corner = [&](int k) { return of_quad ? (first + k) % 4 : k; };
    const double part = of_quad ? 0.5 : 1;
    const Vec3 n = normal / (2 * area);
    const FaceTerms terms = volume_and_gap(objective_, t, center_);
    for (int k = 0; k < 3; ++k) {
      piece.gradient[corner(k)] += part * terms.gradient[k];
      for (int m = 0; m < 3; ++m) {
        piece.hessian[corner(k)][corner(m)] += part * terms.hessian[k][m];
      }
    }
    const double weight = part_weight(face);
    const double x = counted_defect(face, t);
    const double ratio = shape_defect(t) + good_shape;
    const double scaled = 4 * std::numbers::sqrt3 * area;
    std::array<Vec3, 3> slope;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const int last = (k + 2) % 3;
      const Vec3 area_slope = n.cross(t[last] - t[next]) / 2;
      slope[k] = 2 * (2 * t[k] - t[next] - t[last]) / scaled - ratio / area * area_slope;
      piece.gradient[corner(k)] += 2 * weight * x * slope[k];
    }
    if (weight * x <= 0) {
      return;
    }
    for (int k = 0; k < 3; ++k) {
      for (int m = 0; m < 3; ++m) {
        const double springs = (k == m ? 2.0 : -1.0) * 2 * x / scaled;
        piece.hessian[corner(k)][corner(m)] +=
            2 * weight * (springs * Mat3::Identity() + slope[k] * slope[m].transpose());
      }
    }
  }

  // Least squares of what is measured of a quad, its size taken as fixed.
  void add_shape(const QuadCorners& q, double weight, Piece& piece) const {
    const QuadTerms terms(q, options_);
    const double even = 2 * weight * options_.even / terms.squared;
    for (int k = 0; k < 4; ++k) {
      const double sign = k % 2 == 0 ? 1 : -1;
      piece.gradient[k] += even * sign * terms.skew;
      for (int m = 0; m < 4; ++m) {
        piece.hessian[k][m] += even * sign * (m % 2 == 0 ? 1 : -1) * Mat3::Identity();
      }
    }
    const std::array<Vec3, 2> d = {2 / terms.squared * terms.diagonals[0],
                                   2 / terms.squared * terms.diagonals[1]};
    add_residual(2 * weight * options_.square, terms.unequal, {-d[0], d[1], d[0], -d[1]}, piece);
    for (int k = 0; k < 4; ++k) {
      if (terms.flatness[k] > 0) {
        const int next = (k + 1) % 4;
        const int last = (k + 3) % 4;
        std::array<Vec3, 4> slope;
        slope[(k + 2) % 4] = Vec3::Zero();
        slope[next] = -(q[last] - q[k]).cross(terms.normal) / terms.sides[k];
        slope[last] = -terms.normal.cross(q[next] - q[k]) / terms.sides[k];
        slope[k] = -(slope[next] + slope[last]);
        add_residual(2 * weight * options_.corner, terms.flatness[k], slope, piece);
      }
    }
    if (terms.excess != 0) {
      const double scale = 1 / (terms.squared * std::sqrt(terms.squared));
      std::array<Vec3, 4> slope;
      slope[1] = scale * (q[2] - q[0]).cross(q[3] - q[0]);
      slope[2] = scale * (q[3] - q[0]).cross(q[1] - q[0]);
      slope[3] = scale * (q[1] - q[0]).cross(q[2] - q[0]);
      slope[0] = -(slope[1] + slope[2] + slope[3]);
      add_residual(2 * weight * options_.flat, terms.excess, slope, piece);
    }
  }

  static void add_residual(double weight, double value, const std::array<Vec3, 4>& slope,
                           Piece& piece) {
    for (int k = 0; k < 4; ++k) {
      piece.gradient[k] += weight * value * slope[k];
      for (int m = 0; m < 4; ++m) {
        piece.hessian[k][m] += weight * slope[k] * slope[m].transpose();
      }
    }
  }

  // Half spaces that keep a quad within the limits, or bring it nearer to them.
  void add_limits(const Positions& at, const CageFace& face, double reach,
                  std::vector<BlockConstraint>& constraints) const {
    const QuadCorners q = corners_of(at, face);
    const Vec3 area = (q[2] - q[0]).cross(q[3] - q[1]);
    const double length = area.norm();
    if (!(length > 0)) {
      return;
    }
    const Vec3 n = area / length;
    const QuadLimits& limits = guard_.limits();
    constexpr double radians = std::numbers::pi / 180;
    constexpr double within = 0.97; // what a step errs by, being linear
    // Bend: six volumes v = sum of +- p_i h_i, h_i a corner's height along n and p_i twice the area
    // of the other three, seen along n. Along a side d between triangles of twice the areas a and b
    // the sine of the bend is v |d| / (a b).
    std::array<double, 4> p{};
    std::array<double, 4> doubled{};
    double mean = 0;
    for (int i = 0; i < 4; ++i) {
      const Vec3 cross = (q[(i + 2) % 4] - q[(i + 1) % 4]).cross(q[(i + 3) % 4] - q[(i + 1) % 4]);
      p[i] = cross.dot(n);
      doubled[i] = cross.norm();
      mean += p[i] / 4;
    }
    if (mean > 0 && *std::min_element(p.begin(), p.end()) > 0.05 * mean) {
      const double sine = maths::sin(within * std::min(89.0, limits.max_bend_degrees) * radians);
      const double most = sine * std::min(doubled[1] * doubled[3] / (q[2] - q[0]).norm(),
                                          doubled[0] * doubled[2] / (q[3] - q[1]).norm());
      const double v = six_volumes(q);
      for (const double sign : {1.0, -1.0}) {
        const double room = (most - sign * v) / mean;
        if (room > 3 * reach) {
          continue;
        }
        BlockConstraint c;
        c.direction = sign * n;
        for (int i = 0; i < 4; ++i) {
          const double weight = (i % 2 == 0 ? 1 : -1) * p[i] / mean;
          (i < 3 ? c.weight[i] : c.fourth_weight) = weight;
          (i < 3 ? c.vertex[i] : c.fourth_vertex) = number_[face[i]];
        }
        c.bound = std::min(-room, reach);
        constraints.push_back(c);
      }
    }
    // Flat corners: the height of a corner over the line between its neighbours.
    for (int i = 0; i < 4; ++i) {
      const Vec3& before = q[(i + 3) % 4];
      Vec3 line = q[(i + 1) % 4] - before;
      line -= line.dot(n) * n;
      const double base = line.norm();
      if (!(base > 0)) {
        continue;
      }
      line /= base;
      const Vec3 up = line.cross(n); // out of the quad
      const double height = up.dot(q[i] - before);
      const double foot = std::clamp(line.dot(q[i] - before) / base, 0.1, 0.9);
      const double least =
          (180 - within * limits.max_angle_degrees) * radians * foot * (1 - foot) * base;
      if (height - least > 2 * reach) {
        continue;
      }
      constraints.push_back({{number_[face[i]], number_[face[i + 3]], number_[face[i + 1]]},
                             {1, foot - 1, -foot},
                             up,
                             std::min(least - height, reach / 2)});
    }
  }

  // Half spaces that keep the corners, the sides and the diagonals of a face clear of the model.
  // What is on a side is looked at by one of its two faces, for both.
  void add_side_constraints(const Positions& at, Index f, const KeepClear& clear,
                            std::vector<BlockConstraint>& constraints) const {
    const CageFace& face = cage_.face(f);
    const auto add = [&](Index a, Index b, double share) {
      clear.add_point({number_[a], number_[b], number_[b]}, {1 - share, share, 0},
                      (1 - share) * at[a] + share * at[b], constraints);
    };
    const auto add_inside = [&](Index a, Index b) {
      for (int i = 1; i < cells; ++i) {
        add(a, b, static_cast<double>(i) / cells);
      }
    };
    for (int k = 0; k < face.size; ++k) {
      const bool alone = cage_.face_left_of(face[k + 1], face[k]) == no_index;
      if (face[k] < face[k + 1] || alone) {
        add_inside(face[k], face[k + 1]);
      }
      if (cage_.around(face[k]).front() == f) {
        add(face[k], face[k + 1], 0);
      }
    }
    if (face.is_quad()) {
      add_inside(face[0], face[2]);
      add_inside(face[1], face[3]);
    }
  }

  // As much of the way from the present positions to the goal as leaves the cage valid: vertices of
  // faces in trouble go half of their way, again and again, and in the end nowhere.
  [[nodiscard]] Positions valid_part(const Positions& goal) const {
    std::vector<double> share(at_.size(), 1);
    std::vector<std::uint8_t> changed(at_.size(), 1);
    Positions next = goal;
    for (;;) {
      const std::vector<Index> bad = faces_in_trouble(next, changed);
      if (bad.empty()) {
        return loses_a_part(guard_.model(), cage_, next) ? at_ : next;
      }
      std::vector<Index> vertices;
      for (const Index f : bad) {
        const auto corners = cage_.face(f).span();
        vertices.insert(vertices.end(), corners.begin(), corners.end());
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      std::fill(changed.begin(), changed.end(), 0);
      for (const Index v : vertices) {
        changed[v] = 1;
        constexpr double least = 0.1;
        share[v] = share[v] > least ? share[v] / 2 : 0;
        next[v] = share[v] > 0 ? Vec3(at_[v] + share[v] * (goal[v] - at_[v])) : at_[v];
        if (cage_.on_border(v)) {
          next[v].x() = at_[v].x();
        }
      }
    }
  }

  // Those among the moved faces that a change may have brought in trouble: faces with a changed
  // vertex, and those near to what was moved back to its old place. (Such a face is not looked at
  // itself: it was well there, and cannot yield.)
  [[nodiscard]] std::vector<Index>
  faces_in_trouble(const Positions& next, const std::vector<std::uint8_t>& changed) const {
    const std::vector<Box3> boxes = face_boxes(cage_, next);
    const auto is_still = [&](const CageFace& face) {
      const std::span<const Index> v = face.span();
      return std::all_of(v.begin(), v.end(), [&](Index k) { return next[k] == at_[k]; });
    };
    const auto has_changed = [&](const CageFace& face) {
      const std::span<const Index> v = face.span();
      return std::any_of(v.begin(), v.end(), [&](Index k) { return changed[k] != 0; });
    };
    std::vector<Index> moved_back;
    for (const Index f : faces_) {
      if (has_changed(cage_.face(f)) && is_still(cage_.face(f))) {
        moved_back.push_back(f);
      }
    }
    std::vector<std::uint8_t> bad(faces_.size(), 0);
    parallel_for(0, faces_.size(), 1, progress_, [&](std::size_t i) {
      const CageFace& face = cage_.face(faces_[i]);
      const bool is_due =
          has_changed(face) || std::any_of(moved_back.begin(), moved_back.end(), [&](Index f) {
            return boxes[f].intersects(boxes[faces_[i]]);
          });
      if (!is_due || is_still(face)) {
        return;
      }
      bad[i] = static_cast<std::uint8_t>(misshapen(next, faces_[i]) ||
                                         guard_.is_crossed(cage_, next, boxes, face, faces_[i]) ||
                                         !guard_.is_clear(next, face));
    });
    std::vector<Index> result;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (bad[i] != 0) {
        result.push_back(faces_[i]);
      }
    }
    return result;
  }

  // Needles and folds are no better than crossings, unless they were there before; nor are quads
  // beyond the limits, and what leaves its half of a symmetric cage.
  [[nodiscard]] bool misshapen(const Positions& next, Index f) const {
    constexpr double worst_defect = 8;
    constexpr double sharpest = -0.9;
    const CageFace& face = cage_.face(f);
    if (face.is_quad() && !face.tentative) {
      const QuadLimits limits = shape_of(corners_of(at_, face)).widened(guard_.limits());
      if (!shape_of(corners_of(next, face)).within(limits)) {
        return true;
      }
    } else {
      for (const Triangle& t : FaceParts(face)) {
        const Corners now = corners(at_, t);
        const Corners then = corners(next, t);
        const double least_quality = std::min(guard_.limits().min_quality, shape_quality(now));
        if (shape_defect(then) > std::max(worst_defect, shape_defect(now)) ||
            shape_quality(then) < least_quality) {
          return true;
        }
      }
    }
    const auto bend_to = [&](const Positions& at, Index other) {
      const Vec3 m = area_vector(at, face);
      const Vec3 n = area_vector(at, cage_.face(other));
      const double length = m.norm() * n.norm();
      return length > 0 ? m.dot(n) / length : -1;
    };
    for (int k = 0; k < face.size; ++k) {
      const Index other = cage_.face_left_of(face[k + 1], face[k]);
      if (other != no_index) {
        const double b = bend_to(next, other);
        if (b < sharpest && b < bend_to(at_, other)) {
          return true;
        }
      }
      if (cage_.has_border() && !cage_.on_border(face[k])) {
        const double side = at_[face[k]].x() < 0 ? -1 : 1;
        const double before = side * at_[face[k]].x();
        const double least = std::min(plane_gap * guard_.clearance(), before);
        if (!(side * next[face[k]].x() >= least)) {
          return true;
        }
      }
    }
    return false;
  }

  QuadCage& cage_;
  const QuadGuard& guard_;
  const Objective& objective_;
  RelaxQuadsOptions options_;
  Progress progress_; // of the run
  Positions at_;      // the present, valid positions of all vertices
  std::vector<Index> number_;
  std::vector<Index> living_;
  std::vector<Index> faces_;
  Vec3 center_ = Vec3::Zero();
  double keep_ = 0;
};

} // namespace

double relax_quads(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress) {
  return Relaxation(cage, guard, objective, options).run(progress);
}

} // namespace cagewright
