// The pose graph of the whole team: odometry with its constant drift, known starts and headings, and the
// distances that fingerprints predict.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"

namespace radioslam {

struct JointGraphParams {
  double sigma_start_m = 0.05;  ///< of a known initial pose
  double sigma_start_rad = 0.01;
  double least_sigma_yaw_drift_per_m_rad = 1e-3;  ///< drift is estimated even where none is stated
  double least_sigma_scale = 0.02;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"sigma_start_m", "m", 1e-4, 100, "error of a known initial position"}, self.sigma_start_m);
    visit(Field{"sigma_start_rad", "rad", 1e-5, 3, "error of a known initial yaw"}, self.sigma_start_rad);
    visit(Field{"least_sigma_yaw_drift_per_m_rad", "rad/m", 0, 1,
                "prior of the constant yaw drift where a smaller one is stated: 57 degrees per km"},
          self.least_sigma_yaw_drift_per_m_rad);
    visit(Field{"least_sigma_scale", "", 0, 1, "prior of the odometry's scale error, likewise"},
          self.least_sigma_scale);
  }
};

/// Where a robot's variables stand in the graph.
struct RobotVariables {
  std::vector<std::size_t> rows;  ///< odometry rows of the keyframes
  std::vector<Stamp> stamps;      ///< of the keyframes
  std::size_t first_pose = 0;     ///< PoseId of the first keyframe
};

/// A graph and what its parts stand for.
template <class Pose>
struct JointGraph {
  PoseGraph<Pose> graph;
  std::vector<RobotVariables> robots;
  std::size_t first_closure_range = 0;  ///< graph.ranges from here on belong to the closures, in order
};

template <class Pose>
JointGraph<Pose> build_joint_graph(const Mission& mission, const KeyframeParams& keyframes,
                                   const RadioMeasurements& radio, const TeamFrame& team_frame,
                                   const std::vector<FingerprintClosure>& closures,
                                   const JointGraphParams& params);

}  // namespace radioslam
