// Access points of a simulated building, and their received power on the floor.
//
//   P(p) = P0 - 20 log10(f / 2437 MHz) - 10 n log10(max(d, 1 m) / 1 m) - loss + s(p)      [dBm]
// with P0 and n drawn per device, d the distance in space from device to phone, the loss that of the outer
// wall for devices outside, and s the shadowing of each radio (shadowing.hpp).
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/sensors/shadowing.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

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
    visit(Field{"access_points", "", 1, 60000, "number of BSSIDs; about 70 in Liu et al."}.basic(),
          self.access_points);
    visit(Field{"dual_band_ratio", "", 0, 1, "ratio of devices with a second BSSID on the other band"},
          self.dual_band_ratio);
    visit(Field{"band_5ghz_ratio", "", 0, 1, "ratio of single-band devices on 5 GHz"}, self.band_5ghz_ratio);
    visit(Field{"outside_ratio", "", 0, 1, "ratio of devices outside the floor's outer walls"},
          self.outside_ratio);
    visit(Field{"max_outside_m", "m", 1, 1000, "largest distance of outside devices from the outer walls"},
          self.max_outside_m);
    visit(Field{"outside_loss_db", "dB", 0, 60, "transmission loss of the outer wall"}, self.outside_loss_db);
    visit(Field{"ceiling_m", "m", 1, 20, "height of the devices above the floor"}, self.ceiling_m);
    visit(Field{"phone_height_m", "m", 0, 3, "height of the phones above the floor"}, self.phone_height_m);
    visit(Field{"mean_power_at_1m_dbm", "dBm", -100, 30, "mean received power at 1 m and 2437 MHz"},
          self.mean_power_at_1m_dbm);
    visit(
        Field{"sigma_power_at_1m_db", "dB", 0, 30, "standard deviation of the power at 1 m between devices"},
        self.sigma_power_at_1m_db);
    visit(Field{"mean_exponent", "", 1, 8, "mean path loss exponent; 2 in free space, 3 with obstacles"},
          self.mean_exponent);
    visit(Field{"sigma_exponent", "", 0, 2, "standard deviation of the path loss exponent between devices"},
          self.sigma_exponent);
    visit(Field{"sigma_shadowing_db", "dB", 0, 30, "standard deviation of the shadowing"}.basic(),
          self.sigma_shadowing_db);
    visit(Field{"shadowing_length_m", "m", 0.1, 1000, "distance over which shadowing decorrelates to 1/e"},
          self.shadowing_length_m);
    visit(Field{"shadowing_waves", "", 1, 10000, "number of plane waves per shadowing field"},
          self.shadowing_waves);
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
