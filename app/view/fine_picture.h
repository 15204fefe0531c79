/// \file
/// A picture that gets finer while nothing moves: smooth outlines, and shade in corners. Private to
/// canvas.cpp.
#pragma once

#include "app/view/canvas.h"
#include "render/gl.h"

namespace cagewright::app {

/// The mean of pictures of the same scene, each moved by a part of a pixel, and each with shade
/// from other places round it: what one picture of them would be with many samples in a pixel, at
/// the cost of one for each frame.
class FinePicture {
public:
  static constexpr int most_samples = 12;
  /// Fewer look worse than none.
  static constexpr int least_samples = 3;

  /// Errors: not_available, when the driver refuses the shader.
  static Result<FinePicture> create();

  /// Another scene: from the start.
  void restart() { samples_ = 0; }
  [[nodiscard]] int samples() const { return samples_; }

  /// How far the next sample is moved, in pixels.
  [[nodiscard]] Eigen::Vector2d shift() const;
  /// Draws go to the next sample from now on.
  /// \returns false if the driver has no such framebuffers: nothing is bound then
  bool begin_sample(int width, int height);
  /// Adds what was drawn to the mean.
  /// \param clip  with which it was drawn, shifted
  /// \param occlusion  strength of the shade, 0 none
  /// \param radius  from how far away it comes, in the units before clip
  void add_sample(const Eigen::Matrix4d& clip, const Mat3& axes, double occlusion, double radius);
  /// Copies the mean to a framebuffer of the same size, and binds that.
  bool copy_to(GLuint framebuffer) const;

private:
  gl::Program program_;
  gl::VertexArray empty_;
  gl::Texture mean_, color_, depth_;
  gl::Framebuffer mean_frame_, sample_frame_;
  int width_ = 0;
  int height_ = 0;
  int samples_ = 0;
};

} // namespace cagewright::app
