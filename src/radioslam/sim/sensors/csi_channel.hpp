// Channel state information of given paths: one complex number per subcarrier.
//
//   h_k = sum over paths of amplitude * exp(-j 2 pi (carrier + subcarrier_k) length / c)
// The paths are those of a room (image_sources.hpp), or plane waves from given directions.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "radioslam/sim/sensors/image_sources.hpp"

namespace radioslam {

inline constexpr double kLightSpeed_mps = 299'792'458;

/// Carrier and subcarriers of a channel.
struct CsiBand {
  double carrier_hz = 5.54e9;         ///< channel 108
  std::vector<double> subcarrier_hz;  ///< relative to the carrier
  double bandwidth_hz = 20e6;

  /// 20 MHz around a carrier, with the subcarriers that an Intel 5300 reports.
  static CsiBand intel5300(double carrier_hz);
};

/// All paths between two antennas in the common frame; directions are those seen from `here`.
using PathsBetween =
    std::function<std::vector<RadioPath>(const Eigen::Vector3d& here_m, const Eigen::Vector3d& there_m)>;

/// One row, one column per subcarrier.
Eigen::RowVectorXcd channel_of(const std::vector<RadioPath>& paths, const CsiBand& band);

/// A wave from a source at infinity, with the same direction everywhere.
struct PlaneWave {
  double azimuth_rad = 0;  ///< of the source, in the common frame
  double elevation_rad = 0;
  double power_db = 0;
  double delay_s = 0;  ///< at the common frame's origin
};

/// Plane waves, independent of the other antenna's position.
PathsBetween plane_wave_paths(std::vector<PlaneWave> waves);

/// The paths in a room.
PathsBetween room_paths(std::vector<WallSegment> walls, const ImageParams& params);

}  // namespace radioslam
