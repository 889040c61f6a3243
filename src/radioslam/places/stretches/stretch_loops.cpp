#include "radioslam/places/stretches/stretch_loops.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "radioslam/base/evenly_chosen.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/places/loops/alternatives.hpp"
#include "radioslam/places/loops/other_places.hpp"
#include "radioslam/places/loops/storey.hpp"

namespace radioslam {
namespace {

constexpr double kStride_m = 5;                     // between the middles of stretches
constexpr double kReach_m = 6;                      // from the middle, where others are searched on a stretch
constexpr double kRange_m = 20;                     // of points and rays
constexpr double kApart_m = 0.3, kApart_rad = 0.3;  // between the scans of a stretch
constexpr std::size_t kPoints = 150;                // that are searched
constexpr double kMinSeen = 0.4;                    // share of the occupied cells that the other saw
constexpr double kMinAgreement = 0.96;              // of the nominal one
constexpr double kSigmaSearch_m = 0.1, kSigmaSearch_rad = 0.01;  // of a pose found on the grids
constexpr double kRefined = 0.9;  // share of its score that a fit must keep when it is registered

SE2 in_plane(const SE3& T) { return SE2(T.translation().head<2>(), T.yaw()); }
SE3 in_space(const SE2& T) {
  return SE3({T.translation().x(), T.translation().y(), 0},
             Eigen::Quaterniond(Eigen::AngleAxisd(T.angle(), Eigen::Vector3d::UnitZ())));
}

/// Of the keyframes around j that odometry joins to it.
std::unique_ptr<const StretchGrid> grid_around(const ScanKeyframes& keyframes,
                                               const std::vector<double>& path_m, std::size_t j) {
  std::vector<StretchView> views;
  const auto add = [&](std::size_t k, const SE2& T_j_k) {
    StretchView& view = views.emplace_back();
    view.T_stretch_scan = T_j_k;
    const auto cloud = keyframes.clouds[k].read();
    for (const Surfel& surfel : cloud->all)
      view.points.push_back(surfel.position.head<2>().cast<double>());
  };
  add(j, SE2());
  for (const bool ahead : {false, true}) {
    double last_m = path_m[j], last_rad = 0;
    for (std::size_t k = j; ahead ? k + 1 < path_m.size() : k > 0;) {
      const std::size_t step = ahead ? k : k - 1;
      k = ahead ? k + 1 : k - 1;
      if (std::abs(path_m[k] - path_m[j]) > StretchLoops::kHalf_m ||
          is_unknown_motion(keyframes.step_covariances[step]))
        break;
      const SE2 T_j_k = in_plane(keyframes.poses[j].inverse() * keyframes.poses[k]);
      if (keyframes.clouds[k].empty() || (std::abs(path_m[k] - last_m) < kApart_m &&
                                          std::abs(wrap_angle(T_j_k.angle() - last_rad)) < kApart_rad))
        continue;
      add(k, T_j_k);
      last_m = path_m[k];
      last_rad = T_j_k.angle();
    }
  }
  return std::make_unique<const StretchGrid>(views, kRange_m);
}

double sigma_m(const UncertainPose<SE3>& T) { return std::sqrt(T.covariance.topLeftCorner<3, 3>().trace()); }

Eigen::Vector2d possible_off_m(const UncertainPose<SE3>& T) {
  return kPossibleSigmas * T.position_covariance().diagonal().head<2>().cwiseSqrt();
}

}  // namespace

StretchLoops::StretchLoops(const ScanKeyframes& keyframes, const LoopCandidates& candidates,
                           const LoopVerification& registration, const ScanLoopParams& params)
    : keyframes_(keyframes), candidates_(candidates), registration_(registration), params_(params) {
  const std::vector<double>& path_m = candidates.path_m();
  double next_m = 0;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    if (path_m[k] < next_m || keyframes.clouds[k].empty()) continue;
    anchors_.push_back(k);
    next_m = path_m[k] + kStride_m;
  }
  grids_.resize(anchors_.size());
  parallel_for(anchors_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) grids_[k] = grid_around(keyframes, path_m, anchors_[k]);
  });
  nominal_ = nominal_agreement();
}

