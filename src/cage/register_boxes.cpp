#include "cage/register_boxes.h"

#include "core/maths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace cagewright {
namespace {

constexpr double degree = std::numbers::pi / 180;

using Quad = std::array<Vec3, 4>;
using Corners = std::array<Vec3, 8>; // numbered as those of a hexahedron

/// The pairs of corners that are the ends of an edge.
constexpr std::array<std::array<int, 2>, 12> edges = {{{0, 1},
                                                       {2, 3},
                                                       {4, 5},
                                                       {6, 7},
                                                       {0, 2},
                                                       {1, 3},
                                                       {4, 6},
                                                       {5, 7},
                                                       {0, 4},
                                                       {1, 5},
                                                       {2, 6},
                                                       {3, 7}}};

struct Plane {
  Vec3 point;
  Vec3 normal; ///< unit

  [[nodiscard]] double height(const Vec3& p) const { return normal.dot(p - point); }
};

// ---------------------------------------------------------------------------------------------
// What the boxes hold
// ---------------------------------------------------------------------------------------------

/// The voxels as runs along the first axis of the grid, each the cuboid from its first to its last
/// voxel: convex solids that contain the cuboids contain the voxels.
std::vector<Corners> runs_of(const BoxContents& contents, const VoxelGrid& grid) {
  std::map<std::array<int, 2>, std::array<int, 2>> runs; // from (j, k) to (least i, greatest i)
  for (const std::uint32_t voxel : contents.voxels) {
    const auto [i, j, k] = grid.cell(voxel);
    const auto at = runs.try_emplace({j, k}, std::array{i, i}).first;
    at->second = {std::min(at->second[0], i), std::max(at->second[1], i)};
  }
  std::vector<Corners> cuboids;
  cuboids.reserve(runs.size());
  for (const auto& [row, ends] : runs) {
    Corners& cuboid = cuboids.emplace_back();
    for (int c = 0; c < 8; ++c) {
      cuboid[c] = grid.corner((c & 1) ? ends[1] + 1 : ends[0], row[0] + ((c >> 1) & 1),
                              row[1] + ((c >> 2) & 1));
    }
  }
  return cuboids;
}

/// Where the contents of two boxes touch.
struct Contact {
  Vec3 sum = Vec3::Zero(); ///< of the centers of the voxels that touch
  double count = 0;

  [[nodiscard]] Vec3 center() const { return sum / count; }
};
using Contacts = std::map<std::pair<std::uint32_t, std::uint32_t>, Contact>;

/// All pairs (less, greater) of boxes with voxels that share at least a corner.
Contacts find_contacts(std::span<const BoxContents> boxes, const VoxelGrid& grid) {
  constexpr std::uint32_t nobody = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> owner(grid.kinds.size(), nobody);
  for (std::uint32_t b = 0; b < boxes.size(); ++b) {
    for (const std::uint32_t voxel : boxes[b].voxels) {
      owner[voxel] = b;
    }
  }
  Contacts contacts;
  for (std::uint32_t b = 0; b < boxes.size(); ++b) {
    for (const std::uint32_t voxel : boxes[b].voxels) {
      const auto cell = grid.cell(voxel);
      for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> next = {cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1,
                                         cell[2] + n / 9 - 1};
        bool within = true;
        for (int axis = 0; axis < 3; ++axis) {
          within = within && next[axis] >= 0 && next[axis] < grid.dims[axis];
        }
        if (!within) {
          continue;
        }
        const std::uint32_t other = owner[grid.index(next)];
        if (other != nobody && other > b) {
          Contact& contact = contacts[{b, other}];
          contact.sum += grid.center(voxel);
          contact.count += 1;
        }
      }
    }
  }
  return contacts;
}

// ---------------------------------------------------------------------------------------------
// Convex solids as half-spaces
// ---------------------------------------------------------------------------------------------

class HalfSpaces {
public:
  explicit HalfSpaces(const Hexahedron& solid) {
    const std::array<Triangle, 12> triangles = triangulate(solid);
    for (int t = 0; t < 12; ++t) {
      const Vec3& a = solid.corners[triangles[t][0]];
      normals_[t] = (solid.corners[triangles[t][1]] - a)
                        .cross(solid.corners[triangles[t][2]] - a)
                        .normalized();
      offsets_[t] = normals_[t].dot(a);
    }
  }

