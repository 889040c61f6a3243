#include "radioslam/lidar/candidate_map.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {
namespace {

/// Whether the second registration keeps enough of the inlier ratio of the first.
bool keeps_inliers(const Registration& after, const Registration& before, const ScanMatcher& matcher) {
  return after.inlier_ratio >= matcher.params().odometry.relocalise_below_ratio * before.inlier_ratio;
}

}  // namespace

MatchedScan deskew_and_match(MatchedScan matched, const LocalMap& map, const ScanOnMap& last,
                             const PosePrior& prior, const ScanMatcher& matcher) {
  if (matched.scan.times_s.empty()) return matched;
  const ScanOnMap place = matched.scan.on_map(matched.fit.T_target_source);
  if (place.middle_stamp <= last.middle_stamp) return matched;
  MatchedScan again{matched.scan, {}, {}};
  again.scan.deskew_with(twist_between(last, place));
  again.cloud = matcher.pyramid_of(again.scan);
  const SE3 start = place.T_map_middle * again.scan.T_body_middle().inverse();
  again.fit = matcher.register_at(map, again.cloud, start, prior, 0);
  if (!keeps_inliers(again.fit, matched.fit, matcher)) return matched;
  again.fit.iterations += matched.fit.iterations;
  return again;
}

std::optional<MapStart> deskew_map_start(DeskewedScan first, const ScanOnMap& at, MatchedScan next,
                                         const PosePrior& prior, double travelled_m,
                                         const ScanMatcher& matcher) {
  const double dt_s = seconds_between(at.middle_stamp, next.scan.middle());
  if (first.times_s.empty() || dt_s <= 0) return std::nullopt;
  const Registration before = next.fit;
  const SE3::Tangent twist_per_s = next.scan.source == MotionSource::kConstantVelocity
                                       ? twist_between(at, next.scan.on_map(before.T_target_source))
                                       : next.scan.twist_per_s;
  first.deskew_with(twist_per_s);
  next.scan.deskew_with(twist_per_s);
  next.cloud = matcher.pyramid_of(next.scan);
  MapStart start{matcher.empty_map(), first.on_map(at.T_map_body), matcher.pyramid_of(first),
                 std::move(next)};
  start.map.add(start.first_cloud, at.T_map_body, travelled_m);
  const SE3 predicted = start.first.T_map_middle * SE3::exp(dt_s * twist_per_s);
  start.next.fit =
      matcher.register_at(start.map, start.next.cloud, predicted * start.next.scan.T_body_middle().inverse(),
                          prior, matcher.traits().spacing_m);
  if (!keeps_inliers(start.next.fit, before, matcher)) return std::nullopt;
  return start;
}

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
