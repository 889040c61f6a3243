#include "radioslam/io/ros/radioslam_messages.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "radioslam/io/ros/ros_output.hpp"
#include "radioslam/io/text/mac_address.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPathBytes = 32, kReadingBytes = 12, kMostAntennas = 64;

std::optional<MacAddress> recorded_address(const std::string& text) {
  return text.empty() ? std::nullopt : parse_mac_address(text);
}

std::string address_text(const std::optional<MacAddress>& address) {
  return address ? format_mac_address(*address) : std::string();
}

/// Rows by stream, then antenna, as a packet has them.
void read_csi_channel(RosMessageReader& in, std::size_t subcarriers, CsiPacket& packet) {
  const std::size_t antennas = in.u32(), streams = in.u32(), numbers = in.count(sizeof(float));
  if (antennas > kMostAntennas || streams > kMostAntennas || antennas * streams * subcarriers * 2 != numbers)
    in.fail("its channel has " + std::to_string(numbers) +
            " numbers, not two for each antenna, stream and subcarrier");
  packet.antennas = static_cast<int>(antennas);
  packet.streams = static_cast<int>(streams);
  packet.channel.resize(static_cast<Eigen::Index>(antennas * streams),
                        static_cast<Eigen::Index>(subcarriers));
  for (Eigen::Index row = 0; row < packet.channel.rows(); ++row)
    for (Eigen::Index column = 0; column < packet.channel.cols(); ++column) {
      const float real = in.f32();
      packet.channel(row, column) = {real, in.f32()};
    }
}

}  // namespace

RosRangeMeasurement read_range_measurement(const RosMessage& message) {
  RosMessageReader in(message);
  RosRangeMeasurement range;
  range.header = in.header();
  range.antenna = in.text();
  range.other = in.text();
  range.other_antenna = in.text();
  range.range_m = in.f64();
  range.sigma_m = in.f64();
  return range;
}

RosAngleMeasurement read_angle_measurement(const RosMessage& message) {
  RosMessageReader in(message);
  RosAngleMeasurement angles;
  angles.header = in.header();
  angles.transmitter = in.text();
  angles.transmitter_antenna = in.text();
  for (std::size_t left = in.count(kPathBytes); left > 0; --left) {
    AoaPath& path = angles.paths.emplace_back();
    path.azimuth_rad = in.f64();
    if (const double elevation_rad = in.f64(); !std::isnan(elevation_rad)) path.elevation_rad = elevation_rad;
    path.sigma_rad = in.f64();
    path.power_db = in.f64();
  }
  return angles;
}

RosWifiScan read_wifi_scan(const RosMessage& message) {
  RosMessageReader in(message);
  RosWifiScan scan;
  scan.header = in.header();
  for (std::size_t left = in.count(kReadingBytes); left > 0; --left) {
    RosWifiReading& reading = scan.readings.emplace_back();
    reading.bssid = in.text();
    reading.frequency_mhz = in.f32();
    reading.rssi_dbm = in.f32();
  }
  return scan;
}

RosCsiPacket read_csi_packet(const RosMessage& message) {
  RosMessageReader in(message);
  RosCsiPacket csi;
  csi.header = in.header();
  CsiPacket& packet = csi.packet;
  packet.stamp = csi.header.stamp;
  packet.clock_us = in.u32();
  packet.sender = recorded_address(in.text());
  packet.receiver = recorded_address(in.text());
  const bool has_counter = in.boolean();
  if (const std::uint32_t counter = in.u32(); has_counter) packet.counter = counter;
  for (int& rssi : packet.rssi) rssi = in.i32();
  packet.noise_dbm = in.i32();
  packet.gain_control_db = in.i32();
  csi.carrier_hz = in.f64();
  csi.bandwidth_hz = in.f64();
  csi.subcarrier_hz.resize(in.count(sizeof(double)));
  for (double& offset : csi.subcarrier_hz) offset = in.f64();
  read_csi_channel(in, csi.subcarrier_hz.size(), packet);
  return csi;
}

std::string encode_cdr(const RosRangeMeasurement& message) {
  CdrWriter out;
  write_header(out, message.header);
  out.text(message.antenna).text(message.other).text(message.other_antenna);
  return out.f64(message.range_m).f64(message.sigma_m).take();
}

std::string encode_cdr(const RosAngleMeasurement& message) {
  CdrWriter out;
  write_header(out, message.header);
  out.text(message.transmitter).text(message.transmitter_antenna).count(message.paths.size());
  for (const AoaPath& path : message.paths)
    out.f64(path.azimuth_rad)
        .f64(path.elevation_rad.value_or(std::numeric_limits<double>::quiet_NaN()))
        .f64(path.sigma_rad)
        .f64(path.power_db);
  return out.take();
}

std::string encode_cdr(const RosWifiScan& message) {
  CdrWriter out;
  write_header(out, message.header);
  out.count(message.readings.size());
  for (const RosWifiReading& reading : message.readings)
    out.text(reading.bssid).f32(reading.frequency_mhz).f32(reading.rssi_dbm);
  return out.take();
}

std::string encode_cdr(const RosCsiPacket& message) {
  const CsiPacket& packet = message.packet;
  CdrWriter out;
  write_header(out, message.header);
  out.u32(packet.clock_us).text(address_text(packet.sender)).text(address_text(packet.receiver));
  out.u8(packet.counter ? 1 : 0).u32(packet.counter.value_or(0));
  for (const int rssi : packet.rssi) out.i32(rssi);
  out.i32(packet.noise_dbm).i32(packet.gain_control_db).f64(message.carrier_hz).f64(message.bandwidth_hz);
  out.count(message.subcarrier_hz.size());
  for (const double offset : message.subcarrier_hz) out.f64(offset);
  out.u32(static_cast<std::uint32_t>(packet.antennas)).u32(static_cast<std::uint32_t>(packet.streams));
  out.count(static_cast<std::size_t>(packet.channel.size()) * 2);
  for (Eigen::Index row = 0; row < packet.channel.rows(); ++row)
    for (Eigen::Index column = 0; column < packet.channel.cols(); ++column)
      out.f32(packet.channel(row, column).real()).f32(packet.channel(row, column).imag());
  return out.take();
}

}  // namespace radioslam