  /// Whether the point lies at least `margin` behind all faces but those of the set `open` (bits).
  [[nodiscard]] bool contain(const Vec3& p, double margin, unsigned open = 0) const {
    for (int t = 0; t < 12; ++t) {
      if (!((open >> (t / 2)) & 1U) && !(normals_[t].dot(p) <= offsets_[t] - margin)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] const std::array<Vec3, 12>& normals() const { return normals_; }

private:
  std::array<Vec3, 12> normals_;
  std::array<double, 12> offsets_{};
};

/// The range of the solid along a direction.
std::array<double, 2> range_along(const Hexahedron& solid, const Vec3& direction) {
  std::array<double, 2> range = {std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};
  for (const Vec3& corner : solid.corners) {
    const double at = direction.dot(corner);
    range = {std::min(range[0], at), std::max(range[1], at)};
  }
  return range;
}

/// Whether two convex solids come nearer to each other than `gap`, by the separating axes.
bool come_near(const Hexahedron& a, const Hexahedron& b, double gap) {
  const auto separates = [&](const Vec3& direction) {
    const auto in_a = range_along(a, direction);
    const auto in_b = range_along(b, direction);
    return in_a[0] - in_b[1] >= gap || in_b[0] - in_a[1] >= gap;
  };
  for (const Hexahedron* solid : {&a, &b}) {
    const HalfSpaces faces(*solid);
    if (std::any_of(faces.normals().begin(), faces.normals().end(), separates)) {
      return false;
    }
  }
  for (const auto& [p, q] : edges) {
    for (const auto& [r, s] : edges) {
      const Vec3 across = (a.corners[q] - a.corners[p]).cross(b.corners[s] - b.corners[r]);
      if (across.norm() > 0 && separates(across.normalized())) {
        return false;
      }
    }
  }
  return true;
}

/// The angle between two vectors in radians.
double angle_between(const Vec3& a, const Vec3& b) {
  return maths::atan2(a.cross(b).norm(), a.dot(b));
}

bool is_well_shaped(const Hexahedron& solid, const RegisterOptions& options) {
  const double size = (solid.corners[7] - solid.corners[0]).norm();
  if (!(volume(solid) > 0) || !is_convex(solid, 1e-9 * size)) {
    return false;
  }
  const double least = options.min_angle * degree;
  const auto is_sharp = [least](double angle) {
    return !(angle >= least && angle <= std::numbers::pi - least);
  };
  for (int f = 0; f < 6; ++f) {
    for (int i = 0; i < 4; ++i) {
      const Vec3& corner = solid.corner(f, i);
      if (is_sharp(angle_between(solid.corner(f, (i + 1) % 4) - corner,
                                 solid.corner(f, (i + 3) % 4) - corner))) {
        return false;
      }
    }
    for (int g = f + 1; g < 6; ++g) {
      if (g != opposite_face(f) &&
          is_sharp(angle_between(face_area(solid, f), face_area(solid, g)))) {
        return false;
      }
    }
  }
  const HalfSpaces faces(solid);
  for (int f = 0; f < 6; ++f) {
    if (!(angle_between(faces.normals()[2 * f], faces.normals()[2 * f + 1]) <=
          options.max_bend * degree)) {
      return false;
    }
  }
  return true;
}

// ---------------------------------------------------------------------------------------------
// The rectangle where two boxes join
// ---------------------------------------------------------------------------------------------

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back(); // it starts the other side
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// A rectangle in a plane: axes u, v with u x v = the plane's normal, and the extents along them.
struct Rectangle {
  Plane plane;
  Vec3 u;
  Vec3 v;
  Eigen::AlignedBox2d extent; ///< in (u, v), from the plane's point

  [[nodiscard]] Vec2 local(const Vec3& p) const {
    return {u.dot(p - plane.point), v.dot(p - plane.point)};
  }

  /// Counter-clockwise seen from where the normal points.
  [[nodiscard]] Quad corners() const {
    const auto at = [this](double x, double y) -> Vec3 { return plane.point + x * u + y * v; };
    const Vec2& low = extent.min();
    const Vec2& high = extent.max();
    return {at(low.x(), low.y()), at(high.x(), low.y()), at(high.x(), high.y()),
            at(low.x(), high.y())};
  }
};

/// The rectangle of least area around points of the plane: one side lies along a side of the hull.
Rectangle least_rectangle(const Plane& plane, std::span<const Vec3> points) {
  Rectangle frame{plane, plane.normal.unitOrthogonal(), {}, {}};
  frame.v = plane.normal.cross(frame.u);
  std::vector<Vec2> flat;
  for (const Vec3& p : points) {
    flat.push_back(frame.local(p));
  }
  const std::vector<Vec2> hull = convex_hull(flat);
  Rectangle best = frame;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    Rectangle turned{plane, along.x() * frame.u + along.y() * frame.v, {}, {}};
    turned.v = plane.normal.cross(turned.u);
    for (const Vec3& p : points) {
      turned.extent.extend(turned.local(p));
    }
    if (turned.extent.volume() < least * (1 - 1e-9)) { // of equal ones the first
      least = turned.extent.volume();
      best = turned;
    }
  }
  return best;
}

/// Makes the rectangle so large that the cuboids' section with its plane lies `margin` within.
void cover_section(Rectangle& rectangle, std::span<const Corners> cuboids, double margin) {
  for (const Corners& cuboid : cuboids) {
    for (const auto& [a, b] : edges) {
      const double from = rectangle.plane.height(cuboid[a]);
      const double to = rectangle.plane.height(cuboid[b]);
      if ((from < 0) != (to < 0)) {
        const Vec2 at = rectangle.local(cuboid[a] + from / (from - to) * (cuboid[b] - cuboid[a]));
        rectangle.extent.extend(Vec2(at - Vec2::Constant(margin)));
        rectangle.extent.extend(Vec2(at + Vec2::Constant(margin)));
      }
    }
  }
}

/// Moves face f to the rectangle. `corners` are the rectangle's, in the order in which the face's
/// corners run (from outside counter-clockwise), and of the four cyclic matches the one is taken
/// that makes the outward normals of the edges agree best with those of the sides of the solid.
void move_face(Hexahedron& solid, int f, const Quad& corners) {
  const Vec3 facing = face_area(solid, f).normalized();
  const Vec3 rectangle_facing =
      (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  int best = 0;
  double best_sum = -std::numeric_limits<double>::infinity();
  for (int j = 0; j < 4; ++j) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const Vec3 edge = corners[(i + 1) % 4] - corners[i];
      const Vec3 side = solid.corner(f, (i + j + 1) % 4) - solid.corner(f, (i + j) % 4);
      sum += edge.cross(rectangle_facing).normalized().dot(side.cross(facing).normalized());
    }
    if (sum > best_sum + 1e-9) {
      best_sum = sum;
      best = j;
    }
  }
  for (int i = 0; i < 4; ++i) {
    solid.corners[hexahedron_faces[f][(i + best) % 4]] = corners[i];
  }
  solid.shared[f] = true;
  solid.is_box = false;
}

