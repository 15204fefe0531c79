/// \file
/// A model bound to a cage, as the document keeps it.
#pragma once

#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/deformer.h>

#include <memory>
#include <utility>

namespace cagewright::app {

/// Keeps a Deformer. The document only holds on to it; DeformLoop alone uses it.
class Binding {
public:
  Binding(Deformer deformer, CoordinateSettings settings,
          std::shared_ptr<const Coordinates> coordinates)
      : deformer_(std::move(deformer)), settings_(std::move(settings)),
        coordinates_(std::move(coordinates)) {}
  [[nodiscard]] Deformer& deformer() const { return deformer_; }
  /// By which kind it is bound.
  [[nodiscard]] const CoordinateSettings& settings() const { return settings_; }
  /// For points that are none of the model's vertices.
  [[nodiscard]] const Coordinates& coordinates() const { return *coordinates_; }

private:
  mutable Deformer deformer_;
  CoordinateSettings settings_;
  std::shared_ptr<const Coordinates> coordinates_;
};

} // namespace cagewright::app