double StretchLoops::nominal_agreement() const {
  const std::vector<double>& path_m = candidates_.path_m();
  std::vector<double> ratios;
  for (std::size_t a = 0, b = 0; a < anchors_.size(); ++a) {
    while (b < anchors_.size() && path_m[anchors_[b]] - path_m[anchors_[a]] < kHalf_m) ++b;
    if (b == anchors_.size()) break;
    const SE2 T_a_b = in_plane(keyframes_.poses[anchors_[a]].inverse() * keyframes_.poses[anchors_[b]]);
    ratios.push_back(likeness(*grids_[a], *grids_[b], T_a_b).agreement());
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

bool StretchLoops::covers(std::size_t i, std::size_t j) const {
  return candidates_.path_m()[j] - candidates_.path_m()[i] >= std::max(params_.min_path_m, 2 * kHalf_m);
}

std::vector<StretchLoops::Target> StretchLoops::targets_of(std::size_t source,
                                                           const std::vector<SE3>& poses) const {
  const std::size_t j = anchors_[source];
  std::vector<Target> targets;
  std::vector<SE3::Jacobian> with_j;
  for (std::size_t a = 0; a < source; ++a) {
    const std::size_t i = anchors_[a];
    if (!covers(i, j)) break;
    if (with_j.empty()) with_j = candidates_.covariances_with(j);
    const UncertainPose<SE3> T_i_j{poses[i].inverse() * poses[j], with_j[i]};
    if (sigma_m(T_i_j) < params_.known_sigma_m) continue;
    const Eigen::Vector2d at = T_i_j.pose.translation().head<2>();
    if (((at.cwiseAbs() - possible_off_m(T_i_j)).array() > kReach_m).any()) continue;
    targets.push_back({a, T_i_j});
  }
  return targets;
}

std::vector<ScanLoop> StretchLoops::find(const PlacedKeyframes& robot, const std::vector<ScanLoop>& known) {
  const std::vector<double>& path_m = candidates_.path_m();
  std::vector<std::size_t> sources;
  std::vector<std::vector<Target>> targets;
  for (std::size_t s = 0; s < anchors_.size(); ++s) {
    const auto closes = [&](const ScanLoop& loop) {
      return loop.status == LoopStatus::kAccepted &&
             std::abs(path_m[loop.j] - path_m[anchors_[s]]) < kStride_m / 2;
    };
    if (std::any_of(known.begin(), known.end(), closes)) continue;
    std::vector<Target> of = targets_of(s, robot.poses);
    if (of.empty()) continue;
    double least_m = sigma_m(of.front().T_i_j);
    for (const Target& target : of) least_m = std::min(least_m, sigma_m(target.T_i_j));
    const auto before = tried_.find(s);
    if (before != tried_.end() && !is_worth_another_trial(before->second, least_m)) continue;
    tried_[s] = least_m;
    sources.push_back(s);
    targets.push_back(std::move(of));
  }
  std::vector<ScanLoop> loops(sources.size());
  parallel_for(sources.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) loops[k] = closure_of(sources[k], robot, targets[k]);
  });
  return loops;
}

