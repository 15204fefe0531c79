#include "cage/budget_start.h"

#include "envelope/envelope.h"
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// What an envelope is worth: the budget met, and then what a cage made of it in haste costs.
/// Less is better.
using Cost = std::pair<bool, double>;

/// What webs, and handles that are not the model's own, make a cage dearer by.
double factor_of(double webbing, int genus, int known) {
  constexpr double for_a_handle = 0.04;
  return (1 + webbing) * (1 + for_a_handle * std::max(0, genus - known));
}

/// Chooses among envelopes by what becomes of them.
class ChoiceOfStart {
public:
  ChoiceOfStart(TriangleView model, const BudgetCageOptions& options, const EnvelopeOptions& start)
      : model_(model), start_(start), between_(model), draft_(options.improve) {
    draft_.draft = true;
    draft_.extent = start.half ? CageExtent::half : CageExtent::whole;
    draft_.diagonal = start.diagonal;
    draft_.density = {}; // of other vertices, where the model is a half
  }

  [[nodiscard]] Result<Envelope> made(const EnvelopeSetting& setting) const {
    EnvelopeOptions options = start_;
    options.resolution = setting.resolution;
    options.closing = setting.closing;
    return envelope(model_, options);
  }

  [[nodiscard]] Result<Cost> cost_of(const Envelope& start) const {
    const Result<Improved> draft = improve(start.mesh, model_, draft_);
    if (!draft) {
      return draft.error();
    }
    const double webbing = between_.share_inside(start_.half ? whole_of(draft->cage) : draft->cage);
    return Cost{!draft->report.reached,
                draft->report.objective * factor_of(webbing, start.genus, start.known)};
  }

private:
  TriangleView model_;
  EnvelopeOptions start_;
  SpaceBetween between_;
  ImproveOptions draft_;
};

/// The settings that compete with the one chosen by rule.
std::vector<EnvelopeSetting> rivals_of(const Envelope& first, int vertices) {
  const double coarse = std::clamp(3.2 * std::sqrt(vertices), 24.0, 64.0);
  std::vector<EnvelopeSetting> rivals;
  for (const double factor : {1.0, 1.25, 1.75}) {
    const int resolution = static_cast<int>(std::lround(factor * coarse));
    if (resolution != first.resolution) {
      rivals.push_back({resolution, 0});
    }
  }
  if (first.genus > first.known || 8 * first.genus > vertices) {
    rivals.push_back({static_cast<int>(std::lround(1.4 * coarse)), 0.02});
    rivals.push_back({static_cast<int>(std::lround(coarse)), 0.1});
  }
  return rivals;
}

/// The envelope that promises most, and what promises nearly as much.
struct Promising {
  Envelope envelope;
  std::optional<EnvelopeSetting> rival;
};

/// \param first  the envelope chosen by rule
Result<Promising> most_promising(TriangleView model, const BudgetCageOptions& options,
                                 const EnvelopeOptions& start, Envelope first,
                                 const Progress& progress) {
  struct Try {
    EnvelopeSetting setting;
    Cost cost;
    Envelope envelope;
  };
  const ChoiceOfStart choice(model, options, start);
  const std::vector<EnvelopeSetting> rivals = rivals_of(first, start.vertices);
  std::vector<Try> tries;
  const auto add = [&](const EnvelopeSetting& setting, Result<Envelope> made) {
    const Result<Cost> cost = made ? choice.cost_of(*made) : made.error();
    if (cost) {
      tries.push_back({setting, *cost, std::move(*made)});
    }
    return cost ? success() : Status(cost.error());
  };
  if (const Status added = add({first.resolution, first.closing}, std::move(first)); !added) {
    return added.error();
  }
  for (const EnvelopeSetting& setting : rivals) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    (void)add(setting, choice.made(setting)); // it need not be possible
  }
  std::ranges::stable_sort(tries, {}, &Try::cost);
  Promising result{std::move(tries[0].envelope), std::nullopt};
  constexpr double nearly = 1.1;
  if (tries.size() > 1 &&
      tries[1].cost < Cost{tries[0].cost.first, nearly * tries[0].cost.second}) {
    result.rival = tries[1].setting;
  }
  return result;
}

} // namespace

TriangleMesh whole_of(TriangleMesh half) {
  const std::size_t vertices = half.positions.size();
  const std::size_t triangles = half.triangles.size();
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3 p = half.positions[v];
    half.positions.emplace_back(-p.x(), p.y(), p.z());
  }
  const auto image = static_cast<Index>(vertices);
  for (std::size_t f = 0; f < triangles; ++f) {
    const auto [a, b, c] = half.triangles[f];
    half.triangles.push_back({a + image, c + image, b + image});
  }
  return half;
}

int vertices_of(const ImproveOptions& budget) {
  return budget.vertices > 0 ? budget.vertices : budget.faces > 0 ? budget.faces / 2 + 2 : 0;
}

Result<TriangleMesh> start_from_envelope(TriangleView model, const BudgetCageOptions& options,
                                         CageExtent extent, double diagonal, BudgetCage& made,
                                         const Progress& progress) {
  const ImproveOptions& budget = options.improve;
  EnvelopeOptions start;
  start.resolution = options.resolution;
  start.closing = options.closing;
  start.clearance = budget.clearance;
  for (const int vertices : {vertices_of(budget), options.envelope_vertices}) {
    start.vertices = vertices > 0 ? vertices : start.vertices;
  }
  start.half = extent == CageExtent::half;
  start.diagonal = diagonal;
  constexpr double first = 0.3; // of the time
  Result<Envelope> envelope_made = envelope(model, start, progress.part(0, first));
  // Which start makes good quads a draft of triangles does not tell.
  const bool is_open = !options.quads && options.resolution == 0 && options.closing == 0 &&
                       options.envelope_vertices == 0 && options.max_gap == 0 &&
                       vertices_of(budget) > 0;
  if (envelope_made && is_open) {
    Result<Promising> best =
        most_promising(model, options, start, std::move(*envelope_made), progress.part(first, 1));
    if (!best) {
      return best.error();
    }
    envelope_made = std::move(best->envelope);
    made.rival = best->rival;
  }
  if (!envelope_made) {
    return envelope_made.error();
  }
  made.resolution = envelope_made->resolution;
  made.genus = envelope_made->genus;
  made.known = envelope_made->known;
  made.bridges = envelope_made->bridges;
  made.clearance = budget.clearance;
  return std::move(envelope_made->mesh);
}

double cost_of(const BudgetCage& made, TriangleView model) {
  return made.report.objective *
         factor_of(SpaceBetween(model).share_inside(made.cage), made.genus, made.known);
}

} // namespace cagewright
