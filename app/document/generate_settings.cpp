#include "app/document/generate_settings.h"

#include <QObject>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace cagewright::app {
namespace {

using Group = GenerateOption::Group;

/// Shown before all others: what most people change.
constexpr std::array<std::string_view, 5> basic = {"method", "vertices", "quads", "depth",
                                                   "symmetry"};

QString text(std::string_view english) {
  return QObject::tr(std::string(english).c_str());
}

Group group_of(const CageOption& option) {
  if (std::ranges::find(basic, option.name) != basic.end()) {
    return Group::basic;
  }
  return option.group == OptionGroup::envelope ? Group::envelope
         : option.group == OptionGroup::boxes  ? Group::boxes
                                               : Group::budget;
}

GenerateOption::Integer row(const IntegerOption& option) {
  const bool has_zero = !option.zero_means.empty();
  return {has_zero ? 0 : option.least, option.most,
          [&option](const GenerateSettings& s) { return option.get(s.options); },
          [&option](GenerateSettings& s, int value) {
            // Between 0 and the least there is nothing.
            const bool is_zero = value == 0 && !option.zero_means.empty();
            option.set(s.options, is_zero ? 0 : std::max(option.least, value));
          },
          text(option.zero_means)};
}

GenerateOption::Number row(const NumberOption& option) {
  const bool has_zero = !option.zero_means.empty();
  return {has_zero ? 0 : option.least,
          std::min(option.most, option.is_length ? option.most : 2.0),
          option.is_length ? 0.001 : 0.01,
          option.is_length ? 5 : 3,
          [&option](GenerateSettings& s) -> double& { return s.options.*option.member; },
          text(option.zero_means)};
}

GenerateOption::Choice row(const ChoiceOption& option) {
  GenerateOption::Choice choice{
      {},
      {},
      [&option](const GenerateSettings& s) { return option.get(s.options); },
      [&option](GenerateSettings& s, int value) { option.set(s.options, value); }};
  for (const OptionWord& word : option.words) {
    choice.keys.append(
        QString::fromUtf8(word.word.data(), static_cast<qsizetype>(word.word.size())));
    choice.labels.append(text(word.label));
  }
  return choice;
}

GenerateOption of_library(const CageOption& option) {
  using Kind = decltype(GenerateOption::kind);
  return {QString::fromUtf8(option.name.data(), static_cast<qsizetype>(option.name.size())),
          text(option.label), text(option.help), group_of(option),
          std::visit([](const auto& kind) { return Kind(row(kind)); }, option.kind),
          // How the model is split into boxes is shown whatever the cage is made from, but not
          // among what most people change.
          [&option](const GenerateSettings& s) {
            if (group_of(option) == Group::basic && option.group == OptionGroup::boxes &&
                s.options.method == Method::envelope) {
              return false;
            }
            return option.group == OptionGroup::boxes
                       ? option.condition == nullptr || option.condition(s.options)
                       : cagewright::applies(option, s.options);
          }};
}

bool is_improved(const GenerateSettings& s) {
  return s.options.method != Method::boxes;
}

std::vector<GenerateOption> density_options() {
  return {
      {"density", text("Finer where"),
       text("Where the cage gets more vertices. Colors: where vertex colors are red, and fewer "
            "where they are blue. File: one number for each vertex of the model; four times as "
            "much makes edges half as long. Painted here: by the brush of the tool bar."),
       Group::budget,
       GenerateOption::Choice{
           {"even", "colors", "file", "painted"},
           {text("Even"), text("Colors of its file"), text("A file says"), text("Painted here")},
           [](const GenerateSettings& s) { return static_cast<int>(s.density); },
           [](GenerateSettings& s, int i) { s.density = static_cast<DensitySource>(i); }},
       is_improved},
      {"density-file", text("Density file"),
       text("Text with one number to a line, or a NumPy array, in the order of the vertices."),
       Group::budget,
       GenerateOption::File{text("Numbers (*.txt *.csv *.dat *.npy);;All files (*)"),
                            [](GenerateSettings& s) -> QString& { return s.density_file; }},
       [](const GenerateSettings& s) {
         return is_improved(s) && s.density == DensitySource::file;
       }},
  };
}

QString name_of(const CoordinateKind& kind) {
  return QString::fromUtf8(kind.name.data(), static_cast<qsizetype>(kind.name.size()));
}

QString label_of(const CoordinateKind& kind) {
  QString label = name_of(kind).replace('_', ' ');
  label[0] = label[0].toUpper();
  return label;
}

GenerateOption coordinates_option() {
  GenerateOption::Choice choice{
      {},
      {},
      [](const GenerateSettings& s) {
        const auto kinds = coordinate_kinds();
        const auto at = std::ranges::find_if(
            kinds, [&](const CoordinateKind* k) { return name_of(*k) == s.coordinates; });
        return at == kinds.end() ? 0 : static_cast<int>(at - kinds.begin());
      },
      [](GenerateSettings& s, int i) {
        s.coordinates = name_of(*coordinate_kinds()[static_cast<std::size_t>(i)]);
      }};
  QString help = text("By which coordinates the model follows the cage. While it is bound, another "
                      "kind binds it anew and keeps the pose.");
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const QString label = label_of(*kind);
    choice.keys.append(name_of(*kind));
    choice.labels.append(label);
    help += QString("\n%1: %2.").arg(label, text(kind->idea));
  }
  return {"coordinates", text("Follows by"),
          help,          Group::binding,
          choice,        [](const GenerateSettings&) { return true; }};
}

