#include "radioslam/results/most_probable_candidates.hpp"

#include <algorithm>
#include <tuple>

namespace radioslam {

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
