// Parameters, input and peaks of the angle-of-arrival estimation (aoa_estimate.hpp).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {

/// Method that computes the profile.
enum class AoaProfileKind { kBartlett, kMusic, kSparse };

struct AoaParams {
  TwoWayParams two_way;
  std::string profile = "bartlett";
  int azimuths = 360;
  double max_elevation_rad = 0.7;
  double min_source_distance_m = 2;
  double subarray_m = 0.25;
  double min_step_m = 5e-4;
  double min_aperture_m = 0.15;
  double max_aperture_m = 4;
  int model_paths = 8;
  int model_passes = 4;
  int peaks = 4;
  double sigma_floor_rad = 0.03;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    TwoWayParams::visit_fields(self.two_way, visit);
    RADIOSLAM_BASIC_FIELD(profile, "", 0, 0, "method that computes the AoA profile", "bartlett|music|sparse");
    RADIOSLAM_FIELD(azimuths, "", 36, 3600,
                    "number of azimuths of the profile's grid; peaks are refined below its step");
    RADIOSLAM_BASIC_FIELD(
        max_elevation_rad, "rad", 0, 1.57,
        "largest elevation searched, upwards and, where the motion is not planar, downwards");
    RADIOSLAM_FIELD(min_source_distance_m, "m", 0.5, 1e6,
                    "smallest source distance for which spherical wavefronts are tried");
    RADIOSLAM_FIELD(subarray_m, "m", 0.05, 1e6,
                    "length of the subarrays whose profiles are added; higher values resolve better but "
                    "tolerate less odometry drift");
    RADIOSLAM_FIELD(min_step_m, "m", 0, 0.1,
                    "smallest antenna displacement between two packets that are used");
    RADIOSLAM_FIELD(min_aperture_m, "m", 0.01, 100,
                    "shortest antenna path for which directions are estimated");
    RADIOSLAM_FIELD(
        max_aperture_m, "m", 0.1, 30,
        "largest aperture for which directions are estimated; computing time grows with its cube");
    RADIOSLAM_FIELD(
        model_paths, "", 1, 32,
        "largest number of paths in the multipath model that packet delays are estimated against");
    RADIOSLAM_FIELD(model_passes, "", 0, 20,
                    "number of rounds that fit the multipath model and align the packet delays to it");
    RADIOSLAM_BASIC_FIELD(peaks, "", 1, 16, "largest number of directions per measurement");
    RADIOSLAM_FIELD(sigma_floor_rad, "rad", 0, 1,
                    "standard deviation added to every direction for errors of antenna positions and clocks");
  }
};

inline AoaProfileKind profile_kind(const AoaParams& params) {
  if (params.profile == "music") return AoaProfileKind::kMusic;
  return params.profile == "sparse" ? AoaProfileKind::kSparse : AoaProfileKind::kBartlett;
}

/// A direction in the trajectory's frame.
struct AoaDirection {
  double azimuth_rad = 0, elevation_rad = 0;
};

/// One direction that a wave came from.
struct AoaPeak {
  double azimuth_rad = 0;              ///< in the trajectory's frame
  double elevation_rad = 0;            ///< at least 0 for a level trajectory; the negative is as likely
  double sigma_rad = 0;                ///< of the azimuth
  double elevation_sigma_rad = 0;      ///< pi / sqrt(3) where elevation is unobservable
  double power_db = 0;                 ///< relative to the strongest peak
  double curvature_per_m = 0;          ///< inverse of the source's distance, from the wavefront's curvature
  double explained = 0;                ///< fraction of the channel's power that this wave alone explains
  std::optional<AoaDirection> mirror;  ///< equally likely solution beyond a straight path or the path's plane
  bool is_cross_term = false;          ///< artefact of the two-way product, between two paths
};

/// Channels free of the oscillators' phases, with the stamps and antennas of their packets.
struct ChannelTrack {
  std::vector<Stamp> stamps;  ///< increasing
  Eigen::MatrixXcd channel;   ///< packets x subcarriers
  std::vector<double> subcarrier_hz;
  double carrier_hz = 0;
  bool is_two_way = false;  ///< two-way product, else the difference of an antenna pair
  Eigen::Vector3d lever_arm_m =
      Eigen::Vector3d::Zero();  ///< antenna in the body frame; for a pair, their difference
};

}  // namespace radioslam
