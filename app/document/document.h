/// \file
/// What is open: model, cage, binding, poses, and what is shown of them. No widgets.
#pragma once

#include "app/document/deformed_model.h"
#include "app/document/layers.h"
#include "app/document/model.h"
#include "app/document/region.h"
#include "app/document/state.h"
#include "app/edit/selection.h"
#include "app/edit/tool_settings.h"
#include <cagewright/deform/following.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <QObject>
#include <QString>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

/// What is known about the cage's validity.
struct CageCheck {
  enum class State { unknown, checking, done };
  State state = State::unknown;
  std::shared_ptr<const ValidityReport> report; ///< the last complete one; may be of an older cage
};

/// Which of the states between which one can look is shown.
struct Shown {
  double blend = 1;
  std::optional<double> time = {};
  friend bool operator==(const Shown&, const Shown&) = default;
};

/// One document of the application.
///
/// Views read it and listen to its signals. What is undoable (State) is changed through Editor
/// (app/commands/editor.h) only; the set_ functions below it are for Editor, jobs and loading. All
/// of it lives on the GUI thread.
class Document final : public QObject {
  Q_OBJECT

public:
  explicit Document(QObject* parent = nullptr);
  ~Document() override;

  // ---- The model

  [[nodiscard]] bool has_model() const { return model_ != nullptr; }
  /// With has_model(). Share it with jobs.
  [[nodiscard]] const std::shared_ptr<const Model>& model() const { return model_; }
  /// The model with what of it the cage is for. Share it with jobs.
  [[nodiscard]] CagedModel caged() const { return {model_, state_.region}; }
  /// V positions and normals as shown: deformed when bound, else at rest. Valid until the next
  /// modelMoved() or modelChanged().
  [[nodiscard]] std::span<const Vec3> model_positions() const;
  [[nodiscard]] std::span<const Vec3> model_normals() const;
  /// T triangles; they change with modelChanged() only.
  [[nodiscard]] std::span<const Triangle> model_triangles() const;
  /// Model::coarse.
  [[nodiscard]] std::span<const Triangle> coarse_triangles() const;
  /// The unit of all tolerances and tools: the model's diagonal, the cage's without a model, 1
  /// without either.
  [[nodiscard]] double diagonal() const;
  /// Of model and cage as shown; empty without either.
  [[nodiscard]] Box3 bounds() const;

  // ---- The cage

  [[nodiscard]] bool has_cage() const { return state_.rest != nullptr; }
  /// Topology, and positions at rest: with has_cage(). In refine mode the positions that count are
  /// cage_positions().
  [[nodiscard]] const PolygonMesh& cage_rest() const { return *state_.rest; }
  /// C positions as edited: the rest in refine mode, the pose in deform mode.
  [[nodiscard]] std::span<const Vec3> cage_positions() const;
  /// C positions as shown: another than the edited pose while comparing, blending or playing.
  [[nodiscard]] std::span<const Vec3> shown_cage_positions() const;
  /// The cage with cage_positions().
  [[nodiscard]] PolygonMesh cage() const;

  /// How much of each pose is in the cage as shown.
  [[nodiscard]] std::vector<double> shown_pose_shares() const;
  /// Where a pin is as shown.
  [[nodiscard]] Vec3 place_of(const Pin& pin) const;

  [[nodiscard]] Mode mode() const { return state_.binding ? Mode::deform : Mode::refine; }
  [[nodiscard]] const Selection& selection() const { return state_.selection; }
  [[nodiscard]] const State& state() const { return state_; }

  // ---- What is known of it

  /// How the model was split; null: not made yet.
  [[nodiscard]] const std::shared_ptr<const BoxDecomposition>& stages() const {
    return state_.stages;
  }
  /// Depth of the deepest box; 0 without stages.
  [[nodiscard]] int stage_depth() const;
  [[nodiscard]] const CageCheck& check() const { return check_; }
  /// Faces of the cage that are wrong where they are now, ascending: known at once while dragging,
  /// completed by the check. To be drawn red.
  [[nodiscard]] std::span<const Index> offending_faces() const { return offending_faces_; }
  [[nodiscard]] const std::optional<CageMetrics>& metrics() const { return metrics_; }
  /// C distances from the cage's vertices to the model at rest, fractions of the diagonal; empty
  /// unless Layers::distance.
  [[nodiscard]] std::span<const float> cage_distances() const { return cage_distances_; }
  /// V sums of the weights of the selected cage vertices; empty unless Layers::weights, bound and
  /// something selected. Mostly in [0, 1], may be negative.
  [[nodiscard]] std::span<const float> model_weights() const { return model_weights_; }

  // ---- How it is shown

  [[nodiscard]] const Layers& layers() const { return layers_; }
  void set_layers(const Layers& layers);
  [[nodiscard]] const ToolSettings& tools() const { return tools_; }
  void set_tools(const ToolSettings& tools);

