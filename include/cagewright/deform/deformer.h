/// \file
/// A model bound to a cage, for moving it again and again.
#pragma once

#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/deform/normals.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace cagewright {

/// How the weights are kept.
enum class WeightStorage {
  full,    ///< double: P C 8 bytes
  single,  ///< float: half of that; positions err by less than 1e-7 of the displacement
  compact, ///< 16-bit steps: a quarter; see position_error_bound()
};

struct DeformerOptions {
  MeanValueOptions coordinates = {};
  WeightStorage storage = WeightStorage::single;
  bool normals = true; ///< keep normals up to date
  NormalWeighting normal_weighting = NormalWeighting::area;
  /// Normals are computed anew where vertices have moved farther than this, as a fraction of the
  /// model's diagonal; smaller moves add up. 0: on every move.
  double normal_tolerance = 1e-7;
};

/// A model of P vertices bound to a cage of C: move some of the cage's vertices, call update(),
/// look at positions() and normals().
///
/// Nothing is allocated after binding. Functions that are const may be called from any number of
/// threads; the others only while no other function runs. Poses that are reached in different steps
/// differ by no more than rounding in double; a pose set as a whole does not depend on what was
/// before.
class Deformer {
public:
  /// Binds by mean value coordinates.
  /// \param slots  which corners of the model share a normal; none: smooth everywhere
  /// Errors: invalid_cage, cancelled.
  static Result<Deformer> bind(const PolygonMesh& model, const PolygonMesh& cage,
                               const DeformerOptions& options = {},
                               std::optional<NormalSlots> slots = {},
                               const Progress& progress = {});

  /// Takes weights that were computed or read before: P x C.
  /// Errors: mismatch (the weights are for other numbers of vertices).
  static Result<Deformer> from_weights(const PolygonMesh& model,
                                       std::span<const Vec3> cage_positions, FloatWeights weights,
                                       const DeformerOptions& options = {},
                                       std::optional<NormalSlots> slots = {});

  /// Moves one vertex of the cage; seen after the next update(). `vertex` < C.
  void move_cage_vertex(Index vertex, const Vec3& to);
  /// Moves all of them: C positions.
  void set_cage(std::span<const Vec3> positions);

  /// Brings positions and normals up to date. Cost: k P weights are read for k moved cage
  /// vertices; normals are computed where the model moved.
  void update();

  [[nodiscard]] std::span<const Vec3> positions() const { return positions_; }
  /// K unit normals, one for each slot; for smooth models K = P. Empty without normals.
  [[nodiscard]] std::span<const Vec3> normals() const { return normals_.normals(); }
  [[nodiscard]] std::span<const Vec3> cage_positions() const { return cage_; }
  [[nodiscard]] std::span<const Vec3> rest_positions() const { return rest_; }
  [[nodiscard]] std::span<const Vec3> cage_rest_positions() const { return cage_rest_; }

  /// For each of the P vertices the sum of its weights for these cage vertices (each < C): how far
  /// it goes along when they all move alike. Cost: k P weights are read.
  [[nodiscard]] std::vector<float> influence(std::span<const Index> cage_vertices) const;

  /// Vertices of the model that have no weights, and stay where they are.
  [[nodiscard]] std::size_t unbound() const { return unbound_; }
  /// How far a vertex may be from where exact weights of the chosen storage would put it now, in
  /// the model's units: 0 unless the storage is compact.
  [[nodiscard]] double position_error_bound() const;
  [[nodiscard]] std::size_t weight_bytes() const;

private:
  using Storage = std::variant<Weights, FloatWeights, CompactWeights>;

  Deformer(const PolygonMesh& model, std::span<const Vec3> cage_positions, Storage weights,
           const DeformerOptions& options, std::optional<NormalSlots> slots);

  void mark(Index vertex);
  void move_model();
  void update_normals();

  Storage weights_;
  std::vector<Vec3> rest_, positions_;
  std::vector<Vec3> cage_rest_;
  std::vector<Vec3> cage_;         // as it is set
  std::vector<Vec3> applied_cage_; // as positions_ shows it
  std::vector<Index> moved_;       // cage vertices to be applied
  std::vector<std::uint8_t> is_moved_;
  std::vector<Vec3> displacements_; // room for update()
  std::vector<double> tile_travel_; // how far each tile has come since its normals were computed
  std::vector<std::uint8_t> tile_is_stale_;
  NormalField normals_;
  double tolerance_ = 0; // in the model's units
  bool has_normals_ = true;
  std::size_t unbound_ = 0;
};

} // namespace cagewright
