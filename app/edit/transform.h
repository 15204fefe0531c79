/// \file
/// Moving, turning and scaling selected vertices, and those that follow them.
#pragma once

#include "app/edit/cage_graph.h"
#include "app/edit/tool_settings.h"
#include <cagewright/core/geometry.h>

#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

enum class TransformKind { translate, rotate, scale };

/// A transformation that can also be carried out in part.
struct Transform {
  TransformKind kind = TransformKind::translate;
  Vec3 pivot = Vec3::Zero();    ///< what stays where it is when turned or scaled
  Vec3 shift = Vec3::Zero();    ///< of a translation
  Vec3 axis = Vec3::UnitZ();    ///< of a rotation, unit length
  double angle = 0;             ///< of a rotation, counter-clockwise seen from the axis' tip
  Mat3 axes = Mat3::Identity(); ///< columns: the directions of scaling, orthonormal
  Vec3 factors = Vec3::Ones();  ///< along these

  [[nodiscard]] bool is_identity() const;
  /// Where p goes; with a weight below 1, only so much of the shift, the angle, the growth.
  [[nodiscard]] Vec3 apply(const Vec3& p, double weight = 1) const {
    return apply(p, weight, pivot);
  }
  [[nodiscard]] Vec3 apply(const Vec3& p, double weight, const Vec3& about) const;
};

/// How one vertex is the mirror image of another.
struct Symmetry {
  static constexpr Index none = ~Index{0};

  Vec3 point = Vec3::Zero();   ///< on the mirror plane
  Vec3 normal = Vec3::UnitX(); ///< of length 1
  /// For each vertex its image; itself on the plane; `none` where there is no image.
  std::vector<Index> partner;

  [[nodiscard]] Vec3 mirror(const Vec3& p) const {
    return p - 2 * (p - point).dot(normal) * normal;
  }
  [[nodiscard]] Vec3 onto_plane(const Vec3& p) const {
    return p - (p - point).dot(normal) * normal;
  }
  [[nodiscard]] bool is_on_plane(Index v) const { return v < partner.size() && partner[v] == v; }
};

/// The images of the vertices in a plane, each within `tolerance` of where it should be. Of several
/// candidates the nearest; partners are mutual.
Symmetry find_partners(std::span<const Vec3> positions, const Vec3& point, const Vec3& normal,
                       double tolerance);

/// The same in the plane across `axis` (0, 1, 2) of those through 0 and through the middle of the
/// positions that gives more images; nothing when less than half of the vertices have one.
/// \param tolerance  in the positions' unit
std::optional<Symmetry> find_symmetry(std::span<const Vec3> positions, int axis, double tolerance);

struct ProportionalOptions {
  bool enabled = false;
  double radius = 0; ///< in the positions' unit
  Falloff falloff = Falloff::smooth;
  bool connected_only = false; ///< distances along edges, not through the air
};

/// From 1 at distance 0 to 0 at the radius.
double falloff(Falloff kind, double distance, double radius);

/// The mean, or the middle of the box, of some vertices. For `individual` the mean.
Vec3 pivot_of(std::span<const Vec3> positions, std::span<const Index> vertices, Pivot pivot);

/// A mean of the normals of the faces round the vertices as the third axis, and two more: the axes
/// of the selection itself. World axes if that is zero.
Mat3 local_axes(const PolygonMesh& cage, const CageGraph& graph, std::span<const Index> vertices);

struct TransformOptions {
  ProportionalOptions proportional = {};
  Pivot pivot = Pivot::median;
  std::optional<Symmetry> symmetry = std::nullopt; ///< edit symmetrically
};

/// Carries transformations out: made when a drag begins, asked while it goes on.
class TransformTarget {
public:
  TransformTarget() = default;
  /// \param start     V positions where the drag began
  /// \param vertices  the selected ones, ascending
  TransformTarget(std::vector<Vec3> start, std::vector<Index> vertices, const CageGraph& graph,
                  TransformOptions options = {});

  /// V positions.
  [[nodiscard]] std::vector<Vec3> moved(const Transform& transform) const;

  /// Another radius, for the wheel.
  void set_radius(double radius);

  [[nodiscard]] const std::vector<Vec3>& start() const { return start_; }
  /// 1 for the selected vertices, and for those that follow as falloff() says.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  [[nodiscard]] const TransformOptions& options() const { return options_; }

private:
  void find_distances(const CageGraph& graph);
  void find_islands(const CageGraph& graph);
  void find_leaders();
  void update_weights();

  std::vector<Vec3> start_;
  std::vector<Index> vertices_;
  TransformOptions options_;
  std::vector<double> distances_; // from the nearest selected vertex
  std::vector<Index> nearest_;    // that vertex
  std::vector<double> weights_;
  std::vector<Vec3> pivots_; // V, for individual pivots
  std::vector<char> leads_;  // V: moves by itself; its partner follows
};

} // namespace cagewright::app
