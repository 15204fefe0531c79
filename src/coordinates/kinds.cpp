#include <cagewright/coordinates/kinds.h>

#include "core/parse.h"
#include <cagewright/coordinates/biharmonic.h>
#include <cagewright/coordinates/bounded_biharmonic.h>
#include <cagewright/coordinates/green.h>
#include <cagewright/coordinates/harmonic.h>
#include <cagewright/coordinates/maximum_entropy.h>
#include <cagewright/coordinates/maximum_likelihood.h>
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/coordinates/mixed.h>
#include <cagewright/coordinates/positive_mean_value.h>
#include <cagewright/coordinates/quad_green.h>
#include <cagewright/coordinates/quad_mean_value.h>
#include <cagewright/coordinates/somigliana.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace cagewright {
namespace {

// The registry. A kind is a header, a source, a line here and a test.
constexpr std::array kinds = {
    &mean_value_kind,
    &quad_mean_value_kind,
    &harmonic_kind,
    &positive_mean_value_kind,
    &maximum_entropy_kind,
    &maximum_likelihood_kind,
    &green_kind,
    &quad_green_kind,
    &biharmonic_kind,
    &somigliana_kind,
    &bounded_biharmonic_kind,
};

/// Between two kinds that are mixed, in names and in texts.
constexpr std::string_view plus = "+";
constexpr std::string_view spaced_plus = " + ";

constexpr std::array<std::string_view, 2> quad_words = {"center", "diagonal"};
constexpr std::array<std::string_view, 3> outside_words = {"error", "rest", "continue"};

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string value_text(const CoordinateOption& option, double value) {
  return option.words.empty() ? number_text(value)
                              : std::string(option.words[static_cast<std::size_t>(value)]);
}

std::optional<double> parsed(const CoordinateOption& option, std::string_view text) {
  if (!option.words.empty()) {
    const auto word = std::find(option.words.begin(), option.words.end(), text);
    return word == option.words.end()
               ? std::nullopt
               : std::optional(static_cast<double>(word - option.words.begin()));
  }
  double value = 0;
  return parse_number(text, value) && value >= option.least && value <= option.most
             ? std::optional(value)
             : std::nullopt;
}

} // namespace

constinit const CoordinateOption quads_option = {
    .name = "quads",
    .help = "What the cage is inside a quad: four triangles round its center, or two along its "
            "diagonal",
    .words = quad_words};

constinit const CoordinateOption outside_option = {
    .name = "outside",
    .help = "Vertices of the model outside the cage: refuse them, leave them at rest, or continue "
            "the coordinates through the nearest face",
    .words = outside_words};

constinit const CoordinateOption accuracy_option = {
    .name = "accuracy",
    .help = "How near weights come that no closed form gives; 0: as each kind is by itself",
    .initial = 0,
    .least = 0,
    .most = 0.1};

std::span<const CoordinateKind* const> coordinate_kinds() {
  return kinds;
}

const CoordinateKind* find_coordinate_kind(std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const CoordinateKind* kind) { return kind->name == name; });
  return found == kinds.end() ? nullptr : *found;
}

std::string names_of_coordinate_kinds() {
  std::string names;
  for (const CoordinateKind* kind : kinds) {
    names += names.empty() ? "" : ", ";
    names += kind->name;
  }
  return names;
}

std::vector<const CoordinateOption*> coordinate_options() {
  std::vector<const CoordinateOption*> options;
  for (const CoordinateKind* kind : kinds) {
    for (const CoordinateOption* option : kind->options) {
      if (std::find(options.begin(), options.end(), option) == options.end()) {
        options.push_back(option);
      }
    }
  }
  return options;
}

CoordinateSettings::CoordinateSettings() : CoordinateSettings(*kinds.front()) {}

CoordinateSettings::CoordinateSettings(const CoordinateKind& kind) : kind_(&kind) {
  for (const CoordinateOption* option : kind.options) {
    values_.push_back(option->initial);
  }
}

Result<CoordinateSettings> CoordinateSettings::of(std::string_view kind) {
  if (const std::size_t sign = kind.find(plus); sign != std::string_view::npos) {
    Result<CoordinateSettings> first = of(kind.substr(0, sign));
    Result<CoordinateSettings> second = of(kind.substr(sign + plus.size()));
    if (!first || !second) {
      return first ? second : first;
    }
    first->mix_with(*std::move(second));
    return first;
  }
  const CoordinateKind* found = find_coordinate_kind(kind);
  if (found == nullptr) {
    return Error{ErrorCode::invalid_option, "no coordinates are called '" + std::string(kind) +
                                                "'; there are " + names_of_coordinate_kinds()};
  }
  return CoordinateSettings(*found);
}

