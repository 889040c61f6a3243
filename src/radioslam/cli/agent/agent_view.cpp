#include "radioslam/cli/agent/agent_view.hpp"

#include <algorithm>
#include <tuple>

namespace radioslam::cli {
namespace {

/// Of each robot, the last keyframe that the solution has.
std::map<std::string, Stamp> last_solved(const AnySolution& solution) {
  std::map<std::string, Stamp> last;
  std::visit(
      [&](const auto& of) {
        if (!of) return;
        for (const RobotVariables& robot : of->team.joint.robots)
          if (!robot.stamps.empty()) last[robot.id] = robot.stamps.back();
      },
      solution);
  return last;
}

void add_robots(const Agent& agent, AgentView& view) {
  const std::map<std::string, Stamp> last = last_solved(view.solution);
  for (const auto& [id, keyframes] : agent.estimate().keyframes()) {
    auto begin = keyframes.said.begin();
    if (const auto solved = last.find(id); solved != last.end())
      begin = std::lower_bound(begin, keyframes.said.end(), solved->second,
                               [](const auto& pose, Stamp stamp) { return pose.stamp < stamp; });
    view.robots.push_back({id, agent.frame_of(id), {begin, keyframes.said.end()}});
  }
}

std::vector<LivePeer> peers_of(const Agent& agent, Stamp now) {
  std::vector<LivePeer> peers;
  for (const auto& [name, peer] : agent.peers()) {
    LivePeer of{.id = name,
                .silent_s = {},
                .is_heard = peer.is_heard(now),
                .solves = peer.solves,
                .refused = peer.refused};
    if (peer.heard) of.silent_s = seconds_between(*peer.heard, now);
    if (const auto own = peer.knows.find(agent.name()); own != peer.knows.end())
      of.knows_of_own = own->second.records;
    peers.push_back(std::move(of));
  }
  return peers;
}

std::map<std::string, LiveLog> logs_of(const Agent& agent) {
  std::map<std::string, LiveLog> logs;
  for (const auto& [robot, extent] : agent.logs().extents()) logs[robot] = {extent.records, extent.records};
  for (const auto& [name, peer] : agent.peers())
    for (const auto& [robot, extent] : peer.knows)
      logs[robot].said = std::max(logs[robot].said, extent.records);
  return logs;
}

void add_traffic(const TeamTraffic& traffic, bool is_sent, LiveTeam& team) {
  for (const auto& [way, of] : traffic) {
    const auto& [from, to, kind] = way;
    const bool is_known = kind < std::size(kAgentMessageKinds);
    team.traffic.push_back({is_sent ? to : from, is_known ? kAgentMessageKinds[kind] : "other", is_sent,
                            of.messages, of.bytes, of.lost});
  }
}

}  // namespace

void AgentViewer::add_clouds(const std::string& robot, const ScansSoFar& scans, AgentView& view) {
  std::set<Stamp>& seen = seen_[robot];
  if (seen.size() == scans.clouds().size()) return;
  for (const auto& [stamp, cloud] : scans.clouds())
    if (seen.insert(stamp).second) view.clouds.push_back({robot, stamp, cloud});
}

AgentView AgentViewer::view(const Agent& agent, const TeamRun& run, const TeamTraffic& sent,
                            const TeamTraffic& received, Stamp now) {
  AgentView view;
  view.solution = agent.estimate().solution();
  add_robots(agent, view);
  add_clouds(agent.name(), agent.scans().own(), view);
  for (const auto& [robot, scans] : agent.scans().others()) add_clouds(robot, scans, view);
  LiveTeam& team = view.team;
  team.self = agent.name();
  team.now = now;
  team.peers = peers_of(agent, now);
  team.logs = logs_of(agent);
  add_traffic(sent, true, team);
  add_traffic(received, false, team);
  for (const KnownThen& then : run.known) team.known.push_back({then.at, then.share, then.error_m});
  for (const auto& [robot, event] : run.events) team.events.emplace_back(event.at, event.what);
  return view;
}

}  // namespace radioslam::cli
