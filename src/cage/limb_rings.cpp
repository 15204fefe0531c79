#include "cage/limb_rings.h"

#include "cage/decompose.h"
#include "core/parallel.h"
#include "improve/cage_mesh.h"
#include "improve/objective.h"
#include "mesh/edge_chains.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

using Edge = std::array<Index, 2>;

struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();
};

/// A ring that might be, with the limb beyond it.
struct Candidate {
  std::vector<Index> vertices;
  std::vector<Index> limb; ///< faces
  Vec3 center = Vec3::Zero();
  double width = 0;   ///< the diameter of a circle of the ring's area
  double length = 0;  ///< of a limb as wide as the ring, and of its volume; in widths
  double surface = 0; ///< the limb's part of the whole surface
  int copies = 1;     ///< in the whole cage
  Plane plane;        ///< that it was found along
  SeamBand band;
};

class Finder {
public:
  explicit Finder(TriangleView start) : start_(start), mesh_(start) {
    for (Index f = 0; f < mesh_.face_end(); ++f) {
      std::array<Index, 3>& beside = neighbors_.emplace_back();
      const Triangle& t = mesh_.face(f);
      for (int i = 0; i < 3; ++i) {
        beside[i] = mesh_.face_left_of(t[(i + 1) % 3], t[i]);
        if (beside[i] == no_index) {
          is_half_ = true;
          origin_ = start.positions[t[i]];
        }
      }
    }
    for (Index f = 0; f < mesh_.face_end(); ++f) {
      all_.push_back(f);
    }
    area_ = area_of(all_);
    room_ = 0.04 * diagonal(start.positions); // between the cage and the boxes of the cuts
  }

  /// The rings along one plane that have a limb beyond them.
  ///
  /// \param box  that they must lie in, but for the room between boxes and cage; null: anywhere
  [[nodiscard]] std::vector<Candidate> candidates(const Plane& plane,
                                                  const OrientedBox* box) const {
    std::vector<Candidate> candidates;
    std::vector<std::uint8_t> above(start_.positions.size());
    for (std::size_t v = 0; v < above.size(); ++v) {
      above[v] = (start_.positions[v] - plane.point).dot(plane.normal) > 0 ? 1 : 0;
    }
    // Whole fans of vertices: their border is less ragged than that of single faces.
    std::vector<std::uint8_t> inside(mesh_.face_end());
    for (Index f = 0; f < mesh_.face_end(); ++f) {
      const Triangle& t = mesh_.face(f);
      inside[f] = above[t[0]] | above[t[1]] | above[t[2]];
    }
    std::vector<Edge> edges;
    for (Index f = 0; f < mesh_.face_end(); ++f) {
      for (int i = 0; i < 3 && inside[f] != 0; ++i) {
        const Index other = neighbors_[f][i];
        if (other != no_index && inside[other] == 0) {
          edges.push_back({mesh_.face(f)[i], mesh_.face(f)[(i + 1) % 3]});
        }
      }
    }
    for (const EdgeChain& chain : chains_of(edges)) {
      const bool is_there =
          box == nullptr || std::all_of(chain.vertices.begin(), chain.vertices.end(), [&](Index v) {
            return box->contains(start_.positions[v], room_);
          });
      if (is_there && chain.simple && chain.vertices.size() >= (chain.closed ? 4 : 3)) {
        if (std::optional<Candidate> candidate = candidate_of(chain)) {
          candidate->plane = plane;
          candidate->band = band_of(chain, plane, candidate->width);
          candidates.push_back(std::move(*candidate));
        }
      }
    }
    return candidates;
  }

  /// 1 if the limb is on the side to which the normal of the ring's plane points, else -1.
  [[nodiscard]] double toward_limb(const Candidate& ring) const {
    double sum = 0;
    for (const Index f : ring.limb) {
      const Corners t = corners_of(mesh_, f);
      sum += triangle_area(t) * ((t[0] + t[1] + t[2]) / 3 - ring.center).dot(ring.plane.normal);
    }
    return sum < 0 ? -1 : 1;
  }

