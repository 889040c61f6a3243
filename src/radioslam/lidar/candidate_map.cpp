#include "radioslam/lidar/candidate_map.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

CandidateMap::CandidateMap(const DeskewedScan& scan, const ScanPyramid& cloud, const SE3& predicted,
                           const SE3& last_pose, double travelled_m, const ScanMatcher& matcher)
    : map_(matcher.empty_map()),
      first_(scan),
      before_last_(scan.on_map(predicted)),
      last_(before_last_),
      predicted_(predicted) {
  const SE3 gap = last_pose.inverse() * predicted;
  gap_m_ = gap.translation().norm();
  gap_rad_ = gap.log().tail<3>().norm();
  map_.add(cloud, predicted, travelled_m);
}

std::optional<CandidateMap::Fit> CandidateMap::add(const DeskewedScan& scan, ScanPyramid& cloud,
                                                   const SE3& predicted, const PredictionError& error,
                                                   double travelled_m, const ScanMatcher& matcher) {
  const PosePrior prior = error.prior_at(last_.T_map_body * predicted_.inverse() * predicted);
  const Registration fit = matcher.register_near(map_, cloud, prior, map_.fine().max_distance_m());
  if (fit.inlier_ratio < std::max(matcher.params().odometry.min_first_inlier_ratio, error.min_inlier_ratio()))
    return std::nullopt;
  MatchedScan matched{scan, std::move(cloud), fit};
  if (scans_++ == 1) matched = deskew_start(std::move(matched), prior, travelled_m, matcher);
  const double novelty_ratio = map_.add(matched.cloud, matched.fit.T_target_source, travelled_m);
  before_last_ = std::exchange(last_, matched.scan.on_map(matched.fit.T_target_source));
  predicted_ = predicted;
  cloud = std::move(matched.cloud);
  return Fit{matched.fit, prior, novelty_ratio};
}

MatchedScan CandidateMap::deskew_start(MatchedScan next, const PosePrior& prior, double travelled_m,
                                       const ScanMatcher& matcher) {
  auto start = deskew_map_start(first_, last_, next, prior, travelled_m, matcher);
  if (!start) return next;
  map_ = std::move(start->map);
  last_ = start->first;
  return std::move(start->next);
}

SE3::Jacobian CandidateMap::step_covariance(const LidarOdometryParams& params) const {
  const double wide_m = params.first_sigma_m + gap_m_, wide_rad = params.first_sigma_rad + gap_rad_;
  return isotropic(wide_m * wide_m, wide_rad * wide_rad);
}

}  // namespace radioslam
