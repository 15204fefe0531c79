#include "app/view/model_painter.h"

#include "app/view/canvas_shaders.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cagewright::app {
namespace {

std::uint32_t packed_normal(const Vec3& n) { // 10 bits each, signed
  const auto bits = [](double c) {
    return static_cast<std::uint32_t>(std::lround(511 * std::clamp(c, -1.0, 1.0))) & 1023U;
  };
  return n.allFinite() ? bits(n.x()) | bits(n.y()) << 10U | bits(n.z()) << 20U : 0;
}

} // namespace

Result<ModelPainter> ModelPainter::create() {
  ModelPainter painter;
  Result<gl::Program> model =
      gl::make_program(shaders::model_vertex,
                       std::string(shaders::light) + shaders::surfaces + shaders::model_fragment);
  if (!model) {
    return model.error();
  }
  Result<gl::Program> wire = gl::make_program(shaders::wire_vertex, shaders::wire_fragment);
  if (!wire) {
    return wire.error();
  }
  painter.model_ = std::move(*model);
  painter.wire_ = std::move(*wire);
  painter.array_ = make_array();
  painter.coarse_array_ = make_array();
  painter.wire_array_ = make_array();
  return painter;
}

void ModelPainter::set_triangles(std::span<const Triangle> triangles,
                                 std::span<const Triangle> coarse) {
  triangles_ = triangles.size();
  coarse_ = coarse.size();
  edge_count_ = 0;
  has_colors_ = false;
  glBindVertexArray(array_.id());
  indices_.fill(GL_ELEMENT_ARRAY_BUFFER, triangles, GL_STATIC_DRAW);
  glBindVertexArray(coarse_array_.id());
  coarse_indices_.fill(GL_ELEMENT_ARRAY_BUFFER, coarse, GL_STATIC_DRAW);
  glBindVertexArray(0);
}

void ModelPainter::move(std::vector<Eigen::Vector3f> positions, std::span<const Vec3> normals) {
  vertices_ = positions.size();
  normal_bits_.resize(positions.size());
  parallel_for(0, positions.size(), 8192, [&](std::size_t i) {
    normal_bits_[i] = i < normals.size() ? packed_normal(normals[i]) : 0;
  });
  positions_.fill(GL_ARRAY_BUFFER, std::span<const Eigen::Vector3f>(positions), GL_STREAM_DRAW);
  normals_.fill(GL_ARRAY_BUFFER, std::span<const std::uint32_t>(normal_bits_), GL_STREAM_DRAW);
  for (const gl::VertexArray* array : {&array_, &coarse_array_}) {
    glBindVertexArray(array->id());
    glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
    attribute(0, 3, GL_FLOAT, sizeof(Eigen::Vector3f), 0);
    glBindBuffer(GL_ARRAY_BUFFER, normals_.id());
    attribute(1, 4, GL_INT_2_10_10_10_REV, 4, 0);
  }
  glBindVertexArray(0);
}

void ModelPainter::set_colors(std::span<const Color> colors) {
  has_colors_ = !colors.empty() && colors.size() == vertices_;
  if (has_colors_) {
    colors_.fill(GL_ARRAY_BUFFER, colors, GL_STREAM_DRAW);
  }
  for (const gl::VertexArray* array : {&array_, &coarse_array_}) {
    glBindVertexArray(array->id());
    if (has_colors_) {
      glBindBuffer(GL_ARRAY_BUFFER, colors_.id());
      attribute(2, 4, GL_UNSIGNED_BYTE, sizeof(Color), 0);
    } else {
      glDisableVertexAttribArray(2);
    }
  }
  glBindVertexArray(0);
}

void ModelPainter::set_texture(std::span<const std::array<float, 2>> points,
                               std::span<const std::array<float, 4>> places,
                               const Picture& picture) {
  const bool fits = points.size() == vertices_ && places.size() == vertices_;
  texture_width_ = fits ? picture.width : 0;
  texture_height_ = picture.height;
  if (texture_width_ > 0) {
    texture_points_.fill(GL_ARRAY_BUFFER, points, GL_STATIC_DRAW);
    texture_places_.fill(GL_ARRAY_BUFFER, places, GL_STATIC_DRAW);
    GLuint id = 0;
    glGenTextures(1, &id);
    texture_ = gl::Texture(id);
    glBindTexture(GL_TEXTURE_2D, id);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, picture.rgba.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
  }
  for (const gl::VertexArray* array : {&array_, &coarse_array_}) {
    glBindVertexArray(array->id());
    if (texture_width_ == 0) {
      glDisableVertexAttribArray(3);
      glDisableVertexAttribArray(4);
    } else {
      glBindBuffer(GL_ARRAY_BUFFER, texture_points_.id());
      attribute(3, 2, GL_FLOAT, sizeof(std::array<float, 2>), 0);
      glBindBuffer(GL_ARRAY_BUFFER, texture_places_.id());
      attribute(4, 4, GL_FLOAT, sizeof(std::array<float, 4>), 0);
    }
  }
  glBindVertexArray(0);
}

std::size_t ModelPainter::triangle_count(const CanvasView& view) const {
  return view.coarse && has_coarse() ? coarse_ : triangles_;
}

void ModelPainter::draw(const CanvasView& view, std::size_t first, std::size_t count) const {
  const bool coarse = view.coarse && has_coarse();
  const Uniforms uniforms(model_);
  uniforms.set("clip", view.clip);
  uniforms.set("axes", view.axes);
  uniforms.set("one_color", view.model_color, has_colors_ ? 0.0F : 1.0F);
  uniforms.set("smooth_normals", view.smooth ? 1 : 0);
  // Colors that say something are seen as they are.
  uniforms.set("look", static_cast<int>(has_colors_ ? SurfaceLook::studio : view.look));
  const bool textured = texture_width_ > 0;
  uniforms.set("textured", textured ? 1 : 0);
  uniforms.set("texture_size", texture_width_, texture_height_);
  uniforms.set("atlas", 0);
  if (textured) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_.id());
  }
  glBindVertexArray(coarse ? coarse_array_.id() : array_.id());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first * sizeof(Triangle)));
  if (textured) {
    glBindTexture(GL_TEXTURE_2D, 0);
  }
}

void ModelPainter::set_edges(std::span<const std::array<Index, 2>> edges) {
  edge_count_ = edges.size();
  glBindVertexArray(wire_array_.id());
  edges_.fill(GL_ELEMENT_ARRAY_BUFFER, edges, GL_STATIC_DRAW);
  glBindVertexArray(0);
}

void ModelPainter::draw_wireframe(const CanvasView& view, std::size_t first,
                                  std::size_t count) const {
  const Uniforms uniforms(wire_);
  uniforms.set("clip", view.clip);
  const float alpha = 0.45F;
  const Rgb& c = view.wire_color;
  uniforms.set("one_color", Rgb{c[0] * alpha, c[1] * alpha, c[2] * alpha}, alpha);
  glBindVertexArray(wire_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  attribute(0, 3, GL_FLOAT, sizeof(Eigen::Vector3f), 0);
  glDrawElements(GL_LINES, static_cast<GLsizei>(2 * count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first * sizeof(std::array<Index, 2>)));
}

} // namespace cagewright::app