  /// The parts of the cage between the rings: those round larger limbs come first.
  [[nodiscard]] std::vector<Index> parts_between(std::span<const Candidate> rings) const {
    std::vector<Index> parts(mesh_.face_end(), 0);
    Index part = 0;
    for (const Candidate& ring : rings) {
      ++part;
      for (const Index f : ring.limb) {
        parts[f] = part;
      }
    }
    return parts;
  }

private:
  // Round the plane, a part of its width, or as much as it takes to begin with.
  [[nodiscard]] SeamBand band_of(const EdgeChain& ring, const Plane& plane, double width) const {
    constexpr double narrow = 0.15;
    SeamBand band{plane.point, plane.normal, 0};
    if (is_half_ && !ring.closed) { // across the mirror plane
      band.normal.x() = 0;
      band.normal.normalize();
    }
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Index v : ring.vertices) {
      low = std::min(low, band.height(start_.positions[v]));
      high = std::max(high, band.height(start_.positions[v]));
    }
    band.point += (low + high) / 2 * band.normal;
    band.half_width = std::max(narrow * width, (high - low) / 2);
    return band;
  }

  [[nodiscard]] std::optional<Candidate> candidate_of(const EdgeChain& chain) const {
    const std::vector<Edge> seam = edges_of(chain);
    std::optional<Sides> sides = sides_of(seam);
    if (!sides) {
      return std::nullopt;
    }
    // Of a half what lies in the mirror plane or across it counts twice, and its center is in the
    // plane, where the half is open: seen from there what closes it has no volume.
    const bool is_across = is_half_ && !chain.closed;
    const double copies = is_across ? 2 : 1;
    Candidate made;
    made.vertices = chain.vertices;
    made.copies = is_half_ && chain.closed ? 2 : 1;
    made.center =
        is_across ? Vec3((position(chain.vertices.front()) + position(chain.vertices.back())) / 2)
                  : center_of(chain.vertices);
    const bool is_rest_closed = made.copies == 1;
    const bool is_swapped =
        is_rest_closed ? volume_of(sides->right, made.center) < volume_of(sides->left, made.center)
                       : sides->left_has_border;
    made.limb = std::move(is_swapped ? sides->right : sides->left);
    const double ring_area = copies * area_within(seam, made.center);
    const double volume = copies * volume_of(made.limb, made.center);
    const double halves = is_half_ ? 2 : 1;
    const double rest = halves * volume_of(all_, origin_) - volume;
    made.surface = copies * area_of(made.limb) / (halves * area_);
    made.width = std::sqrt(4 / std::numbers::pi * ring_area);
    made.length = volume / std::max(ring_area * made.width, 1e-300);
    constexpr double least_length = 0.75;
    constexpr double least_rest = 2; // cubes of the ring's size
    const bool is_limb =
        made.length > least_length && rest > least_rest * ring_area * std::sqrt(ring_area);
    return is_limb ? std::optional(std::move(made)) : std::nullopt;
  }

  static std::vector<Edge> edges_of(const EdgeChain& chain) {
    std::vector<Edge> edges;
    const std::vector<Index>& v = chain.vertices;
    for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < v.size(); ++i) {
      edges.push_back({v[i], v[(i + 1) % v.size()]});
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  /// The faces on both sides of a ring.
  struct Sides {
    std::vector<Index> left;
    std::vector<Index> right;
    bool left_has_border = false; ///< that of a half
  };

  // None if the ring goes round a handle: then both sides are one.
  [[nodiscard]] std::optional<Sides> sides_of(const std::vector<Edge>& seam) const {
    const auto is_seam = [&](Index a, Index b) {
      return std::binary_search(seam.begin(), seam.end(), Edge{a, b}) ||
             std::binary_search(seam.begin(), seam.end(), Edge{b, a});
    };
    const auto [a, b] = seam.front();
    std::vector<std::uint8_t> is_left(mesh_.face_end(), 0);
    Sides sides;
    sides.left.push_back(mesh_.face_left_of(a, b));
    is_left[sides.left[0]] = 1;
    for (std::size_t i = 0; i < sides.left.size(); ++i) {
      const Index f = sides.left[i];
      const Triangle& t = mesh_.face(f);
      for (int k = 0; k < 3; ++k) {
        const Index other = neighbors_[f][k];
        sides.left_has_border |= other == no_index;
        if (other != no_index && is_left[other] == 0 && !is_seam(t[k], t[(k + 1) % 3])) {
          is_left[other] = 1;
          sides.left.push_back(other);
        }
      }
    }
    if (is_left[mesh_.face_left_of(b, a)] != 0) {
      return std::nullopt;
    }
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(sides.right),
                 [&](Index f) { return is_left[f] == 0; });
    return sides;
  }

  [[nodiscard]] double area_within(std::span<const Edge> seam, const Vec3& center) const {
    Vec3 doubled = Vec3::Zero();
    for (const auto& [a, b] : seam) {
      doubled += (position(a) - center).cross(position(b) - center);
    }
    return doubled.norm() / 2;
  }

  [[nodiscard]] const Vec3& position(Index v) const { return start_.positions[v]; }

  [[nodiscard]] Vec3 center_of(std::span<const Index> vertices) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : vertices) {
      sum += position(v);
    }
    return sum / static_cast<double>(vertices.size());
  }

  [[nodiscard]] double volume_of(std::span<const Index> faces, const Vec3& origin) const {
    double sum = 0;
    for (const Index f : faces) {
      const Corners t = corners_of(mesh_, f);
      sum += (t[0] - origin).dot((t[1] - origin).cross(t[2] - origin)) / 6;
    }
    return sum;
  }

  [[nodiscard]] double area_of(std::span<const Index> faces) const {
    double sum = 0;
    for (const Index f : faces) {
      sum += triangle_area(corners_of(mesh_, f));
    }
    return sum;
  }

  TriangleView start_;
  CageMesh mesh_;
  std::vector<std::array<Index, 3>> neighbors_;
  std::vector<Index> all_;
  bool is_half_ = false;
  Vec3 origin_ = Vec3::Zero();
  double area_ = 0;
  double room_ = 0;
};

