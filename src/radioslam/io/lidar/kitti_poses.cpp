#include "radioslam/io/lidar/kitti_poses.hpp"

#include <Eigen/LU>
namespace radioslam {
namespace {

constexpr double kRotationTolerance = 1e-2;  ///< bound on |R^T R - I|; published files reach 1e-5

}  // namespace

SE3 read_kitti_matrix(LineFields& fields) {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = fields.number("a rotation's entry");
    translation(row) = fields.coordinate("a translation's entry");
  }
  const double defect = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm();
  if (!(defect < kRotationTolerance) || rotation.determinant() < 0)
    fields.fail("the first three columns are not a rotation matrix");
  return {translation, Eigen::Quaterniond(rotation)};
}

Trajectory<SE3> read_kitti_poses(const Text& text) {
  std::vector<StampedPose<SE3>> poses;
  TextLines lines(text);
  while (lines.next_with_content()) {
    const double seconds = static_cast<double>(poses.size()) / kKittiFrequency_hz;
    LineFields fields(lines);
    poses.push_back({Stamp::from_seconds(seconds), read_kitti_matrix(fields)});
    fields.end();
  }
  if (poses.empty()) text.fail(1, "the file has no poses");
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace radioslam
