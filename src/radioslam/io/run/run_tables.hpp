// Reads and writes the tables of a run folder:
//   candidates.csv   robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis
//   closures.csv     robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason,path_weights,x,y,z,qx,qy,qz,qw,
//                    doubt
//   uncertainty.csv  robot,t_s,sigma_m,sigma_team_m,sigma_rad
//   aoa.csv          t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db
//   access_points.csv   bssid,x_m,y_m,sigma_x_m,sigma_y_m,cov_xy,p0_dbm,exponent,sigma_db,readings,status,
//                       sigma_p0_db,sigma_exponent,frequency_mhz,rival_x_m,rival_y_m
// Robots are written by id; stamps are exactly those of <id>.tum.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/eval/access_point_errors.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

inline constexpr std::string_view kCandidateHeader = "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis\n";

/// Writes candidates.csv as the candidates come, since a large team's has gigabytes.
class CandidateWriter {
 public:
  /// `ids`: of all robots.
  CandidateWriter(const std::filesystem::path& path, std::vector<std::string> ids);

  /// `keyframes` has the stamps of all robots, the same at every call.
  void write(const CandidateList::Group& group, const CandidateList& keyframes);
  /// To be called after the last group.
  void close() { file_.close(); }

 private:
  void name_ends(const CandidateList& keyframes);

  FileWriter file_;
  std::vector<std::string> ids_;
  std::vector<std::vector<std::string>> ends_;  ///< "id,stamp" per robot and keyframe
  std::vector<std::string> pieces_;
};
/// ",x,y,z,qx,qy,qz,qw", empty fields without a pose.
void append_pose_fields(std::string& out, const std::optional<SE3>& pose);
/// A list in one call.
void write_candidates(const std::filesystem::path& path, const CandidateList& candidates,
                      std::span<const std::string> ids);
/// The stated standard deviation of every keyframe's position, of the robots that have one.
std::string format_uncertainty(const std::vector<RobotResult>& robots);
/// As in closures.csv.
std::string_view closure_kind_name(ClosureKind kind);
std::string format_closures(const std::vector<ClosureResult>& closures, std::span<const std::string> ids);
/// Angles in the format of a mission's radio/aoa.csv: the paths that the run used, numbered from 0 per
/// measurement.
std::string format_measured_aoa(const std::vector<MeasuredAoaResult>& aoa_measurements);

/// status: found|ambiguous|loose. Positions are in the frame of the first component, p0_dbm is the power at 1
/// m, sigma_db the standard deviation of a reading from the path loss model. The alternative position
/// (rival_x_m, rival_y_m) is empty if there is none.
std::string format_access_points(const std::vector<AccessPointResult>& access_points);
std::vector<LocatedAccessPoint> read_access_points(const Text& text);

/// Refuse malformed rows, unknown robots, kinds and statuses, path weights that are no numbers from 0 on, and
/// stamps at which a robot has no keyframe (not checked for robots without poses, and where they are untied).
CandidateList read_candidates(const Text& text, std::span<const EstimatedTrajectory> robots);
std::vector<ClosureResult> read_closures(const Text& text, std::span<const EstimatedTrajectory> robots);
/// In time order, without peaks and profiles. Refuses what a mission's radio/aoa.csv refuses.
std::vector<MeasuredAoaResult> read_measured_aoa(const Text& text,
                                                 std::span<const EstimatedTrajectory> robots);
/// Sets the standard deviations of the robots in the table. Refuses a robot with other stamps than its poses.
void read_uncertainty(const Text& text, std::span<EstimatedTrajectory> robots);

}  // namespace radioslam
