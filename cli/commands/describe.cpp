#include "describe.h"

#include <cagewright/version.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace cagewright::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The words of "NAME:{a,b}", "ENUM:value in {a->0,b->1}" and "a|b": what may be written.
Json words_of(const std::string& type) {
  Json words = Json::array();
  const std::size_t begin = type.find('{');
  const bool is_set = begin != std::string::npos;
  if (!is_set && type.find('|') == std::string::npos) {
    return words;
  }
  const std::string list =
      is_set ? type.substr(begin + 1, type.find('}', begin) - begin - 1) : type;
  for (const std::string& word : CLI::detail::split(list, is_set ? ',' : '|')) {
    words.push_back(word.substr(0, word.find("->")));
  }
  return words;
}

Json json_of(const CLI::Option& option) {
  Json names = Json::array();
  for (const std::string& name : option.get_snames()) {
    names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    names.push_back("--" + name);
  }
  const bool is_flag = option.get_expected_max() == 0;
  const std::string type = option.get_type_name();
  return {{"names", names},
          {"positional", option.get_positional() ? option.get_name(true) : ""},
          {"type", is_flag ? "" : type},
          {"text", option.get_option_text()},
          {"words", is_flag ? Json::array() : words_of(type)},
          {"default", is_flag ? "" : option.get_default_str()},
          {"many", option.get_items_expected_max() > 1},
          {"required", option.get_required()},
          {"group", option.get_group()},
          {"help", option.get_description()}};
}

Json json_of(const CLI::App& app) {
  Json options = Json::array();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) {
      options.push_back(json_of(*option));
    }
  }
  return {{"name", app.get_name()},
          {"help", app.get_description()},
          {"footer", app.get_footer()},
          {"options", options}};
}

} // namespace

void add_describe(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("describe", "All commands and options as JSON");
  command->group(""); // not in --help
  command->callback([&app, &session] {
    session.run = [&app] {
      Json all = json_of(app);
      all["version"] = CAGEWRIGHT_VERSION;
      all["licence"] = CAGEWRIGHT_LICENCE;
      all["commands"] = Json::array();
      for (const CLI::App* each : app.get_subcommands({})) {
        if (!each->get_group().empty()) {
          all["commands"].push_back(json_of(*each));
        }
      }
      std::fputs((all.dump(1) + "\n").c_str(), stdout);
      return static_cast<int>(done);
    };
  });
}

} // namespace cagewright::cli
