// Pedestrian dead reckoning: a walker's trajectory from the motion sensors of a hand-held phone.
//
//   levelling   heading from the gyroscope, vertical acceleration                    (levelling.hpp)
//   steps       time and length of every step                                        (step_detection.hpp)
//   compass     direction of east                                                    (compass.hpp)
//   p <- p + length (cos, sin)(heading)     each step points along its mean heading
//
// The phone is held in front of the body with its screen up or towards the walker and its y axis in the
// direction of walking. Body frame of the odometry: x forward, z up; yaw counter-clockwise from the frame's x
// axis, which is east if the phone recorded its orientation and the initial heading otherwise. Rotating the
// phone in the hand rotates the path; a turn on the spot appears in the yaw of the next step.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/compass.hpp"
#include "radioslam/mission/levelling.hpp"
#include "radioslam/mission/phone_motion.hpp"
#include "radioslam/mission/step_detection.hpp"

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

/// Dead-reckoned trajectory of one recording.
struct DeadReckoning {
  Trajectory<SE3> odometry;  ///< starts at the origin; a pose at both ends and at the end of every step
  std::vector<Step> steps;
  std::optional<CompassFit> compass;  ///< if present, yaw 0 is east
};

/// Trajectory from `begin` to `end` (`begin` < `end`); outside the sensors' recording, and without at least
/// one sample of accelerometer and gyroscope, the walker does not move.
DeadReckoning dead_reckon(const PhoneMotion& motion, Stamp begin, Stamp end,
                          const DeadReckoningParams& params);

}  // namespace radioslam
