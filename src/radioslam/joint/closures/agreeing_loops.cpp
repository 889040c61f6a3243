#include "radioslam/joint/closures/agreeing_loops.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNeighbours = 40;  // poses between loops that are compared
constexpr double kOdometryVariance = 4;  // over the stated one: it is often understated

}  // namespace

template <class Pose>
AgreeingLoops<Pose>::AgreeingLoops(const LoopChoice<Pose>& choice)
    : choice_(choice), step_(choice.graph.poses.size()) {
  for (std::size_t k = 0; k < choice_.first_loop(); ++k) {
    const auto& factor = choice_.graph.relative_poses[k];
    if (choice_.is_odometry[k] && factor.j.index() == factor.i.index() + 1) step_[factor.j.index()] = &factor;
  }
}

template <class Pose>
std::vector<std::vector<std::size_t>> AgreeingLoops<Pose>::groups() {
  const std::size_t loops = choice_.gates.size();
  std::vector<std::size_t> by_start(loops);
  std::iota(by_start.begin(), by_start.end(), std::size_t{0});
  std::stable_sort(by_start.begin(), by_start.end(),
                   [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
  parent_.resize(loops);
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  for (std::size_t a = 0; a < loops; ++a)
    for (std::size_t b = a + 1; b < loops && low(by_start[b]) - low(by_start[a]) <= kNeighbours; ++b)
      if (root(by_start[a]) != root(by_start[b]) && agree(by_start[a], by_start[b]))
        parent_[root(by_start[b])] = root(by_start[a]);
  std::map<std::size_t, std::vector<std::size_t>> of_root;
  for (std::size_t k = 0; k < loops; ++k) of_root[root(k)].push_back(k);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [root, group] : of_root) groups.push_back(std::move(group));
  return groups;
}

template <class Pose>
std::optional<double> AgreeingLoops<Pose>::disagreement(std::size_t a, std::size_t b) const {
  const auto at_low = way(low(a), low(b)), at_high = way(high(a), high(b));
  if (!at_low || !at_high) return std::nullopt;
  const UncertainPose<Pose> one = measured(a) * *at_high, other = *at_low * measured(b);
  const typename Pose::Jacobian covariance = one.covariance + other.covariance;
  const Cholesky<typename Pose::Jacobian> cholesky(covariance);
  if (!cholesky.succeeded()) return std::nullopt;
  return cholesky.whitened((one.pose.inverse() * other.pose).log()).squaredNorm();
}

template <class Pose>
std::size_t AgreeingLoops<Pose>::low(std::size_t loop) const {
  return std::min(choice_.loop(loop).i, choice_.loop(loop).j).index();
}

template <class Pose>
std::size_t AgreeingLoops<Pose>::high(std::size_t loop) const {
  return std::max(choice_.loop(loop).i, choice_.loop(loop).j).index();
}

template <class Pose>
std::size_t AgreeingLoops<Pose>::root(std::size_t k) {
  while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
  return k;
}

/// The loop from its lower pose to its higher one.
template <class Pose>
UncertainPose<Pose> AgreeingLoops<Pose>::measured(std::size_t loop) const {
  const auto& factor = choice_.loop(loop);
  const UncertainPose<Pose> pose{factor.T_i_j, inverse(factor.information)};
  return factor.i < factor.j ? pose : pose.inverse();
}

/// The odometry from pose `i` to pose `j`; nothing across a gap.
template <class Pose>
std::optional<UncertainPose<Pose>> AgreeingLoops<Pose>::way(std::size_t i, std::size_t j) const {
  UncertainPose<Pose> sum{Pose(), Pose::Jacobian::Zero()};
  for (std::size_t k = std::min(i, j) + 1; k <= std::max(i, j); ++k) {
    if (!step_[k]) return std::nullopt;
    const typename Pose::Jacobian covariance = kOdometryVariance * inverse(step_[k]->information);
    sum = sum * UncertainPose<Pose>{step_[k]->T_i_j, covariance};
  }
  return i <= j ? sum : sum.inverse();
}

template <class Pose>
bool AgreeingLoops<Pose>::agree(std::size_t a, std::size_t b) const {
  const std::size_t apart = high(a) > high(b) ? high(a) - high(b) : high(b) - high(a);
  if (apart > kNeighbours) return false;
  const auto statistic = disagreement(a, b);
  return statistic && *statistic <= kPoseChiSquared999<Pose>;
}

template class AgreeingLoops<SE2>;
template class AgreeingLoops<SE3>;

}  // namespace radioslam
