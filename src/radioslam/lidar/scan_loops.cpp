#include "radioslam/lidar/scan_loops.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/marginals.hpp"

namespace radioslam {
namespace {

constexpr double kLossScale = 4.1;  // root of chi-squared of 6 at 99 %

std::vector<double> way_of(const std::vector<SE3>& poses) {
  std::vector<double> way(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k)
    way[k] = way[k - 1] + (poses[k - 1].inverse() * poses[k]).translation().norm();
  return way;
}

/// A pair to try, with what is known of where the later one stands.
struct Candidate {
  std::size_t i = 0, j = 0;
  UncertainPose<SE3> T_i_j;
};

class LoopCloser {
 public:
  LoopCloser(const ScanKeyframes& keyframes, const ScanLoopParams& params, const LocalMapParams& map,
             const PoseSearchParams& search, const RegistrationParams& registration)
      : keyframes_(keyframes),
        params_(params),
        map_params_(map),
        search_(search),
        registration_(registration),
        way_(way_of(keyframes.poses)) {
    graph_.poses = keyframes.poses;
    for (std::size_t k = 0; k + 1 < keyframes.poses.size(); ++k) {
      RelativePoseFactor<SE3> factor;
      factor.i = PoseId(k);
      factor.j = PoseId(k + 1);
      factor.T_i_j = keyframes.poses[k].inverse() * keyframes.poses[k + 1];
      factor.information = keyframes.step_covariances[k].inverse();
      graph_.relative_poses.push_back(factor);
    }
  }