bool share_vertices(const Candidate& a, const Candidate& b) {
  return std::any_of(a.vertices.begin(), a.vertices.end(), [&](Index v) {
    return std::find(b.vertices.begin(), b.vertices.end(), v) != b.vertices.end();
  });
}

bool leave_room(const Candidate& a, const Candidate& b) {
  constexpr double room = 0.8; // widths of the wider ring
  return (a.center - b.center).norm() >= room * std::max(a.width, b.width) && !share_vertices(a, b);
}

bool has_room(const Candidate& candidate, std::span<const Candidate> others) {
  return std::all_of(others.begin(), others.end(),
                     [&](const Candidate& other) { return leave_room(candidate, other); });
}

/// A fifth of the vertices may be on rings.
int most_rings(int vertices) {
  return vertices / (5 * static_cast<int>(least_seam));
}

/// The directions of all cuts, those once that are nearly the same.
std::vector<Vec3> directions_of(std::span<const LimbCut> cuts) {
  constexpr double nearly = 0.97; // the cosine
  std::vector<Vec3> directions;
  for (const LimbCut& cut : cuts) {
    for (int a = 0; a < 3; ++a) {
      const Vec3 d = cut.box.axes.col(a);
      if (std::none_of(directions.begin(), directions.end(),
                       [&](const Vec3& other) { return std::abs(other.dot(d)) > nearly; })) {
        directions.push_back(d);
      }
    }
  }
  return directions;
}

/// Even planes across the directions.
std::vector<Plane> planes_across(std::span<const Vec3> directions, std::span<const Vec3> points) {
  constexpr int count = 40; // across the diagonal
  const double step = diagonal(points) / count;
  std::vector<Plane> planes;
  for (const Vec3& d : directions) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& p : points) {
      low = std::min(low, p.dot(d));
      high = std::max(high, p.dot(d));
    }
    for (double at = low + step; at < high - step / 2; at += step) {
      planes.push_back({at * d, d});
    }
  }
  return planes;
}

/// All of several lists, in order.
std::vector<Candidate> joined(std::vector<std::vector<Candidate>> lists) {
  std::vector<Candidate> all;
  for (std::vector<Candidate>& list : lists) {
    std::move(list.begin(), list.end(), std::back_inserter(all));
  }
  return all;
}

