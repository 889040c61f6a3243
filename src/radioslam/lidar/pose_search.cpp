#include "radioslam/lidar/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/lidar/structure_fit.hpp"

namespace radioslam {
namespace {

constexpr double kHardlyAny = 1e-3;  // information of a prior that only decides what is unobservable

template <class Surfels>
NearestSurfel nearest_in(const Surfels& map) {
  return [&map](const Eigen::Vector3f& point, float squared) { return map.nearest(point, squared); };
}

RegistrationStart start_at(const SE3& pose, double deviation_m, const LocalMap& map) {
  constexpr double kSigmas = 3;
  const double max_distance_m =
      std::clamp(kSigmas * deviation_m, map.fine().max_distance_m() / 3, map.fine().max_distance_m());
  return {pose, std::min(deviation_m, max_distance_m), max_distance_m};
}

PosePrior hardly_any_prior(const SE3& pose) {
  PosePrior prior{pose};
  prior.information.diagonal().setConstant(kHardlyAny);
  return prior;
}

/// The coarse alignment need only end within the fine map's correspondence distance.
template <class Map>
RegistrationParams rough(const RegistrationParams& params, const Map& map) {
  RegistrationParams result = params;
  result.translation_tolerance_m =
      std::max(params.translation_tolerance_m, 0.03 * map.fine().max_distance_m());
  result.rotation_tolerance_rad = std::max(params.rotation_tolerance_rad, 0.01);
  return result;
}

/// On the coarse map.
template <class Map>
SE3 aligned(const Map& map, const ScanPyramid& scan, const SE3& start, ScannerKind kind,
            const RegistrationParams& params) {
  const double max_distance_m = map.coarse().max_distance_m();
  return register_surfels(nearest_in(map.coarse()), scan.few, {start, 0.5 * max_distance_m, max_distance_m},
                          hardly_any_prior(start), kind, rough(params, map))
      .T_target_source;
}

/// On the fine map, from an alignment on the coarse one.
template <class Map>
Registration register_aligned(const Map& map, const ScanPyramid& scan, const SE3& start, ScannerKind kind,
                              const RegistrationParams& params) {
  const double max_distance_m = map.fine().max_distance_m();
  return register_surfels(nearest_in(map.fine()), scan.source, {start, max_distance_m / 3, max_distance_m},
                          hardly_any_prior(start), kind, params);
}

/// On the fine map, from where another registration ended.
Registration continued(const Submap& map, const ScanPyramid& scan, const Registration& before,
                       ScannerKind kind, const RegistrationParams& params) {
  return register_surfels(nearest_in(map.fine()), scan.source,
                          {before.T_target_source, 0, map.fine().max_distance_m()},
                          hardly_any_prior(before.T_target_source), kind, params);
}

/// Overlap score: a point within a quarter of the coarse correspondence distance counts at least one half, at
/// the full distance next to nothing.
double correspondence_ratio(const LocalMap& map, const ScanPyramid& scan, const SE3& start) {
  const auto max_distance_m = static_cast<float>(map.coarse().max_distance_m());
  const Eigen::Matrix3f R = start.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = start.translation().cast<float>();
  double sum = 0;
  for (const Surfel& surfel : scan.few.surfels) {
    const Eigen::Vector3f point = R * surfel.position + t;
    const Surfel* nearest = map.coarse().nearest(point, max_distance_m * max_distance_m);
    if (!nearest) continue;
    const float relative = (nearest->position - point).squaredNorm() / (max_distance_m * max_distance_m);
    sum += static_cast<double>(1 / (1 + 16 * relative));
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, scan.few.surfels.size()));
}

/// Grid of initial poses.
struct Window {
  int x = 0, y = 0, yaw = 0;  ///< number of steps to either side
  double step_m = 1, step_rad = 1;

