#include "app/view/kept_picture.h"

namespace cagewright::app {
namespace {

GLuint make_renderbuffer(GLenum format, int width, int height) {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, 0);
  return id;
}

void forget_errors() {
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
  }
}

} // namespace

bool KeptPicture::bind(int width, int height) {
  if (width != width_ || height != height_) {
    width_ = width;
    height_ = height;
    GLuint id = 0;
    glGenFramebuffers(1, &id);
    framebuffer_ = gl::Framebuffer(id);
    color_ = Renderbuffer(make_renderbuffer(GL_RGBA8, width, height));
    // The format of the depth that widgets of Qt have: only the same can be copied.
    depth_ = Renderbuffer(make_renderbuffer(GL_DEPTH24_STENCIL8, width, height));
    glBindFramebuffer(GL_FRAMEBUFFER, id);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              depth_.id());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool KeptPicture::copy_to(GLuint framebuffer) const {
  forget_errors();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  return glGetError() == GL_NO_ERROR;
}

} // namespace cagewright::app