/// Where the corners of face f come to lie in the plane: projected on it, or moved along the edges
/// that lead to them. None when these run nearly along the plane.
std::optional<Quad> corners_in_plane(const Hexahedron& solid, int f, const Plane& plane,
                                     bool along_edges) {
  Quad moved;
  for (int i = 0; i < 4; ++i) {
    const Index corner = hexahedron_faces[f][i];
    const Vec3& p = solid.corners[corner];
    const Index behind = corner ^ (1U << (f / 2)); // the other end of the edge across
    const Vec3 way = along_edges ? Vec3((p - solid.corners[behind]).normalized()) : plane.normal;
    const double slope = plane.normal.dot(way);
    if (std::abs(slope) < 0.5) {
      return std::nullopt;
    }
    moved[i] = p - plane.height(p) / slope * way;
  }
  return moved;
}

// ---------------------------------------------------------------------------------------------
// Joining
// ---------------------------------------------------------------------------------------------

struct Candidate {
  Joint joint;
  double cost = 0; ///< volume needed, and a little for a plane that does not bisect the faces
};

/// The solids as they are, and what is joined.
class Registrar {
public:
  Registrar(const VoxelGrid& grid, std::span<const BoxContents> boxes,
            const RegisterOptions& options)
      : options_(options), contacts_(find_contacts(boxes, grid)),
        margin_(options.clearance * grid.size), voxel_(grid.size), gap_(0.5 * grid.size),
        joints_of_(boxes.size()), result_(keep_apart(boxes)) {
    for (const BoxContents& contents : boxes) {
      runs_.push_back(runs_of(contents, grid));
    }
  }

