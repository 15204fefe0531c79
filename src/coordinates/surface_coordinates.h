/// \file
/// What kinds of coordinates share. Internal to this module.
#pragma once

#include "coordinates/surface.h"
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace cagewright {

/// Where the weights of sixteen points go: those for column k begin at weights[k * stride].
struct WeightsOfTile {
  double* weights = nullptr;
  std::size_t stride = 16;
};

/// Coordinates that are computed in the frame of the cage, all columns of one to sixteen points at
/// once.
class FramedCoordinates : public Coordinates {
protected:
  FramedCoordinates(std::shared_ptr<const ColumnRule> rule, const CageFrame& frame,
                    OutsideTreatment outside)
      : Coordinates(std::move(rule), outside), frame_(frame) {}

private:
  /// Writes weights[k * stride + i] of point i for column k; behind the last point anything.
  virtual TileReport solve_framed(std::span<const Vec3> points, double* weights,
                                  std::size_t stride) const = 0;
  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const final;

  CageFrame frame_;
};

/// Those that are computed from triangles.
class SurfaceCoordinates : public FramedCoordinates {
protected:
  /// \param rule  made before: `surface` is moved from
  SurfaceCoordinates(std::shared_ptr<const ColumnRule> rule, Surface surface,
                     OutsideTreatment outside)
      : FramedCoordinates(std::move(rule), surface.frame, outside), surface_(std::move(surface)) {}

  [[nodiscard]] const Surface& surface() const { return surface_; }

private:
  Surface surface_;
};

/// What the option says, of kinds that cannot be continued. Errors: invalid_option.
Result<OutsideTreatment> outside_without_continuation(const CoordinateSettings& settings);

/// The options `quads` and `outside` of such kinds. Errors: invalid_option.
template <class Options> Result<Options> options_inside(const CoordinateSettings& settings) {
  const Result<OutsideTreatment> outside = outside_without_continuation(settings);
  if (!outside) {
    return outside.error();
  }
  Options options;
  options.quads = static_cast<QuadTreatment>(settings.choice(quads_option));
  options.outside = *outside;
  return options;
}

/// CoordinateKind::prepare of kinds that have no other options.
template <auto make, class Options>
Result<std::shared_ptr<const Coordinates>>
prepare_inside(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  const Result<Options> options = options_inside<Options>(settings);
  return options ? make(cage, *options) : options.error();
}

/// A cage, and which of its vertices and middles have faces.
struct UsedSurface {
  const Surface& surface;
  const std::vector<Index>& used;
};

/// The weights of sixteen points or fewer that are inside; see FramedCoordinates::solve_framed().
using InsideTile = TileReport (*)(const UsedSurface& cage, std::span<const Vec3> points,
                                  const WeightsOfTile& out);

/// Coordinates with a column for each vertex, by a function of a tile.
/// Errors: those of Surface::create().
Result<std::shared_ptr<const Coordinates>> inside_coordinates(const PolygonMesh& cage,
                                                              QuadTreatment quads,
                                                              OutsideTreatment outside,
                                                              InsideTile tile);

/// CoordinateKind::rule of kinds that have a column for each vertex and no other.
Result<std::shared_ptr<const ColumnRule>> vertex_rule(const PolygonMesh& cage,
                                                      const CoordinateSettings& settings);

} // namespace cagewright
