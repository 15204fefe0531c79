/// \file
/// What the user can choose about making a cage, in a form that panels, project files and
/// preferences share.
#pragma once

#include "app/document/coordinate_choice.h"
#include <cagewright/cage/option_table.h>
#include <cagewright/coordinates/kinds.h>

#include <QJsonObject>
#include <QString>
#include <QStringList>

#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace cagewright::app {

/// Where the cage is to be finer than elsewhere.
enum class DensitySource {
  even,
  colors,  ///< where the model's vertex colors are red, and coarser where blue
  file,    ///< as the numbers of a file say
  painted, ///< as it was painted in the window
};

struct GenerateSettings {
  DensitySource density = DensitySource::even;
  /// The kind of coordinates by which the model will follow the cage: CoordinateKind::name.
  QString coordinates =
      QString::fromUtf8(coordinate_kinds().front()->name.data(),
                        static_cast<qsizetype>(coordinate_kinds().front()->name.size()));
  QString mixed;  ///< another kind, for what is painted; empty, or the same: none
  QString beside; ///< another kind to compare with, while bound; empty: none
  /// Of its options and of those of other kinds, by CoordinateOption::name; none: as they are by
  /// themselves.
  std::map<std::string, double> coordinate_numbers;
  QString density_file; ///< one number for each vertex of the model: see read_vertex_weights()
  GenerateOptions options;
};

/// One thing to choose: an option of the library's table, or of the density. Lengths are fractions
/// of the model's diagonal.
struct GenerateOption {
  struct Integer {
    int least = 0;
    int most = 0;
    std::function<int(const GenerateSettings&)> get;
    std::function<void(GenerateSettings&, int)> set;
    QString at_least; ///< what to show for `least`, if it means something else: "chosen"
  };
  struct Number {
    double least = 0;
    double most = 0;
    double step = 0.01;
    int decimals = 3;
    std::function<double&(GenerateSettings&)> value;
    QString at_least = {}; ///< as of Integer
  };
  struct Choice {
    QStringList keys;   ///< as in files
    QStringList labels; ///< as shown
    std::function<int(const GenerateSettings&)> get;
    std::function<void(GenerateSettings&, int)> set;
  };

  struct File {
    QString filter; ///< as of QFileDialog
    std::function<QString&(GenerateSettings&)> value;
  };

  enum class Group { basic, budget, envelope, boxes, binding };

  QString key; ///< as on the command line, without dashes
  QString label;
  QString help; ///< a sentence or two
  Group group = Group::basic;
  std::variant<Integer, Number, Choice, File> kind;
  /// Whether it makes a difference, the others being as they are.
  std::function<bool(const GenerateSettings&)> applies;
};

/// All of them, in the order in which they are shown.
const std::vector<GenerateOption>& generate_options();

/// "Mean value" of "mean_value"; empty: no such kind.
QString label_of_coordinates(const QString& name);
QString label_of_coordinates(const CoordinateSettings& settings);
/// The kinds that the settings name, with their numbers; the second where `painted` says so.
CoordinateChoice coordinate_choice(const GenerateSettings& settings,
                                   SharedShares painted = nullptr);
/// The other way round, but for what is painted.
void take_coordinates(const CoordinateChoice& bound, GenerateSettings& settings);

QJsonObject to_json(const GenerateSettings& settings);
/// What is missing, of the wrong kind or out of range keeps its default.
GenerateSettings generate_settings_from_json(const QJsonObject& json);

} // namespace cagewright::app
