/// \file
/// The little of OpenGL 3.3 that the renderer needs, without a window. Private to the module.
#pragma once

#include <cagewright/core/result.h>

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::gl {

/// A context without a surface (EGL_MESA_platform_surfaceless): drawing goes to framebuffers.
class Context {
public:
  /// Errors: not_available, when there is no EGL, no driver, or none with OpenGL 3.3.
  static Result<std::unique_ptr<Context>> create();

  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context();

  /// Makes the context current on this thread for as long as it lives, then puts back the one that
  /// was current before.
  class Use {
  public:
    explicit Use(const Context& context);
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use();

  private:
    void* display_;
    std::array<void*, 4> before_; // display, draw surface, read surface, context
  };

private:
  Context(void* display, void* context) : display_(display), context_(context) {}
  void* display_;
  void* context_;
};

/// An object of OpenGL, deleted with its owner; the context must be current then.
template <void (*Delete)(GLuint)> class Object {
public:
  explicit Object(GLuint id = 0) : id_(id) {}
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Object() {
    if (id_ != 0) {
      Delete(id_);
    }
  }
  [[nodiscard]] GLuint id() const { return id_; }

private:
  GLuint id_;
};

inline void delete_program(GLuint id) {
  glDeleteProgram(id);
}
inline void delete_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void delete_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void delete_vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void delete_framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}

using Program = Object<delete_program>;
using Texture = Object<delete_texture>;
using Buffer = Object<delete_buffer>;
using VertexArray = Object<delete_vertex_array>;
using Framebuffer = Object<delete_framebuffer>;

/// Errors: not_available, with the driver's complaint.
Result<Program> make_program(const std::string& vertex, const std::string& fragment);

/// A texture of the size, without mipmaps; `linear` interpolates between its pixels.
Texture make_texture(GLenum format, int width, int height, bool linear = false);

/// A framebuffer that draws to the colour textures (in this order) and to the depth texture, if
/// any.
Framebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth = 0);

/// One input of a vertex shader: `size` values of `type` at `offset` bytes into each element.
struct Attribute {
  GLuint location;
  GLint size;
  GLenum type; ///< GL_FLOAT, or GL_UNSIGNED_BYTE, which means [0, 1]
  std::size_t offset;
};

/// Elements in the memory of OpenGL, one for each vertex or, `per_instance`, for each copy.
class Elements {
public:
  template <class T>
  Elements(const std::vector<T>& elements, const std::vector<Attribute>& attributes,
           bool per_instance = false)
      : Elements(elements.data(), elements.size(), sizeof(T), attributes, per_instance) {}

  /// Draws all of them as triangles, or as instances of a strip of four vertices.
  void draw() const;

private:
  Elements(const void* data, std::size_t count, std::size_t stride,
           const std::vector<Attribute>& attributes, bool per_instance);
  VertexArray array_;
  Buffer buffer_;
  GLsizei count_;
  bool per_instance_;
};

} // namespace cagewright::gl
