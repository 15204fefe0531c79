/// \file
/// A transformation being made by the mouse and the keyboard, from its first event to its last.
#pragma once

#include "app/edit/gizmo.h"
#include "app/edit/orbit_camera.h"
#include "app/edit/tool_settings.h"
#include "app/edit/transform.h"

#include <array>
#include <string>

namespace cagewright::app {

/// What a drag needs to know about where it takes place.
struct DragScene {
  OrbitCamera camera;
  Vec3 pivot = Vec3::Zero();
  Mat3 local = Mat3::Identity(); ///< columns: the selection's own axes
  AxesKind axes = AxesKind::world;
  double unit = 1;         ///< the model's diagonal
  double snap_step = 0.01; ///< fraction of it
  double snap_angle_degrees = 15;
  double snap_scale = 0.1;
};

/// A transformation in the making, by a handle of the gizmo or by G, R, S as in Blender.
///
/// Keys, while it is active: x, y, z confine it to an axis, with Shift to the plane across it;
/// pressed again, to the axis of the other frame (local, or world if it was local), then set it
/// free. Digits, point and minus give the amount exactly; Tab goes to the next component, Backspace
/// takes the last key back. g, r, s change what is done; r while turning frees the turn
/// (trackball). Enter confirms, Escape cancels.
class TransformDrag {
public:
  enum class State { idle, active, confirmed, cancelled };

  static constexpr char enter = '\r';
  static constexpr char escape = '\x1b';
  static constexpr char backspace = '\b';
  static constexpr char tab = '\t';

  /// Begins at the cursor, free as by a key, or confined by a handle.
  void begin(TransformKind kind, const DragScene& scene, const Pixel& cursor,
             Handle handle = Handle::none);
  void move(const Pixel& cursor);
  /// \returns false for keys that mean nothing here
  bool key(char key, bool shift = false);
  void set_snapping(bool on) { snapping_ = on; }
  /// From now on the mouse counts for a tenth.
  void set_precise(bool on) { precise_ = on; }
  void confirm();
  void cancel();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool is_active() const { return state_ == State::active; }
  [[nodiscard]] TransformKind kind() const { return kind_; }
  /// The transformation so far; after cancelling, none.
  [[nodiscard]] Transform transform() const;
  /// What is happening, for people: "Move along local X: 0.25".
  [[nodiscard]] std::string caption() const;

  /// The frame in which it is confined, and how.
  enum class Freedom { free, axis, plane, trackball };
  [[nodiscard]] Freedom freedom() const { return freedom_; }
  [[nodiscard]] int axis() const { return axis_; } ///< the axis, or the one across the plane
  [[nodiscard]] Mat3 frame() const;                ///< columns

private:
  [[nodiscard]] int component_count() const;
  [[nodiscard]] bool is_typed() const;
  [[nodiscard]] double typed(int component) const;
  [[nodiscard]] AxesKind other_axes() const;
  void confine(int axis, bool plane);
  void restart();

  [[nodiscard]] double along_axis(const Pixel& cursor, const Vec3& axis) const;
  [[nodiscard]] Vec3 in_plane(const Pixel& cursor, const Vec3& normal) const;
  [[nodiscard]] double angle_at(const Pixel& cursor) const;
  [[nodiscard]] Vec3 rotation_axis() const;
  [[nodiscard]] double edge_on_angle() const;
  [[nodiscard]] Pixel pivot_pixel() const;

  [[nodiscard]] Vec3 mouse_shift() const;
  [[nodiscard]] Vec3 mouse_factors() const;
  [[nodiscard]] Vec3 amount() const;

  State state_ = State::idle;
  TransformKind kind_ = TransformKind::translate;
  DragScene scene_;
  Handle handle_ = Handle::none;
  Freedom freedom_ = Freedom::free;
  AxesKind axes_ = AxesKind::world; // of the confinement
  int axis_ = 0;
  int presses_ = 0; // of the same axis key
  bool snapping_ = false;
  bool precise_ = false;
  Pixel first_ = Pixel::Zero();  // the cursor when it began
  Pixel last_ = Pixel::Zero();   // when it moved last
  Pixel cursor_ = Pixel::Zero(); // where precise moves have brought it
  double angle_ = 0;             // so far, more than a full turn counts
  std::array<std::string, 3> text_;
  int component_ = 0;
};

} // namespace cagewright::app
