#include "radioslam/eval/mirror_image.hpp"

#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>

#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr double kMaxRatio = 0.25;         // of the reflected fit's RMSE to the rigid fit's
constexpr double kMinRatioToExtent = 0.1;  // of the rigid fit's RMSE
constexpr Eigen::Index kMinPositions = 4;  // three fit a mirrored triangle too often by chance

double rms(const Eigen::Matrix3Xd& points) {
  return std::sqrt(points.squaredNorm() / static_cast<double>(points.cols()));
}

double aligned_rmse_m(const MatchedPositions& positions, int dimension) {
  const SE3 T_truth_estimate = align_positions(positions, dimension);
  Eigen::Matrix3Xd errors = positions.truth;
  for (Eigen::Index k = 0; k < errors.cols(); ++k)
    errors.col(k) -= T_truth_estimate * Eigen::Vector3d(positions.estimate.col(k));
  return rms(errors);
}

std::optional<MirrorImage> mirror_image(const std::string& robot, MatchedPositions positions, int dimension) {
  if (positions.truth.cols() < kMinPositions) return std::nullopt;
  const double extent_m = rms(positions.truth.colwise() - positions.truth.rowwise().mean());
  const double rigid_m = aligned_rmse_m(positions, dimension);
  if (rigid_m <= kMinRatioToExtent * extent_m) return std::nullopt;
  positions.estimate.row(dimension - 1) *= -1;
  const double reflected_m = aligned_rmse_m(positions, dimension);
  if (reflected_m >= kMaxRatio * rigid_m) return std::nullopt;
  return MirrorImage{robot, rigid_m, reflected_m};
}

}  // namespace

MatchedPositions positions_of(std::span<const std::vector<MatchedPose>> robots) {
  Eigen::Index count = 0;
  for (const auto& matches : robots) count += static_cast<Eigen::Index>(matches.size());
  MatchedPositions positions{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  Eigen::Index column = 0;
  for (const auto& matches : robots)
    for (const MatchedPose& match : matches) {
      positions.estimate.col(column) = match.estimate.translation();
      positions.truth.col(column++) = match.truth.translation();
    }
  return positions;
}

SE3 align_positions(const MatchedPositions& positions, int dimension) {
  const auto& [estimate, truth] = positions;
  if (estimate.cols() == 0) return {};
  if (dimension == 3) return align_points(estimate, truth);
  return lift(align_points(Eigen::Matrix2Xd(estimate.topRows<2>()), Eigen::Matrix2Xd(truth.topRows<2>())));
}

std::vector<MirrorImage> find_mirror_images(const Truth& truth,
                                            std::span<const std::vector<MatchedPose>> matches,
                                            int dimension) {
  if (const auto team = mirror_image("", positions_of(matches), dimension)) return {*team};
  std::vector<MirrorImage> images;
  for (std::size_t r = 0; r < matches.size(); ++r)
    if (const auto image = mirror_image(truth.robots[r].id, positions_of(matches.subspan(r, 1)), dimension))
      images.push_back(*image);
  return images;
}

std::vector<std::string> mirror_notes(const std::vector<MirrorImage>& images) {
  std::vector<std::string> notes;
  for (const MirrorImage& image : images) {
    std::ostringstream note;
    note << std::setprecision(3)
         << (image.robot.empty() ? "the estimate" : "robot " + image.robot + ": its trajectory")
         << " fits the ground truth only as a mirror image (" << image.reflected_rmse_m << " m rmse, "
         << image.rigid_rmse_m << " m without reflection): one of the two is mirrored, or left-handed";
    notes.push_back(note.str());
  }
  return notes;
}

}  // namespace radioslam
