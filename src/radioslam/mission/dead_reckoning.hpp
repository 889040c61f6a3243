// A walker's way from the motion sensors of the phone in the hand: pedestrian dead reckoning.
//
//   levelling   heading since the start from the gyroscope, vertical acceleration   (levelling.hpp)
//   steps       when a foot came down and how far it went                            (steps.hpp)
//   compass     where east is                                                        (compass.hpp)
//   p <- p + length (cos, sin)(heading)     a step goes in its mean heading
//
// The phone is held in front of the body, its screen up or towards the walker, its y axis in the direction of
// walking. Body frame of the odometry: x forward, z up; yaw counter-clockwise from the frame's x axis, which
// is east where the phone knew its orientation and the heading of the start otherwise. A phone turned in the
// hand turns the way; a turn on the spot without a step is seen in the yaw of the next step.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/compass.hpp"
#include "radioslam/mission/levelling.hpp"
#include "radioslam/mission/phone_motion.hpp"
#include "radioslam/mission/steps.hpp"

namespace radioslam {

struct DeadReckoningParams {
  LevellingParams levelling;
  StepParams steps;
  CompassParams compass;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("levelling", self.levelling);
    visit("steps", self.steps);
    visit("compass", self.compass);
  }
};

/// What the sensors of one walk say about the way.
struct DeadReckoning {
  Trajectory<SE3> odometry;  ///< starts at the origin; a pose at both ends and at the end of every step
  std::vector<Step> steps;
  std::optional<CompassFit> compass;  ///< with it, yaw 0 is east
};

/// The way from `begin` to `end`, which may reach beyond the sensors' time: there the walker stands still.
/// `begin` < `end`. Needs one reading of accelerometer and gyroscope; without, the walker stands all the
/// time.
DeadReckoning reckon_walk(const PhoneMotion& motion, Stamp begin, Stamp end,
                          const DeadReckoningParams& params);

}  // namespace radioslam
