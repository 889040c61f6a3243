#include "radioslam/rendezvous/anchored_exploration.hpp"

#include <algorithm>
#include <tuple>

#include "radioslam/rendezvous/partner_choice.hpp"

namespace radioslam {
namespace {

constexpr int kWaitForLandmark = 3;  ///< decisions until a robot without one explores all the same
constexpr int kStillAfter = 12;  ///< decisions after which one that does not walk has no use for a landmark
constexpr int kAloneAfter = 2;   ///< decisions without anybody leaning on it before a landmark may leave
constexpr double kLeastWay_m = 2;
constexpr double kLeastError = 0.01;  ///< where nothing has been lost yet, the nearest landmark will do

const AnchorNeighbour* find(const std::vector<AnchorNeighbour>& neighbours, const std::string& robot) {
  const auto at = std::find_if(neighbours.begin(), neighbours.end(),
                               [&](const AnchorNeighbour& each) { return each.robot == robot; });
  return at == neighbours.end() ? nullptr : &*at;
}

/// The landmark that gains most per metre.
const AnchorNeighbour* best_landmark(double error, const std::vector<AnchorNeighbour>& neighbours,
                                     double range_m) {
  const AnchorNeighbour* best = nullptr;
  double best_rate = -1;
  for (const AnchorNeighbour& each : neighbours) {
    if (!each.standing || each.distance_m > range_m) continue;
    const double way_m = std::max(each.distance_m, kLeastWay_m);
    const double rate = expected_gain(std::max(error, kLeastError), each.error) / way_m;
    if (rate > best_rate) {
      best = &each;
      best_rate = rate;
    }
  }
  return best;
}

}  // namespace

void AnchoredExploration::note_steps(const std::vector<AnchorNeighbour>& neighbours) {
  ++decisions_;
  for (const AnchorNeighbour& each : neighbours) {
    Steps& steps = steps_[each.robot];
    if (each.walked_m == steps.walked_m) continue;
    steps = {each.walked_m, decisions_};
  }
}

bool AnchoredExploration::is_leant_on(const std::string& self,
                                      const std::vector<AnchorNeighbour>& neighbours) const {
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const AnchorNeighbour& each) {
    return each.leans_on == self && decisions_ - steps_.at(each.robot).decision < kStillAfter;
  });
}

void AnchoredExploration::decide(const std::string& self, double error, double walked_m,
                                 const std::vector<AnchorNeighbour>& neighbours,
                                 const AnchoredParams& params) {
  note_steps(neighbours);
  if (role_ == Role::kStanding)
    hand_over(self, walked_m, neighbours);
  else
    explore_or_return(self, error, walked_m, neighbours, params);
}

void AnchoredExploration::explore_or_return(const std::string& self, double error, double walked_m,
                                            const std::vector<AnchorNeighbour>& neighbours,
                                            const AnchoredParams& params) {
  const AnchorNeighbour* landmark = find(neighbours, leans_on_);
  if (!landmark || !landmark->standing) {
    leans_on_.clear();
    role_ = Role::kExploring;
  }
  if (role_ == Role::kReturning) return;
  const double range_m = leans_on_.empty() ? params.anchor_range_m : 1e9;
  if (leans_on_.empty() || error > params.delta) {
    const AnchorNeighbour* best = best_landmark(error, neighbours, range_m);
    if (best) leans_on_ = best->robot;
  }
  if (!leans_on_.empty()) {
    waited_ = 0;
    if (error > params.delta) role_ = Role::kReturning;
    return;
  }
  // Nobody stands: of those that are near, the one that knows best where it is does.
  const auto rank = [](double of_error, double of_walked_m, const std::string& of_robot) {
    return std::tuple(of_error, -of_walked_m, of_robot);
  };
  bool any = false, first = true;
  for (const AnchorNeighbour& each : neighbours) {
    if (each.distance_m > params.anchor_range_m || !each.leans_on.empty()) continue;
    any = true;
    first = first && rank(error, walked_m, self) < rank(each.error, each.walked_m, each.robot);
  }
  if (any && first) {
    role_ = Role::kStanding;
    alone_ = waited_ = 0;
    return;
  }
  waited_ = any && waited_ < kWaitForLandmark ? waited_ + 1 : 0;
}

/// A landmark on which nobody leans explores, if another stands that has walked further.
void AnchoredExploration::hand_over(const std::string& self, double walked_m,
                                    const std::vector<AnchorNeighbour>& neighbours) {
  alone_ = is_leant_on(self, neighbours) ? 0 : alone_ + 1;
  if (alone_ < kAloneAfter) return;
  const AnchorNeighbour* other = nullptr;
  for (const AnchorNeighbour& each : neighbours)
    if (each.standing && std::pair(each.walked_m, self) > std::pair(walked_m, each.robot) &&
        (!other || each.distance_m < other->distance_m))
      other = &each;
  if (other) {
    leans_on_ = other->robot;
    role_ = Role::kExploring;
  } else if (alone_ >= kStillAfter) {
    role_ = Role::kExploring;
    alone_ = 0;
  }
}

void AnchoredExploration::met(double walked_m, const std::vector<AnchorNeighbour>& neighbours) {
  const AnchorNeighbour* landmark = find(neighbours, leans_on_);
  role_ = Role::kExploring;
  if (!landmark) return;
  const bool needed = std::any_of(neighbours.begin(), neighbours.end(), [&](const AnchorNeighbour& each) {
    return each.leans_on == landmark->robot;
  });
  if (needed || landmark->walked_m >= walked_m) return;
  role_ = Role::kStanding;
  leans_on_.clear();
  alone_ = 0;
}

}  // namespace radioslam