Result<CoordinateSettings> CoordinateSettings::parse(std::string_view kind, std::string_view text) {
  if (const std::size_t sign = kind.find(plus); sign != std::string_view::npos) {
    const std::size_t end = std::min(text.find(spaced_plus), text.size());
    const std::size_t next = std::min(end + spaced_plus.size(), text.size());
    Result<CoordinateSettings> first = parse(kind.substr(0, sign), text.substr(0, end));
    Result<CoordinateSettings> second = parse(kind.substr(sign + plus.size()), text.substr(next));
    if (!first || !second) {
      return first ? second : first;
    }
    first->mix_with(*std::move(second));
    return first;
  }
  Result<CoordinateSettings> settings = of(kind);
  while (settings && !text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    const std::size_t sign = std::min(word.find('='), word.size());
    if (Status status =
            settings->set(word.substr(0, sign), word.substr(std::min(sign + 1, word.size())));
        !status) {
      return status.error();
    }
  }
  return settings;
}

void CoordinateSettings::mix_with(CoordinateSettings other) {
  mixed_ = std::make_shared<const CoordinateSettings>(std::move(other));
}

std::string CoordinateSettings::name() const {
  return std::string(kind_->name) + (mixed_ ? std::string(plus) + mixed_->name() : "");
}

std::optional<std::size_t> CoordinateSettings::find(std::string_view option) const {
  const auto found =
      std::find_if(kind_->options.begin(), kind_->options.end(),
                   [&](const CoordinateOption* known) { return known->name == option; });
  return found == kind_->options.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - kind_->options.begin()));
}

bool CoordinateSettings::has(std::string_view option) const {
  return find(option).has_value() || (mixed_ && mixed_->has(option));
}

double CoordinateSettings::number(const CoordinateOption& option) const {
  const auto index = find(option.name);
  assert(index);
  return values_[*index];
}

std::size_t CoordinateSettings::choice(const CoordinateOption& option) const {
  return static_cast<std::size_t>(number(option));
}

Status CoordinateSettings::set(std::string_view option, std::string_view value) {
  if (mixed_ && mixed_->has(option)) {
    CoordinateSettings other = *mixed_;
    if (Status status = other.set(option, value); !status) {
      return status;
    }
    mix_with(std::move(other));
    if (!find(option)) {
      return success();
    }
  }
  const auto index = find(option);
  if (!index) {
    std::string options;
    for (const CoordinateOption* own : kind_->options) {
      options += options.empty() ? " " : ", ";
      options += own->name;
    }
    return Error{ErrorCode::invalid_option, std::string(option) + ": " + std::string(kind_->name) +
                                                " coordinates have no such option, but" +
                                                (options.empty() ? std::string(" none") : options)};
  }
  const CoordinateOption& known = *kind_->options[*index];
  const auto number = parsed(known, value);
  if (!number) {
    return Error{ErrorCode::invalid_option, std::string(option) + ": '" + std::string(value) +
                                                "' is not allowed; give " + values_of(known)};
  }
  values_[*index] = *number;
  return success();
}

std::string CoordinateSettings::text() const {
  std::string text;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    text += i == 0 ? "" : " ";
    text += kind_->options[i]->name;
    text += '=';
    text += value_text(*kind_->options[i], values_[i]);
  }
  return mixed_ ? text + std::string(spaced_plus) + mixed_->text() : text;
}

bool CoordinateSettings::same_weights(const CoordinateSettings& other) const {
  if (kind_ != other.kind_ || (mixed_ != nullptr) != (other.mixed_ != nullptr) ||
      (mixed_ && !mixed_->same_weights(*other.mixed_))) {
    return false;
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!kind_->options[i]->while_posing && values_[i] != other.values_[i]) {
      return false;
    }
  }
  return true;
}

Result<std::shared_ptr<const Coordinates>> prepare_coordinates(const PolygonMesh& cage,
                                                               const CoordinateSettings& settings,
                                                               const Progress& progress) {
  if (settings.mixed() != nullptr) {
    return Error{ErrorCode::invalid_option,
                 settings.name() +
                     " coordinates are mixed by a share for each vertex of the model, "
                     "which is not given here; bind with one kind"};
  }
  return settings.kind().prepare(cage, settings, progress);
}

Result<std::shared_ptr<const ColumnRule>> coordinate_rule(const PolygonMesh& cage,
                                                          const CoordinateSettings& settings) {
  auto first = settings.kind().rule(cage, settings);
  if (!first || settings.mixed() == nullptr) {
    return first;
  }
  auto second = coordinate_rule(cage, *settings.mixed());
  return second ? mixed_rule(*std::move(first), *std::move(second)) : second;
}

std::string values_of(const CoordinateOption& option) {
  if (option.words.empty()) {
    return number_text(option.least) + " to " + number_text(option.most);
  }
  std::string words;
  for (const std::string_view word : option.words) {
    words += words.empty() ? "" : "|";
    words += word;
  }
  return words;
}

std::string initial_text(const CoordinateOption& option) {
  return value_text(option, option.initial);
}

} // namespace cagewright
