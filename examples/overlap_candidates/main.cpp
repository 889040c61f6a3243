// Overlap search: finds the keyframe pairs of two robots whose views can overlap, from odometry with
// covariances and one radio link. The robots drive along crossing streets; where they pass each other, a link
// measures the relative pose.
#include <cstdio>
#include <numbers>
#include <radioslam/closure/overlap/overlap_search.hpp>

using radioslam::SE2;

// 200 keyframes one metre apart; odometry noise of 2 cm and 0.1 degrees per square root of a metre.
radioslam::KeyframeOdometry<SE2> drive() {
  radioslam::KeyframeOdometry<SE2> chain;
  const SE2::Tangent sigma(0.02, 0.02, 0.002);
  for (int k = 0; k < 200; ++k) chain.poses.push_back(SE2({1.0 * k, 0}, 0));
  chain.cov_steps.assign(199, sigma.cwiseAbs2().asDiagonal());
  return chain;
}

int main() {
  // Each trajectory is in its own frame. At keyframe 100 of robot 0, keyframe 60 of robot 1 is five metres
  // ahead with a perpendicular heading.
  const SE2::Tangent sigma(0.5, 0.5, 0.1);
  const radioslam::OverlapLink<SE2> link{
      0, 100, 1, 60, SE2({5, 0}, std::numbers::pi / 2), sigma.cwiseAbs2().asDiagonal()};
  const radioslam::LinkCovariance<SE2> team({drive(), drive()}, {link});

  const auto found = radioslam::search_overlaps(team, {{.range_m = 15}, {.range_m = 15}}, {});

  std::printf("%zu of %zu pairs could overlap\n", static_cast<std::size_t>(found.counts.kept),
              static_cast<std::size_t>(found.counts.pairs));
  for (std::size_t i = 0; i < found.candidates.size(); i += 500) {
    const auto& pair = found.candidates[i];
    std::printf("  keyframe %3u of robot %u, %3u of robot %u: %4.1f m apart, %4.2f sigma beyond sight\n",
                pair.pose_a, pair.robot_a, pair.pose_b, pair.robot_b, pair.distance_m, pair.mahalanobis);
  }
}