  double starts() const { return (2.0 * x + 1) * (2.0 * y + 1) * (2.0 * yaw + 1); }
};

Window window_of(const Submap& map, const ScanPyramid& scan, const UncertainPose<SE3>& guess,
                 const PoseSearchParams& search) {
  const Eigen::Matrix3d position = guess.position_covariance();
  Window window;
  window.step_m = map.coarse().max_distance_m() / 2;
  window.step_rad = window.step_m / std::max(scan.median_range_m, window.step_m);
  const double widest = search.max_starts * window.step_m;  // a longer row exceeds max_starts
  const double wide_x = std::min(widest, search.sigmas * std::sqrt(position(0, 0)));
  const double wide_y = std::min(widest, search.sigmas * std::sqrt(position(1, 1)));
  const double wide_yaw = std::min(std::numbers::pi, search.sigmas * std::sqrt(guess.covariance(5, 5)));
  const auto steps = [](double wide, double step) { return static_cast<int>(std::ceil(wide / step - 0.5)); };
  do {
    window.x = std::max(0, steps(wide_x, window.step_m));
    window.y = std::max(0, steps(wide_y, window.step_m));
    window.yaw = std::max(0, steps(wide_yaw, window.step_rad));
    if (window.starts() <= search.max_starts) break;
    window.step_m *= 1.25;
    window.step_rad *= 1.25;
  } while (true);
  return window;
}

/// The first `count` of which none is near another in the grid, so that one is enough for both.
std::vector<SE3> apart_from_each_other(const std::vector<SE3>& starts, const Window& window, double basin_m,
                                       std::size_t count) {
  const double near_m = std::min(1.5 * window.step_m, basin_m);
  std::vector<SE3> kept;
  for (const SE3& start : starts) {
    if (kept.size() == count) break;
    const auto is_near = [&](const SE3& other) {
      return (other.translation() - start.translation()).cwiseAbs().maxCoeff() < near_m &&
             (other.inverse() * start).log().tail<3>().norm() < 1.5 * window.step_rad;
    };
    if (std::none_of(kept.begin(), kept.end(), is_near)) kept.push_back(start);
  }
  return kept;
}

/// All initial poses, those that overlap the map best first.
std::vector<SE3> starts_in(const Window& window, const SE3& guess, const Submap& map,
                           const ScanPyramid& scan) {
  std::vector<Eigen::Vector3d> places;
  for (int x = -window.x; x <= window.x; ++x)
    for (int y = -window.y; y <= window.y; ++y)
      places.push_back(guess.translation() + Eigen::Vector3d(x * window.step_m, y * window.step_m, 0));
  std::vector<Eigen::Quaterniond> turns;
  for (int yaw = -window.yaw; yaw <= window.yaw; ++yaw)
    turns.push_back(Eigen::Quaterniond(Eigen::AngleAxisd(yaw * window.step_rad, Eigen::Vector3d::UnitZ())) *
                    guess.rotation());
  std::vector<std::vector<double>> scores(turns.size());
  parallel_for(turns.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      scores[k] = map.overlap().scores(scan.few.surfels, turns[k], places);
  });
  std::vector<std::tuple<double, std::size_t, std::size_t>> order;
  for (std::size_t turn = 0; turn < turns.size(); ++turn)
    for (std::size_t place = 0; place < places.size(); ++place)
      order.emplace_back(-scores[turn][place], place, turn);
  std::sort(order.begin(), order.end());
  std::vector<SE3> starts;
  for (const auto& [score, place, turn] : order) starts.emplace_back(places[place], turns[turn]);
  return starts;
}

/// Stopped, half as far, or as predicted; each turned by up to two steps of `step_m` at this range.
std::vector<SE3> poses_around(const Relocalisation& search, double step_m, double range_m) {
  const double step_rad = step_m / std::max(range_m, step_m);
  std::vector<SE3> poses;
  for (const SE3& guess : {search.predicted, search.last, interpolate(search.last, search.predicted, 0.5)})
    for (const double steps : {0.0, -0.5, 0.5, -1.0, 1.0, -2.0, 2.0}) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(steps * step_rad, Eigen::Vector3d::UnitZ()));
      poses.push_back(guess * SE3(Eigen::Vector3d::Zero(), turn));
    }
  return poses;
}

/// Largest displacement of a point at the scan's median range between two poses, in the fine correspondence
/// distance.
double apart(const SE3& a, const SE3& b, const Submap& map, const ScanPyramid& scan) {
  const SE3 between = a.inverse() * b;
  const double turn_rad = between.log().tail<3>().norm();
  return std::max(between.translation().norm(), turn_rad * scan.median_range_m) / map.fine().max_distance_m();
}

/// Without those that would end where an earlier one does.
std::vector<SE3> distinct(const std::vector<SE3>& poses, const Submap& map, const ScanPyramid& scan) {
  constexpr double kSameEnd = 0.3;
  std::vector<SE3> kept;
  for (const SE3& pose : poses)
    if (std::all_of(kept.begin(), kept.end(),
                    [&](const SE3& other) { return apart(other, pose, map, scan) > kSameEnd; }))
      kept.push_back(pose);
  return kept;
}