  /// Shows the rest instead of the pose, while a key is held.
  void set_comparing(bool comparing);
  [[nodiscard]] bool comparing() const { return comparing_; }
  /// Shows the way from the rest (0) to the pose (1).
  void set_blend(double blend);
  [[nodiscard]] double blend() const { return blend_; }
  /// Goes to a frame (not necessarily whole) and shows the time line there; nothing: shows the
  /// edited pose, and stays at the frame.
  void set_time(std::optional<double> frame);
  [[nodiscard]] const std::optional<double>& time() const { return time_; }
  /// The frame it stands at, whatever is shown: keyframes are set there.
  [[nodiscard]] double frame() const { return frame_; }
  /// blend() and time(), to come back to what was seen.
  [[nodiscard]] Shown shown() const { return {blend_, time_}; }
  void set_shown(const Shown& shown);
  /// Makes what is shown what is edited, so that a drag begins with what the user sees.
  void adopt_shown_cage();

  // ---- The same pose by other coordinates, to compare with: it is only looked at

  /// Null: nothing is compared.
  [[nodiscard]] const std::shared_ptr<const Binding>& beside() const { return beside_; }
  /// Null as long as there is nothing to show. Of as many vertices as the model.
  [[nodiscard]] const std::shared_ptr<const DeformedModel>& deformed_beside() const {
    return deformed_beside_;
  }
  /// How far from the model it is shown.
  [[nodiscard]] Vec3 way_beside() const;

  // ---- For Editor, jobs and loading

  /// Another model; the cage and all that hangs on it goes.
  void set_model(std::shared_ptr<const Model> model);
  /// Replaces all that is undoable; emits what differs. The selection is cut to what exists.
  void set_state(const State& state);
  /// Moves cage vertices without a step of undo.
  void move_cage(std::span<const Index> vertices, std::span<const Vec3> to);
  void set_stages(std::shared_ptr<const BoxDecomposition> stages);
  void set_check(CageCheck check);
  void set_offending_faces(std::vector<Index> faces);
  void set_metrics(std::optional<CageMetrics> metrics);
  /// Null: the model is as it was read.
  [[nodiscard]] const std::shared_ptr<const DeformedModel>& deformed() const { return deformed_; }
  /// What became of the surface of the bound model, when it came to rest last; none: not known yet,
  /// or not bound.
  [[nodiscard]] const std::optional<DeformedFigures>& following() const { return following_; }
  void set_following(std::optional<DeformedFigures> figures);
  /// \param beside  as beside() moves it, or null
  void set_deformed(std::shared_ptr<const DeformedModel> deformed,
                    std::shared_ptr<const DeformedModel> beside = nullptr);
  void set_beside(std::shared_ptr<const Binding> binding);
  void set_density(SharedDensity density);
  /// As it is while it is painted: mixChanged() comes when that is over.
  void show_mix(SharedShares mix);
  /// What is painted for another kind of coordinates, as shown; null: nothing.
  [[nodiscard]] const SharedShares& shown_mix() const { return painting_ ? painting_ : state_.mix; }
  void set_cage_distances(std::vector<float> distances);
  void set_model_weights(std::vector<float> weights);

Q_SIGNALS:
  void modelChanged();  ///< another model: everything of it
  void besideChanged(); ///< beside()
  void modelMoved();    ///< model_positions() and model_normals()
  void cageChanged();   ///< topology of the cage, or no cage any more; positions too
  void cageMoved();     ///< cage_positions() or shown_cage_positions(), nothing else
  void selectionChanged();
  void regionChanged(); ///< what of the model the cage is for
  void hiddenChanged(); ///< State::hidden_faces
  void modeChanged();
  void stagesChanged();
  void checkChanged(); ///< check() or offending_faces()
  void metricsChanged();
  void followingChanged();
  void colorsChanged();  ///< cage_distances(), model_weights() or State::density
  void densityChanged(); ///< State::density
  void mixChanged();     ///< State::mix
  void pinsChanged();    ///< State::pins
  void layersChanged();
  void toolsChanged();
  void posesChanged();
  void timeLineChanged();  ///< keyframes or range
  void viewStateChanged(); ///< comparing(), blend(), time() or frame()

private:
  void update_shown();

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const DeformedModel> deformed_; // null: at rest
  std::shared_ptr<const Binding> beside_;
  std::shared_ptr<const DeformedModel> deformed_beside_;
  State state_;
  std::shared_ptr<const std::vector<Vec3>> shown_; // null: state_.cage
  CageCheck check_;
  std::vector<Index> offending_faces_;
  std::optional<CageMetrics> metrics_;
  std::optional<DeformedFigures> following_;
  std::vector<float> cage_distances_;
  std::vector<float> model_weights_;
  Layers layers_;
  ToolSettings tools_;
  bool comparing_ = false;
  double blend_ = 1;
  std::optional<double> time_;
  double frame_ = 1;
  SharedShares painting_; // null: State::mix
};

} // namespace cagewright::app
