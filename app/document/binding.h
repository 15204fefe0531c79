/// \file
/// A model bound to a cage, as the document keeps it.
#pragma once

#include "app/document/coordinate_choice.h"
#include "app/document/deformed_model.h"
#include "app/document/region.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/deformer.h>
#include <cagewright/deform/following.h>
#include <cagewright/deform/normals.h>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace cagewright::app {

/// A cage prepared for the kinds of a choice, so that it can be bound anew where other vertices of
/// the model are painted.
struct PreparedKinds {
  std::shared_ptr<const Coordinates> first;
  std::shared_ptr<const Coordinates> second; ///< null: not needed yet
};

/// Keeps a Deformer. The document only holds on to it; DeformLoop alone uses it.
class Binding {
public:
  /// \param caged  what is bound, where it is not all of its model
  /// \param coordinates  of the model's vertices
  Binding(Deformer deformer, CoordinateChoice choice,
          std::shared_ptr<const Coordinates> coordinates, const CagedModel& caged = {},
          std::optional<UnseenShare> unseen = {}, PreparedKinds kinds = {})
      : deformer_(std::move(deformer)), choice_(std::move(choice)), settings_(choice_.settings()),
        coordinates_(std::move(coordinates)), kinds_(std::move(kinds)), unseen_(unseen) {
    if (caged.region) {
      caged_ = caged;
      const PolygonMesh& whole = caged.whole->mesh;
      normals_ = NormalField(whole, smooth_normals(whole));
    }
  }
  [[nodiscard]] Deformer& deformer() const { return deformer_; }

  /// The positions and normals of the whole model, as the deformer has moved what is bound.
  void take(DeformedModel& deformed) const {
    const std::span<const Vec3> moved = deformer_.positions();
    if (!caged_.region) {
      deformed.positions.assign(moved.begin(), moved.end());
      deformed.normals.assign(deformer_.normals().begin(), deformer_.normals().end());
      return;
    }
    deformed.positions = caged_.positions({moved.begin(), moved.end()});
    normals_.update(deformed.positions);
    deformed.normals.assign(normals_.normals().begin(), normals_.normals().end());
  }
  /// See Deformer::influence(): of the whole model's vertices, 0 beside what is bound.
  [[nodiscard]] std::vector<float> influence(std::span<const Index> cage_vertices) const {
    std::vector<float> found = deformer_.influence(cage_vertices);
    return caged_.region ? scattered<float>(*caged_.region, found,
                                            std::vector<float>(caged_.whole->mesh.positions.size()))
                         : found;
  }
  /// How much the model follows what it does not see; none: not known.
  [[nodiscard]] const std::optional<UnseenShare>& unseen() const { return unseen_; }
  /// By which kinds it is bound, and where.
  [[nodiscard]] const CoordinateChoice& choice() const { return choice_; }
  /// The same, but for where.
  [[nodiscard]] const CoordinateSettings& settings() const { return settings_; }
  /// Of vertices of the model; of other points only where one kind alone holds.
  [[nodiscard]] const Coordinates& coordinates() const { return *coordinates_; }
  [[nodiscard]] const PreparedKinds& kinds() const { return kinds_; }

private:
  mutable Deformer deformer_;
  CoordinateChoice choice_;
  CoordinateSettings settings_;
  std::shared_ptr<const Coordinates> coordinates_;
  PreparedKinds kinds_;
  std::optional<UnseenShare> unseen_;
  CagedModel caged_;            // of a region
  mutable NormalField normals_; // of its whole
};

} // namespace cagewright::app
