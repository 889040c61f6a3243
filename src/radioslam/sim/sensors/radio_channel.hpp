// Simulated radio links between moving robots: ranges and angles of arrival.
//
// Links are drawn at times when two robots are within radio range, one in each of as many equal parts of
// those times, so that they are spread over the mission. A range is the true distance plus Gaussian noise. An
// angle measurement contains the direct path, unless it is missing, and false ones,
// strongest first. Each receiver and transmitter has its own random stream: enabling or disabling one kind of
// measurement leaves the noise of the others unchanged.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Rate and errors of links.
struct RadioChannelParams {
  int links = 40;
  double radio_range_m = 100;
  bool ranges = true;
  std::string angle_ends = "both";
  double sigma_range_m = 0.5;
  double sigma_angle_deg = 10;
  double time_offset_s = 0;
  double missing_direct_ratio = 0.15;
  int min_false_paths = 0;
  int max_false_paths = 5;
  double false_elevation_deg = 20;
  bool mirror = false;
  double mirror_section_m = 150;
  double mirror_distance_m = 12;
  double sigma_power_db = 4;
  double false_power_db = -5;
  double mirror_power_db = -1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(links, "", 0, 100000, "number of links per pair of robots");
    RADIOSLAM_BASIC_FIELD(radio_range_m, "m", 0.1, 1e6,
                          "largest distance at which robots receive each other");
    RADIOSLAM_FIELD(ranges, "", 0, 1, "whether links measure ranges");
    RADIOSLAM_FIELD(angle_ends, "", 0, 0, "robots of a link that measure angles; one: the first of the two",
                    "both|one|none");
    RADIOSLAM_BASIC_FIELD(sigma_range_m, "m", 0.001, 1000,
                          "standard deviation of ranges; 0.5 in Wi-Closure (Wang et al.)");
    RADIOSLAM_BASIC_FIELD(sigma_angle_deg, "deg", 0.01, 90,
                          "standard deviation of angles; 10 in Wi-Closure (Wang et al.)");
    RADIOSLAM_FIELD(time_offset_s, "s", 0, 60, "delay of angle measurements after ranges");
    RADIOSLAM_BASIC_FIELD(missing_direct_ratio, "", 0, 1,
                          "ratio of angle measurements without the direct path");
    RADIOSLAM_FIELD(min_false_paths, "", 0, 100, "smallest number of false paths per angle measurement");
    RADIOSLAM_FIELD(max_false_paths, "", 0, 100, "largest number of false paths per angle measurement");
    RADIOSLAM_FIELD(false_elevation_deg, "deg", 0, 90, "largest absolute elevation of false paths");
    RADIOSLAM_FIELD(mirror, "", 0, 1,
                    "whether every angle measurement contains a mirror image of the transmitter");
    RADIOSLAM_FIELD(mirror_section_m, "m", 1, 1e6,
                    "path length of the first robot along which its mirroring wall is the same");
    RADIOSLAM_FIELD(mirror_distance_m, "m", 0, 1000,
                    "distance from the first robot's path to the mirroring wall");
    RADIOSLAM_FIELD(sigma_power_db, "dB", 0, 60, "standard deviation of every path's power");
    RADIOSLAM_FIELD(false_power_db, "dB", -100, 100, "mean power of false paths relative to direct ones");
    RADIOSLAM_FIELD(mirror_power_db, "dB", -100, 100, "mean power of mirror images relative to direct paths");
  }
};

// Simulated paths of one angle measurement: directions in the receiver's body frame, each with a power.
//
// The direct path points to the transmitter, a mirror image to its reflection in a wall. Both carry isotropic
// Gaussian noise across their direction. False paths have uniform azimuths and bounded elevations. Powers are
// Gaussian: those of direct paths have mean 0 dB, so that the distributions of the others overlap with them.

/// A vertical wall: a plane through `point` with a horizontal unit normal; all in the common frame.
struct Wall {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();

  /// Mirror image of a position.
  Eigen::Vector3d image(const Eigen::Vector3d& position) const {
    return position - 2 * normal.dot(position - point) * normal;
  }
};

/// The wall beside a robot's street, constant along each section of its path: parallel to the line between
/// the section's ends, on a random side per section.
class MirrorWalls {
 public:
  MirrorWalls(const Trajectory<SE3>& truth, const RadioChannelParams& params, const Rng& rng);
  const Wall& at(Stamp stamp) const;

 private:
  std::vector<Stamp> begins_;
  std::vector<Wall> walls_;
};

/// Paths, strongest first, and which of them is direct.
struct DrawnPaths {
  std::vector<AoaPath> paths;  ///< may be empty
  int direct = -1;
};

DrawnPaths draw_paths(const SE3& T_common_receiver, const Eigen::Vector3d& transmitter,
                      const std::optional<Wall>& wall, int dimension, const RadioChannelParams& params,
                      const Rng& rng);

/// Which robots of a link measure angles.
enum class AngleEnds { kBoth, kOne, kNone };

inline AngleEnds angle_ends(const RadioChannelParams& params) {
  if (params.angle_ends == "none") return AngleEnds::kNone;
  return params.angle_ends == "one" ? AngleEnds::kOne : AngleEnds::kBoth;
}

/// Measurements of all links of a team, in temporal order, and which paths are direct (see Truth).
struct RadioLinks {
  std::vector<RangeMeasurement> ranges;
  std::vector<AoaMeasurement> aoa_measurements;
  std::vector<std::optional<int>> direct_paths;
};

/// Links between all pairs of robots that move along `truth` (T_common_body). Robots that are never within
/// range have none. Dimension 2 measures no elevation. Cost: one distance per pair and 50 ms.
RadioLinks simulate_links(const std::vector<Trajectory<SE3>>& truth, int dimension,
                          const RadioChannelParams& params, const Rng& rng);

/// Time grid on which links are placed, so that no two links of a pair coincide.
inline constexpr double kTimeInRangeStep_s = 0.05;

/// Times t at which two robots are within `within_m` of each other and both still move at t + offset.
std::vector<Stamp> times_in_range(const Trajectory<SE3>& a, const Trajectory<SE3>& b, double within_m,
                                  double offset_s = 0);

}  // namespace radioslam
