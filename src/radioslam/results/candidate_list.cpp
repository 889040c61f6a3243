#include "radioslam/results/candidate_list.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace radioslam {
namespace {

std::pair<std::uint32_t, std::uint32_t> keyframes_of(const CandidateList::Row& row) {
  return {row.keyframe_i, row.keyframe_j};
}

/// Sorted union; of equal pairs the nearer one in standard deviations.
std::vector<CandidateList::Row> merged(const std::vector<CandidateList::Row>& a,
                                       const std::vector<CandidateList::Row>& b) {
  std::vector<CandidateList::Row> rows;
  rows.reserve(std::max(a.size(), b.size()));
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rows),
             [](const auto& x, const auto& y) {
               return std::pair(keyframes_of(x), x.mahalanobis) < std::pair(keyframes_of(y), y.mahalanobis);
             });
  rows.erase(std::unique(rows.begin(), rows.end(),
                         [](const auto& x, const auto& y) { return keyframes_of(x) == keyframes_of(y); }),
             rows.end());
  rows.shrink_to_fit();
  return rows;
}

}  // namespace

void merge(CandidateList::Group& group, const CandidateList::Group& other) {
  group.rows = merged(group.rows, other.rows);
}

CandidateList::CandidateList(std::vector<std::vector<Stamp>> stamps)
    : stamps_(std::move(stamps)), keyframes_(stamps_.size()), latest_(stamps_.size(), 0) {
  for (std::size_t r = 0; r < stamps_.size(); ++r)
    for (std::uint32_t k = 0; k < stamps_[r].size(); ++k)
      keyframes_[r].emplace_hint(keyframes_[r].end(), stamps_[r][k], k);
}

/// Index of the robot's keyframe; a new stamp becomes its last one.
std::uint32_t CandidateList::keyframe(RobotIndex robot, Stamp stamp) {
  const std::size_t r = robot.index();
  if (r >= stamps_.size()) {
    stamps_.resize(r + 1);
    keyframes_.resize(r + 1);
    latest_.resize(r + 1, 0);
  }
  std::uint32_t& latest = latest_[r];
  for (const std::uint32_t next : {latest, latest + 1})
    if (next < stamps_[r].size() && stamps_[r][next] == stamp) return latest = next;
  const auto [known, is_new] = keyframes_[r].try_emplace(stamp, stamps_[r].size());
  if (is_new) stamps_[r].push_back(stamp);
  return latest = known->second;
}

CandidateList::Group& CandidateList::group(RobotIndex robot_i, RobotIndex robot_j) {
  const auto is_theirs = [&](const Group& g) { return g.robot_i == robot_i && g.robot_j == robot_j; };
  if (!groups_.empty() && is_theirs(groups_.back())) return groups_.back();
  const auto known = std::find_if(groups_.begin(), groups_.end(), is_theirs);
  return known != groups_.end() ? *known : groups_.emplace_back(Group{robot_i, robot_j, {}});
}

void CandidateList::push_back(const CandidateResult& c) {
  const std::uint32_t i = keyframe(c.robot_i, c.stamp_i), j = keyframe(c.robot_j, c.stamp_j);
  group(c.robot_i, c.robot_j).rows.push_back({i, j, c.distance_m, c.mahalanobis});
}

void CandidateList::append(Group group) {
  if (!group.rows.empty()) groups_.push_back(std::move(group));
}

void CandidateList::renumber_robots(const std::vector<RobotIndex>& robots) {
  for (Group& group : groups_) {
    group.robot_i = robots[group.robot_i.index()];
    group.robot_j = robots[group.robot_j.index()];
  }
  std::vector<std::vector<Stamp>> stamps;
  for (std::size_t r = 0; r < stamps_.size(); ++r) {
    const std::size_t to = robots[r].index();
    if (to >= stamps.size()) stamps.resize(to + 1);
    stamps[to] = std::move(stamps_[r]);
  }
  std::vector<Group> groups = std::move(groups_);
  *this = CandidateList(std::move(stamps));
  groups_ = std::move(groups);
}

