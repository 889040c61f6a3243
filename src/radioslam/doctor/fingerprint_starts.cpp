// Whether stated starts agree with fingerprints: how similar scans of two robots are should depend on how far
// apart the starts and the odometry have them.
//
// The mean similarity at a distance, m(d), is learnt from each robot's own scans within stretches in which
// dead reckoning is nearly exact. For two robots and a relative pose T of their starts, r(T) is the
// correlation of the similarities of their scans with m at the distances under T; a correlation, since
// another device lowers all similarities by one factor. The stated T is held against the best of those that
// two pairs of most similar scans propose. Drift lowers r of sound starts a little; robots that were never
// near each other have no T that explains anything, and show nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/correlation.hpp"
#include "radioslam/doctor/starts.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxScans = 150, kMinScans = 20;
constexpr double kMaxPath_m = 300;      // from the start, over which dead reckoning is compared
constexpr double kOwnPath_m = 100;      // between a robot's own scans
constexpr std::size_t kProposing = 40;  // most similar pairs
constexpr double kMinBaseline_m = 10, kMaxMisfit_m = 6;
constexpr double kDrift_m = 5, kDrift_rad = 0.2;
constexpr double kMinExplained = 0.2;       // of the variance, by the best alignment
constexpr double kMaxExplainedRatio = 0.6;  // of that, by the stated one
constexpr double kSigma_m = 5, kSigma_rad = 0.25;
constexpr std::array kDistances_m{2.0, 4.0, 7.0, 10.0, 14.0, 20.0, 28.0, 40.0, 56.0, 80.0, 120.0};

struct PlacedScan {
  const WifiScan* scan;
  Eigen::Vector2d place_m;  ///< from the robot's start
  double path_m;
};

std::vector<PlacedScan> placed_scans(const Robot& robot, const Track& track) {
  std::vector<PlacedScan> placed;
  for (const WifiScan& scan : robot.wifi)
    if (const auto row = track.at(scan.stamp.seconds()); row && row->path_m < kMaxPath_m)
      placed.push_back({&scan, row->position_m.head<2>(), row->path_m});
  const std::size_t count = std::min(kMaxScans, placed.size());
  for (std::size_t k = 0; k < count; ++k) placed[k] = placed[k * placed.size() / count];
  placed.resize(count);
  return placed;
}

std::size_t bin_of(double distance_m) {
  return static_cast<std::size_t>(std::upper_bound(kDistances_m.begin(), kDistances_m.end(), distance_m) -
                                  kDistances_m.begin());
}

/// Mean similarity by distance.
struct SimilarityLaw {
  std::array<double, kDistances_m.size() + 1> sums{}, counts{};

  void learn(const std::vector<PlacedScan>& scans) {
    for (std::size_t a = 0; a < scans.size(); ++a)
      for (std::size_t b = a + 1; b < scans.size() && scans[b].path_m - scans[a].path_m < kOwnPath_m; ++b) {
        const std::size_t bin = bin_of((scans[a].place_m - scans[b].place_m).norm());
        sums[bin] += fingerprint_similarity(*scans[a].scan, *scans[b].scan);
        counts[bin] += 1;
      }
  }
  double at(double distance_m) const {
    for (std::size_t bin = bin_of(distance_m); bin < counts.size(); ++bin)
      if (counts[bin] > 0) return sums[bin] / counts[bin];
    return 0;
  }
};

struct ComparedPair {
  std::size_t a, b;
  double similarity;
};

class PairOfRobots {
 public:
  PairOfRobots(const std::vector<PlacedScan>& of_i, const std::vector<PlacedScan>& of_j,
               const SimilarityLaw& law)
      : i_(of_i), j_(of_j), law_(law) {
    for (std::size_t a = 0; a < i_.size(); ++a)
      for (std::size_t b = 0; b < j_.size(); ++b)
        pairs_.push_back({a, b, fingerprint_similarity(*i_[a].scan, *j_[b].scan)});
  }

  /// Share of the variance of similarities that distances under T_i_j explain.
  double explained(const SE2& T_i_j, std::size_t stride) const {
    CorrelationSums sums;
    for (std::size_t k = 0; k < pairs_.size(); k += stride) {
      const ComparedPair& pair = pairs_[k];
      sums.add(law_.at((i_[pair.a].place_m - T_i_j * j_[pair.b].place_m).norm()), pair.similarity);
    }
    const double spread = sums.spread_x() * sums.spread_y();
    if (spread <= 0 || sums.spread_xy() <= 0) return 0;
    return sums.spread_xy() * sums.spread_xy() / spread;
  }

