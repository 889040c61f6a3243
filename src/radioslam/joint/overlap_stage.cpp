#include "radioslam/joint/overlap_stage.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/closure/overlap/overlap_exchange.hpp"
#include "radioslam/joint/aoa/mutual_bearing_constraints.hpp"
#include "radioslam/results/candidate_list.hpp"

namespace radioslam {
namespace {

/// All poses of each robot, and which of them are keyframes.
template <class Pose>
std::vector<ChainOfPoses> chains(const JointGraph<Pose>& joint) {
  std::vector<ChainOfPoses> result(joint.robots.size());
  for (std::size_t p = 0; p < joint.team.segments.size(); ++p) {
    const TrajectorySegment& segment = joint.team.segments[p];
    for (std::size_t k = 0; k < segment.pose_count; ++k)
      result[joint.robot_of_segment[p]].poses.push_back(PoseId(segment.first_pose + k));
  }
  for (std::size_t r = 0; r < result.size(); ++r) {
    std::size_t k = 0;
    for (const PoseId keyframe : joint.robots[r].poses) {
      while (result[r].poses[k] != keyframe) ++k;
      result[r].searched.push_back(k);
    }
  }
  return result;
}

template <class Pose>
CandidateList without_candidates(const JointGraph<Pose>& joint) {
  std::vector<std::vector<Stamp>> stamps;
  for (const RobotVariables& robot : joint.robots) stamps.push_back(robot.stamps);
  return CandidateList(std::move(stamps));
}

/// Candidates of one pair of robots.
CandidateList::Group group_of(const std::vector<OverlapCandidate>& found) {
  CandidateList::Group group;
  if (found.empty()) return group;
  group.robot_i = RobotIndex(static_cast<std::size_t>(found.front().robot_a));
  group.robot_j = RobotIndex(static_cast<std::size_t>(found.front().robot_b));
  group.rows.reserve(found.size());
  for (const OverlapCandidate& pair : found)
    group.rows.push_back({pair.pose_a, pair.pose_b, static_cast<float>(pair.distance_m),
                          static_cast<float>(pair.mahalanobis)});
  return group;
}

/// Picks those that were asked for out of all candidates.
class AskedCandidates {
 public:
  /// `keyframes`: the stamps of all robots' keyframes.
  AskedCandidates(const std::vector<KeyframePair>& asked, const CandidateList& keyframes) {
    for (KeyframePair pair : asked) {
      if (pair.robot_j < pair.robot_i) {
        std::swap(pair.robot_i, pair.robot_j);
        std::swap(pair.stamp_i, pair.stamp_j);
      }
      const auto i = keyframe(keyframes.stamps(pair.robot_i), pair.stamp_i);
      const auto j = keyframe(keyframes.stamps(pair.robot_j), pair.stamp_j);
      if (i && j) asked_[{pair.robot_i, pair.robot_j}].emplace(*i, *j);
    }
  }

  void pick(const CandidateList::Group& group, CandidateList& picked) const {
    const auto asked = asked_.find({group.robot_i, group.robot_j});
    if (asked == asked_.end()) return;
    CandidateList::Group found{group.robot_i, group.robot_j, {}};
    for (const Keyframes& pair : asked->second) {
      const auto row = std::lower_bound(
          group.rows.begin(), group.rows.end(), pair,
          [](const auto& r, const Keyframes& p) { return Keyframes(r.keyframe_i, r.keyframe_j) < p; });
      if (row != group.rows.end() && Keyframes(row->keyframe_i, row->keyframe_j) == pair)
        found.rows.push_back(*row);
    }
    picked.append(std::move(found));
  }

 private:
  using Keyframes = std::pair<std::uint32_t, std::uint32_t>;

  static std::optional<std::uint32_t> keyframe(const std::vector<Stamp>& stamps, Stamp stamp) {
    const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
    if (found == stamps.end() || *found != stamp) return std::nullopt;
    return static_cast<std::uint32_t>(found - stamps.begin());
  }

