/// \file
/// What the user can choose about making a cage, in a form that panels, project files and
/// preferences share.
#pragma once

#include "cage/budget_cage.h"

#include <QJsonObject>
#include <QString>
#include <QStringList>

#include <functional>
#include <variant>
#include <vector>

namespace cagewright::app {

enum class CageMethod {
  envelope,       ///< a cage within a budget, from an envelope of voxels
  boxes,          ///< a cage within a budget, from the union of oriented boxes
  union_of_boxes, ///< that union itself
};

struct GenerateSettings {
  CageMethod method = CageMethod::envelope;
  BudgetCageOptions options = {.symmetry = cagewright::Symmetry::automatic}; ///< `start` follows
                                                                             ///< the method
};

/// One thing to choose. Numbers are shown as they are; lengths are fractions of the model's
/// diagonal.
struct GenerateOption {
  struct Integer {
    int least = 0;
    int most = 0;
    std::function<int&(GenerateSettings&)> value;
    QString at_least; ///< what to show for `least`, if it means something else: "chosen"
  };
  struct Number {
    double least = 0;
    double most = 0;
    double step = 0.01;
    int decimals = 3;
    std::function<double&(GenerateSettings&)> value;
  };
  struct Choice {
    QStringList keys;   ///< as in files
    QStringList labels; ///< as shown
    std::function<int(const GenerateSettings&)> get;
    std::function<void(GenerateSettings&, int)> set;
  };

  enum class Group { basic, boxes, budget };

  QString key; ///< as on the command line, without dashes
  QString label;
  QString help; ///< a sentence or two
  Group group = Group::basic;
  std::variant<Integer, Number, Choice> kind;
  /// Whether the method looks at it.
  std::function<bool(CageMethod)> applies;
};

/// All of them, in the order in which they are shown.
const std::vector<GenerateOption>& generate_options();

QJsonObject to_json(const GenerateSettings& settings);
/// What is missing, of the wrong kind or out of range keeps its default.
GenerateSettings generate_settings_from_json(const QJsonObject& json);

} // namespace cagewright::app
