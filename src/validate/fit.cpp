#include <cagewright/validate/fit.h>

#include "core/maths.h"
#include "core/parallel.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t most_points = 300;
constexpr double fits = 0.95;       // share of the model's vertices inside a cage that fits
constexpr double about_fits = 0.4;  // inside one that is meant to be where it is
constexpr double far_too_large = 3; // times the model's diagonal

/// A cage is as large as its model or up to so many times larger, along each axis, and by so much
/// of the model's diagonal: flat models have thick cages.
constexpr double most_times = 2.2;
constexpr double most_beyond = 0.3;

struct NamedScale {
  double factor;
  const char* name;
};
constexpr std::array<NamedScale, 7> units = {{{10, "another unit"},
                                              {100, "centimetres against metres"},
                                              {1000, "millimetres against metres"},
                                              {2.54, "inches against centimetres"},
                                              {25.4, "inches against millimetres"},
                                              {1 / 0.0254, "inches against metres"},
                                              {1 / 0.3048, "feet against metres"}}};

struct NamedTurn {
  Mat3 turn;
  std::string name; // empty: none
};

Mat3 quarter_turns(int axis, int quarters) {
  static constexpr std::array<double, 4> cosines = {1, 0, -1, 0};
  const double c = cosines[static_cast<std::size_t>(quarters & 3)];
  const double s = cosines[static_cast<std::size_t>((quarters + 3) & 3)];
  Mat3 turn = Mat3::Identity();
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  turn(u, u) = c;
  turn(u, v) = -s;
  turn(v, u) = s;
  turn(v, v) = c;
  return turn;
}

/// The likeliest first: y up against z up, then other axes.
std::vector<NamedTurn> turns() {
  std::vector<NamedTurn> list = {
      {Mat3::Identity(), ""},
      {quarter_turns(0, 1), "turned by 90 degrees about the x axis (y up to z up)"},
      {quarter_turns(0, 3), "turned by -90 degrees about the x axis (z up to y up)"}};
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  for (const int quarters : {1, 3, 2}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0 || quarters == 2) {
        list.push_back({quarter_turns(axis, quarters),
                        "turned by " + std::to_string(quarters == 3 ? -90 : 90 * quarters) +
                            " degrees about the " + axes[static_cast<std::size_t>(axis)] +
                            " axis"});
      }
    }
  }
  return list;
}

std::string short_number(double value) {
  std::array<char, 32> text;
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end};
}

/// Whether the winding number of the cage round a point is about one or more, whichever way it is
/// oriented (van Oosterom and Strackee 1983).
bool winds_round(TriangleView cage, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : cage.triangles) {
    const Vec3 a = cage.positions[t[0]] - p;
    const Vec3 b = cage.positions[t[1]] - p;
    const Vec3 c = cage.positions[t[2]] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2 * maths::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(sum) >= 2 * std::numbers::pi;
}

class Fitter {
public:
  Fitter(TriangleView cage, TriangleView model)
      : cage_(cage), cage_box_(bounding_box(cage)), model_box_(bounding_box(model)) {
    std::vector<char> used(model.positions.size(), 0);
    for (const Triangle& t : model.triangles) {
      used[t[0]] = used[t[1]] = used[t[2]] = 1;
    }
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v] != 0 && model.positions[v].allFinite()) {
        points.push_back(model.positions[v]);
      }
    }
    const std::size_t count = std::min(points.size(), most_points);
    for (std::size_t i = 0; i < count; ++i) {
      points_.push_back(points[i * points.size() / count]);
    }
  }

  [[nodiscard]] bool has_sizes() const {
    return !points_.empty() && !cage_.triangles.empty() && cage_box_.sizes().norm() > 0 &&
           model_box_.sizes().norm() > 0 && cage_box_.sizes().allFinite();
  }
  [[nodiscard]] double relative_size() const {
    return cage_box_.sizes().norm() / model_box_.sizes().norm();
  }

  /// The simplest first.
  [[nodiscard]] std::optional<CageFit> find() const {
    const CageFit as_it_is;
    if (share_inside(as_it_is) >= about_fits && relative_size() < far_too_large) {
      return std::nullopt;
    }
    const std::vector<NamedTurn> all = turns();
    // One change; two; all three.
    for (const auto& [scales, turned, shifted] :
         {std::array{true, false, false}, std::array{false, true, false},
          std::array{false, false, true}, std::array{true, true, false},
          std::array{true, false, true}, std::array{false, true, true},
          std::array{true, true, true}}) {
      for (std::size_t t = turned ? 1 : 0; t < (turned ? all.size() : 1); ++t) {
        for (const NamedScale& scale : scales ? scales_for(all[t].turn) : none_) {
          CageFit fit;
          fit.turn = all[t].turn;
          fit.scale = scale.factor;
          if (shifted) {
            fit.shift = model_box_.center() - fit.scale * (fit.turn * cage_box_.center());
          }
          if (!is_plausible(fit)) {
            continue;
          }
          fit.inside = share_inside(fit);
          if (fit.inside >= fits) {
            describe(fit, all[t].name, scale);
            return fit;
          }
        }
      }
    }
    return std::nullopt;
  }

