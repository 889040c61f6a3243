#include "radioslam/sim/sensors/aliased_matches.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

/// draws of an alias until it gives enough pairs
constexpr int kAliasDraws = 30;
/// draws of a position that is far enough away
constexpr int kPositionDraws = 100;

/// Pose k of robot i and pose l of robot j.
struct PosePair {
  std::size_t i = 0, j = 0, k = 0, l = 0;
};

struct DrawnMatch {
  PoseMatch match;
  bool is_true = false;
};

/// Pairs of poses of robots i and j that are close to each other after S has moved those of j.
std::vector<PosePair> near_pairs(const std::vector<Trajectory<SE3>>& truth, std::size_t i, std::size_t j,
                                 const SE3& S, double within_m) {
  std::vector<PosePair> pairs;
  for (std::size_t l = 0; l < truth[j].size(); ++l) {
    const Eigen::Vector3d place = S * truth[j][l].pose.translation();
    for (std::size_t k = 0; k < truth[i].size(); ++k)
      if ((truth[i][k].pose.translation() - place).squaredNorm() < within_m * within_m)
        pairs.push_back({i, j, k, l});
  }
  return pairs;
}

/// `count` distinct pairs.
std::vector<PosePair> sample(std::vector<PosePair> pairs, std::size_t count, Rng& rng) {
  count = std::min(count, pairs.size());
  for (std::size_t n = 0; n < count; ++n) std::swap(pairs[n], pairs[n + rng.below(pairs.size() - n)]);
  pairs.resize(count);
  return pairs;
}

SE3::Tangent draw_noise(int dimension, const AliasedMatchParams& params, Rng& rng) {
  const double sigma_r_rad = radians(params.sigma_match_r_deg);
  SE3::Tangent noise;
  for (int k = 0; k < 6; ++k) noise(k) = rng.normal(0, k < 3 ? params.sigma_match_t_m : sigma_r_rad);
  if (dimension == 2) noise.segment<3>(2).setZero();
  return noise;
}

DrawnMatch measure(const std::vector<Trajectory<SE3>>& truth, const PosePair& pair, const SE3& S,
                   int dimension, const AliasedMatchParams& params, Rng& rng) {
  const auto& at_i = truth[pair.i][pair.k];
  const auto& at_j = truth[pair.j][pair.l];
  DrawnMatch drawn;
  drawn.match.robot_i = RobotIndex(pair.i);
  drawn.match.robot_j = RobotIndex(pair.j);
  drawn.match.stamp_i = at_i.stamp;
  drawn.match.stamp_j = at_j.stamp;
  drawn.match.T_i_j = at_i.pose.inverse() * S * at_j.pose * SE3::exp(draw_noise(dimension, params, rng));
  drawn.match.covariance = isotropic_covariance(params.sigma_match_t_m, radians(params.sigma_match_r_deg));
  return drawn;
}

void append_true(const std::vector<Trajectory<SE3>>& truth, int dimension, double within_m,
                 const AliasedMatchParams& params, Rng rng, std::vector<DrawnMatch>& drawn) {
  if (params.matches_true == 0) return;
  std::vector<PosePair> all;
  for (std::size_t j = 1; j < truth.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const auto pairs = near_pairs(truth, i, j, {}, within_m);
      all.insert(all.end(), pairs.begin(), pairs.end());
    }
  for (const PosePair& pair : sample(std::move(all), static_cast<std::size_t>(params.matches_true), rng)) {
    drawn.push_back(measure(truth, pair, {}, dimension, params, rng));
    drawn.back().is_true = true;
  }
}

/// An alias motion and the pairs of poses that it brings close to each other.
struct Alias {
  SE3 S;
  std::vector<PosePair> pairs;
};

Alias draw_rich_alias(const std::vector<Trajectory<SE3>>& truth, std::size_t i, std::size_t j,
                      std::size_t wanted, double within_m, const DrawAlias& draw, Rng& rng) {
  Alias best;
  for (int attempt = 0; attempt < kAliasDraws && (attempt == 0 || best.pairs.size() < wanted); ++attempt) {
    const SE3 S = draw(truth[i], truth[j], rng);
    auto pairs = near_pairs(truth, i, j, S, within_m);
    if (attempt == 0 || pairs.size() > best.pairs.size()) best = {S, std::move(pairs)};
  }
  return best;
}

void append_aliased(const std::vector<Trajectory<SE3>>& truth, int dimension, double within_m,
                    const DrawAlias& draw, const AliasedMatchParams& params, const Rng& rng,
                    std::vector<DrawnMatch>& drawn) {
  std::vector<std::pair<std::size_t, std::size_t>> teams;
  for (std::size_t j = 1; j < truth.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) teams.emplace_back(i, j);
  if (teams.empty() || params.matches_false == 0) return;
  const auto groups = static_cast<std::size_t>(params.aliases);
  const auto total = static_cast<std::size_t>(params.matches_false);
  for (std::size_t group = 0; group < groups; ++group) {
    const std::size_t wanted = total * (group + 1) / groups - total * group / groups;
    const auto [i, j] = teams[group % teams.size()];
    Rng own = rng.split(group);
    const Alias alias = draw_rich_alias(truth, i, j, wanted, within_m, draw, own);
    for (const PosePair& pair : sample(alias.pairs, wanted, own))
      drawn.push_back(measure(truth, pair, alias.S, dimension, params, own));
  }
}

}  // namespace

DrawAlias upright_alias(double apart_m) {
  return [apart_m](const Trajectory<SE3>& i, const Trajectory<SE3>& j, Rng& rng) {
    SE3 best;
    double furthest_m = -1;
    for (int attempt = 0; attempt < kPositionDraws && furthest_m < apart_m; ++attempt) {
      const SE3& here = i[rng.below(i.size())].pose;
      const SE3& there = j[rng.below(j.size())].pose;
      const double distance_m = (here.translation() - there.translation()).norm();
      if (distance_m <= furthest_m) continue;
      furthest_m = distance_m;
      best = lift(flatten(here), here.translation().z()) *
             lift(flatten(there), there.translation().z()).inverse();
    }
    return best;
  };
}

LabelledMatches simulate_matches(const std::vector<Trajectory<SE3>>& truth, int dimension, double within_m,
                                 const DrawAlias& draw_alias, const AliasedMatchParams& params,
                                 const Rng& rng) {
  std::vector<DrawnMatch> drawn;
  append_true(truth, dimension, within_m, params, rng.split("true"), drawn);
  append_aliased(truth, dimension, within_m, draw_alias, params, rng.split("aliased"), drawn);
  std::stable_sort(drawn.begin(), drawn.end(), [](const DrawnMatch& a, const DrawnMatch& b) {
    return std::tie(a.match.stamp_i, a.match.stamp_j) < std::tie(b.match.stamp_i, b.match.stamp_j);
  });
  LabelledMatches result;
  for (const DrawnMatch& one : drawn) {
    result.matches.push_back(one.match);
    result.true_matches.emplace_back(one.is_true);
  }
  return result;
}

}  // namespace radioslam
