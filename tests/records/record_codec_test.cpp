#include "radioslam/records/record_codec.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

PoseAt somewhere() { return {7, Stamp{1'700'000'000'123'456'789}, lift(SE2({0.5, -0.25}, 0.125))}; }

SE3::Jacobian covariance_in_space() {
  SE3::Jacobian root = SE3::Jacobian::Identity();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) root(i, j) += 0.01 * (i - j);
  return root * root.transpose();
}

std::vector<Record> one_of_each() {
  FactsRecord facts;
  facts.lidar_range_m = 30;
  facts.lidar_view_rad = 6;
  facts.initial_pose = SE3(Eigen::Vector3d(1, 2, 0.5), Eigen::Quaterniond::Identity());
  KeyframeRecord keyframe{3, Stamp{-5}, SE3(Eigen::Vector3d(1, 0, 0.5), Eigen::Quaterniond::Identity()),
                          covariance_in_space()};
  LinkPeer peer{false, "b", "left", {0, 0.1, 0}};
  AnglesRecord angles{somewhere(), peer, {{0.5, std::nullopt, 0.1, -3}, {1, 0.25, 0.2, -9}}};
  FingerprintRecord fingerprint{somewhere(), {{0, -60}, {300, -71.5F}}};
  return {facts,
          AnchorRecord{{"gate", Eigen::Vector3d(1, 2, 3), 0.1}},
          keyframe,
          RangeRecord{somewhere(), "", {0, 0, 0}, peer, true, 12.5, 0.1},
          angles,
          FixRecord{somewhere(), {1, 2, 3}, 0.5},
          AccessPointRecord{300, "00:1a:2b:3c:4d:5e", 2412},
          fingerprint,
          ClosureRecord{somewhere(), "b", Stamp{99}, lift(SE2({3, 4}, -1)), isotropic_covariance(0.1, 0.05),
                        0.9, 0.01},
          DescriptorRecord{7, false, 40, 0.05, 2, 5, {0, 3, 15, 0, 0, 0, 0, 0, 0, 1}},
          AmendmentRecord{2, {{lift(SE2({1, 0}, 0.1)), covariance_in_space()}, {SE3(), std::nullopt}}}};
}

TEST(RecordCodec, WhatWasWrittenIsReadAndWrittenTheSame) {
  const auto records = one_of_each();
  ASSERT_EQ(records.size(), std::variant_size_v<Record>);
  for (std::size_t k = 0; k < records.size(); ++k) {
    ASSERT_EQ(records[k].index(), k);
    const std::string bytes = encode(records[k]);
    const auto read = decode_record(bytes);
    ASSERT_TRUE(read) << kRecordKinds[k];
    EXPECT_EQ(encode(*read).size(), bytes.size());
  }
  const auto angles = std::get<AnglesRecord>(*decode_record(encode(records[4])));
  EXPECT_EQ(angles.at.stamp, somewhere().stamp);
  EXPECT_EQ(angles.transmitter.lever_arm_m, Eigen::Vector3d(0, 0.1, 0));
  EXPECT_EQ(angles.paths[1].elevation_rad, 0.25);
  const auto fingerprint = std::get<FingerprintRecord>(*decode_record(encode(records[7])));
  EXPECT_EQ(fingerprint.readings[1].number, 300U);
  EXPECT_EQ(fingerprint.readings[1].rssi_dbm, -71.5F);
  EXPECT_EQ(std::get<AccessPointRecord>(*decode_record(encode(records[6]))).bssid, "00:1a:2b:3c:4d:5e");
  EXPECT_NEAR(*std::get<ClosureRecord>(*decode_record(encode(records[8]))).doubt, 0.01, 1e-9);
  const auto place = std::get<DescriptorRecord>(records[9]);
  EXPECT_EQ(std::get<DescriptorRecord>(*decode_record(encode(records[9]))).bins, place.bins);
  const auto printer = decode_record(encode(AccessPointRecord{1, "printer", 0}));
  EXPECT_EQ(std::get<AccessPointRecord>(*printer).bssid, "printer");
}