private:
  [[nodiscard]] Vec3 turned_sizes(const Mat3& turn) const {
    return (turn * cage_box_.sizes()).cwiseAbs();
  }

  /// Units, and last what the sizes themselves ask for.
  [[nodiscard]] std::vector<NamedScale> scales_for(const Mat3& turn) const {
    std::vector<NamedScale> list;
    for (const NamedScale& unit : units) {
      list.push_back({1 / unit.factor, unit.name});
      list.push_back({unit.factor, unit.name});
    }
    const Vec3 sizes = turned_sizes(turn);
    double least = 0; // to be as large as the model
    double most = 0;
    for (int k = 0; k < 3; ++k) {
      const double factor = model_box_.sizes()[k] / sizes[k];
      least = std::max(least, factor);
      most = k == 0 ? factor : std::min(most, factor);
    }
    constexpr double alike = 2; // sizes of a cage and of its model have about the same proportions
    if (std::isfinite(least) && least > 0 && least < alike * most) {
      for (const double larger : {1.05, 1.15, 1.3, 1.5}) {
        list.push_back({rounded(larger * least), ""});
      }
    }
    return list;
  }

  /// To two digits: nobody needs more.
  static double rounded(double factor) {
    const double unit = maths::pow(10, std::floor(maths::log(factor) / maths::log(10)) - 1);
    return std::ceil(factor / unit) * unit;
  }

  [[nodiscard]] bool is_plausible(const CageFit& fit) const {
    const Vec3 sizes = fit.scale * turned_sizes(fit.turn);
    const Vec3 model = model_box_.sizes();
    const Vec3 center = fit(cage_box_.center());
    for (int k = 0; k < 3; ++k) {
      const bool reaches = center[k] - sizes[k] / 2 <= model_box_.min()[k] + 0.05 * model[k] &&
                           center[k] + sizes[k] / 2 >= model_box_.max()[k] - 0.05 * model[k];
      if (!reaches || sizes[k] > most_times * model[k] + most_beyond * model.norm()) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] double share_inside(const CageFit& fit) const {
    const std::size_t inside = parallel_reduce_ordered(
        0, points_.size(), 16, std::size_t{0},
        [&](std::size_t first, std::size_t last) {
          std::size_t count = 0;
          for (std::size_t i = first; i < last; ++i) {
            const Vec3 p = fit.turn.transpose() * (points_[i] - fit.shift) / fit.scale;
            count += cage_box_.contains(p) && winds_round(cage_, p) ? 1 : 0;
          }
          return count;
        },
        [](std::size_t& all, std::size_t part) { all += part; });
    return static_cast<double>(inside) / static_cast<double>(points_.size());
  }

  static void describe(CageFit& fit, const std::string& turn, const NamedScale& scale) {
    std::vector<std::string> parts;
    if (fit.scale != 1) {
      parts.push_back("scaled by " + short_number(fit.scale) +
                      (*scale.name != 0 ? " (" + std::string(scale.name) + ")" : ""));
    }
    if (!turn.empty()) {
      parts.push_back(turn);
    }
    if (!fit.shift.isZero(0)) {
      parts.push_back("shifted by (" + short_number(fit.shift.x()) + ", " +
                      short_number(fit.shift.y()) + ", " + short_number(fit.shift.z()) + ")");
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      fit.description += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    }
  }

  TriangleView cage_;
  Box3 cage_box_;
  Box3 model_box_;
  std::vector<Vec3> points_;
  std::vector<NamedScale> none_ = {{1, ""}};
};

} // namespace

PolygonMesh CageFit::operator()(PolygonMesh cage) const {
  for (Vec3& p : cage.positions) {
    p = (*this)(p);
  }
  return cage;
}

std::optional<CageFit> fit_cage(const PolygonMesh& cage, TriangleView model) {
  const TriangleMesh triangles = to_triangle_mesh(cage);
  const Fitter fitter(triangles, model);
  return fitter.has_sizes() ? fitter.find() : std::nullopt;
}

double relative_size(const PolygonMesh& cage, TriangleView model) {
  const TriangleMesh triangles = to_triangle_mesh(cage);
  const Fitter fitter(triangles, model);
  return fitter.has_sizes() ? fitter.relative_size() : 0;
}

} // namespace cagewright