/// Registers from all poses with few iterations, and to the end where the scan's structure fits half as well
/// as at the best.
std::vector<Registration> promising_fits(const Submap& map, const ScanPyramid& scan,
                                         const std::vector<SE3>& starts, ScannerKind kind,
                                         const RegistrationParams& params) {
  constexpr int kFirstIterations = 5;  // the kernel is narrow by then
  constexpr double kPromising = 0.5;
  RegistrationParams first = params;
  first.max_iterations = std::min(kFirstIterations, params.max_iterations);
  std::vector<Registration> fits(starts.size());
  std::vector<double> structure(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      fits[k] = register_aligned(map, scan, starts[k], kind, first);
      structure[k] = structure_fit(map.fine(), scan, fits[k].T_target_source, kind, params.loss_scale);
    }
  });
  const double least = kPromising * *std::max_element(structure.begin(), structure.end());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (structure[k] >= least && fits[k].end == RegistrationStatus::kMaxIterations)
        fits[k] = continued(map, scan, fits[k], kind, params);
  });
  return fits;
}

}  // namespace

std::vector<SE3> best_overlapping(const LocalMap& map, const ScanPyramid& scan,
                                  const std::vector<SE3>& starts, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> scores(starts.size());
  parallel_for(starts.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) scores[k] = {-correspondence_ratio(map, scan, starts[k]), k};
  });
  count = std::min(count, scores.size());
  std::partial_sort(scores.begin(), scores.begin() + static_cast<std::ptrdiff_t>(count), scores.end());
  std::vector<SE3> best;
  for (std::size_t k = 0; k < count; ++k) best.push_back(starts[scores[k].second]);
  return best;
}

Registration register_near(const LocalMap& map, const ScanPyramid& scan, const PosePrior& prior,
                           double deviation_m, ScannerKind kind, const RegistrationParams& params,
                           double min_correspondence_ratio) {
  RegistrationStart start = start_at(prior.pose, deviation_m, map);
  start.min_correspondence_ratio = min_correspondence_ratio;
  return register_surfels(nearest_in(map.fine()), scan.source, start, prior, kind, params);
}

Registration register_at(const LocalMap& map, const ScanPyramid& scan, const SE3& start,
                         const PosePrior& prior, double deviation_m, ScannerKind kind,
                         const RegistrationParams& params) {
  return register_surfels(nearest_in(map.fine()), scan.source, start_at(start, deviation_m, map), prior, kind,
                          params);
}

Registration register_best_of(const LocalMap& map, const ScanPyramid& scan, const std::vector<SE3>& starts,
                              double enough_ratio, ScannerKind kind, const RegistrationParams& params) {
  Registration best;
  for (const SE3& start : starts) {
    const Registration fit =
        register_aligned(map, scan, aligned(map, scan, start, kind, params), kind, params);
    if (fit.inlier_ratio > best.inlier_ratio) best = fit;
    if (best.inlier_ratio >= enough_ratio) break;
  }
  return best;
}

Registration relocalise(const LocalMap& map, const ScanPyramid& scan, const Relocalisation& search,
                        ScannerKind kind, const RegistrationParams& params) {
  const auto hypotheses = poses_around(search, map.coarse().max_distance_m() / 2, scan.median_range_m);
  const auto promising = best_overlapping(map, scan, hypotheses, search.max_aligned);
  return register_best_of(map, scan, promising, search.enough_ratio, kind, params);
}

PoseSearch search_pose(const Submap& map, const ScanPyramid& scan, const UncertainPose<SE3>& guess,
                       ScannerKind kind, const PoseSearchParams& search, const RegistrationParams& params) {
  const Window window = window_of(map, scan, guess, search);
  const auto starts = apart_from_each_other(starts_in(window, guess.pose, map, scan), window,
                                            0.75 * map.coarse().max_distance_m(),
                                            static_cast<std::size_t>(search.max_aligned));
  std::vector<SE3> coarse(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) coarse[k] = aligned(map, scan, starts[k], kind, params);
  });
  std::vector<Registration> fits = promising_fits(map, scan, distinct(coarse, map, scan), kind, params);
  std::stable_sort(fits.begin(), fits.end(), [](const Registration& a, const Registration& b) {
    return a.inlier_ratio > b.inlier_ratio;
  });
  PoseSearch result;
  for (const Registration& fit : fits)
    if (std::all_of(result.fits.begin(), result.fits.end(), [&](const Registration& better) {
          return apart(better.T_target_source, fit.T_target_source, map, scan) > 1;
        }))
      result.fits.push_back(fit);
  return result;
}

}  // namespace radioslam