  /// Most that this alignment or one as near as drift may move it explains.
  double explained_near(const SE2& T_i_j) const {
    constexpr std::size_t kStride = 3;
    double most = 0;
    for (const double x_m : {-kDrift_m, 0.0, kDrift_m})
      for (const double y_m : {-kDrift_m, 0.0, kDrift_m})
        for (const double turn_rad : {-kDrift_rad, 0.0, kDrift_rad})
          most = std::max(most, explained(T_i_j * SE2({x_m, y_m}, turn_rad), kStride));
    return most;
  }

  /// The alignment that explains most, of those that the most similar pairs propose.
  SE2 best() const {
    constexpr std::size_t kStride = 7;
    std::pair<double, SE2> best{-1, SE2()};
    const std::vector<ComparedPair> proposing = most_similar();
    for (std::size_t x = 0; x < proposing.size(); ++x)
      for (std::size_t y = x + 1; y < proposing.size(); ++y)
        if (const auto T = proposed(proposing[x], proposing[y]))
          if (const double share = explained(*T, kStride); share > best.first) best = {share, *T};
    return best.second;
  }

 private:
  /// At most one per scan of either robot.
  std::vector<ComparedPair> most_similar() const {
    std::vector<ComparedPair> sorted = pairs_, result;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& x, const auto& y) { return x.similarity > y.similarity; });
    std::vector<bool> used_i(i_.size()), used_j(j_.size());
    for (const ComparedPair& pair : sorted) {
      if (result.size() == kProposing) break;
      if (used_i[pair.a] || used_j[pair.b]) continue;
      used_i[pair.a] = used_j[pair.b] = true;
      result.push_back(pair);
    }
    return result;
  }

  /// Both pairs at one place each; nothing if the places are too near, or not equally far apart.
  std::optional<SE2> proposed(const ComparedPair& x, const ComparedPair& y) const {
    const Eigen::Vector2d in_i = i_[y.a].place_m - i_[x.a].place_m, in_j = j_[y.b].place_m - j_[x.b].place_m;
    if (in_i.norm() < kMinBaseline_m || in_j.norm() < kMinBaseline_m ||
        std::abs(in_i.norm() - in_j.norm()) > kMaxMisfit_m)
      return std::nullopt;
    const double turn = wrap_angle(std::atan2(in_i.y(), in_i.x()) - std::atan2(in_j.y(), in_j.x()));
    const Eigen::Vector2d middle_i = 0.5 * (i_[x.a].place_m + i_[y.a].place_m),
                          middle_j = 0.5 * (j_[x.b].place_m + j_[y.b].place_m);
    return SE2(middle_i - SE2({0, 0}, turn) * middle_j, turn);
  }

  const std::vector<PlacedScan>&i_, &j_;
  const SimilarityLaw& law_;
  std::vector<ComparedPair> pairs_;
};

/// The error of the stated relative start, if another one explains much more. `explained`: by the better one.
std::optional<StartError> contradiction(const PairOfRobots& pair, const SE3& stated, double& explained) {
  const SE2 T_stated = pose_as<SE2>(stated), found = pair.best();
  const double by_found = pair.explained_near(found), by_stated = pair.explained_near(T_stated);
  explained = std::max(by_found, by_stated);
  const StartError error{lift(T_stated.inverse() * found), kSigma_m, kSigma_rad};
  if (by_stated > kMaxExplainedRatio * by_found || !error.is_far()) return std::nullopt;
  return error;
}

}  // namespace

std::vector<Finding> check_fingerprint_starts(const Mission& mission) {
  std::vector<std::vector<PlacedScan>> scans(mission.robots.size());
  SimilarityLaw law;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    if (!robot.initial_pose || robot.wifi.size() < kMinScans || robot.odometry.empty()) continue;
    scans[r] = placed_scans(robot, Track(robot));
    law.learn(scans[r]);
  }
  std::vector<PairOfStarts> pairs;
  for (std::size_t i = 0; i < scans.size(); ++i)
    for (std::size_t j = i + 1; j < scans.size(); ++j) {
      if (scans[i].size() < kMinScans || scans[j].size() < kMinScans) continue;
      const SE3 stated = mission.robots[i].initial_pose->inverse() * *mission.robots[j].initial_pose;
      double explained = 0;
      const auto error = contradiction({scans[i], scans[j], law}, stated, explained);
      if (explained >= kMinExplained) pairs.push_back({i, j, error});
    }
  return start_findings(mission, pairs, "the fingerprints");
}

}  // namespace radioslam
