/// \file
/// The window onto model and cage.
#pragma once

#include "app/commands/cage_actions.h"
#include "app/commands/editor.h"
#include "app/edit/cage_pull.h"
#include "app/edit/density_brush.h"
#include "app/edit/edit_cage.h"
#include "app/edit/gizmo.h"
#include "app/edit/orbit_camera.h"
#include "app/edit/outlined_faces.h"
#include "app/edit/pick.h"
#include "app/edit/transform_drag.h"
#include "app/view/canvas.h"
#include "app/view/key_map.h"
#include "app/view/scene_marks.h"

#include <QImage>
#include <QJsonObject>
#include <QOpenGLWidget>
#include <QTimer>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright::app {

/// Draws the document and lets the mouse edit it.
///
/// What the buttons do to the camera is the key map's: see key_map.h. Left button: select by a
/// click, a box or (Ctrl) a lasso; drag the gizmo, a vertex or an edge. A click with the right one
/// asks for a menu. Keys are those of Blender, but for what the key map changes: see
/// keyPressEvent().
class Viewport : public QOpenGLWidget {
  Q_OBJECT

public:
  explicit Viewport(Editor& editor, QWidget* parent = nullptr);
  ~Viewport() override;

  /// front, back, left, right, top, bottom, three-quarter.
  void set_standard_view(const QString& name);
  void set_orthographic(bool orthographic);
  [[nodiscard]] bool orthographic() const { return !camera_.is_perspective(); }
  /// Which axis of the model points up on the screen.
  void set_up_axis(UpAxis up);
  [[nodiscard]] UpAxis up_axis() const { return camera_.up(); }
  /// Brings everything, or only the selection, into view.
  void frame_all();
  void frame_selection();
  /// Brings a point and what is round it into view.
  void frame_place(const Vec3& place);

  /// The camera, for the project file.
  [[nodiscard]] QJsonObject camera_state() const;
  void set_camera_state(const QJsonObject& state);

  /// The picture at any size, without gizmo and hints.
  [[nodiscard]] QImage picture(const QSize& size);

  void set_dark(bool dark);
  void set_key_map(KeyMap map) { key_map_ = map; }
  [[nodiscard]] KeyMap key_map() const { return key_map_; }
  /// Whether the wheel zooms the other way.
  void set_wheel_reversed(bool reversed) { wheel_reversed_ = reversed; }
  /// Whether large models are drawn with fewer triangles while they or the camera move, if drawing
  /// them takes long.
  void set_coarse_while_moving(bool on);
  [[nodiscard]] bool coarse_while_moving() const { return coarse_while_moving_; }

