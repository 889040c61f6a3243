#include "radioslam/ros_node/heard_names.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {

HeardNames::HeardNames(Mission mission, RobotIndex self, std::vector<Antennas> antennas)
    : mission_(std::move(mission)), self_(self), antennas_(std::move(antennas)) {
  for (std::size_t k = 0; k < mission_.access_points.size(); ++k)
    access_points_.emplace(mission_.access_points[k], AccessPointIndex(k));
}

Eigen::Vector3d HeardNames::lever_arm(std::size_t robot, const std::string& antenna) const {
  if (robot >= antennas_.size()) return Eigen::Vector3d::Zero();
  const auto found = antennas_[robot].find(antenna);
  return found == antennas_[robot].end() ? Eigen::Vector3d::Zero() : found->second;
}

LinkEnd HeardNames::own_end(const std::string& antenna,
                            const std::optional<Eigen::Vector3d>& lever_arm_m) const {
  LinkEnd end;
  end.robot = self_;
  end.antenna = antenna;
  end.lever_arm_m = lever_arm_m ? *lever_arm_m : lever_arm(self_.index(), antenna);
  return end;
}

std::optional<LinkEnd> HeardNames::other_end(const std::string& name, const std::string& antenna,
                                             NotesOnce& notes) {
  if (!is_record_name(name) || (!antenna.empty() && !is_record_name(antenna))) return std::nullopt;
  LinkEnd end;
  end.antenna = antenna;
  const auto has_id = [&name](const auto& of) { return of.id == name; };
  const auto anchor = std::find_if(mission_.anchors.begin(), mission_.anchors.end(), has_id);
  if (anchor != mission_.anchors.end()) {
    end.anchor = AnchorIndex(static_cast<std::size_t>(anchor - mission_.anchors.begin()));
    return end;
  }
  auto& robots = mission_.robots;
  const auto robot =
      static_cast<std::size_t>(std::find_if(robots.begin(), robots.end(), has_id) - robots.begin());
  if (robot == self_.index()) return std::nullopt;
  if (robot == robots.size()) {
    if (robots.size() >= kMostRobots) return std::nullopt;
    robots.emplace_back().id = name;
    notes.say("measures links to '" + name + "', which no mission names; it is taken as a robot");
  }
  end.robot = RobotIndex(robot);
  end.lever_arm_m = lever_arm(robot, antenna);
  return end;
}

std::optional<AccessPointIndex> HeardNames::access_point(const std::string& bssid) {
  const auto address = parse_mac_address(canonical_bssid(bssid));
  if (!address) return std::nullopt;
  const std::string text = format_mac_address(*address);
  if (const auto found = access_points_.find(text); found != access_points_.end()) return found->second;
  if (mission_.access_points.size() >= kMostAccessPoints) return std::nullopt;
  const AccessPointIndex index(mission_.access_points.size());
  mission_.access_points.push_back(text);
  access_points_.emplace(text, index);
  return index;
}

}  // namespace radioslam