TEST(RecordCodec, FingerprintsOfAnyNumbersAreReadAsWritten) {
  const auto as_read = [](const std::vector<std::uint32_t>& numbers) {
    FingerprintRecord written{somewhere(), {}};
    for (const std::uint32_t number : numbers)
      written.readings.push_back({number, -40 - 0.5F * static_cast<float>(number % 60)});
    const auto read = std::get<FingerprintRecord>(*decode_record(encode(written)));
    for (std::size_t k = 0; k < numbers.size(); ++k)
      EXPECT_EQ(read.readings[k].rssi_dbm, written.readings[k].rssi_dbm);
    std::vector<std::uint32_t> result;
    for (const auto& reading : read.readings) result.push_back(reading.number);
    return result;
  };
  std::vector<std::uint32_t> dense, most;
  for (std::uint32_t k = 0; k < 24; ++k) dense.push_back(3 * k + k % 2);
  for (std::uint32_t k = 0; k < 255; ++k) most.push_back(2 * k);
  for (const auto& numbers :
       {std::vector<std::uint32_t>{}, {0}, {7, 8}, {5, 3}, {4, 4}, {1, 4000000000U}, dense, most})
    EXPECT_EQ(as_read(numbers), numbers);
  FingerprintRecord fingerprint{{}, {}}, empty{{}, {}};
  for (const std::uint32_t number : dense) fingerprint.readings.push_back({number, -50});
  EXPECT_EQ(encode(fingerprint).size() - encode(empty).size(), 24U + 9U)
      << "a byte each, and a bit for each of 71";
}

TEST(RecordCodec, PosesAndCovariancesLoseLittle) {
  const KeyframeRecord written = std::get<KeyframeRecord>(one_of_each()[2]);
  const auto read = std::get<KeyframeRecord>(*decode_record(encode(written)));
  EXPECT_LT((read.T_before_this.inverse() * written.T_before_this).log().norm(), 1e-6);
  EXPECT_LT((*read.covariance - *written.covariance).norm(), 1e-5 * written.covariance->norm());
}

/// In coordinates of a national grid, 32 bits would lose a decimetre.
TEST(RecordCodec, StartsFarFromTheOriginAreExact) {
  const SE3 there(Eigen::Vector3d(691234.567, 5334567.891, 512.3), Eigen::Quaterniond::Identity());
  FactsRecord facts = std::get<FactsRecord>(one_of_each()[0]);
  facts.initial_pose = there;
  EXPECT_EQ(std::get<FactsRecord>(*decode_record(encode(facts))).initial_pose->translation(),
            there.translation());
  const KeyframeRecord first{0, {}, there, std::nullopt};
  EXPECT_EQ(std::get<KeyframeRecord>(*decode_record(encode(first))).T_before_this.translation(),
            there.translation());
}

/// A walk of a metre in the plane, with its covariance, and a range beside it.
TEST(RecordCodec, TakesFewBytes) {
  const KeyframeRecord keyframe{100, somewhere().stamp, lift(SE2({1, 0.1}, 0.2)),
                                isotropic_covariance(0.1, 0.1)};
  EXPECT_LE(encode(keyframe).size(), 64U);
  const RangeRecord range{somewhere(), "", {0, 0, 0}, {false, "b", "", {0, 0, 0}}, false, 12.5, 0.1};
  EXPECT_LE(encode(range).size(), 56U);
}

/// Cut anywhere, or with any byte changed: another record, or none; never anything invalid.
TEST(RecordCodec, RefusesWhatIsDamaged) {
  Rng rng(1);
  for (const Record& record : one_of_each()) {
    const std::string bytes = encode(record);
    for (std::size_t k = 0; k < bytes.size(); ++k) EXPECT_FALSE(decode_record(bytes.substr(0, k)));
    EXPECT_FALSE(decode_record(bytes + '\0'));
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      std::string changed = bytes;
      changed[k] = static_cast<char>(rng.below(256));
      if (const auto read = decode_record(changed)) {
        EXPECT_TRUE(is_valid(*read));
      }
    }
  }
  EXPECT_FALSE(decode_record(""));
  EXPECT_FALSE(decode_record(std::string(kMaxRecordBytes + 1, '\1')));
}

TEST(RecordCodec, RefusesACovarianceThatIsNotDefinite) {
  ClosureRecord closure = std::get<ClosureRecord>(one_of_each()[8]);
  closure.covariance(0, 1) = closure.covariance(1, 0) = 2 * closure.covariance(0, 0);
  EXPECT_FALSE(decode_record(encode(closure)));
}

}  // namespace
}  // namespace radioslam