const CoordinateKind& kind_of(const GenerateSettings& settings) {
  const CoordinateKind* kind = find_coordinate_kind(settings.coordinates.toStdString());
  return kind != nullptr ? *kind : *coordinate_kinds().front();
}

/// One of the kinds, or none.
GenerateOption::Choice choice_of_kinds(QString GenerateSettings::*name, const QString& none) {
  GenerateOption::Choice choice{
      {"none"},
      {none},
      [name](const GenerateSettings& s) {
        const auto kinds = coordinate_kinds();
        const auto at = std::ranges::find_if(
            kinds, [&](const CoordinateKind* k) { return name_of(*k) == s.*name; });
        return at == kinds.end() ? 0 : 1 + static_cast<int>(at - kinds.begin());
      },
      [name](GenerateSettings& s, int i) {
        s.*name =
            i == 0 ? QString() : name_of(*coordinate_kinds()[static_cast<std::size_t>(i - 1)]);
      }};
  for (const CoordinateKind* kind : coordinate_kinds()) {
    choice.keys.append(name_of(*kind));
    choice.labels.append(label_of(*kind));
  }
  return choice;
}

GenerateOption mixed_option() {
  return {"mix",
          text("Where painted"),
          text("Another kind for a part of the model: paint it with Paint Mix of the tool bar. "
               "Between the two the model goes between where they take it. Harmonic keeps arms "
               "apart, say, and green bends the trunk."),
          Group::binding,
          choice_of_kinds(&GenerateSettings::mixed, text("The same")),
          [](const GenerateSettings&) { return true; }};
}

GenerateOption beside_option() {
  return {"beside",
          text("Beside it"),
          text("While the model is bound: the same pose by other coordinates, beside it, to choose "
               "by looking. It is not exported."),
          Group::binding,
          choice_of_kinds(&GenerateSettings::beside, text("Nothing")),
          [](const GenerateSettings&) { return true; }};
}

/// What is painted is followed by; null: nothing else than the rest.
const CoordinateKind* mixed_kind_of(const GenerateSettings& settings) {
  const CoordinateKind* kind = find_coordinate_kind(settings.mixed.toStdString());
  return kind == &kind_of(settings) ? nullptr : kind;
}

/// A number that some kinds can be given, shown while the kind is one of them.
GenerateOption option_of_kinds(const CoordinateOption& option) {
  const std::string name(option.name);
  QString label = QString::fromStdString(name).replace('-', ' ');
  label[0] = label[0].toUpper();
  constexpr double small = 0.01; // what has no digits among the usual three
  return {
      QString::fromStdString(name),
      label,
      text(option.help),
      Group::binding,
      GenerateOption::Number{option.least, option.most, option.most <= 1 ? 0.05 : 0.1,
                             option.initial > 0 && option.initial < small ? 6 : 3,
                             [name, initial = option.initial](GenerateSettings& s) -> double& {
                               return s.coordinate_numbers.try_emplace(name, initial).first->second;
                             }},
      [&option](const GenerateSettings& s) {
        const auto has = [&option](const CoordinateKind& kind) {
          return std::ranges::find(kind.options, &option) != kind.options.end();
        };
        const CoordinateKind* mixed = mixed_kind_of(s);
        return has(kind_of(s)) || (mixed != nullptr && has(*mixed));
      }};
}

} // namespace

QString label_of_coordinates(const CoordinateSettings& settings) {
  return label_of(settings.kind());
}

