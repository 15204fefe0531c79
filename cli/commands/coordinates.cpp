#include "json.h"
#include "session.h"

#include <cagewright/coordinates/kinds.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <memory>
#include <string>
#include <string_view>

namespace cagewright::cli {
namespace {

struct Property {
  std::string_view name;  ///< in JSON
  std::string_view title; ///< for people
  std::string_view CoordinateKind::*value;
};

constexpr std::array<Property, 8> properties = {{
    {"quads", "quads", &CoordinateKind::quads},
    {"sign", "weights", &CoordinateKind::sign},
    {"reproduces", "reproduces", &CoordinateKind::reproduces},
    {"on_cage", "on the cage", &CoordinateKind::on_cage},
    {"outside", "outside", &CoordinateKind::outside},
    {"locality", "reach", &CoordinateKind::locality},
    {"made_by", "made by", &CoordinateKind::made_by},
    {"cost", "cost", &CoordinateKind::cost},
}};

std::string as_text() {
  std::string text;
  for (const CoordinateKind* kind : coordinate_kinds()) {
    text += fmt::format("{}: {}\n", kind->name, kind->idea);
    for (const Property& property : properties) {
      text += fmt::format("  {:<13}{}\n", property.title, kind->*property.value);
    }
    for (const CoordinateOption* option : kind->options) {
      text +=
          fmt::format("  --{} {} [{}]\n", option->name, values_of(*option), initial_text(*option));
    }
  }
  return text;
}

nlohmann::json json_of(const CoordinateOption& option) {
  nlohmann::json json = {{"name", option.name},
                         {"help", option.help},
                         {"default", initial_text(option)},
                         {"while_posing", option.while_posing}};
  if (option.words.empty()) {
    json["default"] = option.initial;
    json["least"] = option.least;
    json["most"] = option.most;
  } else {
    json["words"] = option.words;
  }
  return json;
}

nlohmann::json as_json() {
  nlohmann::json json = {{"format", "cagewright-coordinates"},
                         {"version", 1},
                         {"default", CoordinateSettings().kind().name},
                         {"kinds", nlohmann::json::array()}};
  for (const CoordinateKind* kind : coordinate_kinds()) {
    nlohmann::json entry = {
        {"name", kind->name}, {"idea", kind->idea}, {"options", nlohmann::json::array()}};
    for (const Property& property : properties) {
      entry[std::string(property.name)] = kind->*property.value;
    }
    for (const CoordinateOption* option : kind->options) {
      entry["options"].push_back(json_of(*option));
    }
    json["kinds"].push_back(std::move(entry));
  }
  return json;
}

int run(const std::string& json, const Session& session) {
  if (!json.empty()) {
    if (const Status written = write_json(json, as_json()); !written) {
      return fail(written.error());
    }
  }
  session.say(as_text());
  return done;
}

} // namespace

void add_coordinates(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "coordinates", "The kinds of coordinates by which a model can follow its cage: what each "
                     "is, reproduces and costs");
  auto json = std::make_shared<std::string>();
  command->add_option("--json", *json, "Write the same to this file as JSON");
  command->callback(
      [&session, json] { session.run = [&session, json] { return run(*json, session); }; });
}

} // namespace cagewright::cli
