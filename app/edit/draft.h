/// \file
/// A cage while its topology is being changed. Private to this folder.
#pragma once

#include "app/edit/cage_graph.h"
#include "app/edit/edit_cage.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace cagewright::app {

/// invalid_cage, with the reason.
Error refuse(std::string why);
/// "there is no such edge".
Error no_such(const char* what);
/// Whether there are any, and all of them are faces of the cage.
bool has_faces(const PolygonMesh& cage, std::span<const Index> faces);

/// The faces, grouped where they share an edge; each group ascending.
std::vector<std::vector<Index>> connected_faces(const CageGraph& graph,
                                                std::span<const Index> faces);

/// Whether `after` still is a closed, manifold, oriented surface of as many pieces and handles as
/// `before`. Errors: invalid_cage.
Status check_edited(const PolygonMesh& before, const PolygonMesh& after);

/// A cage being changed: faces as lists, vertices that come and go. The cage outlives it.
class Draft {
public:
  using Corners = std::vector<Index>;

  explicit Draft(const PolygonMesh& cage);

  [[nodiscard]] const Vec3& position(Index v) const { return positions_[v]; }
  void move(Index v, const Vec3& p) { positions_[v] = p; }
  [[nodiscard]] Corners& face(std::size_t f) { return faces_[f].corners; }
  [[nodiscard]] std::size_t face_count() const { return faces_.size(); }

  /// A new vertex; `like` an old one whose colour it takes.
  Index add_vertex(const Vec3& p, Index like);
  /// In the group of face `like`.
  void add_face(Corners corners, std::size_t like);
  void remove_face(std::size_t f) { faces_[f].corners.clear(); }
  /// Everywhere; face corners that become equal to the one before fall together, and faces that
  /// have less than three corners left vanish.
  void replace_vertices(const std::map<Index, Index>& by);

  /// Drops what is gone, and checks the whole.
  /// \param selected  numbers in the draft
  [[nodiscard]] Result<EditedCage> finish(SelectionMode mode,
                                          const std::vector<Index>& selected) const;

private:
  struct Face {
    Corners corners; ///< none: gone
    Index group;
  };

  const PolygonMesh& before_;
  std::vector<Vec3> positions_;
  std::vector<Face> faces_;
  std::vector<Index> origin_; // of each vertex the old one, or EditedCage::none
  std::vector<Index> like_;
};

} // namespace cagewright::app
