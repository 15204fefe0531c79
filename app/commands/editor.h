/// \file
/// All edits of a document: each is a step that undo takes back.
#pragma once

#include "app/commands/live_check.h"
#include "app/document/document.h"

#include <QObject>
#include <QString>
#include <QUndoStack>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

/// What panels and tools use to change a document.
///
/// Drags are previewed and become one step:
///
///     editor.begin_move(vertices);
///     editor.move_to(positions);    // for each movement of the mouse
///     editor.end_move("Move");      // or cancel_move()
class Editor final : public QObject {
  Q_OBJECT

public:
  explicit Editor(Document& document, QObject* parent = nullptr);
  ~Editor() override;

  [[nodiscard]] Document& document() { return document_; }
  [[nodiscard]] QUndoStack& undo_stack() { return undo_stack_; }
  [[nodiscard]] const QUndoStack& undo_stack() const { return undo_stack_; }

  // ---- Moving cage vertices

  /// Starts to move these vertices (ascending). Where something else than the edited pose is shown
  /// (blending, playing), that becomes the pose first.
  void begin_move(std::vector<Index> vertices);
  /// Puts the vertices of begin_move() there: one position for each. In refine mode the faces that
  /// are wrong there are known at once; with stop_at_contact the vertices stop on the way from
  /// where they are now where the cage would become invalid.
  void move_to(std::span<const Vec3> positions);
  /// Makes the movement a step of undo, if there was any.
  void end_move(const QString& text);
  /// Puts everything back.
  void cancel_move();
  [[nodiscard]] bool moving() const { return move_.has_value(); }

  /// A movement in one step, as by numbers that are typed.
  void move(std::vector<Index> vertices, std::span<const Vec3> positions, const QString& text);

  // ---- Several changes as one step

  /// What is changed from now on becomes one step of undo by end_step(), or is taken back by
  /// cancel_step().
  void begin_step();
  void end_step(const QString& text);
  void cancel_step();

  // ---- The cage as a whole

  /// Another selection; what is hidden stays out of it.
  void select(Selection selection);
  /// Puts these faces (ascending) out of sight, and all others in sight.
  void hide_faces(std::vector<Index> faces, const QString& text);
  /// Another cage, to be refined; with the stages it was made from, or the present ones.
  void replace_cage(std::shared_ptr<const PolygonMesh> cage,
                    std::shared_ptr<const BoxDecomposition> stages, const QString& text);
  /// The same, for another part of the model.
  void replace_cage(std::shared_ptr<const PolygonMesh> cage,
                    std::shared_ptr<const BoxDecomposition> stages,
                    std::shared_ptr<const Region> region, const QString& text);
  /// The cage after an edit of its topology, in refine mode: vertices and faces as they come. Poses
  /// and keyframes, which fit the old one, go.
  void edit_topology(PolygonMesh cage, Selection selection, const QString& text);
  /// The same vertices otherwise, in refine mode: turned faces, or all positions p at map(p). Poses
  /// and keyframes go along.
  void adjust_cage(std::shared_ptr<const PolygonMesh> cage,
                   const std::function<Vec3(const Vec3&)>& map, const QString& text);
  /// To deform mode: `rest` is the cage that the binding was made for, with the topology of the
  /// present one. Poses and keyframes keep what they move from the rest, wherever that is now.
  void bind(std::shared_ptr<const Binding> binding, std::shared_ptr<const PolygonMesh> rest);
  /// The same cage and model, bound by another kind of coordinates: the pose stays.
  void bind_anew(std::shared_ptr<const Binding> binding);
  /// What is bound follows what was painted: no step of its own. Steps before and after have the
  /// new binding, too, or each stroke of a brush would keep weights of its own; whoever comes back
  /// to one binds anew.
  void renew_binding(const std::shared_ptr<const Binding>& binding);
  /// Back to refine mode, with the cage at rest. Poses and keyframes stay while the topology does;
  /// a deformation that is none of them becomes the pose "Last pose".
  void refine();

  // ---- Poses, in deform mode

  /// Whether the cage is deformed as no pose and no keyframe has it.
  [[nodiscard]] bool deformation_is_unkept() const;

  void reset_pose();
  void add_pose(const QString& name);
  void remove_pose(std::size_t pose);
  void rename_pose(std::size_t pose, const QString& name);
  /// The cage as it is becomes the pose.
  void update_pose(std::size_t pose);
  /// The cage takes the pose.
  void apply_pose(std::size_t pose);

  /// So much of a pose is in the cage from now on: what the pose moves from the rest is added so
  /// often, whatever else moved the cage. In begin_mix() and end_mix() one step of undo.
  void mix_pose(std::size_t pose, double share);
  void begin_mix();
  void end_mix();

  /// The points by which the model is dragged.
  void set_pins(std::vector<Pin> pins, const QString& text);
  /// What of the model the cage is for; null: all of it.
  void set_region(std::shared_ptr<const Region> region, const QString& text);
  /// Where the cage is to be finer; null: nowhere.
  void set_density(SharedDensity density, const QString& text);
  /// What is painted for another kind of coordinates: its pins go, which have weights of before.
  void set_mix(SharedShares mix, const QString& text);

  void set_keyframe(int frame);
  void remove_keyframe(int frame);
  void set_time_line(TimeLine time_line, const QString& text);

  /// All that undo brings back at once.
  void change(State state, const QString& text);

Q_SIGNALS:
  /// A drag stopped short, or something could not be done: for the status bar.
  void message(const QString& text);

private:
  /// What is to be said of poses and keyframes when another cage takes their place, or nothing.
  [[nodiscard]] QString lost_poses() const;
  /// What stays when the cage becomes another.
  [[nodiscard]] State without_cage() const;
  [[nodiscard]] QString free_pose_name(const QString& name) const;

  struct Move {
    std::vector<Index> vertices;
    State before;
    Shown shown_before;
  };
  struct Step {
    State before;
    Shown shown_before;
  };

  Document& document_;
  QUndoStack undo_stack_;
  std::optional<Move> move_;
  std::optional<Step> step_;
  LiveCheck live_check_;
};

} // namespace cagewright::app
