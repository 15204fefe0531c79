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
                       settings.kind().name, kinds_with(name)));
    } else if (Status status = settings.set(name, value.text); !status) {
      return status;
    }
  }
  return success();
}

} // namespace

void add_coordinate_options(CLI::App& command, CoordinateArguments& arguments, bool offer_best) {
  std::vector<std::string> names;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    names.emplace_back(kind->name);
  }
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
  Result<CoordinateSettings> settings = CoordinateSettings::of(arguments.kind);
  if (settings) {
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
  if (arguments.given->count() > 0 && arguments.kind != best_kind &&
      arguments.kind != stored.settings.kind().name) {
    return Error{ErrorCode::mismatch,
                 fmt::format("the weights are {} coordinates, not {}; bind the model again",
                             stored.settings.kind().name, arguments.kind)};
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
