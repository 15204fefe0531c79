#include "json.h"
#include "report/coordinate_kinds.h"
#include "session.h"

#include <cagewright/coordinates/kinds.h>

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>

namespace cagewright::cli {
namespace {

struct Property {
  std::string_view title;
  std::string_view CoordinateKind::*value;
};

constexpr std::array<Property, 8> properties = {{
    {"quads", &CoordinateKind::quads},
    {"weights", &CoordinateKind::sign},
    {"reproduces", &CoordinateKind::reproduces},
    {"on the cage", &CoordinateKind::on_cage},
    {"outside", &CoordinateKind::outside},
    {"reach", &CoordinateKind::locality},
    {"made by", &CoordinateKind::made_by},
    {"cost", &CoordinateKind::cost},
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

int run(const std::string& json, const Session& session) {
  if (!json.empty()) {
    if (const Status written = write_json(json, coordinate_kinds_as_json()); !written) {
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
