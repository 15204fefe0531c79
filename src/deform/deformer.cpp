#include <cagewright/deform/deformer.h>

#include "deform/apply.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace cagewright {

Deformer::Deformer(const PolygonMesh& model, std::span<const Vec3> cage_positions, Storage weights,
                   const DeformerOptions& options, std::optional<NormalSlots> slots)
    : weights_(std::move(weights)), rest_(model.positions), positions_(model.positions),
      cage_rest_(cage_positions.begin(), cage_positions.end()), cage_(cage_rest_),
      applied_cage_(cage_rest_), is_moved_(cage_.size(), 0), displacements_(cage_.size()),
      tolerance_(options.normal_tolerance * diagonal(model.positions)),
      has_normals_(options.normals) {
  moved_.reserve(cage_.size());
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
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage, options.coordinates);
  if (!solver) {
    return solver.error();
  }
  const auto make = [&](auto solved, auto&& keep) -> Result<Deformer> {
    if (!solved) {
      return solved.error();
    }
    Deformer deformer(model, cage.positions, keep(std::move(solved->weights)), options,
                      std::move(slots));
    deformer.unbound_ = solved->undefined;
    return deformer;
  };
  switch (options.storage) {
  case WeightStorage::full:
    return make(solve_all<double>(*solver, model.positions, progress),
                [](Weights weights) { return Storage(std::move(weights)); });
  case WeightStorage::compact:
    return make(solve_compact(*solver, model.positions, progress),
                [](CompactWeights weights) { return Storage(std::move(weights)); });
  case WeightStorage::single:
    break;
  }
  return make(solve_all<float>(*solver, model.positions, progress),
              [](FloatWeights weights) { return Storage(std::move(weights)); });
}

Result<Deformer> Deformer::from_weights(const PolygonMesh& model,
                                        std::span<const Vec3> cage_positions, FloatWeights weights,
                                        const DeformerOptions& options,
                                        std::optional<NormalSlots> slots) {
  if (weights.points() != model.positions.size() ||
      weights.cage_vertices() != cage_positions.size()) {
    return Error{ErrorCode::mismatch,
                 "the weights are for " + std::to_string(weights.points()) +
                     " vertices and a cage of " + std::to_string(weights.cage_vertices()) +
                     ", the model has " + std::to_string(model.positions.size()) +
                     " and the cage " + std::to_string(cage_positions.size())};
  }
  Storage storage = options.storage == WeightStorage::compact ? Storage(make_compact(weights))
                                                              : Storage(std::move(weights));
  return Deformer(model, cage_positions, std::move(storage), options, std::move(slots));
}

void Deformer::mark(Index vertex) {
  if (is_moved_[vertex] == 0) {
    is_moved_[vertex] = 1;
    moved_.push_back(vertex);
  }
}

void Deformer::move_cage_vertex(Index vertex, const Vec3& to) {
  assert(vertex < cage_.size());
  cage_[vertex] = to;
  mark(vertex);
}

void Deformer::set_cage(std::span<const Vec3> positions) {
  assert(positions.size() == cage_.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    move_cage_vertex(static_cast<Index>(v), positions[v]);
  }
}

void Deformer::update() {
  if (moved_.empty()) {
    return;
  }
  move_model();
  if (has_normals_) {
    update_normals();
  }
  for (const Index v : moved_) {
    is_moved_[v] = 0;
    applied_cage_[v] = cage_[v];
  }
  moved_.clear();
}

void Deformer::move_model() {
  std::sort(moved_.begin(), moved_.end()); // memory in order
  // A pose set as a whole starts from the rest, so that it does not depend on the way there.
  const bool whole = moved_.size() == cage_.size();
  const std::vector<Vec3>& from = whole ? cage_rest_ : applied_cage_;
  const std::span<const Vec3> base = whole ? rest_ : positions_;
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    displacements_[k] = cage_[moved_[k]] - from[moved_[k]];
  }
  const std::span<const Vec3> displacements = std::span(displacements_).first(moved_.size());
  std::visit(
      [&](const auto& weights) {
        move_points(weights, moved_, displacements, base, positions_, tile_travel_);
      },
      weights_);
}

std::vector<float> Deformer::influence(std::span<const Index> cage_vertices) const {
  // What a move of all of them by 1 along x does to points at the origin.
  const std::vector<Vec3> along_x(cage_vertices.size(), Vec3::UnitX());
  std::vector<Vec3> sums(rest_.size(), Vec3::Zero());
  std::visit([&](const auto& weights) { move_points(weights, cage_vertices, along_x, sums, sums); },
             weights_);
  std::vector<float> influence(sums.size());
  std::ranges::transform(sums, influence.begin(),
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
  std::vector<Vec3> displacements(cage_.size());
  for (std::size_t v = 0; v < cage_.size(); ++v) {
    displacements[v] = cage_[v] - cage_rest_[v];
  }
  return cagewright::position_error_bound(*compact, displacements);
}

std::size_t Deformer::weight_bytes() const {
  return std::visit([](const auto& weights) { return weights.bytes(); }, weights_);
}

} // namespace cagewright
