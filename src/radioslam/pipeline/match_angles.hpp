// What angles of arrival say of matches between robots (radio/arrival_likelihood.hpp).
//
// Angles are measured when the robots hear each other, a match may be of two times far apart. So both robots'
// odometry carries it to the time t of the measurement,
//   T_i(t)_j(t) = T_i(t)_i(t_i) T_i_j T_j(t_j)_j(t),
// and what the way there adds to the direction's error adds to the angle's. Of the measurements between the
// two robots, in either direction, those the least way off count, and the median of their scales.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/arrival_likelihood.hpp"

namespace radioslam {

/// How matches from someone else's place recognition join the estimate.
struct MatchParams {
  bool robust = true;
  bool angle_weights = false;
  int angles = 25;
  double most_carried_m = 3000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(
        Field{"robust", "", 0, 0,
              "the largest consistent set alone, under a graduated loss; false: every match, least squares"},
        self.robust);
    visit(Field{"angle_weights", "", 0, 0,
                "whether the angles of arrival near a match scale its information (Wang et al. eq. 7)"},
          self.angle_weights);
    visit(Field{"angles", "", 1, 1000, "measurements of angles per match, of whose scales the median counts"},
          self.angles);
    visit(Field{"most_carried_m", "m", 0, 1e6,
                "a match is carried at most so far, both ways together, to where angles were measured"},
          self.most_carried_m);
  }
};

class MatchAngles {
 public:
  MatchAngles(const Mission& mission, const MatchParams& params, const ArrivalLikelihoodParams& likelihood);

  /// What a match's information is to be scaled by; nothing where no angles were measured near it.
  template <class Pose>
  std::optional<double> information_scale(const PoseMatch& match) const;

 private:
  /// The measurements between two robots that are the least way from the match.
  std::vector<std::size_t> nearest(const PoseMatch& match) const;

  const Mission& mission_;
  MatchParams params_;
  ArrivalLikelihoodParams likelihood_;
  std::vector<std::vector<double>> walked_m_;  ///< per robot and odometry row
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<std::size_t>> arrivals_;  ///< lower index first
};

}  // namespace radioslam
