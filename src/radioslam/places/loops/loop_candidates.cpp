#include "radioslam/places/loops/loop_candidates.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/graph/gauge.hpp"
#include "radioslam/places/closure_worth.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kKeptSigmas = 64;

bool is_doubtful(LoopStatus status) {
  return status == LoopStatus::kAmbiguous || status == LoopStatus::kUnmapped ||
         status == LoopStatus::kAnotherStorey;
}

}  // namespace

void LoopCandidates::note(const ScanLoop& tried) {
  if (!is_doubtful(tried.status)) tried_[{tried.i, tried.j}] = 0;
}

std::vector<LoopCandidate> LoopCandidates::find(const PoseGraph<SE3>& graph) {
  marginals_ = Marginals<SE3>::compute(graph);
  sigmas_.clear();
  std::vector<LoopCandidate> candidates;
  if (!marginals_) return candidates;
  part_of_ = connected_components(graph).of_pose;
  double next_m = 0;
  for (std::size_t j = 0; j < graph.poses.size(); ++j) {
    if (path_m_[j] < next_m || keyframes_.clouds[j].empty()) continue;
    next_m = path_m_[j] + params_.stride_m;
    std::vector<SE3::Jacobian> with_j;  // where j may be a revisit
    for (const std::size_t i : revisits(j, graph.poses)) {
      const auto tried = tried_.find({i, j});
      if (tried != tried_.end() && tried->second == 0) continue;
      const auto T_i_j = graph.poses[i].inverse() * graph.poses[j];
      if (with_j.empty()) with_j = marginals_->relative_poses_with(PoseId(j));
      const SE3::Jacobian covariance = relative_covariance(i, j, with_j[i]);
      if (!is_candidate({T_i_j, covariance}, radius_of(j))) continue;
      const double sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
      if (tried != tried_.end() && !is_worth_another_trial(tried->second, sigma_m)) continue;
      tried_[{i, j}] = sigma_m;
      candidates.push_back({i, j, {T_i_j, covariance}});
    }
  }
  return candidates;
}

bool LoopCandidates::leave_out(std::size_t most, const PoseGraph<SE3>& graph,
                               std::vector<LoopCandidate>& found) {
  if (found.size() <= most) return false;
  std::vector<bool> is_kept(found.size(), false);
  std::vector<WeighedPair> pairs;
  std::vector<std::size_t> of_pair;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto& [i, j, T_i_j] = found[k];
    if (part_of_[i] != part_of_[j]) {
      if (most == 0) continue;
      is_kept[k] = true;
      --most;
      continue;
    }
    const double near = probability_within(radius_of(j), T_i_j.pose.translation().head<2>(),
                                           T_i_j.position_covariance().topLeftCorner<2, 2>());
    pairs.push_back({PoseId(i), PoseId(j), near});
    of_pair.push_back(k);
  }
  const SE3::Jacobian cov_closure =
      isotropic(params_.min_sigma_m * params_.min_sigma_m, params_.min_sigma_rad * params_.min_sigma_rad);
  for (const std::size_t n :
       choose_by_worth<SE3>(pairs, {graph.poses, *marginals_}, cov_closure, std::min(most, pairs.size())))
    is_kept[of_pair[n]] = true;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (is_kept[k])
      found[kept++] = found[k];
    else
      tried_.erase({found[k].i, found[k].j});
  }
  found.resize(kept);
  return true;
}

std::vector<std::size_t> LoopCandidates::revisits(std::size_t j, const std::vector<SE3>& poses) const {
  const double sigma_j = std::sqrt(marginals_->pose(PoseId(j)).topLeftCorner<3, 3>().trace());
  std::vector<std::size_t> visits;
  double nearest = 0;
  bool inside = false;
  for (std::size_t i = 0; i < j && path_m_[j] - path_m_[i] >= params_.min_path_m; ++i) {
    const double distance = (poses[i].translation() - poses[j].translation()).norm();
    const double sigma = part_of_[i] == part_of_[j] ? sigma_j : unknown_motion_m(i, j);
    const double limit = radius_of(j) + params_.sigmas * sigma;
    if (keyframes_.clouds[i].empty() || distance > limit) {
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

double LoopCandidates::unknown_motion_m(std::size_t i, std::size_t j) const {
  double variance = 0;
  for (std::size_t k = i; k < j; ++k)
    if (is_unknown_motion(keyframes_.step_covariances[k]))
      variance += keyframes_.step_covariances[k].topLeftCorner<3, 3>().trace();
  return std::sqrt(variance);
}

double LoopCandidates::sigma_m(std::size_t i, std::size_t j) const { return (*sigmas_with(i))[j]; }

std::shared_ptr<const std::vector<double>> LoopCandidates::sigmas_with(std::size_t i) const {
  {
    const std::lock_guard lock(sigmas_mutex_);
    if (const auto known = sigmas_.find(i); known != sigmas_.end()) return known->second;
  }
  std::vector<double> sigmas;
  for (const SE3::Jacobian& covariance : covariances_with(i))
    sigmas.push_back(std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3));
  const std::lock_guard lock(sigmas_mutex_);
  if (sigmas_.size() >= kKeptSigmas) sigmas_.clear();
  return sigmas_[i] = std::make_shared<const std::vector<double>>(std::move(sigmas));
}

std::vector<SE3::Jacobian> LoopCandidates::covariances_with(std::size_t j) const {
  std::vector<SE3::Jacobian> with_j = marginals_->relative_poses_with(PoseId(j));
  for (std::size_t k = 0; k < with_j.size(); ++k)
    with_j[k] = relative_covariance(std::min(j, k), std::max(j, k), with_j[k]);
  return with_j;
}

SE3::Jacobian LoopCandidates::relative_covariance(std::size_t i, std::size_t j,
                                                  const SE3::Jacobian& in_one_part) const {
  if (part_of_[i] == part_of_[j]) return in_one_part;
  const double sigma_m = unknown_motion_m(i, j);
  return isotropic(sigma_m * sigma_m / 3, std::numbers::pi * std::numbers::pi);
}

bool LoopCandidates::is_candidate(const UncertainPose<SE3>& T_i_j, double radius_m) const {
  const Eigen::Matrix3d covariance = T_i_j.position_covariance();
  const Eigen::Vector3d offset = T_i_j.pose.translation();
  const double distance = offset.norm();
  if (std::sqrt(covariance.trace()) < params_.known_sigma_m) return false;
  if (distance <= radius_m) return true;
  const Eigen::Vector3d beyond = (distance - radius_m) / distance * offset;
  return beyond.dot(covariance.inverse() * beyond) <= params_.sigmas * params_.sigmas;
}

}  // namespace radioslam
