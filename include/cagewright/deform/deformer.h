/// \file
/// A model bound to a cage, for moving it again and again.
#pragma once

#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
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
  full,    ///< double: P K 8 bytes for K columns
  single,  ///< float: half of that; positions err by less than 1e-7 of the displacement
  compact, ///< 16-bit steps: a quarter; see position_error_bound()
};

struct DeformerOptions {
  CoordinateSettings coordinates = {}; ///< their kind, and its options
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
  /// Binds by the coordinates that the options name.
  /// \param slots  which corners of the model share a normal; none: smooth everywhere
  /// Errors: invalid_cage, cancelled.
  static Result<Deformer> bind(const PolygonMesh& model, const PolygonMesh& cage,
                               const DeformerOptions& options = {},
                               std::optional<NormalSlots> slots = {},
                               const Progress& progress = {});

  /// The same by coordinates that were prepared before, such as two kinds mixed: see mixed.h.
  /// `options.coordinates` is not looked at.
  /// Errors: invalid_cage (points outside that the kind refuses), cancelled.
  static Result<Deformer> bind(const PolygonMesh& model, const Coordinates& coordinates,
                               const DeformerOptions& options = {},
                               std::optional<NormalSlots> slots = {},
                               const Progress& progress = {});

  /// Takes weights that were computed or read before: P x K for the rule's K columns, see
  /// vertex_columns() and CoordinateKind::rule.
  /// Errors: mismatch (the weights are for other numbers of vertices or columns).
  static Result<Deformer> from_weights(const PolygonMesh& model,
                                       std::shared_ptr<const ColumnRule> rule, FloatWeights weights,
                                       const DeformerOptions& options = {},
                                       std::optional<NormalSlots> slots = {});

  /// Moves one vertex of the cage; seen after the next update(). `vertex` < C.
  void move_cage_vertex(Index vertex, const Vec3& to);
  /// Moves all of them: C positions.
  void set_cage(std::span<const Vec3> positions);

  /// Brings positions and normals up to date. Cost: n P weights are read for n columns that move,
  /// such as one for each moved vertex of the cage; normals are computed where the model moved.
  void update();

  [[nodiscard]] std::span<const Vec3> positions() const { return positions_; }
  /// K unit normals, one for each slot; for smooth models K = P. Empty without normals.
  [[nodiscard]] std::span<const Vec3> normals() const { return normals_.normals(); }
  [[nodiscard]] std::span<const Vec3> cage_positions() const { return cage_; }
  [[nodiscard]] std::span<const Vec3> rest_positions() const { return rest_; }
  [[nodiscard]] std::span<const Vec3> cage_rest_positions() const { return rule_->cage_at_rest(); }

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

  Deformer(const PolygonMesh& model, std::shared_ptr<const ColumnRule> rule, Storage weights,
           const DeformerOptions& options, std::optional<NormalSlots> slots);

  void move_model();
  void move_divided();
  void update_normals();

  Storage weights_;
  std::vector<Vec3> rest_, positions_;
  std::shared_ptr<const ColumnRule> rule_;
  std::vector<Vec3> cage_;  // as it is set
  std::size_t moved_ = 0;   // how many vertices of it were moved since update()
  bool is_divided_ = false; // positions_ were divided (see ColumnDivisor)
  std::vector<std::uint8_t> is_moved_;
  std::vector<Vec3> applied_; // the moves of the columns as positions_ shows them
  std::vector<Vec3> wanted_;  // and as the cage asks for
  // Room for update(): the columns whose moves differ, and by how much.
  std::vector<Index> changed_;
  std::vector<Vec3> changes_;
  std::vector<double> tile_travel_; // how far each tile has come since its normals were computed
  std::vector<std::uint8_t> tile_is_stale_;
  NormalField normals_;
  double tolerance_ = 0; // in the model's units
  bool has_normals_ = true;
  std::size_t unbound_ = 0;
};

} // namespace cagewright
