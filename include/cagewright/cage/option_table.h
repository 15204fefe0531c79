/// \file
/// Every number and word of GenerateOptions, declared once: for command lines, windows, files and
/// other languages.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/core/result.h>

#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace cagewright {

/// What options are about, in the order in which people want them.
enum class OptionGroup {
  cage,     ///< what the cage is to be like
  model,    ///< what is made of the model
  envelope, ///< for Method::envelope
  boxes,    ///< for Method::boxes and boxes_improved
};

std::string_view title_of(OptionGroup group);

struct IntegerOption {
  int least = 0;
  int most = 0;
  std::string_view zero_means; ///< if 0 is allowed too, outside the range: "no limit"
  int (*get)(const GenerateOptions&) = nullptr;
  void (*set)(GenerateOptions&, int) = nullptr;
};

struct NumberOption {
  double least = 0;
  double most = 0;
  bool is_length = false;      ///< a part of the model's diagonal; may be written as per cent
  std::string_view zero_means; ///< what the default 0 stands for, outside the range
  double GenerateOptions::*member = nullptr;
};

struct OptionWord {
  std::string_view word;  ///< in files and on command lines: "boxes-improved"
  std::string_view label; ///< in windows: "Boxes, improved"
};

/// One of some words. One of "off" and "on" is a switch.
struct ChoiceOption {
  std::span<const OptionWord> words;
  int (*get)(const GenerateOptions&) = nullptr; ///< which of the words
  void (*set)(GenerateOptions&, int) = nullptr;
};

struct CageOption {
  std::string_view name;  ///< "max-gap"
  std::string_view label; ///< "Greatest gap"
  std::string_view help;  ///< a sentence or two
  OptionGroup group = OptionGroup::cage;
  std::variant<IntegerOption, NumberOption, ChoiceOption> kind;
  /// Whether it makes a difference, apart from its group; null: always.
  bool (*condition)(const GenerateOptions&) = nullptr;
};

/// All of them, each group in one place.
std::span<const CageOption> cage_options();

/// The option of that name; null: there is none.
const CageOption* find_cage_option(std::string_view name);

/// Whether the option makes a difference to the cage, the others being as they are.
bool applies(const CageOption& option, const GenerateOptions& options);

/// Sets an option to what a person wrote: "60", "0.2%" or "0.002", "boxes-improved".
/// Errors: invalid_option, with the cause and what is allowed.
Status set_from_text(const CageOption& option, std::string_view text, GenerateOptions& options);

/// Its value as a person would write it.
std::string text_of(const CageOption& option, const GenerateOptions& options);

/// What may be written: "4 to 100000", "envelope|boxes|boxes-improved", "0.0001% to 50%".
std::string values_of(const CageOption& option);

/// Whether every option is within its range. Errors: invalid_option, for the first that is not.
Status check_ranges(const GenerateOptions& options);

} // namespace cagewright