  [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
  /// Where the gizmo stands, while there is one.
  [[nodiscard]] std::optional<GizmoFrame> gizmo() const;
  /// A transformation is being made by the mouse or by keys.
  [[nodiscard]] bool transforming() const { return drag_.is_active(); }
  /// Starts one as by a key, with the mouse where it is.
  void begin_transform(TransformKind kind, Handle handle = Handle::none);
  /// Extrudes the selected faces, and goes on with moving them along their normal: one step of
  /// undo, and none if it is cancelled.
  void extrude();
  /// Cuts a ring of quads: the one of the edge under the pointer, until a click; the wheel says how
  /// often. Then the loops slide, until another.
  void begin_loop_cut();
  [[nodiscard]] bool cutting_loops() const { return loop_cut_.has_value(); }
  /// Makes the picture as fine as it gets, however long that takes.
  void finish_picture();
  /// What draws it, once it has been shown; null: not yet, or OpenGL refuses.
  [[nodiscard]] Canvas* canvas() { return canvas_.get(); }
  /// Takes all pins of the model away, by which it is dragged.
  void remove_pins();
  /// Takes away what was painted.
  void clear_density();
  void clear_mix();

Q_SIGNALS:
  void cameraChanged();
  void regionPainted(const std::vector<Index>& faces); ///< of the model, ascending
  /// What of the model is within is painted as a whole, or erased.
  void regionOutlined(const cagewright::app::ScreenOutline& outline, bool erases);
  void menuRequested(const QPoint& at); ///< of what can be done there
  void hint(const QString& text);       ///< what the mouse would do here: for the status bar

protected:
  void initializeGL() override;
  void paintGL() override;
  void resizeGL(int width, int height) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  bool event(QEvent* event) override;

private:
  enum class Gesture { none, orbit, pan, zoom, press, box, lasso, transform, pull, paint };
  struct Press {
    Pixel at = Pixel::Zero();
    Qt::KeyboardModifiers modifiers;
    std::optional<Pick> pick;
  };
  struct LoopCut {
    std::optional<EdgeVertices> edge; ///< of the ring
    int cuts = 1;
    double slide = 0;
    bool slides = false;                      ///< the ring is chosen
    Pixel from = Pixel::Zero();               ///< where sliding began
    std::vector<std::pair<Vec3, Vec3>> lines; ///< to be drawn
  };
  struct Pull { ///< of the model by one of its pins
    CagePull solver;
    std::size_t pin = 0;
    bool is_new = false;
    bool moves = false;
    Pixel pressed = Pixel::Zero();
    Pixel offset = Pixel::Zero(); ///< from the pointer to the pin
    Vec3 from = Vec3::Zero();
    std::vector<Vec3> cage;    ///< where it began
    std::vector<Vec3> targets; ///< of all pins
  };
  struct Stroke {
    Tool tool = Tool::paint;
    bool chooses = false; ///< the region; then `density` is above 0 there
    bool erases = false;
    bool painted = false; ///< it has met the model
    double sign = 1;
    Pixel last = Pixel::Zero(); ///< where the last dab was
    std::vector<float> density;
  };
  struct Dirty {
    bool model = true;
    bool positions = false;
    bool edges = true;
    bool colors = true;
    bool voxels = true;
    bool frame = true;
  };

  // What is drawn
  void upload();
  void upload_surface();
  [[nodiscard]] Index drawn_vertices() const;
  void paint_names_beside(QPainter& painter) const;
  [[nodiscard]] bool wears_dress() const;
  [[nodiscard]] std::vector<Color> model_colors() const;
  [[nodiscard]] std::vector<Color> region_colors() const;
  void something_moves();
  [[nodiscard]] bool draws_coarsely() const;
  [[nodiscard]] bool is_still() const;
  void improve_picture();
  [[nodiscard]] Box3 scene_box() const;
  [[nodiscard]] Marks make_marks();
  [[nodiscard]] Overlay make_overlay() const;
  [[nodiscard]] CanvasView canvas_view(int width, int height, double ratio) const;
  void paint_texts(QPainter& painter) const;
  void paint_legend(QPainter& painter) const;
  [[nodiscard]] PolygonMesh shown_cage() const;
  void refresh_graph();
  [[nodiscard]] const Picker& picker();
  void camera_moved();
  void model_changed();

  // The mouse
  void begin_camera_move(CameraMove move);
  void click(const Press& press);
  void finish_outline(Qt::KeyboardModifiers modifiers);
  void forget_outline();
  void hover(const Pixel& cursor);
  void forget_hover();
  /// The pointer says what a press would do, or what it does.
  void update_cursor();
  [[nodiscard]] std::vector<Pixel> outline() const;
  /// Outlines are round what the cage is for, not round parts of the cage.
  [[nodiscard]] bool outlines_region() const;
  /// The tool is a brush, and may be used on the model as it is.
  [[nodiscard]] bool paints_here() const;
  [[nodiscard]] PickOptions pick_options() const;
  [[nodiscard]] Selection selection_of(const Pick& pick) const;

  // Loop cuts
  void aim_loop_cut();
  void preview_loop_cut();
  [[nodiscard]] Result<EditedCage> loop_cut_result();
  void slide_loop_cut();
  void add_loop_cuts(int more);
  void confirm_loop_cut();
  void end_loop_cut();
  bool loop_cut_key(QKeyEvent* event);
  bool loop_cut_press(Qt::MouseButton button);

  // Dragging the model
  [[nodiscard]] std::optional<std::size_t> pin_at(const Pixel& cursor) const;
  [[nodiscard]] std::optional<Pin> new_pin(const Pixel& cursor) const;
  bool pull_press(const Qt::KeyboardModifiers& modifiers);
  void pull_move();
  void end_pull(bool keep);

  // Painting
  [[nodiscard]] std::optional<Dab> dab_at(const Pixel& cursor) const;
  bool paint_press(const Qt::KeyboardModifiers& modifiers);
  void add_dabs(bool first);
  void show_stroke();
  void end_stroke(bool keep);

  // Transformations
  [[nodiscard]] TransformKind tool_kind() const;
  [[nodiscard]] bool has_gizmo_tool() const;
  void apply_drag();
  void end_drag();
  bool drag_key(QKeyEvent* event);
  bool camera_key(QKeyEvent* event);
  bool edit_key(QKeyEvent* event);
  bool maya_key(QKeyEvent* event);
  void update_caption();

  Editor& editor_;
  Document& document_;
  OrbitCamera camera_;
  ViewColors colors_ = ViewColors::light();
  bool framed_ = false; // something was framed since the viewport was empty

  std::unique_ptr<Canvas> canvas_;
  QString failure_; // of OpenGL
  Dirty dirty_;
  Layers layers_before_; // what the last change of layers changed
  Tool tool_before_ = Tool::translate;
  bool shows_beside_ = false;
  bool beside_framed_ = false; // what is beside the model was brought into view
  bool dressed_ = false;       // what the canvas has is the model's dress
  bool with_texts_ = true;
  bool coarse_while_moving_ = true;
  QTimer rest_;    // runs while something moves, and a moment longer
  QTimer improve_; // until a piece of a better picture is made

  CageGraph graph_;
  bool graph_is_stale_ = true;
  std::optional<Picker> picker_;

  KeyMap key_map_ = KeyMap::blender;
  bool wheel_reversed_ = false;
  Gesture gesture_ = Gesture::none;
  std::optional<Pixel> menu_press_; // of the right button, while it may become a click
  bool box_armed_ = false;          // by the key B
  Press press_;
  Pixel cursor_ = Pixel::Zero();
  std::vector<Pixel> lasso_;
  std::optional<Pick> hovered_;
  Handle hovered_handle_ = Handle::none;

  TransformDrag drag_;
  TransformTarget target_;
  std::vector<Index> moving_; // the vertices handed to the editor
  QString step_title_;        // of a step that the drag is the end of, or empty
  std::optional<LoopCut> loop_cut_;
  std::optional<Pull> pull_;
  std::optional<Stroke> stroke_;
  QString caption_;
};

} // namespace cagewright::app
