#include "radioslam/sim/sensors/csi_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "phases.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kCarrier_hz = 5.54e9;
constexpr std::size_t kAtTheCarrier = 1;

/// Cards that add nothing to the channel.
CsiCardParams ideal() {
  CsiCardParams cards;
  cards.carrier_offset_hz = cards.carrier_walk_hz_per_sqrt_s = cards.clock_rate_ppm = 0;
  cards.random_phase = cards.quantised = false;
  cards.detection_delay_ns = cards.loss_ratio = cards.late_stamp_ratio = 0;
  cards.snr_db = 100;
  cards.snr_distance_m = 1000;
  return cards;
}

/// An asker that drives along x and a static answerer, in the open.
struct Pair {
  CsiCardParams cards = ideal();
  std::vector<Eigen::Vector3d> asker_antennas{{0, 0, 0}};
  double heading_rad = 0, distance_m = 5;
  int packets = 400;

  CsiRadio asker() const {
    return {MacAddress{0xa}, asker_antennas,
            [heading = heading_rad](double t_s) {
              return SE3({0.3 * t_s, 0, 0}, so3_exp({0, 0, heading}));
            },
            CsiCard(cards, 10, Rng(1))};
  }
  CsiRadio answerer() const {
    return {MacAddress{0xb},
            {{0, 0, 0}},
            [y = distance_m](double /*t_s*/) {
              return SE3({0, y, 0}, Eigen::Quaterniond::Identity());
            },
            CsiCard(cards, 10, Rng(2))};
  }
  CsiMedium air() const { return {room_paths({}, {}), {kCarrier_hz, {-5e6, 0, 5e6}, 20e6}, cards}; }
  ReceivedPackets exchange(std::uint64_t seed = 3) const {
    std::vector<SentPacket> asked;
    for (int k = 0; k < packets; ++k) asked.push_back({0.1 + k / 120.0, static_cast<std::uint32_t>(k)});
    return exchange_packets(asker(), answerer(), asked, air(), Rng(seed));
  }
};

std::complex<double> centre(const ReceivedPacket& heard, Eigen::Index row = 0) {
  return std::complex<double>(heard.packet.channel(row, kAtTheCarrier));
}

/// Distance of the two bodies' origins.
double distance_m(const Pair& pair, double t_s) {
  return (pair.asker().T_common_body(t_s).translation() - pair.answerer().T_common_body(t_s).translation())
      .norm();
}

TEST(CsiExchange, TheProductsPhaseIsTwiceThePathsAfterTheCarriersPart) {
  Pair pair;
  pair.cards.carrier_offset_hz = 8000;
  pair.cards.random_phase = true;
  const auto heard = pair.exchange();
  ASSERT_EQ(heard.by_asker.size(), 400U);
  ASSERT_EQ(heard.by_answerer.size(), 400U);
  const double f_hz = pair.answerer().card.carrier_offset_hz(1) - pair.asker().card.carrier_offset_hz(1);
  EXPECT_GT(std::abs(f_hz), 1000) << "or the test shows nothing";
  double worst_without = 0;
  for (std::size_t k = 0; k < 400; ++k) {
    const auto& answer = heard.by_asker[k];
    const auto& question = heard.by_answerer[k];
    EXPECT_EQ(answer.packet.counter, question.packet.counter);
    EXPECT_EQ(answer.packet.sender, MacAddress{0xb});
    EXPECT_EQ(question.packet.sender, MacAddress{0xa});
    const double gap_s = answer.t_s - question.t_s;
    const double way_m = distance_m(pair, answer.t_s) + distance_m(pair, question.t_s);
    const double phase = std::arg(centre(answer) * centre(question));
    const double paths = phase + 2 * kPi * way_m * kCarrier_hz / 299792458.0;
    EXPECT_NEAR(wrapped(paths - 2 * kPi * f_hz * gap_s), 0, 1e-4) << k;
    worst_without = std::max(worst_without, std::abs(wrapped(paths)));
  }
  EXPECT_GT(worst_without, 1) << "the carriers' offset is present";
}

TEST(CsiExchange, TheProductCancelsOscillatorsOfOneFrequency) {
  Pair pair;
  pair.cards.random_phase = true;
  const auto heard = pair.exchange();
  std::complex<double> alone = 0, product = 0;
  for (std::size_t k = 0; k < 400; ++k) {
    const double way_m = distance_m(pair, heard.by_asker[k].t_s) + distance_m(pair, heard.by_answerer[k].t_s);
    const auto turned = [&](std::complex<double> value, double path_m) {
      return value / std::abs(value) * std::polar(1.0, 2 * kPi * path_m * kCarrier_hz / 299792458.0);
    };
    alone += turned(centre(heard.by_asker[k]), distance_m(pair, heard.by_asker[k].t_s));
    product += turned(centre(heard.by_asker[k]) * centre(heard.by_answerer[k]), way_m);
  }
  EXPECT_LT(std::abs(alone) / 400, 0.15) << "one end's phases are random";
  EXPECT_NEAR(std::abs(product) / 400, 1, 1e-6);
  EXPECT_NEAR(std::arg(product), 0, 1e-4);
}

