// Access points of a simulated building, and their received power on the floor.
//
//   P(p) = P0 - 20 log10(f / 2437 MHz) - 10 n log10(max(d, 1 m) / 1 m) - loss + s(p)      [dBm]
// with P0 and n drawn per device, d the distance in space from device to phone, the loss that of the outer
// wall for devices outside, and s the shadowing of each radio.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

// Shadowing: spatially correlated deviation of received power from the path loss model.
//
// A Gaussian random field over the floor with correlation exp(-distance / length) (Gudmundson 1991), as a sum
// of plane waves (Rahimi, Recht 2007): s(p) = sigma sqrt(2/m) sum cos(k_i . p + phase_i). The spectrum of
// that correlation in the plane is proportional to (1 + (k length)^2)^(-3/2), so the quantile u of the
// wavenumber is k = sqrt((1 - u)^-2 - 1) / length.

/// One transmitter's shadowing; decibels over metres.
class ShadowingField {
 public:
  ShadowingField(double sigma_db, double correlation_length_m, int waves, Rng rng);

  /// Cost: one cosine per wave.
  double at_db(const Eigen::Vector2d& position) const;

 private:
  struct PlaneWave {
    Eigen::Vector2d wavenumber_per_m;
    double phase_rad = 0;
  };
  double amplitude_db_ = 0;
  std::vector<PlaneWave> waves_;
};

/// Number, positions and propagation of access points.
struct TransmitterParams {
  int access_points = 70;
  double dual_band_ratio = 0;
  double band_5ghz_ratio = 0.3;
  double outside_ratio = 0.3;
  double max_outside_m = 25;
  double outside_loss_db = 5;
  double ceiling_m = 2.8;
  double phone_height_m = 0.8;
  double mean_power_at_1m_dbm = -36;
  double sigma_power_at_1m_db = 4;
  double mean_exponent = 3;
  double sigma_exponent = 0.25;
  double sigma_shadowing_db = 5;
  double shadowing_length_m = 7;
  int shadowing_waves = 64;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(access_points, "", 1, 60000, "number of BSSIDs; about 70 in Liu et al.");
    RADIOSLAM_FIELD(dual_band_ratio, "", 0, 1, "ratio of devices with a second BSSID on the other band");
    RADIOSLAM_FIELD(band_5ghz_ratio, "", 0, 1, "ratio of single-band devices on 5 GHz");
    RADIOSLAM_FIELD(outside_ratio, "", 0, 1, "ratio of devices outside the floor's outer walls");
    RADIOSLAM_FIELD(max_outside_m, "m", 1, 1000, "largest distance of outside devices from the outer walls");
    RADIOSLAM_FIELD(outside_loss_db, "dB", 0, 60, "transmission loss of the outer wall");
    RADIOSLAM_FIELD(ceiling_m, "m", 1, 20, "height of the devices above the floor");
    RADIOSLAM_FIELD(phone_height_m, "m", 0, 3, "height of the phones above the floor");
    RADIOSLAM_FIELD(mean_power_at_1m_dbm, "dBm", -100, 30, "mean received power at 1 m and 2437 MHz");
    RADIOSLAM_FIELD(sigma_power_at_1m_db, "dB", 0, 30,
                    "standard deviation of the power at 1 m between devices");
    RADIOSLAM_FIELD(mean_exponent, "", 1, 8, "mean path loss exponent; 2 in free space, 3 with obstacles");
    RADIOSLAM_FIELD(sigma_exponent, "", 0, 2, "standard deviation of the path loss exponent between devices");
    RADIOSLAM_BASIC_FIELD(sigma_shadowing_db, "dB", 0, 30, "standard deviation of the shadowing");
    RADIOSLAM_FIELD(shadowing_length_m, "m", 0.1, 1000, "distance over which shadowing decorrelates to 1/e");
    RADIOSLAM_FIELD(shadowing_waves, "", 1, 10000, "number of plane waves per shadowing field");
  }
};

/// One radio with its own BSSID.
class Transmitter {
 public:
  Transmitter(std::string bssid, Eigen::Vector3d position, double frequency_mhz, double power_at_1m_dbm,
              double exponent, ShadowingField shadowing);

  const std::string& bssid() const { return bssid_; }
  const Eigen::Vector3d& position() const { return position_; }
  double frequency_mhz() const { return frequency_mhz_; }
  /// Received power without fading.
  double mean_power_dbm(const Eigen::Vector3d& receiver) const;

 private:
  std::string bssid_;
  Eigen::Vector3d position_;
  double frequency_mhz_;
  double power_at_1m_dbm_;
  double exponent_;
  ShadowingField shadowing_;
};

/// The radios of a floor, sorted by BSSID.
std::vector<Transmitter> place_transmitters(const LaneGridParams& floor, const TransmitterParams& params,
                                            const Rng& rng);

}  // namespace radioslam
