#include "render/gl.h"

#include <epoxy/egl.h>

namespace cagewright::gl {
namespace {

Error no_driver(const std::string& what) {
  return {ErrorCode::not_available,
          "cannot draw without a display: " + what + "; install libegl1 and libgl1-mesa-dri"};
}

std::string log_of(GLuint id, bool is_shader) {
  std::string log(2048, '\0');
  GLsizei length = 0;
  if (is_shader) {
    glGetShaderInfoLog(id, static_cast<GLsizei>(log.size()), &length, log.data());
  } else {
    glGetProgramInfoLog(id, static_cast<GLsizei>(log.size()), &length, log.data());
  }
  log.resize(static_cast<std::size_t>(length));
  return log;
}

/// Compiles and attaches; empty, or the driver's complaint.
std::string add_shader(GLuint program, GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const std::string text = "#version 330 core\n" + source;
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  const std::string log = good != 0 ? "" : log_of(shader, true) + " ";
  glAttachShader(program, shader);
  glDeleteShader(shader); // when the program lets go of it
  return log;
}

} // namespace

Result<std::unique_ptr<Context>> Context::create() {
  if (!epoxy_has_egl()) {
    return no_driver("there is no EGL library");
  }
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    return no_driver("EGL lacks EGL_MESA_platform_surfaceless");
  }
  const EGLDisplay display =
      eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  // The display belongs to the process: others may use it too, so it is never terminated.
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    return no_driver("EGL found no driver");
  }
  const EGLenum api_before = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  constexpr std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                3,
                                                EGL_CONTEXT_MINOR_VERSION,
                                                3,
                                                EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                EGL_NONE};
  const EGLContext context =
      eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  eglBindAPI(api_before);
  if (context == EGL_NO_CONTEXT) {
    return no_driver("the driver does not offer OpenGL 3.3");
  }
  return std::unique_ptr<Context>(new Context(display, context));
}

Context::~Context() {
  eglDestroyContext(display_, context_);
}

Context::Use::Use(const Context& context)
    : display_(context.display_), before_{eglGetCurrentDisplay(), eglGetCurrentSurface(EGL_DRAW),
                                          eglGetCurrentSurface(EGL_READ), eglGetCurrentContext()} {
  eglBindAPI(EGL_OPENGL_API);
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_);
}

Context::Use::~Use() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (before_[3] != EGL_NO_CONTEXT) {
    eglMakeCurrent(before_[0], before_[1], before_[2], before_[3]);
  }
}

Result<Program> make_program(const std::string& vertex, const std::string& fragment) {
  Program program(glCreateProgram());
  std::string log = add_shader(program.id(), GL_VERTEX_SHADER, vertex);
  log += add_shader(program.id(), GL_FRAGMENT_SHADER, fragment);
  glLinkProgram(program.id());
  GLint good = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
  if (good == 0) {
    return no_driver("the driver refuses a shader: " + log + log_of(program.id(), false));
  }
  return program;
}

Texture make_texture(GLenum format, int width, int height, bool linear) {
  GLuint id = 0;
  glGenTextures(1, &id);
  glBindTexture(GL_TEXTURE_2D, id);
  const bool depth = format == GL_DEPTH_COMPONENT32F;
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0,
               depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, nullptr);
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Texture(id);
}

Framebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth) {
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  std::vector<GLenum> targets;
  for (const GLuint color : colors) {
    targets.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + targets.size()));
    glFramebufferTexture2D(GL_FRAMEBUFFER, targets.back(), GL_TEXTURE_2D, color, 0);
  }
  if (depth != 0) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  }
  if (targets.empty()) {
    targets.push_back(GL_NONE);
  }
  glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
  return Framebuffer(id);
}

Elements::Elements(const void* data, std::size_t count, std::size_t stride,
                   const std::vector<Attribute>& attributes, bool per_instance)
    : count_(static_cast<GLsizei>(count)), per_instance_(per_instance) {
  GLuint array = 0;
  GLuint buffer = 0;
  glGenVertexArrays(1, &array);
  glGenBuffers(1, &buffer);
  array_ = VertexArray(array);
  buffer_ = Buffer(buffer);
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * stride), data, GL_STATIC_DRAW);
  for (const Attribute& a : attributes) {
    glEnableVertexAttribArray(a.location);
    glVertexAttribPointer(a.location, a.size, a.type, a.type == GL_UNSIGNED_BYTE,
                          static_cast<GLsizei>(stride), reinterpret_cast<const void*>(a.offset));
    glVertexAttribDivisor(a.location, per_instance ? 1 : 0);
  }
}

void Elements::draw() const {
  if (count_ == 0) {
    return;
  }
  glBindVertexArray(array_.id());
  if (per_instance_) {
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
  } else {
    glDrawArrays(GL_TRIANGLES, 0, count_);
  }
}

} // namespace cagewright::gl
