// Matches whose relative poses are the inverse of what is documented, or have their quaternion's w first.
// Two matches between the same robots close a loop with the odometry between them. Wrong matches close none;
// where most loops close only under another reading, that is how they were written.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kMaxPath_m = 60;   // of dead reckoning between two matches
constexpr double kMinMotion_m = 1;  // without which any reading closes the loop
constexpr std::size_t kMinLoops = 6;
constexpr double kMaxClosed = 0.3, kMinClosed = 0.6, kMinRatio = 3;
constexpr std::size_t kNeighbours = 8;

using Reading = SE3 (*)(const SE3&);

SE3 as_recorded(const SE3& T) { return T; }
SE3 inverted(const SE3& T) { return T.inverse(); }
/// As if the file's columns had been w, x, y, z: the value read as x is w.
SE3 with_w_first(const SE3& T) {
  const Eigen::Quaterniond& q = T.rotation();
  return {T.translation(), Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())};
}

struct Placed {
  SE3 T_i_j;
  Track::Row a, b;
  double sigma_m, sigma_rad;
};

SE3 pose_of(const Track::Row& row) { return {row.position_m, row.rotation}; }

/// Whether the loop over two matches closes, within their noise and what dead reckoning may drift.
bool closes(const Placed& x, const Placed& y, Reading reading) {
  const double path_m = std::abs(x.a.path_m - y.a.path_m) + std::abs(x.b.path_m - y.b.path_m);
  const SE3 one = reading(x.T_i_j) * (pose_of(x.b).inverse() * pose_of(y.b)),
            other = (pose_of(x.a).inverse() * pose_of(y.a)) * reading(y.T_i_j);
  const SE3::Tangent error = (one.inverse() * other).log();
  return error.head<3>().norm() < 0.3 + 0.03 * path_m + 4 * (x.sigma_m + y.sigma_m) &&
         error.tail<3>().norm() < 0.1 + 0.003 * path_m + 4 * (x.sigma_rad + y.sigma_rad);
}

}  // namespace

std::vector<Finding> check_matches(const Mission& mission) {
  if (mission.matches.empty()) return {};
  std::vector<Track> tracks;
  for (const Robot& robot : mission.robots) tracks.emplace_back(robot);
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Placed>> of_pair;
  for (const PoseMatch& match : mission.matches) {
    const auto a = tracks[match.robot_i.index()].at(match.stamp_i.seconds()),
               b = tracks[match.robot_j.index()].at(match.stamp_j.seconds());
    if (!a || !b) continue;
    of_pair[{match.robot_i.index(), match.robot_j.index()}].push_back(
        {match.T_i_j, *a, *b, std::sqrt(match.covariance.topLeftCorner<2, 2>().diagonal().maxCoeff()),
         std::sqrt(match.covariance(5, 5))});
  }
  const std::array<Reading, 3> readings = {as_recorded, inverted, with_w_first};
  std::array<double, 3> closed{};
  std::size_t loops = 0;
  for (auto& [pair, matches] : of_pair) {
    std::stable_sort(matches.begin(), matches.end(),
                     [](const Placed& x, const Placed& y) { return x.a.path_m < y.a.path_m; });
    for (std::size_t k = 0; k < matches.size(); ++k)
      for (std::size_t l = k + 1; l < std::min(matches.size(), k + kNeighbours); ++l) {
        const double of_a = std::abs(matches[k].a.path_m - matches[l].a.path_m),
                     of_b = std::abs(matches[k].b.path_m - matches[l].b.path_m);
        if (of_a + of_b > kMaxPath_m || of_a + of_b < kMinMotion_m) continue;
        ++loops;
        for (std::size_t r = 0; r < readings.size(); ++r)
          closed[r] += closes(matches[k], matches[l], readings[r]);
      }
  }
  const auto best = static_cast<std::size_t>(std::max_element(closed.begin(), closed.end()) - closed.begin());
  const double count = static_cast<double>(loops);
  if (loops < kMinLoops || best == 0 || closed[0] > kMaxClosed * count || closed[best] < kMinClosed * count ||
      closed[best] < kMinRatio * closed[0])
    return {};
  const std::string shares = number(100 * closed[best] / count) +
                             " % of the loops over two matches close then, " +
                             number(100 * closed[0] / count) + " % as recorded";
  if (best == 1)
    return {{"convention", Severity::kWarning, "", "matches.csv",
             "relative poses are the inverse ones (" + shares + ")", "the pose of body j in body i",
             "exchange robots and times i and j, or invert the poses"}};
  return {{"column-order", Severity::kWarning, "", "matches.csv",
           "quaternions fit with w before x, y, z (" + shares + ")", "x, y, z, w", "reorder the columns"}};
}

}  // namespace radioslam
