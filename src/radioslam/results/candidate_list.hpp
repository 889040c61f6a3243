// Candidates of the overlap search: 16 bytes each, grouped by pair of robots. A large team has tens of
// millions, of which a run lists the most probable (most_probable_candidates.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"

namespace radioslam {

/// Pair of keyframes of different robots whose views may overlap.
struct CandidateResult {
  RobotIndex robot_i;
  Stamp stamp_i;
  RobotIndex robot_j;
  Stamp stamp_j;
  float distance_m = 0;
  float mahalanobis = 0;
};

class CandidateList {
 public:
  /// Keyframes as indices into their robots' stamps.
  struct Row {
    std::uint32_t keyframe_i = 0, keyframe_j = 0;
    float distance_m = 0, mahalanobis = 0;
  };
  struct Group {
    RobotIndex robot_i, robot_j;
    std::vector<Row> rows;
  };
  class Iterator;

  CandidateList() = default;
  /// `stamps`: keyframes of every robot in time order.
  explicit CandidateList(std::vector<std::vector<Stamp>> stamps);

  /// Appends a candidate, to the group of its robots.
  void push_back(const CandidateResult& candidate);
  /// Appends a group of new robots whose rows refer to the stamps given to the constructor.
  void append(Group group);
  /// Gives every robot another index.
  void renumber_robots(const std::vector<RobotIndex>& robots);

  std::size_t size() const;
  bool empty() const { return size() == 0; }
  const std::vector<Group>& groups() const { return groups_; }
  /// The robot's keyframes that the rows refer to; empty for a robot that is not in the list.
  const std::vector<Stamp>& stamps(RobotIndex robot) const;
  CandidateResult at(const Group& group, const Row& row) const;
  /// Whether the pair is in the list, in either order. The list must be sorted, as a search makes it.
  bool contains(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j, Stamp stamp_j) const;

  Iterator begin() const;
  Iterator end() const;

 private:
  std::uint32_t keyframe(RobotIndex robot, Stamp stamp);
  Group& group(RobotIndex robot_i, RobotIndex robot_j);
  bool contains_in_order(RobotIndex robot_i, Stamp stamp_i, RobotIndex robot_j, Stamp stamp_j) const;

  std::vector<std::vector<Stamp>> stamps_;  ///< per robot
  std::vector<std::map<Stamp, std::uint32_t>> keyframes_;
  std::vector<std::uint32_t> latest_;  ///< keyframe per robot that was found last
  std::vector<Group> groups_;
};

/// Adds another group of the same robots, over the same stamps; of a pair in both, the nearer one in standard
/// deviations stays. Both must be sorted.
void merge(CandidateList::Group& group, const CandidateList::Group& other);

/// Over all groups, by value.
class CandidateList::Iterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = CandidateResult;
  using difference_type = std::ptrdiff_t;
  using pointer = const CandidateResult*;
  using reference = CandidateResult;

  Iterator(const CandidateList& list, std::size_t group) : list_(&list), group_(group) { skip_empty(); }
  CandidateResult operator*() const {
    const Group& group = list_->groups_[group_];
    return list_->at(group, group.rows[row_]);
  }
  Iterator& operator++() {
    ++row_;
    skip_empty();
    return *this;
  }
  Iterator operator++(int) {
    Iterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Iterator& other) const { return group_ == other.group_ && row_ == other.row_; }

 private:
  void skip_empty() {
    while (group_ < list_->groups_.size() && row_ == list_->groups_[group_].rows.size()) ++group_, row_ = 0;
  }

  const CandidateList* list_;
  std::size_t group_, row_ = 0;
};

inline CandidateList::Iterator CandidateList::begin() const { return {*this, 0}; }
inline CandidateList::Iterator CandidateList::end() const { return {*this, groups_.size()}; }

// The most probable of candidates that come in any order: those nearest to overlapping in standard
// deviations, of equal ones the nearest, then the first by robots and keyframes. Memory: twice their number,
// 24 bytes each.

class MostProbableCandidates {
 public:
  /// `limit`: how many are kept.
  explicit MostProbableCandidates(std::size_t limit) : limit_(limit) {}

  /// A group of robots whose first is listed before the second.
  void add(const CandidateList::Group& group);
  /// Appends those kept to a list over the same stamps, by robots and keyframes, and forgets them.
  void move_to(CandidateList& list);

 private:
  struct Candidate {
    RobotIndex robot_i, robot_j;
    CandidateList::Row row;
  };
  static bool is_more_probable(const Candidate& a, const Candidate& b);
  void drop_improbable();

  std::size_t limit_;
  std::vector<Candidate> kept_;
  Candidate last_;  ///< the least probable of the first `limit_`, once candidates have been dropped
  bool has_dropped_ = false;
};

}  // namespace radioslam
