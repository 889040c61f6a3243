// Packets between robots on a floor with walls: on which paths they arrive, and how well.
//
// Paths by image sources, with one reflection. Strength over distance by an exponent, loss in walls,
// and shadowing that is the same for all robots at a place. ESNR: the SNR of a flat channel that would lose
// as many bits as the channel over the subcarriers does, by the exponential mapping -log(mean(exp(-SNR_k)))
// (Ericsson 2003, EESM with beta 1; Halperin et al. 2010 for the use). Directions carry Gaussian noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/sensors/image_sources.hpp"

namespace radioslam {

struct PacketRadioParams {
  double esnr_1m_db = 55;
  double path_loss_exponent = 2.2;
  double sigma_shadowing_db = 3;
  double sigma_aoa_rad = 0.14835298641951802;
  double wall_loss_db = 8;
  double wall_reflection = 0.4;
  int max_heard = 40;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(esnr_1m_db, "dB", 0, 200, "simulated ESNR at a distance of one metre");
    RADIOSLAM_FIELD(path_loss_exponent, "", 1, 6, "simulated fall of the signal with distance");
    RADIOSLAM_FIELD(sigma_shadowing_db, "dB", 0, 20, "standard deviation of simulated shadowing");
    RADIOSLAM_FIELD(sigma_aoa_rad, "rad", 0.001, 3,
                    "standard deviation of simulated angles of arrival; 8.5 degrees in Wang et al.");
    RADIOSLAM_FIELD(wall_loss_db, "dB", 0, 100, "simulated loss of the signal in a wall");
    RADIOSLAM_FIELD(wall_reflection, "", 0, 1, "simulated amplitude that a wall reflects");
    RADIOSLAM_FIELD(max_heard, "", 1, 10000, "robots that a simulated robot hears at once: the nearest");
  }
};

/// One path on which a packet arrives; azimuth in the frame of the floor.
struct PacketPath {
  double azimuth_rad = 0;
  double power_db = 0;
};

struct PacketReception {
  double esnr_db = 0;
  std::vector<PacketPath> paths;  ///< strongest first
};

class PacketRadio {
 public:
  PacketRadio(const std::vector<WallSegment>& walls, const PacketRadioParams& params, const Rng& rng);

  /// `rng`: of the noise of this packet.
  PacketReception receive(const Eigen::Vector2d& transmitter_m, const Eigen::Vector2d& receiver_m,
                          Rng rng) const;

 private:
  double shadowing_db(const Eigen::Vector2d& place) const;

  struct Wave {
    Eigen::Vector2d wavenumber;
    double phase = 0;
  };
  std::vector<WallSegment> walls_;
  PacketRadioParams params_;
  std::array<Wave, 6> waves_{};
};

}  // namespace radioslam