  std::map<std::pair<RobotIndex, RobotIndex>, std::set<Keyframes>> asked_;
};

/// Hands over the candidates of any of the searches, which are of one team's alignments; returns their
/// counts.
template <class Search>
OverlapCounts take_all(const std::vector<Search>& searches, std::uint32_t robots,
                       const std::function<void(const CandidateList::Group&)>& take) {
  OverlapCounts counts;
  for (std::uint32_t a = 0; a < robots; ++a) {
    std::vector<CandidateList::Group> groups(robots);
    for (const Search& search : searches) {
      OverlapCounts own = search.search(a, [&](const std::vector<OverlapCandidate>& found) {
        if (found.empty()) return;
        CandidateList::Group& group = groups[found.front().robot_b];
        if (group.rows.empty())
          group = group_of(found);
        else
          merge(group, group_of(found));
      });
      if (&search != &searches.front()) own.pairs = 0;
      own.kept = 0;
      counts += own;
    }
    for (const CandidateList::Group& group : groups) {
      if (group.rows.empty()) continue;
      counts.kept += group.rows.size();
      take(group);
    }
  }
  return counts;
}

ExchangeResult exchange_of(const OverlapTraffic& traffic) {
  ExchangeResult result;
  result.rounds = traffic.rounds;
  for (const auto& of_robot : traffic.bytes) {
    auto& bytes = result.bytes.emplace_back();
    for (std::size_t kind = 0; kind < of_robot.size(); ++kind)
      bytes[kOverlapMessageKinds[kind]] = of_robot[kind];
  }
  return result;
}

template <class Source>
void search_all(const std::vector<Source>& sources, const std::vector<OverlapSensor>& sensors,
                const OverlapParams& params, SearchMethod method,
                const std::function<void(const CandidateList::Group&)>& take, OverlapStage& stage) {
  const auto robots = static_cast<std::uint32_t>(sensors.size());
  if (method == SearchMethod::kDistributed) {
    OverlapTraffic traffic;
    std::vector<TeamOverlapExchange<Source>> searches;
    for (const Source& source : sources) searches.emplace_back(source, sensors, params, traffic);
    stage.exchange = exchange_of(traffic);
    stage.counts = take_all(searches, robots, take);
  } else {
    std::vector<TeamOverlapSearch<Source>> searches;
    for (const Source& source : sources) searches.emplace_back(source, sensors, params, method);
    stage.counts = take_all(searches, robots, take);
  }
}

}  // namespace

template <class Pose>
OverlapStage find_overlaps(std::vector<JointGraph<Pose>> alignments, const OverlapStageParams& params,
                           const OverlapRequest& request) {
  const JointGraph<Pose>& first = alignments.front();
  OverlapStage stage;
  stage.listed = stage.of_asked = without_candidates(first);
  std::vector<OverlapSensor> sensors;
  for (const RobotVariables& robot : first.robots)
    sensors.push_back(params.radius_m > 0 ? OverlapSensor{params.radius_m / 2}
                                          : OverlapSensor{robot.lidar_range_m, robot.lidar_view_rad});
  OverlapParams rule = params.overlap;
  if (params.radius_m > 0) rule.min_shared_view = 0;
  const AskedCandidates asked(request.asked, stage.listed);
  MostProbableCandidates most_probable(request.max_listed);
  const auto take = [&](const CandidateList::Group& group) {
    most_probable.add(group);
    asked.pick(group, stage.of_asked);
    if (request.take) request.take(group, stage.listed);
  };
  if (overlap_mode(params) == OverlapMode::kLink) {
    std::vector<LinkCovariance<Pose>> sources;
    auto links = measured_links(first, params.pairing_s, static_cast<std::size_t>(params.max_links));
    stage.estimated_links = links.estimated;
    for (std::size_t a = 0; a < sensors.size(); ++a)
      for (std::size_t b = a + 1; b < sensors.size(); ++b)
        if (links.covariance.team().view(a, b).ties() == 0)
          stage.unlinked.emplace_back(RobotIndex(a), RobotIndex(b));
    sources.push_back(std::move(links.covariance));
    search_all(sources, sensors, rule, request.method, take, stage);
  } else {
    std::vector<JointCovariance<Pose>> sources;
    for (JointGraph<Pose>& joint : alignments) {
      if (auto source = JointCovariance<Pose>::compute(joint.team.graph, chains(joint)))
        sources.push_back(std::move(*source));
      else if (sources.empty())
        return stage;
      joint = {};
    }
    stage.alignments = sources.size();
    search_all(sources, sensors, rule, request.method, take, stage);
  }
  most_probable.move_to(stage.listed);
  stage.searched = true;
  return stage;
}

template OverlapStage find_overlaps(std::vector<JointGraph<SE2>>, const OverlapStageParams&,
                                    const OverlapRequest&);
template OverlapStage find_overlaps(std::vector<JointGraph<SE3>>, const OverlapStageParams&,
                                    const OverlapRequest&);

}  // namespace radioslam
