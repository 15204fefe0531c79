/// \file
/// What the painters of the canvas share: buffers that are filled again and again, and uniforms.
/// Private to this folder.
#pragma once

#include "render/gl.h"
#include <cagewright/core/geometry.h>
#include <cagewright/render/palette.h>

#include <cstddef>
#include <span>

namespace cagewright::app {

/// A buffer that is filled anew as often as needed.
class StreamBuffer {
public:
  template <class T> void fill(GLenum target, std::span<const T> data, GLenum usage) {
    if (buffer_.id() == 0) {
      GLuint id = 0;
      glGenBuffers(1, &id);
      buffer_ = gl::Buffer(id);
    }
    glBindBuffer(target, buffer_.id());
    glBufferData(target, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), usage);
  }
  [[nodiscard]] GLuint id() const { return buffer_.id(); }

private:
  gl::Buffer buffer_;
};

inline gl::VertexArray make_array() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return gl::VertexArray(id);
}

/// One input of the vertex array and the buffer that are bound.
inline void attribute(GLuint location, GLint size, GLenum type, std::size_t stride,
                      std::size_t offset, bool per_instance = false) {
  glEnableVertexAttribArray(location);
  const bool normalized = type != GL_FLOAT;
  glVertexAttribPointer(location, size, type, normalized ? GL_TRUE : GL_FALSE,
                        static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(location, per_instance ? 1 : 0);
}

/// Uses a program and sets its uniforms.
class Uniforms {
public:
  explicit Uniforms(const gl::Program& program) : id_(program.id()) { glUseProgram(id_); }
  void set(const char* name, int value) const { glUniform1i(at(name), value); }
  void set(const char* name, double value) const {
    glUniform1f(at(name), static_cast<float>(value));
  }
  void set(const char* name, double x, double y) const {
    glUniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
  }
  void set(const char* name, const Rgb& c) const { glUniform3f(at(name), c[0], c[1], c[2]); }
  void set(const char* name, const Rgb& c, float alpha) const {
    glUniform4f(at(name), c[0], c[1], c[2], alpha);
  }
  void set(const char* name, const Mat3& m) const {
    const Eigen::Matrix3f f = m.cast<float>();
    glUniformMatrix3fv(at(name), 1, GL_FALSE, f.data());
  }
  void set(const char* name, const Eigen::Matrix4d& m) const {
    const Eigen::Matrix4f f = m.cast<float>();
    glUniformMatrix4fv(at(name), 1, GL_FALSE, f.data());
  }

private:
  [[nodiscard]] GLint at(const char* name) const { return glGetUniformLocation(id_, name); }
  GLuint id_;
};

} // namespace cagewright::app
