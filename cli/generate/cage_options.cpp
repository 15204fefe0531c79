#include "generate/arguments.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>

namespace cagewright::cli {
namespace {

std::string dashed(const CageOption& option) {
  return "--" + std::string(option.name);
}

/// Of one of "off" and "on": whether naming it is enough to switch it on.
bool is_flag(const CageOption& option) {
  const auto* choice = std::get_if<ChoiceOption>(&option.kind);
  return choice != nullptr && choice->words.front().word == "off" && choice->words.size() == 2 &&
         choice->get(GenerateOptions()) == 0;
}

std::string type_of(const CageOption& option) {
  if (std::holds_alternative<ChoiceOption>(option.kind)) {
    return values_of(option);
  }
  const auto* number = std::get_if<NumberOption>(&option.kind);
  return number == nullptr ? "COUNT" : number->is_length ? "PERCENT" : "NUMBER";
}

} // namespace

void add_cage_options(CLI::App& command, GenerateArguments& arguments) {
  for (const CageOption& option : cage_options()) {
    const auto set = [&option, &arguments](const std::string& text) {
      if (const Status status = set_from_text(option, text, arguments.options); !status) {
        throw CLI::ValidationError(dashed(option), status.error().message);
      }
      arguments.given.push_back(&option);
      arguments.words.push_back(dashed(option) + (is_flag(option) ? "" : "=" + text));
    };
    CLI::Option* added = nullptr;
    if (is_flag(option)) {
      added = command.add_flag_callback(
          dashed(option), [set] { set("on"); }, std::string(option.help));
    } else {
      added =
          command.add_option_function<std::string>(dashed(option), set, std::string(option.help));
      added->type_name(type_of(option))->default_str(text_of(option, arguments.options));
    }
    added->group(std::string(title_of(option.group)));
  }
}

void imply_method(GenerateArguments& arguments) {
  const auto is_about_boxes = [](const CageOption* option) {
    return option->group == OptionGroup::boxes;
  };
  const bool is_named = std::ranges::find(arguments.given, std::string_view("method"),
                                          &CageOption::name) != arguments.given.end();
  if (is_named || std::ranges::none_of(arguments.given, is_about_boxes)) {
    return;
  }
  arguments.options.method = Method::boxes;
  const bool is_heeded = std::ranges::all_of(arguments.given, [&](const CageOption* option) {
    return is_about_boxes(option) || option->group == OptionGroup::envelope ||
           applies(*option, arguments.options);
  });
  if (!is_heeded || !arguments.density.empty()) {
    arguments.options.method = Method::boxes_improved;
  }
}

std::string without_effect(const GenerateArguments& arguments) {
  std::string text;
  for (const CageOption* option : arguments.given) {
    if (!arguments.start.empty()) {
      if (option->name != "clearance") {
        text +=
            dashed(*option) + " makes no difference here: the cage keeps the faces of --start\n";
      }
      continue;
    }
    const bool is_split_only = arguments.emit != Emit::cage && option->group == OptionGroup::boxes;
    if (!applies(*option, arguments.options) && !is_split_only) {
      text +=
          dashed(*option) + " makes no difference here: the method is " +
          text_of(*find_cage_option("method"), arguments.options) +
          (option->group == OptionGroup::boxes
               ? ", the slicing rule " + text_of(*find_cage_option("slicing"), arguments.options)
               : "") +
          "\n";
    }
  }
  return text;
}

} // namespace cagewright::cli
