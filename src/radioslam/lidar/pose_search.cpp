#include "radioslam/lidar/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr double kHardlyAny = 1e-3;  // information: a prior that decides only what nothing else does

NearestSurfel nearest_in(const SurfelMap& map) {
  return [&map](const Eigen::Vector3f& point, float squared) { return map.nearest(point, squared); };
}

RegistrationStart start_at(const SE3& pose, double deviation_m, const LocalMap& map) {
  constexpr double kSigmas = 3;
  const double reach = std::clamp(kSigmas * deviation_m, map.fine().reach_m() / 3, map.fine().reach_m());
  return {pose, std::min(deviation_m, reach), reach};
}

PosePrior hardly_any_prior(const SE3& pose) {
  PosePrior prior{pose};
  prior.information.diagonal().setConstant(kHardlyAny);
  return prior;
}

/// A first alignment need only end within the fine map's reach.
RegistrationParams rough(const RegistrationParams& params, const LocalMap& map) {
  RegistrationParams result = params;
  result.translation_tolerance_m = std::max(params.translation_tolerance_m, 0.03 * map.fine().reach_m());
  result.rotation_tolerance_rad = std::max(params.rotation_tolerance_rad, 0.01);
  return result;
}

Registration register_far(const LocalMap& map, const ScanCloud& scan, const SE3& start, ScannerKind kind,
                          const RegistrationParams& params) {
  const double coarse_reach = map.coarse().reach_m(), reach = map.fine().reach_m();
  const PosePrior prior = hardly_any_prior(start);
  const Registration aligned =
      register_surfels(nearest_in(map.coarse()), scan.few, {start, 0.5 * coarse_reach, coarse_reach}, prior,
                       kind, rough(params, map));
  return register_surfels(nearest_in(map.fine()), scan.source, {aligned.T_target_source, reach / 3, reach},
                          prior, kind, params);
}

/// Points within a quarter of the coarse reach count nearly one, at its end nearly nothing.
double meeting_share(const LocalMap& map, const ScanCloud& scan, const SE3& start) {
  const auto reach = static_cast<float>(map.coarse().reach_m());
  const Eigen::Matrix3f R = start.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = start.translation().cast<float>();
  double sum = 0;
  for (const Surfel& surfel : scan.few.surfels) {
    const Eigen::Vector3f point = R * surfel.position + t;
    const Surfel* met = map.coarse().nearest(point, reach * reach);
    if (!met) continue;
    const float relative = (met->position - point).squaredNorm() / (reach * reach);
    sum += static_cast<double>(1 / (1 + 16 * relative));
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, scan.few.surfels.size()));
}

/// How wide and how finely starts are spread.
struct Window {
  int x = 0, y = 0, yaw = 0;  ///< steps to either side
  double step_m = 1, step_rad = 1;

  double starts() const { return (2.0 * x + 1) * (2.0 * y + 1) * (2.0 * yaw + 1); }
};

Window window_of(const LocalMap& map, const ScanCloud& scan, const UncertainPose<SE3>& guess,
                 const PoseSearchParams& search) {
  const Eigen::Matrix3d position = guess.position_covariance();
  Window window;
  window.step_m = map.coarse().reach_m() / 2;
  window.step_rad = window.step_m / std::max(scan.median_range_m, window.step_m);
  const double widest = search.most_starts * window.step_m;  // that many in a row are too many by far
  const double wide_x = std::min(widest, search.sigmas * std::sqrt(position(0, 0)));
  const double wide_y = std::min(widest, search.sigmas * std::sqrt(position(1, 1)));
  const double wide_yaw = std::min(std::numbers::pi, search.sigmas * std::sqrt(guess.covariance(5, 5)));
  const auto steps = [](double wide, double step) { return static_cast<int>(std::ceil(wide / step - 0.5)); };
  do {
    window.x = std::max(0, steps(wide_x, window.step_m));
    window.y = std::max(0, steps(wide_y, window.step_m));
    window.yaw = std::max(0, steps(wide_yaw, window.step_rad));
    if (window.starts() <= search.most_starts) break;
    window.step_m *= 1.25;
    window.step_rad *= 1.25;
  } while (true);
  return window;
}

