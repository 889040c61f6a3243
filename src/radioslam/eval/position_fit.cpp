#include "radioslam/eval/position_fit.hpp"

#include "radioslam/geometry/alignment.hpp"

namespace radioslam {

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

}  // namespace radioslam
