/// \file
/// Draws the model. Private to canvas.cpp.
#pragma once

#include "app/view/canvas.h"
#include "app/view/gl_stream.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cagewright::app {

class ModelPainter {
public:
  /// Errors: not_available, when the driver refuses a shader.
  static Result<ModelPainter> create();

  /// See Canvas. Positions are those of the graphics card.
  void set_triangles(std::span<const Triangle> triangles, std::span<const Triangle> coarse);
  void set_edges(std::span<const std::array<Index, 2>> edges);
  void move(std::vector<Eigen::Vector3f> positions, std::span<const Vec3> normals);
  void set_colors(std::span<const Color> colors);
  void set_texture(std::span<const std::array<float, 2>> points,
                   std::span<const std::array<float, 4>> places, const Picture& picture);

  [[nodiscard]] bool empty() const { return triangles_ == 0; }
  [[nodiscard]] bool has_coarse() const { return coarse_ > 0; }
  /// Of those that `view` shows.
  [[nodiscard]] std::size_t triangle_count(const CanvasView& view) const;
  [[nodiscard]] std::size_t edge_count() const { return edge_count_; }

  /// The triangles, or edges, from `first` on.
  void draw(const CanvasView& view, std::size_t first, std::size_t count) const;
  void draw_wireframe(const CanvasView& view, std::size_t first, std::size_t count) const;

private:
  gl::Program model_, wire_;
  gl::VertexArray array_, coarse_array_, wire_array_;
  StreamBuffer positions_, normals_, colors_, indices_, coarse_indices_, edges_;
  StreamBuffer texture_points_, texture_places_;
  gl::Texture texture_;
  int texture_width_ = 0; // 0: none
  int texture_height_ = 0;
  std::size_t triangles_ = 0;
  std::size_t coarse_ = 0;
  std::size_t edge_count_ = 0;
  bool has_colors_ = false;
  std::size_t vertices_ = 0;
  std::vector<std::uint32_t> normal_bits_;
};

} // namespace cagewright::app
