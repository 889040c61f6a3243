#include "radioslam/sim/sensors/csi_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/direction.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

/// Received power of a path of amplitude 1: 15 dBm minus the 47 dB of the first metre at 5.5 GHz.
constexpr double kPowerAtOneMetre_dbm = -32;
/// The card's power scale: RSSI = dBm + 44 + gain, with a gain that brings it close to kNominalRssi.
constexpr double kRssiOffset_db = 44, kNominalRssi = 35;
constexpr int kMaxByte = 255, kMinNoise_dbm = -127;

double exponential(double mean, Rng& rng) { return -mean * std::log(1 - rng.uniform()); }

double answer_delay_s(const CsiCardParams& params, Rng rng) {
  double us = params.answer_delay_us + exponential(params.answer_jitter_us, rng);
  const bool is_late = rng.uniform() < params.late_answer_ratio;
  const double more_us = exponential(params.late_answer_us, rng);
  if (is_late) us += more_us;
  return us * kSecondsPerMicrosecond;
}

int byte_of(double value, int least) {
  return static_cast<int>(std::lround(std::clamp(value, double{0} + least, double{kMaxByte})));
}

/// Sets signal strengths and gain as reported by the card.
void state_power(const Eigen::MatrixXcd& channel, const CsiCardParams& params, CsiPacket& packet) {
  const Eigen::VectorXd power = channel.cwiseAbs2().rowwise().mean().array() + noise_power(params);
  const double strongest_dbm = kPowerAtOneMetre_dbm + decibels(power.maxCoeff());
  packet.gain_control_db = byte_of(kNominalRssi - kRssiOffset_db - strongest_dbm, 0);
  for (Eigen::Index a = 0; a < power.size(); ++a)
    packet.rssi[static_cast<std::size_t>(a)] =
        byte_of(kPowerAtOneMetre_dbm + decibels(power[a]) + kRssiOffset_db + packet.gain_control_db, 1);
  packet.noise_dbm = static_cast<int>(std::lround(
      std::clamp(kPowerAtOneMetre_dbm + decibels(noise_power(params)), double{kMinNoise_dbm}, double{0})));
}

/// One direction of an exchange: receiver, sender, time and oscillator phase.
struct Reception {
  const CsiRadio& receiver;
  const CsiRadio& sender;
  bool receiver_asks;
  double t_s;
  double oscillators_rad;
};

/// The channel from the sender's first antenna to all of the receiver's, with the phases of oscillators and
/// receive chains and the slope of a late detection.
Eigen::MatrixXcd arriving_channel(const Reception& reception, const CsiMedium& air, double detection_s) {
  const SE3 T_common_receiver = reception.receiver.T_common_body(reception.t_s);
  const Eigen::Vector3d sender_m =
      reception.sender.T_common_body(reception.t_s) * reception.sender.antennas_m.front();
  Eigen::RowVectorXcd slope(std::ssize(air.band.subcarrier_hz));
  for (Eigen::Index k = 0; k < slope.size(); ++k) {
    const double turns = air.band.subcarrier_hz[static_cast<std::size_t>(k)] * detection_s;
    slope[k] = std::polar(1.0, reception.oscillators_rad - 2 * std::numbers::pi * turns);
  }
  const auto antennas = std::ssize(reception.receiver.antennas_m);
  Eigen::MatrixXcd channel(antennas, slope.size());
  for (Eigen::Index a = 0; a < antennas; ++a) {
    const auto antenna = static_cast<std::size_t>(a);
    const Eigen::Vector3d receiver_m = T_common_receiver * reception.receiver.antennas_m[antenna];
    const auto paths =
        reception.receiver_asks ? air.paths(receiver_m, sender_m) : air.paths(sender_m, receiver_m);
    channel.row(a) =
        reception.receiver.card.chain_phase(antenna) * channel_of(paths, air.band).cwiseProduct(slope);
  }
  return channel;
}

std::optional<ReceivedPacket> receive(const Reception& reception, std::uint32_t counter, const CsiMedium& air,
                                      const Rng& rng) {
  if (rng.split("loss").uniform() < air.cards.loss_ratio) return std::nullopt;
  const double detection_s =
      rng.split("detection").uniform(0, air.cards.detection_delay_ns) * kSecondsPerNanosecond;
  const Eigen::MatrixXcd channel = arriving_channel(reception, air, detection_s);
  ReceivedPacket received{reception.t_s, {}};
  CsiPacket& packet = received.packet;
  packet.clock_us = reception.receiver.card.clock_us(reception.t_s);
  packet.sender = reception.sender.address;
  packet.counter = counter;
  packet.antennas = static_cast<int>(channel.rows());
  packet.streams = 1;
  packet.channel = measured_channel(channel, air.cards, rng.split("noise"));
  state_power(channel, air.cards, packet);
  return received;
}

}  // namespace

