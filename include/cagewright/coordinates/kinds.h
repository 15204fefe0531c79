/// \file
/// All kinds of coordinates by name, with what each is good for and the options it has.
#pragma once

#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

class CoordinateSettings;

/// A number or one of some words that a kind of coordinates can be given. Kinds that share an
/// option share its declaration.
struct CoordinateOption {
  std::string_view name; ///< "poisson-ratio"
  std::string_view help;
  double initial = 0; ///< of words: which of them
  double least = 0;
  double most = 0;
  std::span<const std::string_view> words = {}; ///< empty: a number
  /// It changes how a bound model follows its cage, not the weights.
  bool while_posing = false;
};

/// A kind of coordinates, in words for people.
struct CoordinateKind {
  std::string_view name; ///< "mean_value"
  std::string_view idea; ///< a sentence
  std::string_view quads, sign, reproduces, on_cage, outside, locality, made_by, cost;
  std::span<const CoordinateOption* const> options;
  /// A cage ready for computing weights. Errors: invalid_cage, cancelled.
  Result<std::shared_ptr<const Coordinates>> (*prepare)(const PolygonMesh& cage,
                                                        const CoordinateSettings& settings,
                                                        const Progress& progress) = nullptr;
  /// How weights that were computed before are applied: quick. Errors: invalid_cage.
  Result<std::shared_ptr<const ColumnRule>> (*rule)(const PolygonMesh& cage,
                                                    const CoordinateSettings& settings) = nullptr;
};

/// All of them; the first is what is meant where nothing is said.
std::span<const CoordinateKind* const> coordinate_kinds();

/// The kind of that name; null: there is none.
const CoordinateKind* find_coordinate_kind(std::string_view name);

/// "mean_value, green, ...".
std::string names_of_coordinate_kinds();

/// All options of all kinds, each once.
std::vector<const CoordinateOption*> coordinate_options();

/// A kind, and values for its options.
class CoordinateSettings {
public:
  /// The first kind, as it is by itself.
  CoordinateSettings();
  explicit CoordinateSettings(const CoordinateKind& kind);

  /// By names, as people write them and name() does. Errors: invalid_option (no such kind; see
  /// set()).
  static Result<CoordinateSettings> of(std::string_view kind);
  /// Those that text() has written. Errors: invalid_option.
  static Result<CoordinateSettings> parse(std::string_view kind, std::string_view text);

  [[nodiscard]] const CoordinateKind& kind() const { return *kind_; }
  /// Whether the kind has an option of this name, or what it is mixed with does.
  [[nodiscard]] bool has(std::string_view option) const;

  /// The kind with which this one is mixed by a share for each point; null: none. See mixed.h.
  [[nodiscard]] const CoordinateSettings* mixed() const { return mixed_.get(); }
  void mix_with(CoordinateSettings other);

  /// "harmonic", or "harmonic+green" of two that are mixed.
  [[nodiscard]] std::string name() const;

  /// The value of an option that the kind has.
  [[nodiscard]] double number(const CoordinateOption& option) const;
  [[nodiscard]] std::size_t choice(const CoordinateOption& option) const;

  /// Of two kinds that are mixed, both take it, as far as they have it.
  /// Errors: invalid_option: the kind has no such option, or the value is not allowed; both with
  /// what is.
  Status set(std::string_view option, std::string_view value);

  /// "quads=center outside=error": all options, so that later defaults do not matter; those of a
  /// second kind follow after " + ".
  [[nodiscard]] std::string text() const;

  /// Whether weights made with the one are good for the other: all but options for posing agree.
  [[nodiscard]] bool same_weights(const CoordinateSettings& other) const;

  /// Accept a cage with open edges where the kind makes sense of it.
  bool allow_open = false;

private:
  [[nodiscard]] std::optional<std::size_t> find(std::string_view option) const;

  const CoordinateKind* kind_;
  std::vector<double> values_; // in the order of the kind's options
  std::shared_ptr<const CoordinateSettings> mixed_;
};

/// The cage prepared for the kind that the settings name.
/// Errors: invalid_cage, cancelled, invalid_option (two kinds that are mixed: see prepare_mixed()).
Result<std::shared_ptr<const Coordinates>>
prepare_coordinates(const PolygonMesh& cage, const CoordinateSettings& settings = {},
                    const Progress& progress = {});

/// How weights that were computed before with these settings are applied: quick.
/// Errors: invalid_cage, invalid_option (kinds that cannot be mixed).
Result<std::shared_ptr<const ColumnRule>> coordinate_rule(const PolygonMesh& cage,
                                                          const CoordinateSettings& settings);

/// What a value of an option may be: "center|diagonal", "0 to 0.499".
std::string values_of(const CoordinateOption& option);

/// The value that it has by itself: "center", "0.3".
std::string initial_text(const CoordinateOption& option);

// Options that several kinds share.
extern const CoordinateOption quads_option;    ///< which QuadTreatment
extern const CoordinateOption outside_option;  ///< which OutsideTreatment
extern const CoordinateOption accuracy_option; ///< of kinds that are not in closed form

} // namespace cagewright