QString label_of_coordinates(const QString& name) {
  const CoordinateKind* kind = find_coordinate_kind(name.toStdString());
  return kind != nullptr ? label_of(*kind) : QString();
}

namespace {

CoordinateSettings with_numbers(const CoordinateKind& kind, const GenerateSettings& settings) {
  CoordinateSettings chosen(kind);
  for (const auto& [name, value] : settings.coordinate_numbers) {
    if (chosen.has(name)) {
      static_cast<void>(chosen.set(name, QString::number(value, 'g', 17).toStdString()));
    }
  }
  return chosen;
}

void take_numbers(const CoordinateSettings& bound, GenerateSettings& settings) {
  for (const CoordinateOption* option : bound.kind().options) {
    if (option->words.empty()) {
      settings.coordinate_numbers[std::string(option->name)] = bound.number(*option);
    }
  }
}

} // namespace

CoordinateChoice coordinate_choice(const GenerateSettings& settings, SharedShares painted) {
  CoordinateChoice choice(with_numbers(kind_of(settings), settings));
  if (const CoordinateKind* mixed = mixed_kind_of(settings)) {
    choice.second = with_numbers(*mixed, settings);
    choice.shares = std::move(painted);
  }
  return choice;
}

void take_coordinates(const CoordinateChoice& bound, GenerateSettings& settings) {
  settings.coordinates = name_of(bound.first.kind());
  take_numbers(bound.first, settings);
  settings.mixed.clear();
  if (bound.second) {
    settings.mixed = name_of(bound.second->kind());
    take_numbers(*bound.second, settings);
  }
}

const std::vector<GenerateOption>& generate_options() {
  static const std::vector<GenerateOption> options = [] {
    std::vector<GenerateOption> all;
    for (const std::string_view name : basic) {
      all.push_back(of_library(*find_cage_option(name)));
    }
    for (const CageOption& option : cage_options()) {
      if (group_of(option) != Group::basic) {
        all.push_back(of_library(option));
      }
    }
    const std::vector<GenerateOption> density = density_options();
    all.insert(all.end(), density.begin(), density.end());
    all.push_back(coordinates_option());
    all.push_back(mixed_option());
    for (const CoordinateOption* option : coordinate_options()) {
      if (option->words.empty()) {
        all.push_back(option_of_kinds(*option));
      }
    }
    all.push_back(beside_option());
    return all;
  }();
  return options;
}

QJsonObject to_json(const GenerateSettings& settings) {
  GenerateSettings copy = settings; // the accessors give references that may be written to
  QJsonObject json;
  for (const GenerateOption& option : generate_options()) {
    if (const auto* integer = std::get_if<GenerateOption::Integer>(&option.kind)) {
      json[option.key] = integer->get(copy);
    } else if (const auto* number = std::get_if<GenerateOption::Number>(&option.kind)) {
      json[option.key] = number->value(copy);
    } else if (const auto* file = std::get_if<GenerateOption::File>(&option.kind)) {
      json[option.key] = file->value(copy);
    } else {
      const auto& choice = std::get<GenerateOption::Choice>(option.kind);
      json[option.key] = choice.keys[choice.get(copy)];
    }
  }
  return json;
}

GenerateSettings generate_settings_from_json(const QJsonObject& json) {
  GenerateSettings settings;
  for (const GenerateOption& option : generate_options()) {
    const QJsonValue value = json[option.key];
    if (const auto* integer = std::get_if<GenerateOption::Integer>(&option.kind)) {
      if (value.isDouble()) {
        const int kept = value.toInt(integer->get(settings));
        integer->set(settings, std::clamp(kept, integer->least, integer->most));
      }
    } else if (const auto* number = std::get_if<GenerateOption::Number>(&option.kind)) {
      double& kept = number->value(settings);
      kept = std::clamp(value.toDouble(kept), number->least, number->most);
    } else if (const auto* file = std::get_if<GenerateOption::File>(&option.kind)) {
      file->value(settings) = value.toString();
    } else {
      const auto& choice = std::get<GenerateOption::Choice>(option.kind);
      const CageOption* of_table = find_cage_option(option.key.toStdString());
      if (const auto at = choice.keys.indexOf(value.toString()); at >= 0) {
        choice.set(settings, static_cast<int>(at));
      } else if (of_table != nullptr) { // a word of an earlier version, or none: then as it was
        static_cast<void>(
            set_from_text(*of_table, value.toString().toStdString(), settings.options));
      }
    }
  }
  return settings;
}

} // namespace cagewright::app
