#include "cage/promising_envelope.h"

#include "cage/merit.h"
#include "improve/improve.h"
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

struct Try {
  EnvelopeSetting setting;
  Cost cost;
  Envelope envelope;
};

/// Tells what an envelope is worth by what becomes of it.
class Drafts {
public:
  Drafts(const Ground& ground, const GenerateOptions& options, const EnvelopeOptions& wanted)
      : ground_(ground), wanted_(wanted), draft_(ground.budget(options.clearance)) {
    draft_.draft = true;
    draft_.density = {}; // of other vertices, where the model is a half
  }

  [[nodiscard]] Result<Try> made(const EnvelopeSetting& setting, const Progress& progress) const {
    EnvelopeOptions options = wanted_;
    options.resolution = setting.resolution;
    options.closing = setting.closing;
    options.fill = setting.fill;
    constexpr double enclosed = 0.3; // of the time
    Result<Envelope> start = envelope(ground_.model_here(), options, progress.part(0, enclosed));
    return start ? judged(setting, std::move(*start), progress.part(enclosed, 1)) : start.error();
  }

  [[nodiscard]] Result<Try> judged(const EnvelopeSetting& setting, Envelope start,
                                   const Progress& progress) const {
    const Result<Improved> draft = ground_.drafted(start.mesh, draft_, progress);
    if (!draft) {
      return draft.error();
    }
    const double webbing = ground_.between().share_inside(ground_.with_image(draft->cage));
    const Cost cost{!draft->report.reached,
                    draft->report.objective * dearer_by(webbing, start.genus, start.known)};
    return Try{setting, cost, std::move(start)};
  }

private:
  const Ground& ground_;
  EnvelopeOptions wanted_;
  ImproveOptions draft_;
};

/// The settings that compete with the one chosen by rule.
std::vector<EnvelopeSetting> rivals_of(const Envelope& first, int vertices) {
  const double coarse = std::clamp(3.2 * std::sqrt(vertices), 24.0, 64.0);
  std::vector<EnvelopeSetting> rivals;
  for (const double factor : {1.0, 1.25, 1.75}) {
    const int resolution = static_cast<int>(std::lround(factor * coarse));
    if (resolution != first.resolution) {
      rivals.push_back({resolution, 0, narrow_handle});
    }
  }
  if (first.genus > first.known || 8 * first.genus > vertices) {
    rivals.push_back({first.resolution, first.closing, wide_handle});
    rivals.push_back({static_cast<int>(std::lround(1.4 * coarse)), 0.02, narrow_handle});
    rivals.push_back({static_cast<int>(std::lround(coarse)), 0.1, narrow_handle});
  }
  return rivals;
}

} // namespace

Result<PromisingEnvelope> promising_envelope(const Ground& ground, const GenerateOptions& options,
                                             const EnvelopeOptions& wanted, Envelope first,
                                             const Progress& progress) {
  const Drafts drafts(ground, options, wanted);
  const std::vector<EnvelopeSetting> rivals = rivals_of(first, wanted.vertices);
  const auto share = [&](std::size_t k) {
    const auto count = static_cast<double>(rivals.size() + 1);
    return progress.part(static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
  };
  const EnvelopeSetting by_rule{first.resolution, first.closing, wanted.fill};
  Result<Try> ruled = drafts.judged(by_rule, std::move(first), share(0));
  if (!ruled) {
    return ruled.error();
  }
  std::vector<Try> tries;
  tries.push_back(std::move(*ruled));
  for (std::size_t k = 0; k < rivals.size() && ground.runs().are_left(); ++k) {
    Result<Try> made = drafts.made(rivals[k], share(k + 1));
    if (made) {
      tries.push_back(std::move(*made));
    } else if (made.error().code == ErrorCode::cancelled) {
      return made.error();
    } // else it is not possible, and need not be
  }
  std::stable_sort(tries.begin(), tries.end(),
                   [](const Try& a, const Try& b) { return a.cost < b.cost; });
  PromisingEnvelope result{std::move(tries[0].envelope), std::nullopt};
  constexpr double nearly = 1.1;
  if (tries.size() > 1 && tries[1].cost < tries[0].cost.times(nearly)) {
    result.rival = tries[1].setting;
  }
  return result;
}

} // namespace cagewright
