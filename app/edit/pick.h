/// \file
/// What of a cage lies under the cursor, or within an outline on the screen.
#pragma once

#include "app/edit/cage_graph.h"
#include "app/edit/hidden.h"
#include "app/edit/orbit_camera.h"
#include "app/edit/selection.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/polygon_mesh.h>

#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

struct PickOptions {
  double radius = 12;       ///< how far from the cursor vertices and edges may be, in pixels
  bool see_through = false; ///< take what the cage's own faces hide, too
};

/// What was found: a vertex, an edge or a face, as the mode says.
struct Pick {
  SelectionMode mode = SelectionMode::vertex;
  Index element = 0;   ///< edges by their number in the graph
  Vec3 point;          ///< where on the element
  double distance = 0; ///< from the cursor, in pixels
};

/// Answers for one state of a cage; make a new one when it moves.
///
/// A point is hidden when a face of the cage lies before it. Cost: building O(T log T) for T
/// triangles, some milliseconds for 10,000; a pick less.
class Picker {
public:
  Picker() = default;
  /// \param sight  what is out of sight is neither found nor before anything
  Picker(const PolygonMesh& cage, const CageGraph& graph, InSight sight = {});

  /// The nearest element of the mode, if one is near enough. Of elements within a pixel or so of
  /// each other the one in front.
  [[nodiscard]] std::optional<Pick> pick(const OrbitCamera& camera, const Pixel& cursor,
                                         SelectionMode mode, const PickOptions& options = {}) const;

  /// The first face along the line of sight.
  [[nodiscard]] std::optional<Pick> face_at(const OrbitCamera& camera, const Pixel& cursor) const;

  /// Whether no face lies before the point.
  [[nodiscard]] bool is_visible(const OrbitCamera& camera, const Vec3& p) const;

  /// The elements of the mode within a closed outline: vertices inside it, edges that reach into
  /// it, faces whose middle lies inside it. A face counts as hidden where nothing of it is seen.
  [[nodiscard]] Selection within(const OrbitCamera& camera, std::span<const Pixel> outline,
                                 SelectionMode mode, const PickOptions& options = {}) const;

private:
  [[nodiscard]] std::vector<std::optional<Projected>> project_all(const OrbitCamera& camera) const;
  [[nodiscard]] Vec3 center_of(Index face) const;
  [[nodiscard]] bool shows_face(const OrbitCamera& camera, Index face) const;

  std::vector<Vec3> positions_;
  const CageGraph* graph_ = nullptr;
  InSight sight_;
  std::vector<Index> face_of_; // of each triangle
  TriangleBvh bvh_;
  double diagonal_ = 1;
};

/// The corners of a rectangle, for within().
std::vector<Pixel> rectangle(const Pixel& a, const Pixel& b);

/// Whether a point lies inside a closed polygon (even-odd rule).
bool contains(std::span<const Pixel> outline, const Pixel& p);

/// The point of the segment a b nearest to p, as a fraction from a to b.
double nearest_fraction(const Pixel& p, const Pixel& a, const Pixel& b);

} // namespace cagewright::app
