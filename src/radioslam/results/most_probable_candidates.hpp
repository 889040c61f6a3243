// The most probable of candidates that come in any order: those nearest to overlapping in standard
// deviations, of equal ones the nearest, then the first by robots and keyframes. Memory: twice their number,
// 24 bytes each.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/results/candidate_list.hpp"

namespace radioslam {

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
