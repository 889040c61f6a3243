#include "radioslam/sim/sensors/transmitters.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>

namespace radioslam {
namespace {

TEST(Transmitter, FallsByTenTimesItsExponentPerDecade) {
  const Transmitter radio("02:00:00:00:00:01", {0, 0, 0}, 2437, -30, 3, ShadowingField(0, 7, 1, Rng(1)));
  EXPECT_DOUBLE_EQ(radio.mean_power_dbm({1, 0, 0}), -30);
  EXPECT_DOUBLE_EQ(radio.mean_power_dbm({0, 10, 0}), -60);
  EXPECT_DOUBLE_EQ(radio.mean_power_dbm({0, 0, 100}), -90);
  EXPECT_DOUBLE_EQ(radio.mean_power_dbm({0.1, 0, 0}), -30);  // no stronger than at a metre
}

TEST(Transmitter, IsWeakerOnTheHigherBand) {
  const ShadowingField none(0, 7, 1, Rng(1));
  const Transmitter low("02:00:00:00:00:01", {0, 0, 0}, 2437, -30, 3, none);
  const Transmitter high("02:00:00:00:00:02", {0, 0, 0}, 4874, -30, 3, none);
  EXPECT_NEAR(low.mean_power_dbm({5, 0, 0}) - high.mean_power_dbm({5, 0, 0}), 6.0206, 1e-4);
}

TEST(PlaceTransmitters, GivesSortedDistinctBssids) {
  const auto radios = place_transmitters({}, {}, Rng(1));
  ASSERT_EQ(radios.size(), 70U);
  const std::regex form("02(:[0-9a-f]{2}){5}");
  for (std::size_t i = 0; i < radios.size(); ++i) {
    EXPECT_TRUE(std::regex_match(radios[i].bssid(), form)) << radios[i].bssid();
    if (i > 0) {
      EXPECT_LT(radios[i - 1].bssid(), radios[i].bssid());
    }
  }
}

TEST(PlaceTransmitters, PutsTheRequestedRatioOutside) {
  TransmitterParams params;
  params.access_points = 1000;
  int outside = 0;
  for (const auto& radio : place_transmitters({}, params, Rng(1))) {
    const auto& p = radio.position();
    outside += p.x() < 0 || p.x() > 85 || p.y() < 0 || p.y() > 60 ? 1 : 0;
    EXPECT_TRUE(p.x() >= -25 && p.x() <= 110 && p.y() >= -25 && p.y() <= 85);
  }
  EXPECT_NEAR(outside, 300, 5 * std::sqrt(1000 * 0.3 * 0.7));
}

TEST(PlaceTransmitters, PutsTwoBandsInADualBandDevice) {
  TransmitterParams params;
  params.dual_band_ratio = 1;
  std::map<std::pair<double, double>, std::vector<double>> bands;
  for (const auto& radio : place_transmitters({}, params, Rng(1)))
    bands[{radio.position().x(), radio.position().y()}].push_back(radio.frequency_mhz());
  EXPECT_EQ(bands.size(), 35U);
  for (const auto& [place, frequencies] : bands) {
    ASSERT_EQ(frequencies.size(), 2U);
    EXPECT_NE(frequencies[0] < 3000, frequencies[1] < 3000);
  }
}

TEST(PlaceTransmitters, AnotherOneLeavesTheOthersWhereTheyAre) {
  TransmitterParams more;
  more.access_points = 71;
  std::map<std::string, Eigen::Vector3d> places;
  for (const auto& radio : place_transmitters({}, more, Rng(1))) places[radio.bssid()] = radio.position();
  for (const auto& radio : place_transmitters({}, {}, Rng(1))) {
    ASSERT_TRUE(places.contains(radio.bssid()));
    EXPECT_EQ(places[radio.bssid()], radio.position());
  }
}

}  // namespace
}  // namespace radioslam
