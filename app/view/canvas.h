/// \file
/// Draws the viewport with OpenGL 3.3: a model, translucent faces, lines and dots. Knows neither Qt
/// nor the document. Needs a current context in every function, and where it is destroyed.
#pragma once

#include "app/edit/surface_look.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/render/palette.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace cagewright::app {

/// Red, green, blue, opacity; sRGB.
using Color = std::array<std::uint8_t, 4>;

Color color_of(const Rgb& rgb, double opacity = 1);
Color faded(Color color, double opacity);

struct LineMark {
  Vec3 begin, end;
  Color color;
  float width = 1.5F; ///< logical pixels
};

struct DotMark {
  Vec3 position;
  Color color;
  float radius = 3; ///< logical pixels
};

struct FaceMark {
  std::array<Vec3, 3> corners;
  std::array<Color, 3> colors;
};

/// What is drawn besides the model, in the model's coordinates.
struct Marks {
  std::vector<FaceMark> faces;  ///< translucent, in any order
  std::vector<LineMark> lines;  ///< hidden by the model, then faint
  std::vector<DotMark> dots;    ///< likewise
  std::vector<LineMark> ground; ///< hidden by the model altogether
};

/// What is drawn last, before everything, in logical pixels (z is ignored).
struct Overlay {
  std::vector<FaceMark> faces;
  std::vector<LineMark> lines;
  std::vector<DotMark> dots;
};

/// Pixels in rows, the lowest first.
struct Picture {
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> rgba; ///< width x height x 4
};

struct CanvasView {
  /// From (p - center) * scale to clip coordinates: of OrbitCamera::clip_matrix().
  Eigen::Matrix4d clip = Eigen::Matrix4d::Identity();
  Mat3 axes = Mat3::Identity(); ///< rows: right, up, backward
  int width = 1;                ///< device pixels
  int height = 1;
  double pixel_ratio = 1; ///< device pixels in a logical one
  bool model = true;
  bool smooth = true;
  SurfaceLook look = SurfaceLook::studio;
  bool occlusion = false; ///< shade in corners, where the picture is refined
  bool wireframe = false;
  bool coarse = false; ///< the coarse triangles, if there are any, and no wireframe
  bool keep = false;   ///< the framebuffer has GL_DEPTH24_STENCIL8: the model's picture may be kept
  bool patient = false;               ///< all at once, however long it takes: see improve()
  double model_opacity_behind = 0.16; ///< of marks that the model hides
  Rgb background_top = {0.93F, 0.94F, 0.95F};
  Rgb background_bottom = {0.80F, 0.82F, 0.85F};
  Rgb model_color = {0.74F, 0.71F, 0.67F};
  Rgb wire_color = {0.15F, 0.15F, 0.17F};
};

struct MarkView;

class Canvas {
public:
  /// Errors: not_available, when the driver refuses a shader.
  static Result<std::unique_ptr<Canvas>> create();
  ~Canvas();

  /// Positions go to the graphics card as (p - center) * scale.
  void set_frame(const Vec3& center, double scale);
  [[nodiscard]] const Vec3& center() const { return center_; }
  [[nodiscard]] double scale() const { return scale_; }

  /// Another model: V positions, V unit normals, T triangles. Empty: none.
  /// \param coarse  triangles of the same vertices to draw instead while `CanvasView::coarse`
  void set_model(std::span<const Vec3> positions, std::span<const Vec3> normals,
                 std::span<const Triangle> triangles, std::span<const Triangle> coarse = {});
  /// Lines for CanvasView::wireframe, between vertices of the model that was set last.
  void set_model_edges(std::span<const std::array<Index, 2>> edges);
  /// The same triangles elsewhere.
  void move_model(std::span<const Vec3> positions, std::span<const Vec3> normals);
  /// V colours instead of one; empty: one.
  void set_model_colors(std::span<const Color> colors);

  /// A texture for the model, by which its colours are multiplied; an empty picture: none.
  /// \param points  V texture points, v upwards; they repeat beyond 0 and 1
  /// \param places  V corners and sizes of what they are points of, as fractions of the image; of
  /// no
  ///                size: no texture there
  void set_model_texture(std::span<const std::array<float, 2>> points,
                         std::span<const std::array<float, 4>> places, const Picture& picture);

  /// Opaque faces that are drawn with the model.
  void set_solids(std::vector<FaceMark> solids);

  /// Draws to the framebuffer that is bound. The picture of the model is kept, so that marks alone
  /// can change at little cost. Where a picture with all triangles takes long, the one with the
  /// coarse ones is drawn instead, and improve() makes the other.
  void draw(const CanvasView& view, const Marks& marks, const Overlay& overlay);

  /// Whether improve() has anything to do: all triangles, where coarse ones were drawn for them;
  /// then smooth outlines, and shade in corners.
  /// \param patient  however long it takes
  [[nodiscard]] bool can_improve(bool patient = false) const;
  /// Makes a piece of a better picture of what was drawn last: so much as takes a few hundredths of
  /// a second, unless `patient`. Binds another framebuffer.
  /// \returns whether there is a better picture now: draw it, the same view again
  bool improve(bool patient = false);

  /// Whether a picture of the model with all triangles takes long: as a large one's does, until it
  /// is known.
  [[nodiscard]] bool is_slow() const;
  /// Whether the picture that was drawn last has all triangles.
  [[nodiscard]] bool shows_all() const;
  /// The most triangles and edges of the model that were drawn at once since the last call.
  std::size_t take_most_at_once() { return std::exchange(most_at_once_, 0); }

private:
  struct Gl;
  struct Pieces;
  explicit Canvas(std::unique_ptr<Gl> gl);
  void draw_model(const CanvasView& view);
  bool draw_piece(const CanvasView& view, Pieces& pieces, std::size_t most);
  bool draw_timed_piece(const CanvasView& view, Pieces& pieces, bool patient);
  [[nodiscard]] bool is_kept(const CanvasView& view) const;
  bool keep_picture(const CanvasView& view);
  void draw_or_copy_model(const CanvasView& view);
  bool complete(bool patient);
  bool refine(bool patient);
  [[nodiscard]] MarkView in_space(const CanvasView& view) const;

  std::unique_ptr<Gl> gl_;
  Vec3 center_ = Vec3::Zero();
  double scale_ = 1;
  std::size_t most_at_once_ = 0;
};

} // namespace cagewright::app
