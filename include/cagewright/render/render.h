/// \file
/// Pictures of models and cages, made without a display.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/render/camera.h>
#include <cagewright/render/image.h>
#include <cagewright/render/palette.h>

#include <memory>
#include <span>
#include <vector>

namespace cagewright {

/// A mesh in a picture. The mesh and the colours are someone else's and outlive the call.
struct Layer {
  enum class Style {
    solid, ///< an opaque surface, smooth up to its creases
    cage,  ///< translucent faces, the sides of the polygons as lines, the vertices as dots
  };

  const PolygonMesh* mesh = nullptr;
  Style style = Style::solid;
  Rgb color = {0.80F, 0.735F, 0.66F};
  bool color_by_group = false;             ///< a colour of its own for each group of the mesh
  std::span<const Rgb> vertex_colors = {}; ///< V colours instead of one, or none; for solids

  static Layer model(const PolygonMesh& mesh) { return {.mesh = &mesh}; }
  static Layer cage(const PolygonMesh& mesh) {
    return {.mesh = &mesh, .style = Style::cage, .color = {0.13F, 0.40F, 0.86F}};
  }
};

struct Scene {
  std::vector<Layer> layers;
};

enum class Background { gradient, white, transparent };

/// Lengths in pixels are those of the finished picture.
struct RenderOptions {
  int width = 1200; ///< of each view
  int height = 900;
  View view;
  UpAxis up = UpAxis::y;
  Background background = Background::gradient;
  double angle_degrees = 24;     ///< height of the angle of view; in [1, 120]
  double margin = 0.04;          ///< free at each side, fraction of the picture; in [0, 0.4]
  double crease_degrees = 45;    ///< edges that bend more stay sharp
  bool ambient_occlusion = true; ///< darkens folds and corners
  bool shadows = true;           ///< of the main light, on the model and the ground
  bool model_edges = false;      ///< the sides of the polygons of solids, as fine lines
  bool cage_faces = true;        ///< else only lines and dots
  double cage_opacity = 0.16;    ///< of faces seen head-on; in [0, 1]
  double edge_width = 2.2;       ///< of the cage's lines, pixels
  double vertex_radius = 3.4;    ///< of the cage's dots, pixels; 0: no dots
  double least_bend_degrees = 0; ///< sides of the cage that bend less are not drawn
  int samples = 3; ///< each pixel is the mean of samples * samples, fewer if that is too many;
                   ///< in [1, 4]
};

/// Keeps what drawing needs (an OpenGL context and programs) for many pictures. A renderer may be
/// used from any thread, by one at a time.
class Renderer {
public:
  /// Errors: not_available, with what to install.
  static Result<Renderer> create();

  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Draws the scene, framed so that all of it is seen. The same scene gives the same picture on
  /// the same machine; drivers differ in the last bits. Models may be of any size and anywhere.
  ///
  /// Errors: invalid_option; unfit_model (nothing to draw, or a coordinate that is not finite);
  /// too_large (more pixels than the driver can hold).
  /// Cost: on a processor without a graphics card some 0.7 s for the default size, and 0.5 s more
  /// for each million triangles.
  Result<Image> render(const Scene& scene, const RenderOptions& options = {});

  /// The same from several sides, at one scale, as pictures side by side.
  Result<Image> render(const Scene& scene, std::span<const View> views,
                       const RenderOptions& options = {});

private:
  struct Programs;
  explicit Renderer(std::unique_ptr<Programs> programs);
  std::unique_ptr<Programs> programs_;
};

/// One picture with a renderer of its own.
Result<Image> render(const Scene& scene, const RenderOptions& options = {});

} // namespace cagewright
