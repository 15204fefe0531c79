/// \file
/// Draws the model. Private to canvas.cpp.
#pragma once

#include "app/view/canvas.h"
#include "app/view/gl_stream.h"

#include <cstdint>
#include <vector>

namespace cagewright::app {

class ModelPainter {
public:
  /// Errors: not_available, when the driver refuses a shader.
  static Result<ModelPainter> create();

  /// See Canvas. Positions are those of the graphics card.
  void set_triangles(std::span<const Triangle> triangles, std::span<const Triangle> coarse);
  void move(std::vector<Eigen::Vector3f> positions, std::span<const Vec3> normals);
  void set_colors(std::span<const Color> colors);
  void set_texture(std::span<const std::array<float, 2>> points,
                   std::span<const std::array<float, 4>> places, const Picture& picture);

  [[nodiscard]] bool empty() const { return corners_ == 0; }
  [[nodiscard]] bool has_coarse() const { return coarse_corners_ > 0; }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }

  void draw(const CanvasView& view) const;
  void draw_wireframe(const CanvasView& view);

private:
  void make_edges();

  gl::Program model_, wire_;
  gl::VertexArray array_, coarse_array_, wire_array_;
  StreamBuffer positions_, normals_, colors_, indices_, coarse_indices_, edges_;
  StreamBuffer texture_points_, texture_places_;
  gl::Texture texture_;
  int texture_width_ = 0; // 0: none
  int texture_height_ = 0;
  GLsizei corners_ = 0;
  GLsizei coarse_corners_ = 0;
  GLsizei edge_ends_ = 0;
  bool has_edges_ = false;
  bool has_colors_ = false;
  std::size_t vertices_ = 0;
  std::vector<Triangle> triangles_; // for the edges, when they are asked for
  std::vector<std::uint32_t> normal_bits_;
};

} // namespace cagewright::app
