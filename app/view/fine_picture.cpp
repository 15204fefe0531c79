#include "app/view/fine_picture.h"

#include "app/view/canvas_shaders.h"
#include "app/view/gl_stream.h"

namespace cagewright::app {
namespace {

/// Of a sequence that fills [0, 1) evenly however long it is.
double halton(int index, int base) {
  double result = 0;
  double part = 1;
  for (int i = index; i > 0; i /= base) {
    part /= base;
    result += part * (i % base);
  }
  return result;
}

bool is_complete(const gl::Framebuffer& framebuffer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

} // namespace

Result<FinePicture> FinePicture::create() {
  Result<gl::Program> program = gl::make_program(shaders::fine_vertex, shaders::fine_fragment);
  if (!program) {
    return program.error();
  }
  FinePicture picture;
  picture.program_ = std::move(*program);
  picture.empty_ = make_array();
  return picture;
}

Eigen::Vector2d FinePicture::shift() const {
  return {halton(samples_ + 1, 2) - 0.5, halton(samples_ + 1, 3) - 0.5};
}

bool FinePicture::begin_sample(int width, int height) {
  if (width != width_ || height != height_) {
    width_ = width;
    height_ = height;
    samples_ = 0;
    mean_ = gl::make_texture(GL_RGBA16F, width, height);
    color_ = gl::make_texture(GL_RGBA8, width, height);
    depth_ = gl::make_texture(GL_DEPTH_COMPONENT32F, width, height);
    mean_frame_ = gl::make_framebuffer({mean_.id()});
    sample_frame_ = gl::make_framebuffer({color_.id()}, depth_.id());
    if (!is_complete(mean_frame_)) {
      return false;
    }
  }
  return is_complete(sample_frame_);
}

void FinePicture::add_sample(const Eigen::Matrix4d& clip, const Mat3& axes, double occlusion,
                             double radius) {
  glBindFramebuffer(GL_FRAMEBUFFER, mean_frame_.id());
  glViewport(0, 0, width_, height_);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  // The mean is opaque, or what lies behind the view would shine through it.
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, color_.id());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, depth_.id());
  {
    const Uniforms uniforms(program_);
    uniforms.set("picture", 0);
    uniforms.set("depths", 1);
    uniforms.set("share", 1.0 / (samples_ + 1));
    uniforms.set("clip", clip);
    uniforms.set("unclip", Eigen::Matrix4d(clip.inverse()));
    uniforms.set("axes", axes);
    uniforms.set("strength", occlusion);
    uniforms.set("radius", radius);
    uniforms.set("number", samples_);
    uniforms.set("frame", static_cast<double>(width_), static_cast<double>(height_));
    glBindVertexArray(empty_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, 0);
  ++samples_;
}

bool FinePicture::copy_to(GLuint framebuffer) const {
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) { // those of others
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, mean_frame_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  return glGetError() == GL_NO_ERROR;
}

} // namespace cagewright::app