template <class Value> void sort_by(std::vector<Candidate>& candidates, const Value& value) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return value(a) > value(b); });
}

/// The rings where limbs begin: those without a better one near.
std::vector<Candidate> beginnings(const Finder& finder, std::span<const LimbCut> cuts,
                                  std::span<const Vec3> points) {
  const std::vector<Plane> planes = planes_across(directions_of(cuts), points);
  std::vector<std::vector<Candidate>> found(planes.size());
  parallel_for(0, planes.size(), 1,
               [&](std::size_t i) { found[i] = finder.candidates(planes[i], nullptr); });
  std::vector<Candidate> all = joined(std::move(found));
  sort_by(all, [](const Candidate& c) { return c.length; });
  std::vector<Candidate> best;
  for (Candidate& candidate : all) {
    if (has_room(candidate, best)) {
      best.push_back(std::move(candidate));
    }
  }
  constexpr double long_enough = 3;
  sort_by(best, [=](const Candidate& c) { return c.surface * std::min(c.length, long_enough); });
  return best;
}

/// The rings along the cuts.
std::vector<Candidate> bends(const Finder& finder, std::span<const LimbCut> cuts) {
  std::vector<std::vector<Candidate>> found(cuts.size());
  parallel_for(0, cuts.size(), 1, [&](std::size_t i) {
    found[i] = finder.candidates({cuts[i].point, cuts[i].normal}, &cuts[i].box);
  });
  std::vector<Candidate> all = joined(std::move(found));
  sort_by(all, [](const Candidate& c) { return c.surface; });
  return all;
}

/// Rings among which there is room, as many as the vertices allow.
class Chosen {
public:
  explicit Chosen(int vertices) : vertices_(vertices), most_(most_rings(vertices)) {}

  void add(std::vector<Candidate> candidates) {
    constexpr double least_share = 3; // vertices, if limbs have them by their surface
    for (Candidate& candidate : candidates) {
      if (count_ + candidate.copies <= most_ && candidate.surface * vertices_ >= least_share &&
          has_room(candidate, rings_)) {
        keep(std::move(candidate));
      }
    }
  }

  /// These are asked for: they may be near each other, and be more.
  void add_joints(std::vector<Candidate> candidates) {
    sort_by(candidates, [](const Candidate& c) { return c.surface; });
    for (Candidate& candidate : candidates) {
      const bool is_apart = std::none_of(rings_.begin(), rings_.end(), [&](const Candidate& other) {
        return share_vertices(candidate, other) ||
               (candidate.center - other.center).norm() < 0.25 * candidate.width;
      });
      if (count_ + candidate.copies <= 2 * most_ && is_apart) {
        keep(std::move(candidate));
      }
    }
    most_ = std::max(most_, count_);
  }

  /// From the largest limb to the smallest, which may lie within a larger one.
  std::vector<Candidate> taken() && {
    sort_by(rings_, [](const Candidate& c) { return c.surface; });
    return std::move(rings_);
  }

private:
  void keep(Candidate candidate) {
    count_ += candidate.copies;
    rings_.push_back(std::move(candidate));
  }

  int vertices_;
  int most_;
  int count_ = 0;
  std::vector<Candidate> rings_;
};

/// The directions in which planes through a joint are tried: near its own, or all round.
std::vector<Vec3> directions_at(const LimbJoint& joint, std::span<const LimbCut> cuts) {
  constexpr double near = 0.8; // the cosine of about 37 degrees
  std::vector<Vec3> all = directions_of(cuts);
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = 0; z <= 2; ++z) {
        if (z > 0 || y > 0 || (y == 0 && x > 0)) {
          all.push_back(Vec3(x, y, z).normalized());
        }
      }
    }
  }
  const double length = joint.along.norm();
  if (!(length > 0)) {
    return all;
  }
  const Vec3 along = joint.along / length;
  std::vector<Vec3> directions = {along};
  std::copy_if(all.begin(), all.end(), std::back_inserter(directions),
               [&](const Vec3& d) { return std::abs(d.dot(along)) > near; });
  return directions;
}

