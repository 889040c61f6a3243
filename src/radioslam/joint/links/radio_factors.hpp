// Radio factors of a mission: adds ranges, angles of arrival and anchors to the joint graph.
// In planar estimates, angles are levelled by the odometry's roll and pitch.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

// Numbering of antenna pairs between which ranges were measured, independent of their order.

class AntennaPairs {
 public:
  /// Appends each new pair to `names`.
  explicit AntennaPairs(std::vector<std::pair<std::string, std::string>>& names) : names_(names) {}

  std::size_t index_of(const std::string& i, const std::string& j) {
    const auto [entry, added] = indices_.try_emplace(std::minmax(i, j), names_.size());
    if (added) names_.push_back(entry->first);
    return entry->second;
  }

 private:
  std::vector<std::pair<std::string, std::string>>& names_;
  std::map<std::pair<std::string, std::string>, std::size_t> indices_;
};

/// The measurement's paths in the dimension of the estimate, given the receiver's odometry pose.
template <class Pose>
AoaMeasurement as_estimated(const AoaMeasurement& measured, const SE3& T_start_body);

/// Adds points for the anchors and factors for links whose stamps the odometry of all their robots covers, on
/// the keyframes before them; the other links are counted in ignored_links.
template <class Pose>
void add_radio_factors(JointGraph<Pose>& joint, const Mission& mission);

}  // namespace radioslam
