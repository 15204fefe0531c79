#include <cagewright/deform/deformer.h>

#include "deform/apply.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace cagewright {

Deformer::Deformer(const PolygonMesh& model, std::shared_ptr<const ColumnRule> rule,
                   Storage weights, const DeformerOptions& options,
                   std::optional<NormalSlots> slots)
    : weights_(std::move(weights)), rest_(model.positions), positions_(model.positions),
      rule_(std::move(rule)), cage_(rule_->cage_at_rest().begin(), rule_->cage_at_rest().end()),
      is_moved_(cage_.size(), 0), applied_(rule_->columns(), Vec3::Zero()), wanted_(applied_),
      tolerance_(options.normal_tolerance * diagonal(model.positions)),
      has_normals_(options.normals) {
  changed_.reserve(applied_.size());
  changes_.reserve(applied_.size());
  if (has_normals_) {
    const std::size_t tiles = (rest_.size() + 15) / 16;
    tile_travel_.assign(tiles, 0.0);
    tile_is_stale_.assign(tiles, 0);
    normals_ = NormalField(model, slots ? *std::move(slots) : smooth_normals(model),
                           options.normal_weighting);
  }
}

Result<Deformer> Deformer::bind(const PolygonMesh& model, const PolygonMesh& cage,
                                const DeformerOptions& options, std::optional<NormalSlots> slots,
                                const Progress& progress) {
  const auto coordinates = prepare_coordinates(cage, options.coordinates, progress.part(0, 0.5));
  if (!coordinates) {
    return coordinates.error();
  }
  return bind(model, **coordinates, options, std::move(slots), progress.part(0.5, 1));
}

Result<Deformer> Deformer::bind(const PolygonMesh& model, const Coordinates& coordinates,
                                const DeformerOptions& options, std::optional<NormalSlots> slots,
                                const Progress& progress) {
  const auto make = [&](auto solved, auto&& keep) -> Result<Deformer> {
    if (!solved) {
      return solved.error();
    }
    Deformer deformer(model, coordinates.rule(), keep(std::move(solved->weights)), options,
                      std::move(slots));
    deformer.unbound_ = solved->counts.undefined;
    if (coordinates.outside() == OutsideTreatment::rest) {
      deformer.unbound_ += solved->counts.outside;
    }
    return deformer;
  };
  switch (options.storage) {
  case WeightStorage::full:
    return make(solve_all<double>(coordinates, model.positions, progress),
                [](Weights weights) { return Storage(std::move(weights)); });
  case WeightStorage::compact:
    return make(solve_compact(coordinates, model.positions, progress),
                [](CompactWeights weights) { return Storage(std::move(weights)); });
  case WeightStorage::single:
    break;
  }
  return make(solve_all<float>(coordinates, model.positions, progress),
              [](FloatWeights weights) { return Storage(std::move(weights)); });
}

Result<Deformer> Deformer::from_weights(const PolygonMesh& model,
                                        std::shared_ptr<const ColumnRule> rule,
                                        FloatWeights weights, const DeformerOptions& options,
                                        std::optional<NormalSlots> slots) {
  if (weights.points() != model.positions.size() || weights.columns() != rule->columns()) {
    return Error{ErrorCode::mismatch, "the weights are for " + std::to_string(weights.points()) +
                                          " vertices and " + std::to_string(weights.columns()) +
                                          " columns, the model has " +
                                          std::to_string(model.positions.size()) +
                                          " and the cage " + std::to_string(rule->columns())};
  }
  Storage storage = options.storage == WeightStorage::compact ? Storage(make_compact(weights))
                                                              : Storage(std::move(weights));
  return Deformer(model, std::move(rule), std::move(storage), options, std::move(slots));
}

void Deformer::move_cage_vertex(Index vertex, const Vec3& to) {
  assert(vertex < cage_.size());
  cage_[vertex] = to;
  moved_ += is_moved_[vertex] == 0 ? 1 : 0;
  is_moved_[vertex] = 1;
}

void Deformer::set_cage(std::span<const Vec3> positions) {
  assert(positions.size() == cage_.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    move_cage_vertex(static_cast<Index>(v), positions[v]);
  }
}

void Deformer::update() {
  if (moved_ == 0) {
    return;
  }
  move_model();
  if (has_normals_) {
    update_normals();
  }
  std::fill(is_moved_.begin(), is_moved_.end(), std::uint8_t(0));
  moved_ = 0;
}

void Deformer::move_model() {
  const std::optional<ColumnDivisor> divisor = rule_->divisor(cage_);
  if (divisor || is_divided_) {
    move_divided();
    is_divided_ = divisor.has_value();
    return;
  }
  rule_->move(cage_, wanted_);
  // A pose set as a whole starts from the rest, so that it does not depend on the way there.
  const bool whole = moved_ == cage_.size();
  if (whole) {
    std::fill(applied_.begin(), applied_.end(), Vec3::Zero());
  }
  changed_.clear();
  changes_.clear();
  for (std::size_t k = 0; k < wanted_.size(); ++k) {
    if (wanted_[k] != applied_[k]) {
      changed_.push_back(static_cast<Index>(k));
      changes_.emplace_back(wanted_[k] - applied_[k]);
    }
  }
  const std::span<const Vec3> base = whole ? rest_ : positions_;
  std::visit(
      [&](const auto& weights) {
        move_points(weights, changed_, changes_, base, positions_, tile_travel_);
      },
      weights_);
  applied_ = wanted_;
}

/// From the rest: what was divided cannot be added to.
void Deformer::move_divided() {
  const PosedColumns pose(*rule_, cage_);
  const std::vector<Vec3> before = has_normals_ ? positions_ : std::vector<Vec3>();
  std::visit([&](const auto& weights) { move_to_pose(weights, pose, rest_, positions_); },
             weights_);
  for (std::size_t i = 0; i < before.size(); ++i) {
    tile_travel_[i / 16] += (positions_[i] - before[i]).cwiseAbs().maxCoeff();
  }
  applied_ = pose.moves;
}

std::vector<float> Deformer::influence(std::span<const Index> cage_vertices) const {
  std::vector<double> factors(rule_->columns(), 0.0);
  for (const Index v : cage_vertices) {
    rule_->add_influence(v, factors);
  }
  // What a move of all of them by 1 along x does to points at the origin.
  std::vector<Index> columns;
  std::vector<Vec3> along_x;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    if (factors[k] != 0) {
      columns.push_back(static_cast<Index>(k));
      along_x.emplace_back(factors[k], 0, 0);
    }
  }
  std::vector<Vec3> sums(rest_.size(), Vec3::Zero());
  std::visit([&](const auto& weights) { move_points(weights, columns, along_x, sums, sums); },
             weights_);
  std::vector<float> influence(sums.size());
  std::transform(sums.begin(), sums.end(), influence.begin(),
                 [](const Vec3& sum) { return static_cast<float>(sum.x()); });
  return influence;
}

void Deformer::update_normals() {
  for (std::size_t t = 0; t < tile_travel_.size(); ++t) {
    tile_is_stale_[t] = tile_travel_[t] > tolerance_ ? 1 : 0;
    if (tile_is_stale_[t] != 0) {
      tile_travel_[t] = 0;
    }
  }
  normals_.update(positions_, tile_is_stale_);
}

double Deformer::position_error_bound() const {
  const auto* compact = std::get_if<CompactWeights>(&weights_);
  if (compact == nullptr) {
    return 0;
  }
  return cagewright::position_error_bound(*compact, applied_);
}

std::size_t Deformer::weight_bytes() const {
  return std::visit([](const auto& weights) { return weights.bytes(); }, weights_);
}

} // namespace cagewright
