// What one robot says it measured: relative quantities and positions that were surveyed, never a frame of the
// team's estimate. Immutable once said; a robot numbers its records from 0 on, without gaps.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A robot and its sensors; the first record of a log.
struct FactsRecord {
  int dimension = 2;    ///< of the mission
  OdometryNoise noise;  ///< without steps
  Heading heading = Heading::kRelative;
  double sigma_heading_rad = 0;
  std::optional<SE3> initial_pose;  ///< surveyed
  double lidar_range_m = 0, lidar_view_rad = 0;
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();
};

/// An anchor that the robot knows.
struct AnchorRecord {
  Anchor anchor;
};

/// A pose of the robot's trajectory, from which others of its records are measured.
struct KeyframeRecord {
  std::uint32_t number = 0;  ///< in order of time, from 0 on
  Stamp stamp;
  SE3 T_before_this;  ///< from the keyframe before; of the first one, from the odometry's start
  std::optional<SE3::Jacobian> covariance;  ///< of T_before_this, if measured; else by FactsRecord::noise
};

/// The robot at any time: the last keyframe before, and the motion since.
struct PoseAt {
  std::uint32_t keyframe = 0;
  Stamp stamp;
  SE3 T_keyframe_body;
};

/// The other end of a radio link.
struct LinkPeer {
  bool is_anchor = false;
  std::string name, antenna;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
};

struct RangeRecord {
  PoseAt at;
  std::string antenna;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
  LinkPeer other;
  bool is_other_first = false;  ///< in the order in which the range was recorded
  double range_m = 0, sigma_m = 0;
};

struct AnglesRecord {
  PoseAt at;
  LinkPeer transmitter;
  std::vector<AoaPath> paths;  ///< 1 to 64
};

struct FixRecord {
  PoseAt at;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double sigma_m = 0;
};

/// An access point that the robot has heard; of one that sends at several frequencies, one of these.
struct AccessPointRecord {
  std::uint32_t number = 0;  ///< by which fingerprints name it
  std::string bssid;
  float frequency_mhz = 0;
};

/// Signal strength, to half a decibel, between -127.5 and 0 dBm.
struct HeardAccessPoint {
  std::uint32_t number = 0;  ///< AccessPointRecord::number
  float rssi_dbm = 0;
};
struct FingerprintRecord {
  PoseAt at;
  std::vector<HeardAccessPoint> readings;  ///< at most 255
};

/// A relative pose that place recognition measured, in the log of whoever verified it.
struct ClosureRecord {
  PoseAt at;
  std::string other;  ///< robot; may be the same one
  Stamp stamp_other;
  SE3 T_i_j;  ///< of the other one's body in this one's
  SE3::Jacobian covariance = SE3::Jacobian::Identity();
  std::optional<double> inlier_ratio;  ///< of scans that measured it; nothing where it was measured otherwise
  std::optional<double> doubt;         ///< of scans: probability that another place explains them
};

/// The largest number in a bin of a place's grid.
inline constexpr std::uint8_t kMostBin = 15;

/// The polar grid of a place (scan_context.hpp), by which other robots recognise it.
struct DescriptorRecord {
  std::uint32_t keyframe = 0;
  bool is_occupancy = false;     ///< of a planar scanner; else heights
  double range_m = 0, step = 0;  ///< of the grid; of a bin's number
  std::uint32_t rings = 0, sectors = 0;
  std::vector<std::uint8_t> bins;  ///< ring by ring, 0 where empty, at most kMostBin
};

/// A motion between keyframes as the robot now knows it.
struct AmendedStep {
  SE3 T_before_this;
  std::optional<SE3::Jacobian> covariance;
};
/// The robot has changed its mind: of several amendments the last one holds.
struct AmendmentRecord {
  std::uint32_t first = 0;  ///< keyframe
  std::vector<AmendedStep> steps;
};

using Record =
    std::variant<FactsRecord, AnchorRecord, KeyframeRecord, RangeRecord, AnglesRecord, FixRecord,
                 AccessPointRecord, FingerprintRecord, ClosureRecord, DescriptorRecord, AmendmentRecord>;

/// The name of a record's kind, in the order of Record.
inline constexpr const char* kRecordKinds[] = {"facts",   "anchor",     "keyframe",     "range",
                                               "angles",  "fix",        "access_point", "fingerprint",
                                               "closure", "descriptor", "amendment"};

}  // namespace radioslam
