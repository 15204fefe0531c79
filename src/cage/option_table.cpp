#include <cagewright/cage/option_table.h>

#include "core/parse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <system_error>
#include <type_traits>
#include <utility>

namespace cagewright {
namespace {

using O = GenerateOptions;

constexpr std::array methods = {OptionWord{"envelope", "Envelope"},
                                OptionWord{"boxes", "Union of boxes"},
                                OptionWord{"boxes-improved", "Boxes, improved"}};
constexpr std::array off_on = {OptionWord{"off", "No"}, OptionWord{"on", "Yes"}};
constexpr std::array faces_words = {OptionWord{"off", "Triangles"},
                                    OptionWord{"on", "Quads where they can be"}};
constexpr std::array symmetries = {
    OptionWord{"off", "Off"},    OptionWord{"auto", "Automatic"},
    OptionWord{"x", "Across X"}, OptionWord{"y", "Across Y"},
    OptionWord{"z", "Across Z"}, OptionWord{"topology", "Of a pose"}};
constexpr std::array piece_words = {OptionWord{"together", "One cage"},
                                    OptionWord{"apart", "A cage each"}};
constexpr std::array rules = {OptionWord{"volume", "Volume"}, OptionWord{"published", "Published"}};
constexpr std::array splits = {OptionWord{"parts", "Connected parts"},
                               OptionWord{"binary", "Halves"}};
constexpr std::array without_jump = {OptionWord{"skip", "Leave it whole"},
                                     OptionWord{"middle", "Cut in the middle"}};

// Words of earlier versions, and what they are called now.
constexpr std::array old_words = {
    std::pair<std::string_view, std::string_view>{"obb", "boxes-improved"}};

constexpr double most_length = 0.5;
constexpr double least_length = 1e-6;

bool is_improved(const O& o) {
  return o.method != Method::boxes;
}
bool by_volume(const O& o) {
  return o.slicing == SlicingRule::volume;
}
bool by_jumps(const O& o) {
  return o.slicing == SlicingRule::published;
}

template <auto Member> int get_as_int(const O& o) {
  return static_cast<int>(o.*Member);
}
template <auto Member> void set_as_int(O& o, int value) {
  o.*Member = static_cast<std::remove_reference_t<decltype(o.*Member)>>(value);
}
template <auto Member>
constexpr IntegerOption integer(int least, int most, std::string_view zero_means = {}) {
  return {least, most, zero_means, get_as_int<Member>, set_as_int<Member>};
}
template <auto Member> constexpr ChoiceOption choice(std::span<const OptionWord> words) {
  return {words, get_as_int<Member>, set_as_int<Member>};
}
constexpr NumberOption length(double O::*member, double least, std::string_view zero_means = {}) {
  return {least, most_length, true, zero_means, member};
}
constexpr NumberOption number(double O::*member, double least, double most) {
  return {least, most, false, {}, member};
}

const std::array options_table = {
    CageOption{"vertices", "Vertices",
               "The best cage of at most so many vertices. 50 to 150 are easy to edit by hand; "
               "more follow the model more closely.",
               OptionGroup::cage,
               IntegerOption{4, 100000, "no limit", [](const O& o) { return vertex_limit(o); },
                             [](O& o, int value) { o.vertices = value; }},
               is_improved},
    CageOption{"quads", "Faces",
               "Quads where they can be: they are easier to select in loops and rings, triangles "
               "fit more closely. The cage is valid along both diagonals of each.",
               OptionGroup::cage, choice<&O::quads>(faces_words)},
    CageOption{"method", "Method",
               "What the cage is made from. envelope: a tight skin of voxels, for any shape, and "
               "the best choice for editing; boxes: the union of oriented boxes along the limbs, "
               "as it is; boxes-improved: that union, improved within the budget.",
               OptionGroup::cage, choice<&O::method>(methods)},
    CageOption{"symmetry", "Symmetry",
               "Whether the cage is its own mirror image, vertex by vertex. auto: if the model is, "
               "in whatever plane; x, y, z: in the best plane across that axis, even if the model "
               "is not; topology: where the model is in a pose, faces and vertices are paired left "
               "to right, and follow the pose.",
               OptionGroup::cage, choice<&O::symmetry>(symmetries), is_improved},
    CageOption{"clearance", "Clearance",
               "Least distance between cage and model, as a part of the model's diagonal.",
               OptionGroup::cage, length(&O::clearance, least_length), is_improved},
    CageOption{"max-gap", "Greatest gap",
               "The coarsest cage no point of which is farther from the model than this part of "
               "the model's diagonal, proved. Vertices and faces are then limits only.",
               OptionGroup::cage, length(&O::max_gap, least_length, "as the vertices allow"),
               is_improved},
    CageOption{"faces", "Most faces", "At most so many faces, as they are written: a quad is one.",
               OptionGroup::cage, integer<&O::faces>(4, 200000, "no limit"), is_improved},
    CageOption{"rounds", "Refinement",
               "How often, at most, vertices are moved to where they pay. Fewer is quicker, and "
               "looser.",
               OptionGroup::cage, integer<&O::rounds>(0, 100), is_improved},
    CageOption{"pieces", "Separate pieces",
               "What a model in several pieces gets. together: one cage, with thin bridges; apart: "
               "a closed surface for each group of pieces that are apart.",
               OptionGroup::model, choice<&O::pieces>(piece_words)},
    CageOption{"ignore-specks", "Ignore specks",
               "Leave out tiny pieces far from the rest, as scans have them, and vertices that no "
               "face uses: the cage is made for what remains.",
               OptionGroup::model, choice<&O::ignore_specks>(off_on)},
    CageOption{"solid", "Solid",
               "Close the openings of an open model, so that a dome, a vase or a pipe gets one "
               "solid cage instead of a thin one that goes in and out.",
               OptionGroup::model, choice<&O::solid>(off_on)},
    CageOption{"closing", "Closing",
               "Holes and gaps narrower than twice this part of the model's diagonal are filled; "
               "with solid, openings that are no wider are closed, or all of them (0).",
               OptionGroup::envelope, length(&O::closing, 0)},
    CageOption{"envelope-resolution", "Envelope resolution",
               "Voxels along the model's diagonal: finer ones follow narrow gaps and take longer.",
               OptionGroup::envelope, integer<&O::envelope_resolution>(8, 512, "automatic")},
    CageOption{"depth", "Depth",
               "How often a part of the model may be cut in two: more cuts, more and smaller "
               "boxes.",
               OptionGroup::boxes, integer<&O::depth>(0, 20)},
    CageOption{"boxes", "Most boxes", "Stop at so many boxes, cutting first where it pays most.",
               OptionGroup::boxes, integer<&O::max_boxes>(1, 100000, "no limit")},
    CageOption{"slicing", "Slicing rule",
               "Where a box is cut. volume: where the boxes of the parts get smallest; published: "
               "at the greatest jump of the cross-section (Xian, Lin and Gao 2012).",
               OptionGroup::boxes, choice<&O::slicing>(rules)},
    CageOption{"resolution", "Resolution",
               "Voxels along the longest axis of the model's box, from which the boxes are made.",
               OptionGroup::boxes, integer<&O::resolution>(8, 512)},
    CageOption{"split", "Split",
               "Whether each connected part of a half gets a box (parts), or each half one "
               "(binary).",
               OptionGroup::boxes,
               ChoiceOption{splits, [](const O& o) { return o.split_parts ? 0 : 1; },
                            [](O& o, int value) { o.split_parts = value == 0; }}},
    CageOption{"registration", "Join faces",
               "Join the faces of neighbouring boxes where they fit, so that the union has fewer "
               "slivers.",
               OptionGroup::boxes, choice<&O::registration>(off_on)},
    CageOption{"min-gain", "Least gain",
               "With the volume rule, the least part of a box's volume that a cut must save.",
               OptionGroup::boxes, number(&O::min_gain, 0, 1), by_volume},
    CageOption{"min-jump", "Least jump",
               "With the published rule, the least clear jump, as a part of the greatest "
               "cross-section.",
               OptionGroup::boxes, number(&O::min_jump, 0, 1), by_jumps},
    CageOption{"no-jump", "Without a jump",
               "With the published rule, what becomes of a box without a clear jump. middle: its "
               "longest edge is cut in the middle; skip: it is left whole.",
               OptionGroup::boxes, choice<&O::no_jump>(without_jump), by_jumps},
    CageOption{"eta", "Eta (T1)",
               "A box is left whole where its least cross-section over its greatest is above this, "
               "and zeta holds too; above 1: never.",
               OptionGroup::boxes, number(&O::eta, 0.001, 1000)},
    CageOption{"zeta", "Zeta (T2)",
               "A box is left whole where its shortest edge over its longest is above this, and "
               "eta holds too; above 1: never.",
               OptionGroup::boxes, number(&O::zeta, 0.001, 1000)},
};

std::string plain(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

std::string percent(double value) {
  return plain(100 * value) + "%";
}

Error refusal(std::string_view text, const CageOption& option) {
  std::string message(1, '\'');
  message.append(text).append("' is not ");
  message.append(std::holds_alternative<ChoiceOption>(option.kind) ? "one of " : "");
  message.append(values_of(option));
  return {ErrorCode::invalid_option, std::move(message)};
}

bool is_within(const IntegerOption& option, int value) {
  return (value >= option.least && value <= option.most) ||
         (value == 0 && !option.zero_means.empty());
}

bool is_within(const NumberOption& option, double value) {
  return value >= option.least && value <= option.most;
}

} // namespace

std::string_view title_of(OptionGroup group) {
  switch (group) {
  case OptionGroup::cage:
    return "The cage";
  case OptionGroup::model:
    return "The model";
  case OptionGroup::envelope:
    return "Envelope";
  case OptionGroup::boxes:
    return "Boxes";
  }
  return "";
}

std::span<const CageOption> cage_options() {
  return options_table;
}

const CageOption* find_cage_option(std::string_view name) {
  const auto found = std::find_if(options_table.begin(), options_table.end(),
                                  [&](const CageOption& option) { return option.name == name; });
  return found == options_table.end() ? nullptr : &*found;
}

bool applies(const CageOption& option, const GenerateOptions& options) {
  const bool is_envelope = options.method == Method::envelope;
  const bool by_group = option.group == OptionGroup::envelope ? is_envelope
                        : option.group == OptionGroup::boxes  ? !is_envelope
                                                              : true;
  return by_group && (option.condition == nullptr || option.condition(options));
}

Status set_from_text(const CageOption& option, std::string_view text, GenerateOptions& options) {
  if (const auto* whole = std::get_if<IntegerOption>(&option.kind)) {
    int value = 0;
    if (!parse_number(text, value) || !is_within(*whole, value)) {
      return refusal(text, option);
    }
    whole->set(options, value);
  } else if (const auto* real = std::get_if<NumberOption>(&option.kind)) {
    const bool is_percent = real->is_length && text.ends_with('%');
    double value = 0;
    if (!parse_number(text.substr(0, text.size() - (is_percent ? 1 : 0)), value)) {
      return refusal(text, option);
    }
    value = is_percent ? value / 100 : value;
    if (!is_within(*real, value)) {
      return refusal(text, option);
    }
    options.*real->member = value;
  } else {
    const auto& words = std::get<ChoiceOption>(option.kind);
    const auto old = std::find_if(old_words.begin(), old_words.end(),
                                  [&](const auto& pair) { return pair.first == text; });
    const std::string_view word = old == old_words.end() ? text : old->second;
    const auto found = std::find_if(words.words.begin(), words.words.end(),
                                    [&](const OptionWord& known) { return known.word == word; });
    if (found == words.words.end()) {
      return refusal(text, option);
    }
    words.set(options, static_cast<int>(std::distance(words.words.begin(), found)));
  }
  return success();
}

std::string text_of(const CageOption& option, const GenerateOptions& options) {
  if (const auto* whole = std::get_if<IntegerOption>(&option.kind)) {
    const int value = whole->get(options);
    return value == 0 && !whole->zero_means.empty() ? std::string(whole->zero_means)
                                                    : std::to_string(value);
  }
  if (const auto* real = std::get_if<NumberOption>(&option.kind)) {
    const double value = options.*real->member;
    return value == 0 && !real->zero_means.empty() ? std::string(real->zero_means)
           : real->is_length                       ? percent(value)
                                                   : plain(value);
  }
  const auto& words = std::get<ChoiceOption>(option.kind);
  return std::string(words.words[static_cast<std::size_t>(words.get(options))].word);
}

std::string values_of(const CageOption& option) {
  if (const auto* whole = std::get_if<IntegerOption>(&option.kind)) {
    return std::to_string(whole->least) + " to " + std::to_string(whole->most);
  }
  if (const auto* real = std::get_if<NumberOption>(&option.kind)) {
    return real->is_length ? percent(real->least) + " to " + percent(real->most)
                           : plain(real->least) + " to " + plain(real->most);
  }
  std::string text;
  for (const OptionWord& word : std::get<ChoiceOption>(option.kind).words) {
    text.append(text.empty() ? "" : "|").append(word.word);
  }
  return text;
}

Status check_ranges(const GenerateOptions& options) {
  for (const CageOption& option : options_table) {
    bool is_good = true;
    std::string value;
    if (const auto* whole = std::get_if<IntegerOption>(&option.kind)) {
      is_good = is_within(*whole, whole->get(options));
      value = std::to_string(whole->get(options));
    } else if (const auto* real = std::get_if<NumberOption>(&option.kind)) {
      const double is = options.*real->member;
      is_good = is_within(*real, is) || (is == 0 && !real->zero_means.empty());
      value = plain(is);
    }
    if (!is_good) {
      return Error{ErrorCode::invalid_option,
                   std::string(option.name) + ": " + refusal(value, option).message};
    }
  }
  return success();
}

} // namespace cagewright
