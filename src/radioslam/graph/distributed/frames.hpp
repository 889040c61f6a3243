// Robots that start without a common frame agree on one: each part of a trajectory adopts the frame of the
// lowest origin that a neighbour is in, so that in the end every part of a connected team is in the frame of
// its lowest robot. Nobody needs to know the team for it, and parts that join later adopt it, too.
//
// Where a part is in its neighbours' frame, every factor between them says by itself. The placements vote:
// the one that most others agree with, within what odometry may have drifted between them, wins.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

/// When a placement is trusted.
struct FrameVoteParams {
  int min_votes = 1;          ///< factors that must agree before a frame is adopted
  double max_statistic = 25;  ///< squared norm of the difference of two placements that agree
  double drift_ratio = 0.05;  ///< of odometry, of the distance between two factors' poses

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(min_votes, "", 1, 1000,
                          "factors between two robots that must agree before one adopts the other's frame");
    RADIOSLAM_FIELD(max_statistic, "", 0, 1e6,
                    "squared Mahalanobis norm up to which two factors agree on a robot's frame");
    RADIOSLAM_FIELD(drift_ratio, "", 0, 1,
                    "drift of odometry allowed between two such factors, per distance between their poses");
  }
};

/// What a robot knows of frames: its parts' and those of the neighbours' poses.
template <class Pose>
class FrameAgreement {
 public:
  FrameAgreement(const RobotGraph<Pose>& robot, const FrameVoteParams& params);

  const Frame& frame_of_part(std::size_t part) const { return frames_[part]; }
  /// Per own pose.
  std::vector<Frame> frames(const RobotGraph<Pose>& robot) const;
  /// Of a pose of the robot's graph; nothing for a copy that was not heard of yet.
  std::optional<Frame> frame_of(const RobotGraph<Pose>& robot, std::size_t pose) const;
  /// Both ends in one frame.
  bool usable(const RobotGraph<Pose>& robot, const RelativePoseFactor<Pose>& factor) const;
  /// Where every usable factor between robots is in the relative poses.
  std::vector<std::uint32_t> usable_factors(const RobotGraph<Pose>& robot) const;

  /// As if nothing had been heard: every part in its own frame, numbered from 0, those of `first` (own poses)
  /// before others.
  void start_again(const RobotGraph<Pose>& robot, const std::vector<std::uint32_t>& first);
  /// Takes over a neighbour's values; false where they do not fit, and nothing is changed.
  bool hear(RobotGraph<Pose>& robot, RobotNumber from, const SeenPoses<Pose>& seen);
  /// Moves parts to frames of lower origins; whether any moved.
  bool adopt(RobotGraph<Pose>& robot);
  /// What is sent to a neighbour.
  SeenPoses<Pose> seen_by(const RobotGraph<Pose>& robot, const NeighbourRobot& neighbour) const;
  /// The same as messages to all neighbours.
  std::vector<Message<Pose>> seen_by_all(const RobotGraph<Pose>& robot, std::uint32_t round) const;

 private:
  bool adopt_part(RobotGraph<Pose>& robot, std::uint32_t part);

  FrameVoteParams params_;
  std::vector<Frame> frames_;                      ///< per part
  std::vector<std::optional<Frame>> copy_frames_;  ///< per copy
};

}  // namespace radioslam
