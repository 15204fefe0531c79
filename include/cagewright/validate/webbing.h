/// \file
/// Whether a cage joins what is apart: legs, arms, fingers.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace cagewright {

/// The free space between two parts of a model that are near each other in space and far apart
/// along the surface, as the centers of voxels.
///
/// A free voxel of a grid (96 along the diagonal of the model's box) is one of them if on one of
/// 13 lines through it, along axes and diagonals, it is in the middle third between two voxels of
/// the model; these are from 3 % to 35 % of the diagonal apart; and the way from one to the other
/// through the model is at least twice as long, as between limbs less than 60 degrees apart, and a
/// quarter of the diagonal. Pieces of a model that do not touch are as far apart as can be. Those
/// are in *narrow* gaps where the two are at most 20 % of the diagonal apart, and the way is three
/// times as long: between legs, while the others are between the tips of spread arms, too.
///
/// What is inside and outside is decided as for every grid of voxels: open and dirty models have
/// such a space too. The same points on any number of threads.
class SpaceBetween {
public:
  SpaceBetween() = default; ///< none

  /// None if the model cannot be made of voxels: without triangles, without extent, not finite.
  ///
  /// None, too, if it is to stop.
  /// Cost: O(T + N) for T triangles and N voxels, some 20 ms, and about as much for the ways.
  explicit SpaceBetween(TriangleView model, const Progress& progress = {});

  [[nodiscard]] std::size_t count() const { return count_; } ///< of the points
  [[nodiscard]] double voxel() const { return size_; }       ///< length of their voxels' edges
  [[nodiscard]] std::vector<Vec3> points() const;

  /// Those at x > 0: between the limbs of half a symmetric model.
  [[nodiscard]] SpaceBetween right_half() const;

  /// How many points lie on the side of the triangle from where the x axis comes, in line with it:
  /// positive if its normal points along the axis, else negative. The sum over the faces of a
  /// closed surface, oriented outward, is the number of points inside.
  [[nodiscard]] long behind(const std::array<Vec3, 3>& triangle) const;

  /// The share of the points that is inside the surface, or of those in narrow gaps if that is
  /// greater and they are more than a few: what is wide does not make up for legs that are joined.
  /// 0 if there are no points.
  ///
  /// Cost: O(F) and the area of the faces in voxels.
  [[nodiscard]] double share_inside(TriangleView surface) const;

private:
  friend class SpaceBetweenFinder;

  struct Count {
    long all = 0;
    long narrow = 0;
  };
  [[nodiscard]] Count behind_of(const std::array<Vec3, 3>& triangle) const;

  /// Points with the same y and z: places_[first[row] .. first[row + 1]), ascending.
  [[nodiscard]] std::size_t row(int j, int k) const {
    return static_cast<std::size_t>(j) +
           static_cast<std::size_t>(rows_[0]) * static_cast<std::size_t>(k);
  }

  std::size_t count_ = 0;
  Vec3 corner_ = Vec3::Zero(); // of the grid
  double size_ = 0;
  std::array<int, 2> rows_ = {0, 0}; // along y and z
  std::vector<std::size_t> first_;
  std::vector<double> places_;      // x
  std::vector<long> narrow_before_; // by place, and at the end: those in narrow gaps before it
};

} // namespace cagewright
