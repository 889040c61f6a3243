// One robot's estimate in a team that is seldom connected: of the logs that it knows (robot_logs.hpp), the
// poses that sightings tie together, with odometry condensed between them, solved as one pose graph in the
// plane; the robot's other poses are placed between its own of these.
//
// It needs nobody's answer to be solved, and no round in which all take part: whatever has arrived is used,
// and what is still missing is missing. Robots that know the same records have the same estimate, as long as
// the others have no more poses in it than `max_poses`: that of a central solution, up to condensing odometry
// to first order. Cost of a solution: that of the graph of these poses, and a sum over the logs.
// Sources: Cunningham et al. 2010, DDF-SAM; Lazaro et al. 2013 (condensed measurements).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/rendezvous/robot_logs.hpp"

namespace radioslam {

/// How relative poses between robots are weighed, and how much of a team is used.
struct RobotEstimateParams {
  std::string angle_weights = "posterior";
  double outlier_ratio = 0.3;
  int hops = 3;
  int max_poses = 400;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(angle_weights, "", 0, 0,
                          "weight of a relative pose between robots by angles of arrival; posterior: the "
                          "probability that it is right; published: Wang et al., eq. 7",
                          "posterior|published|off");
    RADIOSLAM_FIELD(outlier_ratio, "", 0, 0.9,
                    "share of wrong relative poses between robots that is expected beforehand");
    RADIOSLAM_FIELD(hops, "", 1, 1000,
                    "observations between a robot and the furthest whose measurements it is sent");
    RADIOSLAM_FIELD(
        max_poses, "", 10, 1e6,
        "largest number of other robots' poses in one robot's estimate; the nearest by observations, of "
        "each at most the latest half of so many");
  }
};

class RobotEstimate {
 public:
  /// A robot that begins at t_s, where it is in the common frame if that is known.
  RobotEstimate(const std::string& robot, double t_s, const std::optional<SE2>& start,
                const RobotEstimateParams& params, const AngleCheckParams& angles = {});

  /// A new pose, T_latest_new; standard deviations per axis.
  void move(double t_s, const SE2& step, double sigma_m, double sigma_rad);
  /// Another robot as seen from the latest pose.
  void see(double t_s, const std::string& robot, const SE2& T_i_j, double sigma_m, double sigma_rad);
  /// A packet of another robot as it arrived at an own pose.
  void hear(double t_s, const std::string& robot, std::uint32_t node, const std::vector<ArrivalPath>& paths) {
    logs_.say(angles_of(node, Stamp::from_seconds(t_s), robot, paths));
  }
  RobotLogs& logs() { return logs_; }
  const RobotLogs& logs() const { return logs_; }

  /// Whether there are observations of or by this robot that the estimate does not contain.
  bool has_own_news();
  /// How the odometry between poses that sightings tie together is used.
  enum class Odometry {
    kCondensed,  ///< to first order
    kWhole,      ///< step by step: what a central solution would say, at a higher cost
  };
  /// Solves for what is known; false, and nothing changes, if nothing is new since the last time, unless the
  /// odometry is used as a whole.
  bool solve(Odometry odometry = Odometry::kCondensed);

  std::size_t size() const { return poses_.size(); }
  const std::vector<SE2>& poses() const { return poses_; }    ///< the estimate, in frame()
  const std::vector<SE2>& raw_poses() const { return raw_; }  ///< odometry composed from the start as origin
  const ReadLog& own() const { return logs_.own(); }
  /// Of an own sighting, in [0, 1]; 0: it was of no use.
  double weight(std::size_t sighting) const { return sighting < weights_.size() ? weights_[sighting] : 0; }
  /// The latest pose in frame(), with its covariance there.
  const UncertainPose<SE2>& latest() const { return latest_; }
  /// The latest pose as seen from the last one at which the team was met, or from the start.
  const UncertainPose<SE2>& since_contact() const { return since_contact_; }
  /// Where another robot was, in frame(), if that pose is in this estimate.
  std::optional<SE2> pose_of(const std::string& robot, Stamp stamp) const;
  /// The robots in one frame with this one, itself among them, by name.
  const std::vector<std::string>& team() const { return team_; }
  /// The robot whose start is the origin; empty: the frame in which starts are known.
  const std::string& frame() const { return frame_; }
  /// Number of own or others' sightings between this robot and another since a time.
  std::size_t sightings_with(const std::string& robot, double since_s) const;

 private:
  /// A robot's poses in the graph, by their numbers in its log; its start first.
  struct Part {
    std::vector<std::uint32_t> keyframes;
    std::size_t first = 0;  ///< in the graph
    std::vector<SE2> poses{};
    std::optional<std::size_t> place_of(std::uint32_t keyframe) const;
  };
  using Parts = std::map<std::string, Part>;
  /// The last own pose at which another robot was seen, or that was seen, and how well.
  struct Contact {
    std::size_t node = 0;
    std::optional<SE2::Jacobian> information;
    void add(std::size_t at, const RelativePoseFactor<SE2>& seen);
    SE2::Jacobian covariance() const;
  };

  void refresh();
  Parts connected_parts() const;
  std::optional<std::size_t> pose_in(const Parts& parts, const std::string& robot,
                                     std::uint32_t keyframe) const;
  std::string frame_of(const Parts& parts) const;
  PoseGraph2 graph_of(const Parts& parts, const std::string& frame);
  void add_sightings(const Parts& parts, PoseGraph2& graph);
  void place(const Parts& parts, PoseGraph2& graph) const;
  void spread(const Part& self);
  double weight_of(const AngleEvidence& evidence) const;

  RobotEstimateParams params_;
  RobotLogs logs_;
  std::vector<SightingBetween> between_;
  std::size_t changes_ = 0, own_sightings_ = 0, used_sightings_ = 0;
  bool is_old_ = false;
  std::vector<SE2> raw_, poses_;
  std::vector<double> weights_;
  UncertainPose<SE2> latest_, since_contact_;
  Contact contact_;
  Parts parts_;  ///< of the last solution
  std::vector<std::string> team_;
  std::string frame_;
};

}  // namespace radioslam
