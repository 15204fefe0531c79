#include "coordinate_options.h"
#include "session.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace cagewright::cli {
namespace {

std::string kinds_with(std::string_view option) {
  std::string names;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    if (CoordinateSettings(*kind).has(option)) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", kind->name);
    }
  }
  return names;
}

/// Sets what was given, and has a meaning for the kind.
Status set_given(const CoordinateArguments& arguments, CoordinateSettings& settings) {
  for (const CoordinateArguments::Value& value : arguments.values) {
    const std::string_view name = value.option->name;
    if (value.given->count() == 0) {
      continue;
    }
    if (!settings.has(name)) {
      warn(fmt::format("--{} makes no difference to {} coordinates; it is for {}", name,
                       settings.name(), kinds_with(name)));
    } else if (Status status = settings.set(name, value.text); !status) {
      return Error{status.error().code, "--" + status.error().message};
    }
  }
  return success();
}

/// Kinds without `best_kind`.
std::vector<std::string> names_of_kinds() {
  std::vector<std::string> names;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    names.emplace_back(kind->name);
  }
  return names;
}

/// Whether --mix and --mix-weights make sense.
Status check_mix(const CoordinateArguments& arguments) {
  const auto refused = [](const std::string& message) {
    return Status(Error{ErrorCode::invalid_option, message});
  };
  if (arguments.mix.empty()) {
    return arguments.mix_weights.empty()
               ? success()
               : refused("--mix-weights: say with --mix which coordinates they are for");
  }
  if (arguments.mix == arguments.kind) {
    return refused("--mix: " + arguments.mix + " is what --coordinates says already; give another");
  }
  if (arguments.kind == best_kind) {
    return refused("--mix: say with --coordinates which kind it is mixed with, not auto");
  }
  return success();
}

} // namespace

void add_mix_options(CLI::App& command, CoordinateArguments& arguments) {
  command
      .add_option("--mix", arguments.mix,
                  "Where --mix-weights say so, the model follows by these coordinates instead of "
                  "--coordinates: one kind for the limbs, another for the trunk")
      ->check(CLI::IsMember(names_of_kinds()))
      ->option_text("NAME");
  command
      .add_option("--mix-weights", arguments.mix_weights,
                  "The share of --mix for each vertex of the model, from 0 to 1: a file with a "
                  "number a line (or NumPy's .npy), 'colors' for red paint in the model's vertex "
                  "colors, or 'group:NAME' for the vertices of an object or group")
      ->option_text("FILE");
}

void add_coordinate_options(CLI::App& command, CoordinateArguments& arguments, bool offer_best) {
  std::vector<std::string> names = names_of_kinds();
  if (offer_best) {
    names.emplace_back(best_kind);
  }
  arguments.given =
      command
          .add_option("--coordinates", arguments.kind,
                      "How the model follows its cage; 'cagewright coordinates' tells what each "
                      "is good for" +
                          std::string(offer_best ? "; auto tries all, and says why" : ""))
          ->check(CLI::IsMember(names))
          ->option_text("NAME [" + arguments.kind + "]");
  for (const CoordinateOption* option : coordinate_options()) {
    CoordinateArguments::Value& value = arguments.values.emplace_back();
    value.option = option;
    CLI::Option* declared =
        command.add_option(fmt::format("--{}", option->name), value.text,
                           fmt::format("{}; for {}", option->help, kinds_with(option->name)));
    declared->option_text(fmt::format("{} [{}]", values_of(*option), initial_text(*option)));
    value.given = declared;
  }
}

Result<CoordinateSettings> settings_of(const CoordinateArguments& arguments) {
  if (Status status = check_mix(arguments); !status) {
    return status.error();
  }
  Result<CoordinateSettings> settings = CoordinateSettings::of(arguments.kind);
  if (settings) {
    if (!arguments.mix.empty()) {
      Result<CoordinateSettings> other = CoordinateSettings::of(arguments.mix);
      if (!other) {
        return other.error();
      }
      settings->mix_with(*std::move(other));
    }
    if (Status status = set_given(arguments, *settings); !status) {
      return status.error();
    }
  }
  return settings;
}

Status take_settings(const CoordinateArguments& arguments, StoredWeights& stored) {
  if (!stored.has_identity) {
    Result<CoordinateSettings> settings = settings_of(arguments);
    if (!settings) {
      return settings.error();
    }
    stored.settings = *std::move(settings);
    return success();
  }
  const CoordinateSettings* const mixed = stored.settings.mixed();
  const bool is_other_kind = arguments.given->count() > 0 && arguments.kind != best_kind &&
                             arguments.kind != stored.settings.kind().name;
  const bool is_other_mix =
      !arguments.mix.empty() && (mixed == nullptr || arguments.mix != mixed->name());
  if (is_other_kind || is_other_mix) {
    return Error{ErrorCode::mismatch,
                 fmt::format("the weights are {} coordinates, not {}{}; bind the model again",
                             stored.settings.name(), arguments.kind,
                             arguments.mix.empty() ? "" : "+" + arguments.mix)};
  }
  CoordinateSettings wanted = stored.settings;
  if (Status status = set_given(arguments, wanted); !status) {
    return status;
  }
  if (!wanted.same_weights(stored.settings)) {
    return Error{ErrorCode::mismatch,
                 fmt::format("the weights were made with {}, not {}; bind the model again",
                             stored.settings.text(), wanted.text())};
  }
  stored.settings = std::move(wanted);
  return success();
}

} // namespace cagewright::cli
