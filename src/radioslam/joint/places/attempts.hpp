// Registrations of earlier rounds, by robots and keyframes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "radioslam/joint/places/place_proposals.hpp"
#include "radioslam/places/loops/other_places.hpp"

namespace radioslam {

/// They must outlive the result.
class Attempts {
 public:
  explicit Attempts(const std::vector<PlaceAttempt>& tried) {
    for (const PlaceAttempt& attempt : tried) {
      const std::size_t a = attempt.robot_i.index(), b = attempt.robot_j.index();
      of_pair_[{a, b, attempt.i, attempt.j}].push_back(&attempt);
      robots_.emplace(a, b);
    }
  }

  /// Whether the pair is known to hold, or was tried under a prediction that was hardly worse.
  bool has(const Proposal& pair) const {
    const auto found = of_pair_.find({pair.a, pair.b, pair.i, pair.j});
    if (found == of_pair_.end()) return false;
    const double now_m = horizontal_sigma(pair.T_i_j);
    return std::any_of(found->second.begin(), found->second.end(), [&](const PlaceAttempt* attempt) {
      return attempt->holds || !is_worth_another_trial(attempt->sigma_m, now_m);
    });
  }
  bool has_robots(std::size_t a, std::size_t b) const { return robots_.contains({a, b}); }

 private:
  std::map<std::array<std::size_t, 4>, std::vector<const PlaceAttempt*>> of_pair_;
  std::set<std::pair<std::size_t, std::size_t>> robots_;
};

}  // namespace radioslam