TEST(CsiExchange, AntennasTurnWithTheBody) {
  Pair pair;
  pair.asker_antennas = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.2, 1}};
  pair.heading_rad = kPi / 2;  // body x points at the answerer, body y backwards along the path
  const auto heard = pair.exchange();
  const auto& answer = heard.by_asker[60];
  ASSERT_EQ(answer.packet.antennas, 3);
  ASSERT_EQ(answer.packet.channel.rows(), 3);
  EXPECT_EQ(heard.by_answerer[60].packet.antennas, 1);
  const double x = 0.3 * answer.t_s;
  const double lengths_m[] = {std::hypot(x, 5), std::hypot(x, 4.5), std::hypot(x - 0.2, 5, 1)};
  for (Eigen::Index a = 1; a < 3; ++a) {
    const double longer_m = lengths_m[a] - lengths_m[0];
    const auto ratio = centre(answer, a) / centre(answer, 0);
    EXPECT_NEAR(wrapped(std::arg(ratio) + 2 * kPi * longer_m * kCarrier_hz / 299792458.0), 0, 1e-4);
    EXPECT_NEAR(std::abs(ratio), lengths_m[0] / lengths_m[a], 1e-4);
  }
}

TEST(CsiExchange, LateDetectionSlopesThePhaseOverTheSubcarriersOnly) {
  Pair pair;
  pair.cards.detection_delay_ns = 80;
  double min_s = 1, max_s = 0;
  for (const ReceivedPacket& answer : pair.exchange().by_asker) {
    const auto& h = answer.packet.channel;
    const double slope =
        wrapped(std::arg(std::complex<double>(h(0, 2)) * std::conj(std::complex<double>(h(0, 1)))));
    const double late_s = -slope / (2 * kPi * 5e6) - distance_m(pair, answer.t_s) / 299792458.0;
    min_s = std::min(min_s, late_s);
    max_s = std::max(max_s, late_s);
    EXPECT_NEAR(wrapped(std::arg(centre(answer)) +
                        2 * kPi * distance_m(pair, answer.t_s) * kCarrier_hz / 299792458.0),
                0, 1e-4);
  }
  EXPECT_GT(min_s, -1e-12);
  EXPECT_LT(min_s, 4e-9);
  EXPECT_GT(max_s, 76e-9);
  EXPECT_LT(max_s, 80e-9 + 1e-12);
}

TEST(CsiExchange, AnswersWaitAsLongAsAsked) {
  Pair pair;
  pair.packets = 900;
  const auto heard = pair.exchange();
  double sum_us = 0;
  int late = 0;
  for (std::size_t k = 0; k < heard.by_asker.size(); ++k) {
    const double wait_us = (heard.by_asker[k].t_s - heard.by_answerer[k].t_s) * 1e6;
    EXPECT_GE(wait_us, 300 - 1e-6);
    sum_us += wait_us;
    if (wait_us > 450) ++late;
  }
  EXPECT_NEAR(sum_us / 900, 300 + 20 + 0.05 * 200, 8);
  EXPECT_NEAR(late / 900.0, 0.05 * std::exp(-130.0 / 200), 0.02);
}

TEST(CsiExchange, LosesTheRatioOfPacketsInEachDirection) {
  Pair pair;
  pair.cards.loss_ratio = 0.3;
  pair.packets = 1100;
  const auto heard = pair.exchange();
  std::map<std::uint32_t, int> halves;
  for (const auto* side : {&heard.by_asker, &heard.by_answerer})
    for (const ReceivedPacket& packet : *side) ++halves[*packet.packet.counter];
  const auto both = std::count_if(halves.begin(), halves.end(), [](const auto& h) { return h.second == 2; });
  const double sigma = std::sqrt(0.7 * 0.3 / 1100);
  EXPECT_NEAR(static_cast<double>(heard.by_asker.size()) / 1100, 0.7, 4 * sigma);
  EXPECT_NEAR(static_cast<double>(heard.by_answerer.size()) / 1100, 0.7, 4 * sigma);
  EXPECT_NEAR(static_cast<double>(both) / 1100, 0.49, 4 * sigma);
}

/// Mean over packets of the power that follows the channel over that of the rest.
double measured_snr_db(const Pair& pair) {
  double signal = 0, noise = 0;
  for (const ReceivedPacket& heard : pair.exchange().by_answerer) {
    const auto paths = pair.air().paths({0.3 * heard.t_s, 0, 0}, {0, pair.distance_m, 0});
    const Eigen::RowVectorXcd h = channel_of(paths, pair.air().band);
    const Eigen::RowVectorXcd c = heard.packet.channel.row(0).cast<std::complex<double>>();
    const std::complex<double> gain = (h.conjugate().cwiseProduct(c)).sum() / h.squaredNorm();
    const double scale = std::norm(gain);
    signal += 1;
    noise += (c / gain - h).squaredNorm() / h.squaredNorm() * 3 / 2;  // two of three dimensions are left
    EXPECT_GT(scale, 0);
  }
  return 10 * std::log10(signal / noise);
}