std::vector<SE3> starts_in(const Window& window, const SE3& guess) {
  std::vector<SE3> starts;
  for (int x = -window.x; x <= window.x; ++x)
    for (int y = -window.y; y <= window.y; ++y)
      for (int yaw = -window.yaw; yaw <= window.yaw; ++yaw) {
        const Eigen::Vector3d shift(x * window.step_m, y * window.step_m, 0);
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw * window.step_rad, Eigen::Vector3d::UnitZ()));
        starts.emplace_back(guess.translation() + shift, turn * guess.rotation());
      }
  return starts;
}

/// Do two poses put a point of the scan, at its median range, farther apart than the fine map's reach?
bool are_apart(const SE3& a, const SE3& b, const LocalMap& map, const ScanCloud& scan) {
  const SE3 between = a.inverse() * b;
  const double turn_rad = between.log().tail<3>().norm();
  return std::max(between.translation().norm(), turn_rad * scan.median_range_m) > map.fine().reach_m();
}

}  // namespace

std::vector<SE3> most_promising(const LocalMap& map, const ScanCloud& scan, const std::vector<SE3>& starts,
                                std::size_t count) {
  std::vector<std::pair<double, std::size_t>> shares(starts.size());
  parallel_for(starts.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) shares[k] = {-meeting_share(map, scan, starts[k]), k};
  });
  count = std::min(count, shares.size());
  std::partial_sort(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(count), shares.end());
  std::vector<SE3> best;
  for (std::size_t k = 0; k < count; ++k) best.push_back(starts[shares[k].second]);
  return best;
}

Registration register_near(const LocalMap& map, const ScanCloud& scan, const PosePrior& prior,
                           double deviation_m, ScannerKind kind, const RegistrationParams& params,
                           double least_met_share) {
  RegistrationStart start = start_at(prior.pose, deviation_m, map);
  start.least_met_share = least_met_share;
  return register_surfels(nearest_in(map.fine()), scan.source, start, prior, kind, params);
}

Registration register_at(const LocalMap& map, const ScanCloud& scan, const SE3& start, const PosePrior& prior,
                         double deviation_m, ScannerKind kind, const RegistrationParams& params) {
  return register_surfels(nearest_in(map.fine()), scan.source, start_at(start, deviation_m, map), prior, kind,
                          params);
}

Registration register_from(const LocalMap& map, const ScanCloud& scan, const std::vector<SE3>& starts,
                           double enough_share, ScannerKind kind, const RegistrationParams& params) {
  Registration best;
  for (const SE3& start : starts) {
    const Registration fit = register_far(map, scan, start, kind, params);
    if (fit.matched_share > best.matched_share) best = fit;
    if (best.matched_share >= enough_share) break;
  }
  return best;
}

PoseSearch search_pose(const LocalMap& map, const ScanCloud& scan, const UncertainPose<SE3>& guess,
                       ScannerKind kind, const PoseSearchParams& search, const RegistrationParams& params) {
  const Window window = window_of(map, scan, guess, search);
  const auto starts =
      most_promising(map, scan, starts_in(window, guess.pose), static_cast<std::size_t>(search.most_aligned));
  std::vector<Registration> fits(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) fits[k] = register_far(map, scan, starts[k], kind, params);
  });
  PoseSearch result;
  for (const Registration& fit : fits)
    if (fit.matched_share > result.best.matched_share) result.best = fit;
  for (const Registration& fit : fits)
    if (are_apart(result.best.T_target_source, fit.T_target_source, map, scan))
      result.next_share = std::max(result.next_share, fit.matched_share);
  return result;
}

}  // namespace radioslam