CsiBand CsiBand::intel5300(double carrier_hz) {
  return {carrier_hz, grouped_subcarriers_hz(ChannelWidth::k20MHz), 20e6};
}

Eigen::RowVectorXcd channel_of(const std::vector<RadioPath>& paths, const CsiBand& band) {
  Eigen::RowVectorXcd channel = Eigen::RowVectorXcd::Zero(std::ssize(band.subcarrier_hz));
  for (const RadioPath& path : paths) {
    const double delay_s = path.length_m / kLightSpeed_mps;
    for (Eigen::Index k = 0; k < channel.size(); ++k) {
      const double turns = (band.carrier_hz + band.subcarrier_hz[static_cast<std::size_t>(k)]) * delay_s;
      const double phase = -2 * std::numbers::pi * (turns - std::floor(turns));
      channel[k] += path.amplitude * std::complex<double>(std::cos(phase), std::sin(phase));
    }
  }
  return channel;
}

PathsBetween plane_wave_paths(std::vector<PlaneWave> waves) {
  return [waves = std::move(waves)](const Eigen::Vector3d& here_m, const Eigen::Vector3d& /*there_m*/) {
    std::vector<RadioPath> paths;
    for (const PlaneWave& wave : waves) {
      const Eigen::Vector3d from = unit_direction(wave.azimuth_rad, wave.elevation_rad);
      paths.push_back(
          {wave.delay_s * kLightSpeed_mps - from.dot(here_m), std::pow(10, wave.power_db / 20), 0, from});
    }
    return paths;
  };
}

PathsBetween room_paths(std::vector<WallSegment> walls, const ImageParams& params) {
  return [walls = std::move(walls), params](const Eigen::Vector3d& here_m, const Eigen::Vector3d& there_m) {
    return image_paths(there_m, here_m, walls, params);
  };
}

ReceivedPackets exchange_packets(const CsiRadio& asker, const CsiRadio& answerer,
                                 const std::vector<SentPacket>& asked, const CsiMedium& air, const Rng& rng) {
  const auto oscillators_rad = [&](double t_s) {
    const double turns = answerer.card.carrier_turns(t_s) - asker.card.carrier_turns(t_s);
    return 2 * std::numbers::pi * (turns - std::floor(turns));
  };
  ReceivedPackets received;
  for (const SentPacket& packet : asked) {
    const Rng own = rng.split(packet.counter);
    const double answered_s = packet.t_s + answer_delay_s(air.cards, own.split("delay"));
    const double fresh_rad = air.cards.random_phase ? own.split("phase").uniform(0, 2 * std::numbers::pi) : 0;
    const Reception question{answerer, asker, false, packet.t_s, -oscillators_rad(packet.t_s) - fresh_rad};
    const Reception answer{asker, answerer, true, answered_s, oscillators_rad(answered_s) + fresh_rad};
    if (auto record = receive(question, packet.counter, air, own.split("question")))
      received.by_answerer.push_back(std::move(*record));
    if (auto record = receive(answer, packet.counter, air, own.split("answer")))
      received.by_asker.push_back(std::move(*record));
  }
  return received;
}

CsiCapture record_as_sent(std::vector<ReceivedPacket> received, const CsiMedium& air, Rng rng) {
  std::stable_sort(received.begin(), received.end(),
                   [](const ReceivedPacket& a, const ReceivedPacket& b) { return a.t_s < b.t_s; });
  CsiCapture capture;
  capture.subcarrier_hz = air.band.subcarrier_hz;
  capture.carrier_hz = air.band.carrier_hz;
  capture.bandwidth_hz = air.band.bandwidth_hz;
  std::int64_t last_us = -1;
  for (ReceivedPacket& one : received) {
    double t_s = one.t_s + air.cards.stamp_offset_s;
    const bool is_late = rng.uniform() < air.cards.late_stamp_ratio;
    const double late_s = exponential(air.cards.late_stamp_ms, rng) * kSecondsPerMillisecond;
    if (is_late) t_s += late_s;
    last_us = std::max(last_us + 1, static_cast<std::int64_t>(std::llround(t_s / kSecondsPerMicrosecond)));
    one.packet.stamp = {last_us * kNanosecondsPerMicrosecond};
    capture.packets.push_back(std::move(one.packet));
  }
  return capture;
}

}  // namespace radioslam
