// One robot's estimate in a team that is seldom connected: its own trajectory with all it measured, and the
// parts that others shared with it (shared_part.hpp), solved together as one pose graph.
//
// It needs nobody's answer to be solved, and no round in which all take part: whatever has arrived is used,
// and what is still missing is missing. Robots that know the same parts have the same estimate, that of a
// central solution, up to condensing odometry to first order. Cost of a solution: that of the graph of the
// own poses and of the poses that others share.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/distributed/condensed/shared_part.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// How relative poses between robots are weighed, and how much of a team is used.
struct KnownTeamParams {
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
        "largest number of other robots' poses in one robot's estimate; the nearest by observations");
  }
};

/// An observation of this robot that it has not judged yet.
struct UnjudgedObservation {
  std::string by;
  std::uint32_t node = 0;  ///< the own pose that was seen
  double t_s = 0;
  SE2 T_j_i;  ///< of the robot that saw it, in this one's frame
  double sigma_m = 1, sigma_rad = 1;
};

class KnownTeam {
 public:
  using PartPointer = std::shared_ptr<const SharedPart>;

  /// A robot that begins at t_s, where it is in the common frame if that is known.
  KnownTeam(std::string robot, double t_s, const std::optional<SE2>& start, const KnownTeamParams& params);

  /// A new pose, T_latest_new; standard deviations per axis.
  void move(double t_s, const SE2& step, double sigma_m, double sigma_rad);
  /// Another robot as seen from the latest pose.
  void see(double t_s, const std::string& robot, const SE2& T_i_j, double sigma_m, double sigma_rad,
           const AngleEvidence& evidence);
  /// The part of another robot, from itself or from a third; false for what is not new or not well-formed.
  bool take(const PartPointer& part);
  /// Observations of this robot by others that `judge` was not called for.
  std::vector<UnjudgedObservation> unjudged() const;
  void judge(const std::string& by, double t_s, const AngleEvidence& evidence);
  /// What this robot shares at `now_s`. The version rises with the contents.
  PartPointer own_part(double now_s);
  const std::map<std::string, PartPointer>& parts() const { return parts_; }

  /// What is of use to another robot, the nearest first: parts of robots that observations lead to from it.
  std::vector<PartPointer> parts_for(const std::string& robot, double now_s);
  /// Whether there are observations of or by this robot that the estimate does not contain.
  bool has_own_news() const { return own_news_; }
  /// Solves for what is known; false, and nothing changes, if nothing is new since the last time.
  bool solve();

  std::size_t size() const { return poses_.size(); }
  double time(std::size_t node) const { return times_[node]; }
  const std::vector<SE2>& poses() const { return poses_; }    ///< the estimate, in frame()
  const std::vector<SE2>& raw_poses() const { return raw_; }  ///< odometry composed from the start as origin
  const std::vector<UncertainPose<SE2>>& steps() const { return steps_; }  ///< steps()[k]: from k to k + 1
  const std::vector<SharedObservation>& observations() const { return observations_; }
  double weight(std::size_t observation) const {
    return weights_[observation];
  }  ///< of an own one, in [0, 1]
  /// The latest pose in frame(), with its covariance there.
  const UncertainPose<SE2>& latest() const { return latest_; }
  /// The latest pose as seen from the last one at which the team was met, or from the start.
  const UncertainPose<SE2>& since_contact() const { return since_contact_; }
  /// Where the pose of another robot that it shared was, in frame(), if it is in this estimate.
  std::optional<SE2> pose_of(const std::string& robot, double t_s) const;
  /// The robots in one frame with this one, itself among them, by name.
  const std::vector<std::string>& team() const { return team_; }
  /// The robot whose start is the origin; empty: the frame in which starts are known.
  const std::string& frame() const { return frame_; }
  /// Number of own or others' observations between this robot and another since a time that are in the
  /// estimate.
  std::size_t observations_with(const std::string& robot, double since_s) const;

 private:
  struct Layout;
  struct Between {
    const SharedObservation* observation = nullptr;
    const std::string* from = nullptr;
    AngleEvidence at_seen{};  ///< by the robot that was seen
  };

  /// The last own pose at which another robot was seen, or that was seen, and how well.
  struct Contact {
    std::size_t node = 0;
    std::optional<SE2::Jacobian> information;
    void add(std::size_t at, const RelativePoseFactor<SE2>& seen);
    SE2::Jacobian covariance() const;
  };

  std::optional<std::uint32_t> own_node_at(double t_s) const;
  std::vector<Between> all_observations() const;
  std::vector<PartPointer> parts_around(const std::string& robot, int hops) const;
  Layout connected_part(const std::vector<Between>& between) const;
  PoseGraph2 graph_of(const Layout& layout, const std::vector<Between>& between);
  void place(const Layout& layout, PoseGraph2& graph) const;
  std::size_t observations_between(const SharedPart& part) const;
  void share_node(std::uint32_t number);
  std::vector<std::uint32_t> latest_shared() const;
  SE2::Jacobian latest_covariance(const PoseGraph2& graph) const;
  double weight_of(const Between& between) const;

  KnownTeamParams params_;
  std::string robot_;
  std::optional<SE2> start_;
  std::vector<double> times_;
  std::vector<SE2> raw_, poses_;
  std::vector<UncertainPose<SE2>> steps_;
  std::vector<SharedObservation> observations_;
  std::vector<double> weights_;
  std::map<std::pair<std::string, double>, AngleEvidence> evidence_;
  std::map<std::string, PartPointer> parts_;
  std::vector<std::uint32_t> shared_;  ///< numbers of the nodes that others may refer to, ascending
  PartPointer own_part_;
  std::uint64_t version_ = 0;
  bool part_is_old_ = true, estimate_is_old_ = false, own_news_ = false;
  std::map<std::string, std::set<std::string>> links_;  ///< who saw whom, both ways
  UncertainPose<SE2> latest_, since_contact_;
  Contact contact_;
  std::map<std::string, std::vector<SE2>> others_;  ///< per robot in the estimate, its nodes' poses
  std::map<std::string, PartPointer> used_parts_;   ///< that others_ is of
  std::vector<std::string> team_;
  std::string frame_;
};

}  // namespace radioslam