TEST(CsiExchange, HasTheSignalToNoiseThatWasAsked) {
  Pair pair;
  pair.cards.snr_db = 20;
  pair.cards.snr_distance_m = 5.1;  // about their distance
  EXPECT_NEAR(measured_snr_db(pair), 20, 0.4);
  pair.cards.quantised = true;
  EXPECT_NEAR(measured_snr_db(pair), 20, 0.4) << "eight bits are enough";
  pair.distance_m = 16.1;
  EXPECT_NEAR(measured_snr_db(pair), 10, 0.5);
}

TEST(CsiExchange, WritesEightBitNumbersWhateverTheDistance) {
  for (const double distance_m : {0.5, 40.0}) {
    Pair pair;
    pair.cards.quantised = true;
    pair.distance_m = distance_m;
    for (const ReceivedPacket& heard : pair.exchange().by_asker) {
      double largest = 0;
      for (const std::complex<float>& value : heard.packet.channel.reshaped())
        for (const float part : {value.real(), value.imag()}) {
          EXPECT_EQ(part, std::round(part));
          largest = std::max(largest, static_cast<double>(std::abs(part)));
        }
      EXPECT_EQ(largest, 120);
      const double strength_dbm = heard.packet.rssi[0] - 44 - heard.packet.gain_control_db;
      EXPECT_NEAR(strength_dbm, -32 - 20 * std::log10(distance_m), distance_m < 1 ? 12 : 1.1);
    }
  }
}

TEST(CsiCard, CountsMicrosecondsAtItsOwnRate) {
  CsiCardParams params = ideal();
  params.clock_rate_ppm = 1000;
  const CsiCard card(params, 10, Rng(5));
  const double counted = static_cast<std::uint32_t>(card.clock_us(9) - card.clock_us(1));
  const double counted_less = static_cast<std::uint32_t>(card.clock_us(5) - card.clock_us(1));
  EXPECT_NEAR(counted, 2 * counted_less, 2);
  EXPECT_GT(std::abs(counted - 8e6), 100);
  EXPECT_LT(std::abs(counted - 8e6), 4 * 8e3);
}

TEST(CsiCard, ItsCarrierIsARandomWalk) {
  CsiCardParams params = ideal();
  params.carrier_walk_hz_per_sqrt_s = 50;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const CsiCard card(params, 4, Rng(seed));
    squares += std::pow(card.carrier_offset_hz(4), 2);
    const double slope = (card.carrier_turns(2.0001) - card.carrier_turns(1.9999)) / 2e-4;
    EXPECT_NEAR(slope, card.carrier_offset_hz(2), 0.1);
  }
  EXPECT_NEAR(squares / 300 / (50 * 50 * 4), 1, 4 * std::sqrt(2.0 / 300));
}

TEST(WriteDown, StampsInOrderMostOnTimeSomeLate) {
  Pair pair;
  pair.cards.late_stamp_ratio = 0.2;
  pair.cards.stamp_offset_s = 2;
  const auto heard = pair.exchange().by_asker;
  const CsiCapture capture = record_as_sent(heard, pair.air(), Rng(4));
  ASSERT_EQ(capture.packets.size(), heard.size());
  EXPECT_EQ(capture.subcarrier_hz, pair.air().band.subcarrier_hz);
  int late = 0;
  for (std::size_t k = 0; k < heard.size(); ++k) {
    EXPECT_EQ(capture.packets[k].stamp.ns % 1000, 0);
    EXPECT_TRUE(k == 0 || capture.packets[k - 1].stamp < capture.packets[k].stamp);
    const double late_s = capture.packets[k].stamp.seconds() - 2 - heard[k].t_s;
    EXPECT_GT(late_s, -1e-6);
    if (late_s > 1e-6) ++late;
  }
  EXPECT_NEAR(late / 400.0, 0.2, 4 * std::sqrt(0.2 * 0.8 / 400));
}

TEST(CsiExchange, SameSeedSamePackets) {
  Pair pair;
  pair.cards = CsiCardParams{};
  const auto one = pair.exchange(3).by_asker, same = pair.exchange(3).by_asker,
             other = pair.exchange(4).by_asker;
  ASSERT_EQ(one.size(), same.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].t_s, same[k].t_s);
    EXPECT_EQ(one[k].packet.channel, same[k].packet.channel);
  }
  EXPECT_NE(one[0].packet.channel, other[0].packet.channel);
}

}  // namespace
}  // namespace radioslam
