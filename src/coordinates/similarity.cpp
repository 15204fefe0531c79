#include "coordinates/similarity.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

/// U diag(1, 1, +-1) V^T, a rotation.
Mat3 rotation_of(const Eigen::JacobiSVD<Mat3>& svd, double& last_sign) {
  last_sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vec3(1, 1, last_sign).asDiagonal() * svd.matrixV().transpose();
}

} // namespace

Similarity best_similarity(std::span<const Vec3> rest, std::span<const Vec3> pose) {
  if (std::equal(rest.begin(), rest.end(), pose.begin(), pose.end()) || rest.empty()) {
    return {};
  }
  const auto count = static_cast<double>(rest.size());
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    from += rest[i] / count;
    to += pose[i] / count;
  }
  Mat3 covariance = Mat3::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    covariance += (pose[i] - to) * (rest[i] - from).transpose() / count;
    spread += (rest[i] - from).squaredNorm() / count;
  }
  Similarity best;
  double sign = 1;
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  best.turn = rotation_of(svd, sign);
  const Vec3& values = svd.singularValues();
  best.scale = spread > 0 ? (values[0] + values[1] + sign * values[2]) / spread : 1;
  best.shift = to - best.scale * (best.turn * from);
  return best;
}

Mat3 nearest_rotation(const Mat3& m, const Mat3& otherwise) {
  constexpr double singular = 1e-9;
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[2] > singular * svd.singularValues()[0])) {
    return otherwise;
  }
  double sign = 1;
  return rotation_of(svd, sign);
}

} // namespace cagewright