/// The ring round each joint, if there is one: that of the smallest area.
std::vector<Candidate> at_joints(const Finder& finder, std::span<const LimbCut> cuts,
                                 std::span<const LimbJoint> joints) {
  constexpr double off_center = 0.75; // widths
  std::vector<std::optional<Candidate>> found(joints.size());
  parallel_for(0, joints.size(), 1, [&](std::size_t i) {
    const Vec3& position = joints[i].position;
    for (const Vec3& direction : directions_at(joints[i], cuts)) {
      for (Candidate& candidate : finder.candidates({position, direction}, nullptr)) {
        const bool is_round = (candidate.center - position).norm() < off_center * candidate.width;
        if (is_round && (!found[i] || candidate.width < found[i]->width)) {
          found[i] = std::move(candidate);
        }
      }
    }
  });
  std::vector<Candidate> rings;
  for (std::optional<Candidate>& ring : found) {
    if (ring) {
      rings.push_back(std::move(*ring));
    }
  }
  return rings;
}

std::vector<Candidate> chosen_rings(const Finder& finder, TriangleView start,
                                    std::span<const LimbCut> cuts, int vertices,
                                    std::span<const LimbJoint> joints) {
  Chosen chosen(vertices);
  chosen.add_joints(at_joints(finder, cuts, joints));
  chosen.add(beginnings(finder, cuts, start.positions));
  chosen.add(bends(finder, cuts));
  return std::move(chosen).taken();
}

LimbRings packed(const Finder& finder, std::span<const Candidate> chosen) {
  LimbRings rings;
  rings.parts = finder.parts_between(chosen);
  rings.bands.emplace_back(); // of the body
  for (const Candidate& ring : chosen) {
    rings.bands.push_back(ring.band);
    rings.count += ring.copies;
  }
  return rings;
}

} // namespace

std::vector<LimbCut> limb_cuts(TriangleView model, const Progress& progress) {
  std::vector<LimbCut> cuts;
  const Result<BoxDecomposition> boxes = decompose(model, {}, progress);
  if (!boxes) {
    return cuts;
  }
  for (const BoxNode& node : boxes->tree.nodes) {
    if (node.cut) {
      cuts.push_back({boxes->to_model(node.cut->point), boxes->grid.axes * node.cut->normal,
                      boxes->to_model(node.box)});
    }
  }
  return cuts;
}

LimbRings limb_rings(TriangleView start, std::span<const LimbCut> cuts, int vertices,
                     std::span<const LimbJoint> joints) {
  const Finder finder(start);
  return packed(finder, chosen_rings(finder, start, cuts, vertices, joints));
}

LimbRings find_limb_rings(TriangleView start, TriangleView model, int vertices,
                          std::span<const LimbJoint> joints, const Progress& progress) {
  return most_rings(vertices) > 0 ? limb_rings(start, limb_cuts(model, progress), vertices, joints)
                                  : LimbRings();
}

LimbRings rings_at_joints(TriangleView start, std::span<const LimbJoint> joints, int vertices) {
  const Finder finder(start);
  Chosen chosen(vertices);
  chosen.add_joints(at_joints(finder, {}, joints));
  return packed(finder, std::move(chosen).taken());
}

std::vector<Limb> find_limbs(TriangleView surface, std::span<const LimbCut> cuts, int vertices,
                             std::span<const LimbJoint> joints) {
  const Finder finder(surface);
  std::vector<Limb> limbs;
  std::vector<Candidate> rings;
  if (joints.empty()) {
    rings = chosen_rings(finder, surface, cuts, vertices, {});
  } else {
    rings = at_joints(finder, cuts, joints);
    sort_by(rings, [](const Candidate& c) { return c.surface; });
  }
  for (Candidate& ring : rings) {
    const Vec3 along = finder.toward_limb(ring) * ring.plane.normal;
    limbs.push_back({{ring.center, along}, ring.width, std::move(ring.limb)});
  }
  return limbs;
}

std::vector<std::vector<Index>> rings_between(const PolygonMesh& cage,
                                              std::span<const Index> parts) {
  std::vector<std::vector<Index>> rings;
  if (!parts.empty()) {
    for (EdgeChain& chain : chains_of(edges_between_parts(cage, parts))) {
      rings.push_back(std::move(chain.vertices));
    }
  }
  return rings;
}

} // namespace cagewright
