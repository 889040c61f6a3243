#include "radioslam/study/overlap_growth/overlap_growth.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/overlap_growth/overlap_town.hpp"

namespace radioslam {
namespace {

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
