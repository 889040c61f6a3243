// What a robot hears and measures, in the order of time, and what it answers. Planar; metres, radians,
// seconds of one clock. Body frame: x ahead, y to the left.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

struct RobotMessage;  // robot_message.hpp

struct RobotStart {
  double t_s = 0;
  std::optional<SE2> pose;  ///< in the common frame, where known
  std::optional<double> q_db, delta, max_step_m;
  std::optional<int> kappa;
};

struct OdometryStep {
  double t_s = 0;
  SE2 T_previous_body;
  double sigma_m = 0, sigma_rad = 0;  ///< per axis
};

/// Another robot within sensing range, as it looks from here; perhaps wrongly.
struct SeenRobot {
  double t_s = 0;
  std::string robot;
  SE2 T_i_j;
  double sigma_m = 0, sigma_rad = 0;
};

/// One path on which a packet arrived, in the receiver's body frame.
struct ArrivalPath {
  double azimuth_rad = 0;
  double sigma_rad = 1;
  double power_db = 0;
};

/// A packet of another robot as it was heard here; without message a beacon.
struct HeardPacket {
  double t_s = 0;
  std::string from;
  double esnr_db = 0;
  std::vector<ArrivalPath> paths;
  std::shared_ptr<const RobotMessage> message;
};

struct ObstacleAhead {
  double t_s = 0;
  double azimuth_rad = 0;  ///< in the body frame
  double distance_m = 0;
};

struct DecisionTick {
  double t_s = 0;
  bool talk = false;  ///< messages only: robots stand still
};

enum class Reach { kControl, kData };

struct OutgoingMessage {
  std::string to;  ///< empty: to everybody
  Reach reach = Reach::kControl;
  std::shared_ptr<const RobotMessage> message;
};

struct Movement {
  enum class Kind { kMove, kStay, kExplore };
  Kind kind = Kind::kExplore;
  Eigen::Vector2d target = Eigen::Vector2d::Zero();  ///< of a move, in the robot's raw odometry
};

struct RobotState {
  double error = 0;    ///< by the monitor
  double sigma_m = 0;  ///< of the position in its frame, per axis
  bool asking = false;
  std::string serving;            ///< robot that this one walks to; empty: none
  std::vector<std::string> team;  ///< in one frame with this robot, itself among them
};

struct TickAnswer {
  std::vector<OutgoingMessage> messages;
  std::optional<Movement> movement;  ///< absent after a talk tick
  RobotState state;
};

struct FinalTrajectory {
  struct Row {
    double t_s = 0;
    SE2 pose;
  };
  struct Measurement {
    double t_s = 0;
    std::string robot;
    double weight = 1;  ///< its share of the stated information, in [0, 1]; 0: it was of no use
  };
  std::vector<Row> rows;  ///< per pose
  std::string frame;      ///< robot whose start is the origin; empty: the common frame
  std::vector<Measurement> measurements;
};

}  // namespace radioslam