  Result<Registration> run(const Progress& progress) {
    std::vector<Candidate> candidates;
    const std::vector<Joint> pairs = facing_pairs();
    double done = 0;
    for (const Joint& joint : pairs) {
      if (progress.cancelled()) {
        return Error::cancelled();
      }
      const Trial trial = best_trial(joint);
      if (trial.verdict == JointVerdict::joined) {
        candidates.push_back({joint, trial.cost});
      } else {
        count(trial.verdict);
      }
      progress(++done / (static_cast<double>(pairs.size()) + 1), "register boxes");
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    for (const Candidate& candidate : candidates) {
      if (progress.cancelled()) {
        return Error::cancelled();
      }
      count(join(candidate.joint));
    }
    progress(1, "register boxes");
    return std::move(result_);
  }

private:
  /// Two solids as a joint would make them.
  struct Trial {
    JointVerdict verdict = JointVerdict::misshapen;
    double growth = std::numeric_limits<double>::infinity(); ///< of the volume, a fraction
    double cost = std::numeric_limits<double>::infinity();
    Hexahedron first;
    Hexahedron second;
  };

  void count(JointVerdict verdict) { ++result_.verdicts[static_cast<std::size_t>(verdict)]; }

  [[nodiscard]] const Hexahedron& solid(std::uint32_t i) const { return result_.solids[i]; }

  [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const {
    return contacts_.contains(std::minmax(a, b));
  }

  /// The pairs of faces that face each other across a contact, are alike and near: the paper's
  /// conditions.
  [[nodiscard]] std::vector<Joint> facing_pairs() const {
    std::vector<Joint> pairs;
    for (const auto& [boxes, contact] : contacts_) {
      const auto& [a, b] = boxes;
      const double ratio = volume(solid(a)) / volume(solid(b));
      if (std::min(ratio, 1 / ratio) < options_.min_size_ratio) {
        continue;
      }
      for (int f = 0; f < 6; ++f) {
        for (int g = 0; g < 6; ++g) {
          if (are_alike(solid(a), f, solid(b), g, contact.center())) {
            pairs.push_back({a, f, b, g});
          }
        }
      }
    }
    return pairs;
  }

  [[nodiscard]] bool are_alike(const Hexahedron& a, int f, const Hexahedron& b, int g,
                               const Vec3& contact) const {
    const Vec3 area_a = face_area(a, f);
    const Vec3 area_b = face_area(b, g);
    const auto [small, large] = std::minmax(
        {area_a.norm(), area_b.norm()}); // a list: of temporaries it would keep references
    const double reach = options_.max_distance * std::sqrt((small + large) / 2);
    const Vec3 middle = (face_center(a, f) + face_center(b, g)) / 2;
    return angle_between(area_a, area_b) >= options_.min_facing_angle * degree &&
           small >= options_.min_area_ratio * large &&
           (face_center(a, f) - face_center(b, g)).norm() <= reach &&
           (contact - middle).norm() <= reach;
  }

  [[nodiscard]] bool is_taken(std::uint32_t i, int f) const {
    for (int g = 0; g < 6; ++g) {
      if (solid(i).shared[g] && g != opposite_face(f)) {
        return true;
      }
    }
    return false;
  }

  JointVerdict join(const Joint& joint) {
    if (is_taken(joint.solid0, joint.face0) || is_taken(joint.solid1, joint.face1)) {
      return JointVerdict::taken;
    }
    const Trial trial = best_trial(joint);
    if (trial.verdict == JointVerdict::joined) {
      result_.solids[joint.solid0] = trial.first;
      result_.solids[joint.solid1] = trial.second;
      push(joint);
      result_.joints.push_back(joint);
    }
    return trial.verdict;
  }

  void push(const Joint& joint) {
    joints_of_[joint.solid0].push_back(joint);
    joints_of_[joint.solid1].push_back({joint.solid1, joint.face1, joint.solid0, joint.face0});
  }
  void pop(const Joint& joint) {
    joints_of_[joint.solid0].pop_back();
    joints_of_[joint.solid1].pop_back();
  }

  /// The joint of least cost, or the one that comes nearest to being possible.
  Trial best_trial(const Joint& joint) {
    Trial best;
    for (const Plane& plane : planes_between(joint)) {
      for (const bool along_edges : {false, true}) {
        for (const double slack : {0.0, 0.5, 1.0}) {
          const Trial trial = attempt(joint, plane, along_edges, slack * voxel_);
          const auto rank = [](const Trial& t) {
            return t.verdict == JointVerdict::joined ? joint_verdicts : static_cast<int>(t.verdict);
          };
          if (std::pair(-rank(trial), trial.cost) < std::pair(-rank(best), best.cost)) {
            best = trial;
          }
        }
      }
    }
    return best;
  }

  /// The normal of the plane that bisects the two faces, from the first solid to the second.
  [[nodiscard]] Vec3 bisector_of(const Joint& joint) const {
    return (face_area(solid(joint.solid0), joint.face0).normalized() -
            face_area(solid(joint.solid1), joint.face1).normalized())
        .normalized();
  }

  /// The paper's plane, perpendicular to the line between the centers of the faces, if that line
  /// is long enough to have a direction; and the plane that bisects the faces. Both normals point
  /// from the first solid to the second.
  [[nodiscard]] std::vector<Plane> planes_between(const Joint& joint) const {
    const Vec3 from = face_center(solid(joint.solid0), joint.face0);
    const Vec3 to = face_center(solid(joint.solid1), joint.face1);
    const Vec3 bisector = bisector_of(joint);
    const Vec3 middle = (from + to) / 2;
    std::vector<Plane> planes = {{middle, bisector}};
    const double distance = (to - from).norm();
    if (distance > gap_ && std::abs((to - from).dot(bisector)) > 0.8 * distance) {
      const double sign = (to - from).dot(bisector) > 0 ? 1 : -1; // boxes that overlap: behind
      planes.push_back({middle, sign * (to - from) / distance});
    }
    return planes;
  }

  Trial attempt(const Joint& joint, const Plane& plane, bool along_edges, double slack) {
    const auto& [a, f, b, g] = joint;
    Trial trial;
    const auto corners_a = corners_in_plane(solid(a), f, plane, along_edges);
    const auto corners_b = corners_in_plane(solid(b), g, plane, along_edges);
    if (!corners_a || !corners_b) {
      return trial;
    }
    Corners eight;
    std::copy(corners_a->begin(), corners_a->end(), eight.begin());
    std::copy(corners_b->begin(), corners_b->end(), eight.begin() + 4);
    Rectangle rectangle = least_rectangle(plane, eight);
    cover_section(rectangle, runs_[a], margin_ * 1.01);
    cover_section(rectangle, runs_[b], margin_ * 1.01);
    rectangle.extent.min().array() -= slack;
    rectangle.extent.max().array() += slack;

    Quad corners = rectangle.corners();
    trial.first = solid(a);
    trial.second = solid(b);
    move_face(trial.first, f, corners);
    std::reverse(corners.begin(), corners.end()); // the second looks at it from the other side
    move_face(trial.second, g, corners);
    const double before = volume(solid(a)) + volume(solid(b));
    trial.growth = (volume(trial.first) + volume(trial.second)) / before - 1;
    trial.cost = trial.growth + 0.2 * angle_between(plane.normal, bisector_of(joint));
    trial.verdict = judge(joint, trial);
    return trial;
  }

  JointVerdict judge(const Joint& joint, const Trial& trial) {
    if (!is_well_shaped(trial.first, options_) || !is_well_shaped(trial.second, options_)) {
      return JointVerdict::misshapen;
    }
    if (trial.growth > options_.max_growth) {
      return JointVerdict::too_large;
    }
    if (!contains_contents(joint, trial)) {
      return JointVerdict::uncontained;
    }
    if (runs_into_others(joint, joint.solid0, trial.first) ||
        runs_into_others(joint, joint.solid1, trial.second)) {
      return JointVerdict::runs_into;
    }
    return JointVerdict::joined;
  }

  /// Whether the changed solid comes near one that it did not come near, and whose contents do not
  /// touch its own: they would become connected.
  [[nodiscard]] bool runs_into_others(const Joint& joint, std::uint32_t i,
                                      const Hexahedron& changed) const {
    for (std::uint32_t other = 0; other < result_.solids.size(); ++other) {
      if (other != joint.solid0 && other != joint.solid1 && !touch(i, other) &&
          come_near(changed, solid(other), gap_) && !come_near(solid(i), solid(other), gap_)) {
        return true;
      }
    }
    return false;
  }

  /// Whether all contents that the joint concerns would be covered: those of both solids, and of
  /// their other neighbors, which may reach into them.
  bool contains_contents(const Joint& joint, const Trial& trial) {
    const Hexahedron first = std::exchange(result_.solids[joint.solid0], trial.first);
    const Hexahedron second = std::exchange(result_.solids[joint.solid1], trial.second);
    push(joint);
    std::vector<std::uint32_t> concerned = {joint.solid0, joint.solid1};
    for (const std::uint32_t i : {joint.solid0, joint.solid1}) {
      for (const Joint& other : joints_of_[i]) {
        concerned.push_back(other.solid1);
      }
    }
    std::sort(concerned.begin(), concerned.end());
    concerned.erase(std::unique(concerned.begin(), concerned.end()), concerned.end());
    const bool contained = std::all_of(concerned.begin(), concerned.end(),
                                       [this](std::uint32_t i) { return covers_its_contents(i); });
    pop(joint);
    result_.solids[joint.solid0] = first;
    result_.solids[joint.solid1] = second;
    return contained;
  }

  /// A joint as one of its solids sees it.
  struct Side {
    Plane plane; ///< pointing out of the solid
    HalfSpaces beyond;
    unsigned open_beyond; ///< the face of the other solid, as a bit
  };

  /// Whether solid i contains its cuboids, what lies beyond the plane of a joint being left to the
  /// neighbor there. The solids are convex: corners, and points where edges cross the planes, tell.
  [[nodiscard]] bool covers_its_contents(std::uint32_t i) const {
    const HalfSpaces own(solid(i));
    unsigned open = 0;
    std::vector<Side> sides;
    for (const Joint& joint : joints_of_[i]) {
      open |= 1U << joint.face0;
      sides.push_back(
          {{face_center(solid(i), joint.face0), face_area(solid(i), joint.face0).normalized()},
           HalfSpaces(solid(joint.solid1)),
           1U << joint.face1});
    }
    const auto covered = [&](const Corners& cuboid) {
      return std::all_of(cuboid.begin(), cuboid.end(),
                         [&](const Vec3& p) { return own.contain(p, margin_); }) ||
             (corners_covered(cuboid, own, open, sides) &&
              crossings_covered(cuboid, own, open, sides));
    };
    return std::all_of(runs_[i].begin(), runs_[i].end(), covered);
  }

  [[nodiscard]] bool corners_covered(const Corners& cuboid, const HalfSpaces& own, unsigned open,
                                     std::span<const Side> sides) const {
    for (const Vec3& p : cuboid) {
      bool is_beyond = false;
      for (const Side& side : sides) {
        if (side.plane.height(p) > 0) {
          is_beyond = true;
          if (!side.beyond.contain(p, margin_, side.open_beyond)) {
            return false;
          }
        }
      }
      if (!is_beyond && !own.contain(p, margin_, open)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool crossings_covered(const Corners& cuboid, const HalfSpaces& own, unsigned open,
                                       std::span<const Side> sides) const {
    for (const Side& side : sides) {
      for (const auto& [a, b] : edges) {
        const double from = side.plane.height(cuboid[a]);
        const double to = side.plane.height(cuboid[b]);
        if ((from > 0) == (to > 0)) {
          continue;
        }
        const Vec3 p = cuboid[a] + from / (from - to) * (cuboid[b] - cuboid[a]);
        if (!own.contain(p, margin_, open) || !side.beyond.contain(p, margin_, side.open_beyond)) {
          return false;
        }
      }
    }
    return true;
  }

  const RegisterOptions& options_;
  Contacts contacts_;
  double margin_;
  double voxel_; // its edge
  double gap_;   // between solids that are not to become connected
  std::vector<std::vector<Corners>> runs_;
  std::vector<std::vector<Joint>> joints_of_; // of each solid, which is the joint's solid0
  Registration result_;
};

} // namespace

std::string_view name_of(JointVerdict verdict) {
  switch (verdict) {
  case JointVerdict::joined:
    return "joined";
  case JointVerdict::taken:
    return "taken";
  case JointVerdict::misshapen:
    return "misshapen";
  case JointVerdict::too_large:
    return "too_large";
  case JointVerdict::uncontained:
    return "uncontained";
  case JointVerdict::runs_into:
    return "runs_into";
  }
  return "unknown";
}

Result<Registration> register_boxes(const VoxelGrid& grid, std::span<const BoxContents> boxes,
                                    const RegisterOptions& options, const Progress& progress) {
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (const std::uint32_t voxel : boxes[b].voxels) {
      if (voxel >= grid.kinds.size()) {
        return Error{ErrorCode::invalid_option,
                     "box " + std::to_string(b) + " holds a voxel that the grid does not have"};
      }
    }
  }
  return Registrar(grid, boxes, options).run(progress);
}

Registration keep_apart(std::span<const BoxContents> boxes) {
  Registration registration;
  for (const BoxContents& contents : boxes) {
    const OrientedBox& box = contents.box;
    registration.solids.push_back(make_box(box.center, box.axes, box.half));
  }
  return registration;
}

} // namespace cagewright