std::size_t CandidateList::size() const {
  std::size_t size = 0;
  for (const Group& group : groups_) size += group.rows.size();
  return size;
}

const std::vector<Stamp>& CandidateList::stamps(RobotIndex robot) const {
  static const std::vector<Stamp> kNone;
  return robot.index() < stamps_.size() ? stamps_[robot.index()] : kNone;
}

CandidateResult CandidateList::at(const Group& group, const Row& row) const {
  return {group.robot_i,  stamps(group.robot_i)[row.keyframe_i],
          group.robot_j,  stamps(group.robot_j)[row.keyframe_j],
          row.distance_m, row.mahalanobis};
}

bool CandidateList::contains_in_order(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j,
                                      Stamp stamp_j) const {
  for (const Group& group : groups_) {
    if (group.robot_i != robot_i || group.robot_j != robot_j) continue;
    const auto i = keyframes_[robot_i.index()].find(stamp_i), j = keyframes_[robot_j.index()].find(stamp_j);
    if (i == keyframes_[robot_i.index()].end() || j == keyframes_[robot_j.index()].end()) return false;
    const std::pair<std::uint32_t, std::uint32_t> pair(i->second, j->second);
    const auto found =
        std::lower_bound(group.rows.begin(), group.rows.end(), pair,
                         [](const Row& row, const auto& wanted) { return keyframes_of(row) < wanted; });
    return found != group.rows.end() && keyframes_of(*found) == pair;
  }
  return false;
}

bool CandidateList::contains(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j, Stamp stamp_j) const {
  return contains_in_order(robot_i, stamp_i, robot_j, stamp_j) ||
         contains_in_order(robot_j, stamp_j, robot_i, stamp_i);
}

bool MostProbableCandidates::is_more_probable(const Candidate& a, const Candidate& b) {
  const auto key = [](const Candidate& c) {
    return std::tuple(c.row.mahalanobis, c.row.distance_m, c.robot_i, c.robot_j, c.row.keyframe_i,
                      c.row.keyframe_j);
  };
  return key(a) < key(b);
}

void MostProbableCandidates::add(const CandidateList::Group& group) {
  if (limit_ == 0) return;
  for (const CandidateList::Row& row : group.rows) {
    const Candidate candidate{group.robot_i, group.robot_j, row};
    if (has_dropped_ && !is_more_probable(candidate, last_)) continue;
    kept_.push_back(candidate);
    if (kept_.size() / 2 >= limit_) drop_improbable();
  }
}

void MostProbableCandidates::drop_improbable() {
  if (kept_.size() <= limit_) return;
  const auto last = kept_.begin() + static_cast<std::ptrdiff_t>(limit_ - 1);
  std::nth_element(kept_.begin(), last, kept_.end(), is_more_probable);
  last_ = *last;
  has_dropped_ = true;
  kept_.resize(limit_);
}

void MostProbableCandidates::move_to(CandidateList& list) {
  drop_improbable();
  std::sort(kept_.begin(), kept_.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(a.robot_i, a.robot_j, a.row.keyframe_i, a.row.keyframe_j) <
           std::tuple(b.robot_i, b.robot_j, b.row.keyframe_i, b.row.keyframe_j);
  });
  for (auto first = kept_.begin(); first != kept_.end();) {
    const auto last = std::find_if(first, kept_.end(), [&](const Candidate& c) {
      return c.robot_i != first->robot_i || c.robot_j != first->robot_j;
    });
    CandidateList::Group group{first->robot_i, first->robot_j, {}};
    group.rows.reserve(static_cast<std::size_t>(last - first));
    for (; first != last; ++first) group.rows.push_back(first->row);
    list.append(std::move(group));
  }
  kept_ = {};
}

}  // namespace radioslam
