#include "report/coordinate_kinds.h"

#include <cagewright/coordinates/kinds.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace cagewright {
namespace {

struct Property {
  std::string_view name;
  std::string_view CoordinateKind::*value;
};

constexpr std::array<Property, 8> properties = {{
    {"quads", &CoordinateKind::quads},
    {"sign", &CoordinateKind::sign},
    {"reproduces", &CoordinateKind::reproduces},
    {"on_cage", &CoordinateKind::on_cage},
    {"outside", &CoordinateKind::outside},
    {"locality", &CoordinateKind::locality},
    {"made_by", &CoordinateKind::made_by},
    {"cost", &CoordinateKind::cost},
}};

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

} // namespace

nlohmann::json coordinate_kinds_as_json() {
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

} // namespace cagewright
