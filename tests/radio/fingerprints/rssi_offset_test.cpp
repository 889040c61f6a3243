#include "radioslam/radio/fingerprints/rssi_offset.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/sim/scenarios/carpark.hpp"

namespace radioslam {
namespace {

using Fingerprints = std::vector<std::vector<Fingerprint>>;

/// Fingerprints of robots in a car park, each with one phone of the same model.
Mission one_make(int robots, std::uint64_t seed) {
  CarparkParams params;
  params.robots = robots;
  params.phones.phones = 1;
  params.phones.sigma_phone_offset_db = 0;
  return simulate_carpark(params, seed).mission;
}

Fingerprints heard_in(const Mission& mission) {
  Fingerprints heard;
  for (const Robot& robot : mission.robots) heard.push_back(make_fingerprints(robot, {}));
  return heard;
}

RssiOffsets estimated(const Fingerprints& heard) { return estimate_rssi_offsets(heard, {}, {}); }

TEST(RssiOffsetEstimate, IsZeroForPhonesOfOneMake) {
  const auto offsets = estimated(heard_in(one_make(3, 401)));
  EXPECT_FALSE(offsets.shown);
  for (const RssiOffsetEstimate& robot : offsets.robots) {
    EXPECT_EQ(robot.offset_db, 0);
    EXPECT_GT(robot.pairs, 0U);
    EXPECT_LT(robot.sigma_db, 0.5);
  }
}

/// Distinct places with eight access points each.
std::vector<Fingerprint> clear_places(std::size_t places, float rss_dbm) {
  std::vector<Fingerprint> heard;
  for (std::size_t place = 0; place < places; ++place) {
    Fingerprint fingerprint{Stamp::from_seconds(static_cast<double>(place)), 1, {}};
    for (std::size_t k = 0; k < 8; ++k)
      fingerprint.entries.push_back(
          {AccessPointIndex(8 * place + k), rss_dbm - 3 * static_cast<float>(k), 1});
    heard.push_back(std::move(fingerprint));
  }
  return heard;
}

TEST(RssiOffsetEstimate, EveryPlaceIsAPairOnceHoweverTheRowsAreSplit) {
  // Each of 40 places was visited twice by either robot, the second time many rows later.
  constexpr std::size_t kPlaces = 40;
  Fingerprints heard{clear_places(kPlaces, -50), clear_places(kPlaces, -58)};
  for (auto& robot : heard) {
    const auto again = robot;
    robot.insert(robot.end(), again.begin(), again.end());
  }
  for (const std::size_t threads : {1U, 3U}) {
    set_thread_count(threads);
    const auto offsets = estimated(heard);
    EXPECT_EQ(offsets.robots[0].pairs, kPlaces);
    EXPECT_EQ(offsets.robots[1].pairs, kPlaces);
    EXPECT_NEAR(offsets.robots[0].offset_db - offsets.robots[1].offset_db, 8, 0.05);
  }
  set_thread_count(0);
}

TEST(RssiOffsetEstimate, HasAStatusPerRobot) {
  using Status = RssiOffsetStatus;
  const auto statuses = [](const Fingerprints& heard, const RssiOffsetParams& params = {}) {
    std::vector<Status> all;
    for (const auto& robot : estimate_rssi_offsets(heard, {}, params).robots) all.push_back(robot.status);
    return all;
  };
  const auto here = clear_places(20, -50), louder = clear_places(20, -44);
  const std::vector<Fingerprint> few(here.begin(), here.begin() + 3);
  EXPECT_EQ(statuses({here, louder, few, {}}),
            (std::vector{Status::kCorrected, Status::kCorrected, Status::kNotObserved, Status::kNotSought}));
  EXPECT_EQ(statuses({here, here}), (std::vector{Status::kNotSignificant, Status::kNotSignificant}));
  EXPECT_EQ(statuses({here, few}), (std::vector{Status::kNotObserved, Status::kNotObserved}));
  EXPECT_EQ(statuses({here, {}}), (std::vector{Status::kNotSought, Status::kNotSought}));
  RssiOffsetParams off;
  off.prior_sigma_db = 0;
  EXPECT_EQ(statuses({here, louder}, off), (std::vector{Status::kNotSought, Status::kNotSought}));
}

TEST(RssiOffsetEstimate, OfAPhoneThatHearsWeakerIsFound) {
  CarparkParams params;
  params.phones.phones = 1;
  params.phones.sigma_phone_offset_db = 0;
  auto mission = simulate_carpark(params, 402).mission;
  // 6 dB less, applied before the detection threshold: one phone receives every transmitter 6 dB weaker.
  params.transmitters.mean_power_at_1m_dbm -= 6;
  mission.robots[1].wifi = simulate_carpark(params, 402).mission.robots[1].wifi;
  const auto offsets = estimated(heard_in(mission));
  ASSERT_TRUE(offsets.shown);
  EXPECT_NEAR(offsets.robots[0].offset_db - offsets.robots[1].offset_db, 6, 1);
}

TEST(RssiOffsetEstimate, MovesWithWhatIsAddedToOneRobotAndNothingElse) {
  const Fingerprints heard = heard_in(one_make(3, 403));
  Fingerprints louder = heard, more = heard;
  remove_rssi_offset(louder[1], -4);
  remove_rssi_offset(more[1], -8);
  const auto first = estimated(louder), second = estimated(more);
  ASSERT_TRUE(first.shown && second.shown);
  const auto between = [](const RssiOffsets& of, std::size_t a, std::size_t b) {
    return of.robots[a].offset_db - of.robots[b].offset_db;
  };
  EXPECT_NEAR(between(second, 1, 0) - between(first, 1, 0), 4, 0.05);
  EXPECT_NEAR(between(second, 1, 2) - between(first, 1, 2), 4, 0.05);
  EXPECT_NEAR(between(second, 2, 0) - between(first, 2, 0), 0, 0.02);
  for (const auto& of : {first, second})
    EXPECT_NEAR(of.robots[0].offset_db + of.robots[1].offset_db + of.robots[2].offset_db, 0, 1e-9);
}

TEST(RssiOffsetEstimate, IsRemovedBeforeFingerprintsAreCompared) {
  Mission mission = one_make(2, 404);
  const auto add = [&](Robot& robot, float decibels) {
    for (WifiScan& scan : robot.wifi)
      for (WifiReading& reading : scan.readings) reading.rssi_dbm += decibels;
  };
  for (Robot& robot : mission.robots) add(robot, -3);  // the mean of the offsets below
  const auto plain = measure_radio(mission, {}, {});
  add(mission.robots[0], 3);
  add(mission.robots[1], -3);
  const auto corrected = measure_radio(mission, {}, {});
  RadioParams off;
  off.rssi_offset.prior_sigma_db = 0;
  const auto as_heard = measure_radio(mission, off, {});
  ASSERT_TRUE(corrected.rssi_offsets.shown);
  EXPECT_FALSE(as_heard.rssi_offsets.shown);
  double error = 0, error_as_heard = 0;
  for (std::size_t i = 0; i < plain.nodes.size(); ++i)
    for (std::size_t j = i + 1; j < plain.nodes.size(); ++j) {
      if (plain.nodes[i].robot == plain.nodes[j].robot) continue;
      const auto of = [&](const RadioMeasurements& radio) {
        return static_cast<double>(std::abs(radio.near_similarity.of(i, j) - plain.near_similarity.of(i, j)));
      };
      error += of(corrected);
      error_as_heard += of(as_heard);
    }
  EXPECT_LT(error, 0.2 * error_as_heard);
}

TEST(RssiOffsetEstimate, IsTheSameForAnyNumberOfThreads) {
  Fingerprints heard = heard_in(one_make(3, 405));
  remove_rssi_offset(heard[0], 5);
  set_thread_count(1);
  const auto alone = estimated(heard);
  set_thread_count(4);
  const auto together = estimated(heard);
  set_thread_count(0);
  for (std::size_t r = 0; r < heard.size(); ++r)
    EXPECT_EQ(alone.robots[r].offset_db, together.robots[r].offset_db);
}

TEST(RssiOffsetEstimate, NeedsSomethingToCompare) {
  const Mission mission = one_make(2, 406);
  Fingerprints heard = heard_in(mission);
  const auto expect_nothing = [](const Fingerprints& fingerprints) {
    const auto offsets = estimated(fingerprints);
    EXPECT_FALSE(offsets.shown);
    ASSERT_EQ(offsets.robots.size(), fingerprints.size());
    for (const RssiOffsetEstimate& robot : offsets.robots) {
      EXPECT_EQ(robot.offset_db, 0);
      EXPECT_EQ(robot.sigma_db, RssiOffsetParams{}.prior_sigma_db);
      EXPECT_EQ(robot.pairs, 0U);
    }
  };
  expect_nothing({});
  expect_nothing({{}, {}});
  expect_nothing({heard[0]});
  expect_nothing({heard[0], {}});
  for (Fingerprint& fingerprint : heard[1])
    for (FingerprintEntry& entry : fingerprint.entries)
      entry.access_point = AccessPointIndex(entry.access_point.index() + mission.access_points.size());
  expect_nothing(heard);  // no shared access point
}

TEST(RssiOffsetEstimate, LeavesAnUnconnectedRobotAtZero) {
  const Mission mission = one_make(3, 407);
  Fingerprints heard = heard_in(mission);
  remove_rssi_offset(heard[1], 5);
  for (Fingerprint& fingerprint : heard[2])
    for (FingerprintEntry& entry : fingerprint.entries)
      entry.access_point = AccessPointIndex(entry.access_point.index() + mission.access_points.size());
  const auto offsets = estimated(heard);
  ASSERT_TRUE(offsets.shown);
  EXPECT_NEAR(offsets.robots[0].offset_db, 2.5, 0.5);
  EXPECT_NEAR(offsets.robots[0].offset_db + offsets.robots[1].offset_db, 0, 1e-9);
  EXPECT_EQ(offsets.robots[2].offset_db, 0);
}

}  // namespace
}  // namespace radioslam
