#include "radioslam/study/overlap_growth/overlap_growth.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// n poses at distances of a metre in straight streets, turning at random crossings, from the middle of the
/// square.
std::vector<SE2> drive(Rng& rng, const OverlapTown& town) {
  std::vector<SE2> poses;
  const auto blocks = static_cast<std::uint64_t>(town.side_m / town.street_m);
  const std::uint64_t middle = blocks / 2;
  Eigen::Vector2d p = Eigen::Vector2d::Constant(town.street_m * static_cast<double>(middle));
  int quarter = 0;
  double left_m = 0;
  const auto way = [](int q) {
    return Eigen::Vector2d(q == 0 ? 1 : q == 2 ? -1 : 0, q == 1 ? 1 : q == 3 ? -1 : 0);
  };
  while (poses.size() < town.poses) {
    if (left_m <= 0) {
      quarter = (quarter + (rng.below(2) == 0 ? 1 : 3)) % 4;
      left_m = town.street_m * static_cast<double>(1 + rng.below(std::max<std::uint64_t>(1, blocks / 3)));
      const Eigen::Vector2d end = p + left_m * way(quarter);
      if (end.minCoeff() < 0 || end.maxCoeff() > town.side_m) {
        left_m = 0;
        continue;
      }
    }
    poses.emplace_back(p, quarter * std::numbers::pi / 2);
    p += way(quarter);
    left_m -= 1;
  }
  return poses;
}

/// Poses of a robot by the square of the town that contains them.
class Districts {
 public:
  Districts(const std::vector<SE2>& poses, double size_m) : size_m_(size_m) {
    for (std::size_t k = 0; k < poses.size(); ++k) poses_[square(poses[k])].push_back(k);
  }
  /// Some pose in the same square as `pose`, if there is one.
  std::optional<std::size_t> near(const SE2& pose, Rng& rng) const {
    const auto found = poses_.find(square(pose));
    if (found == poses_.end()) return std::nullopt;
    return found->second[rng.below(found->second.size())];
  }

 private:
  std::pair<long, long> square(const SE2& pose) const {
    return {std::lround(pose.translation().x() / size_m_), std::lround(pose.translation().y() / size_m_)};
  }
  double size_m_;
  std::map<std::pair<long, long>, std::vector<std::size_t>> poses_;
};

constexpr double kFirstPoses = 1000;
constexpr double kMaxAllPairs = 2e7;  // beyond, testing every pair takes long
constexpr std::size_t kMinForSlope =
    10000;  // smaller towns are dominated by clock resolution and cache effects

template <class Work>
double seconds(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Source>
void time_search(const Source& source, const OverlapTeam& team, OverlapGrowthPoint& point) {
  OverlapCandidates found;
  point.search_s = seconds([&] { found = search_overlaps(source, team.sensors, {}); });
  point.pairs = static_cast<double>(found.counts.pairs);
  point.kept = static_cast<double>(found.counts.kept);
  point.distances_evaluated = static_cast<double>(found.counts.distances_evaluated);
  if (point.pairs <= kMaxAllPairs)
    point.all_pairs_s = seconds([&] { search_overlaps_exhaustively(source, team.sensors, {}); });
}

OverlapGrowthPoint time_joint(const OverlapTeam& team, std::size_t poses) {
  OverlapGrowthPoint point;
  point.poses = poses;
  const OverlapTeamGraph g = graph_of(team);
  std::optional<JointCovariance<SE2>> source;
  point.prepare_s = seconds([&] { source = JointCovariance<SE2>::compute(g.graph, g.robots); });
  time_search(*source, team, point);
  return point;
}

OverlapGrowthPoint time_link(const OverlapTeam& team, std::size_t poses) {
  OverlapGrowthPoint point;
  point.poses = poses;
  std::optional<LinkCovariance<SE2>> source;
  point.prepare_s = seconds([&] { source.emplace(team.chains, team.links); });
  time_search(*source, team, point);
  return point;
}

std::vector<std::size_t> town_sizes(std::size_t max_poses) {
  std::vector<std::size_t> sizes;
  for (double poses = kFirstPoses; std::lround(poses) <= static_cast<long>(max_poses);
       poses *= std::sqrt(10.0))
    sizes.push_back(static_cast<std::size_t>(std::lround(poses)));
  return sizes;
}

double items(const OverlapGrowthPoint& point) { return 2 * static_cast<double>(point.poses) + point.kept; }

void add_rows(StudyTable& table, const std::string& mode, const std::vector<OverlapGrowthPoint>& points) {
  for (const OverlapGrowthPoint& p : points) {
    const double allowed = 3 * p.kept + 2 * static_cast<double>(p.poses);
    const auto ratio = p.all_pairs_s ? std::optional(*p.all_pairs_s / p.search_s) : std::nullopt;
    table.rows.push_back({mode,
                          {number_text(static_cast<double>(p.poses), 0), number_text(p.pairs, 0),
                           number_text(p.kept, 0), number_text(p.prepare_s, 3), number_text(p.search_s, 4),
                           number_text(1e6 * p.search_s / items(p), 2),
                           number_text(p.distances_evaluated / allowed, 2), number_text(ratio, 0)}});
  }
}

}  // namespace