  ScanLoops run(const Progress& progress) {
    for (int round = 0; round < params_.rounds; ++round) {
      const auto candidates = find_candidates();
      std::vector<ScanLoop> tried(candidates.size());
      parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) tried[k] = try_candidate(candidates[k]);
      });
      const auto found = std::count_if(tried.begin(), tried.end(), [](const ScanLoop& loop) {
        return loop.verdict == LoopVerdict::kAccepted;
      });
      loops_.insert(loops_.end(), tried.begin(), tried.end());
      if (found == 0) break;
      settle(progress);
    }
    return {loops_, graph_.poses};
  }

 private:
  double radius_of(std::size_t k) const { return params_.radius_share * keyframes_.clouds[k].median_range_m; }

  std::vector<Candidate> find_candidates() {
    const auto marginals = Marginals<SE3>::compute(graph_);
    std::vector<Candidate> candidates;
    if (!marginals) return candidates;
    double next_m = 0;
    for (std::size_t j = 0; j < graph_.poses.size(); ++j) {
      if (way_[j] < next_m || keyframes_.clouds[j].source.surfels.empty()) continue;
      next_m = way_[j] + params_.stride_m;
      for (const std::size_t i : earlier_visits(j, *marginals)) {
        if (tried_.contains({i, j})) continue;
        const auto T_i_j = graph_.poses[i].inverse() * graph_.poses[j];
        const SE3::Jacobian covariance = marginals->relative_pose(PoseId(i), PoseId(j));
        if (!is_candidate({T_i_j, covariance}, radius_of(j))) continue;
        tried_.insert({i, j});
        candidates.push_back({i, j, {T_i_j, covariance}});
      }
    }
    return candidates;
  }

  /// Of every stretch of earlier way that may pass keyframe j, the keyframe nearest to it.
  std::vector<std::size_t> earlier_visits(std::size_t j, const Marginals<SE3>& marginals) const {
    const double sigma_j = std::sqrt(marginals.pose(PoseId(j)).topLeftCorner<3, 3>().trace());
    const double limit = radius_of(j) + params_.sigmas * sigma_j;
    std::vector<std::size_t> visits;
    double nearest = 0;
    bool inside = false;
    for (std::size_t i = 0; i < j && way_[j] - way_[i] >= params_.least_way_m; ++i) {
      const double distance = (graph_.poses[i].translation() - graph_.poses[j].translation()).norm();
      if (keyframes_.clouds[i].source.surfels.empty() || distance > limit) {
        inside = false;
        continue;
      }
      if (!inside) {
        visits.push_back(i);
        nearest = distance;
      } else if (distance < nearest) {
        visits.back() = i;
        nearest = distance;
      }
      inside = true;
    }
    return visits;
  }

  bool is_candidate(const UncertainPose<SE3>& T_i_j, double radius_m) const {
    const Eigen::Matrix3d covariance = T_i_j.position_covariance();
    const Eigen::Vector3d offset = T_i_j.pose.translation();
    const double distance = offset.norm();
    if (std::sqrt(covariance.trace()) < params_.known_sigma_m) return false;
    if (distance <= radius_m) return true;
    const Eigen::Vector3d beyond = (distance - radius_m) / distance * offset;
    return beyond.dot(covariance.inverse() * beyond) <= params_.sigmas * params_.sigmas;
  }

  LocalMap map_about(std::size_t i) const {
    LocalMap map(keyframes_.spacing_m, map_params_);
    const SE3 T_i_frame = graph_.poses[i].inverse();
    for (std::size_t k = 0; k < graph_.poses.size(); ++k)
      if (std::abs(way_[k] - way_[i]) <= params_.submap_m)
        map.add(keyframes_.clouds[k], T_i_frame * graph_.poses[k], 0);
    return map;
  }

  ScanLoop try_candidate(const Candidate& candidate) const {
    const PoseSearch found = search_pose(map_about(candidate.i), keyframes_.clouds[candidate.j],
                                         candidate.T_i_j, keyframes_.kind, search_, registration_);
    ScanLoop loop{candidate.i, candidate.j, found.best.T_target_source};
    loop.matched_share = found.best.matched_share;
    loop.information = bounded(found.best.information);
    loop.verdict = judge(found, candidate, loop);
    return loop;
  }

  LoopVerdict judge(const PoseSearch& found, const Candidate& candidate, const ScanLoop& loop) const {
    if (loop.matched_share < params_.fit_share * keyframes_.usual_share) return LoopVerdict::kPoorFit;
    if (found.next_share > params_.rival_share * loop.matched_share) return LoopVerdict::kAmbiguous;
    const SE3::Tangent off = (candidate.T_i_j.pose.inverse() * loop.T_i_j).log();
    const SE3::Jacobian covariance =
        candidate.T_i_j.covariance + (loop.information + 1e-9 * SE3::Jacobian::Identity()).inverse();
    if (off.dot(covariance.ldlt().solve(off)) > params_.gate) return LoopVerdict::kFarFromGuess;
    return LoopVerdict::kAccepted;
  }

  /// The map that was met has errors of its own: (I^-1 + least)^-1, also where I is singular.
  SE3::Jacobian bounded(const SE3::Jacobian& information) const {
    SE3::Tangent most;
    most.head<3>().setConstant(1 / (params_.least_sigma_m * params_.least_sigma_m));
    most.tail<3>().setConstant(1 / (params_.least_sigma_rad * params_.least_sigma_rad));
    const SE3::Jacobian limit = most.asDiagonal();
    const SE3::Jacobian bounded = limit - limit * (information + limit).ldlt().solve(limit);
    return 0.5 * (bounded + bounded.transpose());
  }

  /// Optimises with all closures that stand; those that the others contradict fall.
  void settle(const Progress& progress) {
    graph_.relative_poses.resize(graph_.poses.size() - 1);
    std::vector<std::size_t> of_factor;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      if (loops_[k].verdict != LoopVerdict::kAccepted) continue;
      RelativePoseFactor<SE3> factor;
      factor.i = PoseId(loops_[k].i);
      factor.j = PoseId(loops_[k].j);
      factor.T_i_j = loops_[k].T_i_j;
      factor.information = loops_[k].information;
      factor.loss = {LossKind::kGemanMcClure, kLossScale};
      graph_.relative_poses.push_back(factor);
      of_factor.push_back(k);
    }
    const FactorMask mask = geman_mcclure_factors(graph_);
    const auto summary =
        optimize_graduated(graph_, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {}, progress);
    apply_weights(summary.weights, mask, graph_);
    for (std::size_t f = graph_.poses.size() - 1; f < graph_.relative_poses.size(); ++f)
      if (graph_.relative_poses[f].weight < 0.5)
        loops_[of_factor[f - (graph_.poses.size() - 1)]].verdict = LoopVerdict::kOutvoted;
  }

  const ScanKeyframes& keyframes_;
  ScanLoopParams params_;
  LocalMapParams map_params_;
  PoseSearchParams search_;
  RegistrationParams registration_;
  std::vector<double> way_;
  PoseGraph<SE3> graph_;
  std::vector<ScanLoop> loops_;
  std::set<std::pair<std::size_t, std::size_t>> tried_;
};

}  // namespace

std::string_view reason(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::kAccepted:
      return "";
    case LoopVerdict::kPoorFit:
      return "the scans do not fit";
    case LoopVerdict::kAmbiguous:
      return "another place fits as well";
    case LoopVerdict::kFarFromGuess:
      return "the odometry disagrees";
    case LoopVerdict::kOutvoted:
      return "the other closures disagree";
  }
  return "";
}

ScanLoops close_scan_loops(const ScanKeyframes& keyframes, const ScanLoopParams& params,
                           const LocalMapParams& map, const PoseSearchParams& search,
                           const RegistrationParams& registration, const Progress& progress) {
  if (!params.enabled || keyframes.poses.size() < 2) return {{}, keyframes.poses};
  return LoopCloser(keyframes, params, map, search, registration).run(progress);
}

}  // namespace radioslam