std::vector<StretchLoops::Fit> StretchLoops::fits_of(std::size_t source, const PlacedKeyframes& robot,
                                                     const std::vector<Target>& targets) const {
  std::vector<SearchedStretch> searched;
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kReach_m);
  for (const Target& target : targets) {
    const UncertainPose<SE3>& T = target.T_i_j;
    const Eigen::Vector2d at = T.pose.translation().head<2>(), off = possible_off_m(T);
    searched.push_back({grids_[target.anchor].get(), in_plane(robot.poses[anchors_[target.anchor]]),
                        in_plane(T.pose), kPossibleSigmas * std::sqrt(T.covariance(5, 5)),
                        (at - off).cwiseMax(-reach), (at + off).cwiseMin(reach)});
  }
  std::vector<Fit> fits;
  const auto points = evenly_chosen(grids_[source]->occupied(), kPoints);
  for (const FoundPlace& place : search_stretches(points, searched, {})) {
    const Target& target = targets[place.stretch];
    fits.push_back({&target, place.T_grid_points,
                    likeness(*grids_[target.anchor], *grids_[source], place.T_grid_points)});
  }
  return fits;
}

void StretchLoops::weigh(std::vector<Fit>& fits) const {
  double best = 0;
  for (const Fit& fit : fits) best = std::max(best, fit.likeness.score);
  for (Fit& fit : fits) {
    fit.likelihood = likelihood_beside(best, fit.likeness.score, params_.alternative_ratio);
    const SE3::Tangent off = (fit.target->T_i_j.pose.inverse() * in_space(fit.T_i_j)).log();
    const SE3::Jacobian covariance =
        fit.target->T_i_j.covariance +
        isotropic(kSigmaSearch_m * kSigmaSearch_m, kSigmaSearch_rad * kSigmaSearch_rad);
    fit.weight = fit.likelihood * prior_density(std::max(0.0, off.dot(ldlt_solve(covariance, off))));
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.weight > b.weight; });
}

double StretchLoops::doubt_of(const std::vector<Fit>& fits, double range_m) const {
  double others = 0, fitting = kUnseenFits;
  for (std::size_t k = 1; k < fits.size(); ++k) {
    others += fits[k].weight;
    if (fits[k].likelihood > kFits) fitting += fits[k].likelihood;
  }
  const double seen_m2 = 2 * range_m * (candidates_.path_m().back() + 2 * range_m);
  const Eigen::Matrix2d covariance = fits.front().target->T_i_j.position_covariance().topLeftCorner<2, 2>();
  const double possible_m2 = 2 * std::numbers::pi * std::sqrt(std::max(0.0, covariance.determinant()));
  others += weight_of_unseen(fitting, seen_m2, possible_m2);
  return others / (others + std::max(fits.front().weight, kLeastWeight));
}

ScanLoop StretchLoops::closure_of(std::size_t source, const PlacedKeyframes& robot,
                                  const std::vector<Target>& targets) const {
  const std::size_t j = anchors_[source];
  std::vector<Fit> fits = fits_of(source, robot, targets);
  ScanLoop loop{anchors_[targets.front().anchor], j, targets.front().T_i_j.pose};
  loop.status = LoopStatus::kLowOverlap;
  if (fits.empty()) return loop;
  weigh(fits);
  const Fit& first = fits.front();
  loop.i = anchors_[first.target->anchor];
  loop.T_i_j = in_space(first.T_i_j);
  loop.inlier_ratio = first.likeness.agreement();
  if (loop.inlier_ratio < kMinAgreement * nominal_ || first.likeness.seen() < kMinSeen) return loop;
  loop.doubt = doubt_of(fits, std::max(1.0, keyframes_.clouds[j].median_range_m()));
  loop.status = LoopStatus::kAmbiguous;
  if (*loop.doubt > params_.max_doubt) return loop;
  const ScanLoop fine = registration_.register_near(
      robot, loop.i, robot, j,
      {loop.T_i_j, isotropic(kSigmaSearch_m * kSigmaSearch_m, kSigmaSearch_rad * kSigmaSearch_rad)});
  const double score = likeness(*grids_[first.target->anchor], *grids_[source], in_plane(fine.T_i_j)).score;
  loop.status = score < kRefined * first.likeness.score ? LoopStatus::kLowOverlap : LoopStatus::kAccepted;
  loop.T_i_j = fine.T_i_j;
  loop.information = fine.information;
  return loop;
}

}  // namespace radioslam
