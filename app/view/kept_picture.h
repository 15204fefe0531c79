/// \file
/// A picture and its depth, kept from one frame to the next. Private to canvas.cpp.
#pragma once

#include "render/gl.h"

namespace cagewright::app {

/// Where what is slow to draw and seldom changes is drawn once, and copied from.
class KeptPicture {
public:
  /// Draws go there from now on; made anew if the size is another.
  /// \returns false if the driver has no such framebuffer: nothing is bound then
  bool bind(int width, int height);
  /// Copies color and depth to a framebuffer of the same size, and binds that.
  /// \returns false if the driver cannot, as when the formats differ
  bool copy_to(GLuint framebuffer) const;

private:
  static void delete_renderbuffer(GLuint id) { glDeleteRenderbuffers(1, &id); }
  using Renderbuffer = gl::Object<delete_renderbuffer>;

  gl::Framebuffer framebuffer_;
  Renderbuffer color_, depth_;
  int width_ = 0;
  int height_ = 0;
};

} // namespace cagewright::app