OverlapTown growing_town(std::size_t poses) {
  OverlapTown town;
  town.poses = poses;
  town.street_m = 100;
  town.range_m = 5;
  town.side_m = 35 * std::sqrt(static_cast<double>(poses));
  town.links = std::max<std::size_t>(10, poses / 300);
  town.sigma_xy_per_sqrt_m = 0.004;
  town.sigma_yaw_per_sqrt_m_rad = 0.0002;
  town.link_sigma_m = 0.2;
  town.link_sigma_rad = 0.005;
  return town;
}

OverlapTeam draw_team(const OverlapTown& town) {
  Rng rng(town.seed);
  OverlapTeam team;
  const double m = town.sigma_xy_per_sqrt_m, rad = town.sigma_yaw_per_sqrt_m_rad;
  const Eigen::Vector3d step = Eigen::Vector3d(m, m, rad).cwiseAbs2();
  const Eigen::Vector3d link =
      Eigen::Vector3d(town.link_sigma_m, town.link_sigma_m, town.link_sigma_rad).cwiseAbs2();
  for (int robot = 0; robot < 2; ++robot) {
    KeyframeOdometry<SE2> chain{drive(rng, town), {}, {}};
    chain.cov_steps.assign(town.poses - 1, step.asDiagonal());
    team.chains.push_back(std::move(chain));
    team.sensors.push_back({town.range_m});
  }
  const Districts meetings(team.chains[1].poses, 150);
  while (team.links.size() < town.links) {
    const std::size_t k = rng.below(town.poses);
    const auto met = meetings.near(team.chains[0].poses[k], rng);
    if (!met) continue;
    OverlapLink<SE2> l{0, k, 1, *met, {}, link.asDiagonal()};
    l.T_a_b = team.chains[0].poses[l.pose_a].inverse() * team.chains[1].poses[l.pose_b];
    const double distance_m = l.T_a_b.translation().norm();
    l.covariance.topLeftCorner<2, 2>() += 1e-4 * distance_m * distance_m * Eigen::Matrix2d::Identity();
    team.links.push_back(l);
  }
  return team;
}

OverlapTeamGraph graph_of(const OverlapTeam& team) {
  OverlapTeamGraph g;
  for (const auto& chain : team.chains) {
    g.robots.emplace_back();
    const DriftId drift(g.graph.drifts.size());
    g.graph.drifts.push_back(Drift::Zero());
    g.graph.drift_priors.push_back({drift, Drift::Zero(), Eigen::Vector2d(1e6, 2500).asDiagonal()});
    for (std::size_t k = 0; k < chain.poses.size(); ++k) {
      g.robots.back().poses.push_back(PoseId(g.graph.poses.size()));
      g.graph.poses.push_back(chain.poses[k]);
      if (k == 0) continue;
      RelativePoseFactor<SE2> f{PoseId(g.graph.poses.size() - 2), PoseId(g.graph.poses.size() - 1),
                                chain.poses[k - 1].inverse() * chain.poses[k]};
      f.information = inverse(chain.cov_steps[k - 1]);
      f.drift = drift;
      f.drift_jacobian(2, 0) = f.drift_jacobian(0, 1) = 1;
      g.graph.relative_poses.push_back(f);
    }
  }
  for (const auto& link : team.links) {
    RelativePoseFactor<SE2> f{g.robots[0].poses[link.pose_a], g.robots[1].poses[link.pose_b], link.T_a_b};
    f.information = inverse(link.covariance);
    g.graph.relative_poses.push_back(f);
  }
  return g;
}

OverlapGrowth measure_overlap_growth(std::size_t max_poses, std::uint64_t seed, const Progress& progress) {
  const std::size_t threads = thread_count();
  set_thread_count(1);
  OverlapGrowth growth;
  growth.seed = seed;
  const std::vector<std::size_t> sizes = town_sizes(max_poses);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    report_progress(progress, "towns", static_cast<double>(k) / static_cast<double>(sizes.size()));
    OverlapTown town = growing_town(sizes[k]);
    town.seed = seed;
    const OverlapTeam team = draw_team(town);
    growth.joint.push_back(time_joint(team, sizes[k]));
    growth.link.push_back(time_link(team, sizes[k]));
  }
  set_thread_count(threads);
  return growth;
}

std::optional<double> growth_exponent(const std::vector<OverlapGrowthPoint>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const OverlapGrowthPoint& p : points) {
    if (p.poses < kMinForSlope) continue;
    const double x = std::log(items(p)), y = std::log(p.search_s);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  if (n < 2) return std::nullopt;
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

StudyTable overlap_growth_table(const OverlapGrowth& growth) {
  StudyTable table{"Growth of the overlap search",
                   "Two robots in towns that grow with their path lengths; one core; wall time in seconds on "
                   "this computer.",
                   {"poses a robot", "pairs", "kept", "prepare, s", "search, s", "us per pose and pair kept",
                    "distances, share of 3 a pair kept + 1 a pose", "all pairs / search"},
                   {},
                   {}};
  add_rows(table, "joint", growth.joint);
  add_rows(table, "link", growth.link);
  for (const auto& [mode, points] : {std::pair("joint", &growth.joint), std::pair("link", &growth.link)})
    if (const auto exponent = growth_exponent(*points))
      table.notes.push_back("Mode " + std::string(mode) +
                            ": time grows with (poses + pairs kept) to the power " +
                            number_text(exponent, 2) + ", from 10,000 poses per robot on.");
  return table;
}

}  // namespace radioslam
