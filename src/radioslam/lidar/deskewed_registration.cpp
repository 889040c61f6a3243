#include "radioslam/lidar/deskewed_registration.hpp"

#include <utility>

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

}  // namespace radioslam
