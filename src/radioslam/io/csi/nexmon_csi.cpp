#include "radioslam/io/csi/nexmon_csi.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/nexmon_record.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/pcap.hpp"

namespace radioslam {
namespace {

constexpr std::uint16_t kNexmonPort = 5500;
/// The records of one frame are about 0.1 ms apart; later ones belong to another frame.
constexpr double kMaxFrame_s = 5e-3;
constexpr unsigned kControlFrame = 1;

using CoreAndStream = std::pair<int, int>;
CoreAndStream place_of(const NexmonRecord& record) { return {record.core, record.stream}; }

/// The records of one frame.
struct NexmonFrame {
  Stamp stamp;
  std::vector<NexmonRecord> records;

  bool takes(const NexmonRecord& next, Stamp at) const {
    const NexmonRecord& first = records.front();
    return next.sender == first.sender && next.sequence_control == first.sequence_control &&
           next.chanspec == first.chanspec && next.chip == first.chip &&
           next.frame_control == first.frame_control &&
           next.rssi_dbm.has_value() == first.rssi_dbm.has_value() && at >= stamp &&
           seconds_between(stamp, at) < kMaxFrame_s &&
           std::none_of(records.begin(), records.end(),
                        [&](const NexmonRecord& record) { return place_of(record) == place_of(next); });
  }
};

/// The band, cores and streams of a packet.
struct NexmonShape {
  CapturedBand band;
  std::uint16_t chip = 0;
  std::set<int> cores, streams;
  friend auto operator<=>(const NexmonShape&, const NexmonShape&) = default;
};

/// The packet of a frame; nothing unless every core has a record of every stream.
std::optional<NexmonShape> shape_of(const NexmonFrame& frame) {
  NexmonShape shape{nexmon_band(frame.records.front()), frame.records.front().chip, {}, {}};
  for (const NexmonRecord& record : frame.records) {
    shape.cores.insert(record.core);
    shape.streams.insert(record.stream);
  }
  if (shape.cores.size() * shape.streams.size() != frame.records.size()) return std::nullopt;
  return shape;
}

std::optional<std::uint32_t> counter_of(const NexmonRecord& record) {
  if (record.frame_control && (*record.frame_control >> 2U & 3U) == kControlFrame) return std::nullopt;
  return record.sequence_control;
}

CsiPacket nexmon_packet(const NexmonFrame& frame, const NexmonShape& shape) {
  constexpr int kNoiseNotMeasured = -127;
  const NexmonRecord& first = frame.records.front();
  CsiPacket packet;
  packet.stamp = frame.stamp;
  packet.clock_us = static_cast<std::uint32_t>(frame.stamp.ns / kNanosecondsPerMicrosecond);
  packet.sender = first.sender;
  packet.counter = counter_of(first);
  packet.rssi[0] = first.rssi_dbm.value_or(0);
  packet.noise_dbm = kNoiseNotMeasured;
  packet.antennas = static_cast<int>(shape.cores.size());
  packet.streams = static_cast<int>(shape.streams.size());
  const auto columns = static_cast<Eigen::Index>(shape.band.subcarriers.size());
  packet.channel.resize(static_cast<Eigen::Index>(frame.records.size()), columns);
  for (const NexmonRecord& record : frame.records) {
    const auto antenna = std::distance(shape.cores.begin(), shape.cores.find(record.core));
    const auto stream = std::distance(shape.streams.begin(), shape.streams.find(record.stream));
    for (Eigen::Index k = 0; k < columns; ++k)
      packet.channel(stream * packet.antennas + antenna, k) =
          record.value(shape.band.subcarriers[static_cast<std::size_t>(k)]);
  }
  return packet;
}

class NexmonReader {
 public:
  NexmonReader(const std::string& name, std::string_view bytes) : name_(name), packets_(name, bytes) {}

  CsiCapture read() {
    while (const auto packet = packets_.next()) read_record(*packet);
    if (frames_.empty()) refuse();
    CsiCapture capture = capture_of_most_measured();
    add_warnings(capture);
    return capture;
  }

 private:
  void read_record(const PcapPacket& packet) {
    const auto payload = packets_.udp_payload(packet, kNexmonPort);
    if (!payload || !is_nexmon_record(*payload)) {
      ++others_;
      return;
    }
    try {
      add(read_nexmon_record(name_, packet.at, *payload), packet.stamp);
    } catch (const InputError& error) {
      unusable_.add(error);
    }
  }

  void add(const NexmonRecord& record, Stamp stamp) {
    if (frames_.empty() || !frames_.back().takes(record, stamp)) frames_.push_back({stamp, {}});
    frames_.back().records.push_back(record);
  }

  [[noreturn]] void refuse() const {
    unusable_.throw_first();
    throw InputError(name_, 0,
                     "at byte " + std::to_string(packets_.at()) +
                         (packets_.is_truncated() ? ": the first packet is truncated"
                                                  : ": the pcap file contains no packet of Nexmon CSI"));
  }

  CsiCapture capture_of_most_measured() {
    MeasuredShapes<NexmonShape> shapes;
    for (const NexmonFrame& frame : frames_)
      if (const auto shape = shape_of(frame))
        shapes.add(*shape, frame.records.size() * shape->band.subcarriers.size());
    if (shapes.empty())
      throw InputError(name_, 0, "no frame has a record of every stream from every core that received it");
    const NexmonShape& kept = shapes.most_frequent();
    CsiCapture capture = capture_of(kept.band);
    for (const NexmonFrame& frame : frames_)
      if (shape_of(frame) == kept) capture.packets.push_back(nexmon_packet(frame, kept));
    return capture;
  }

  void add_warnings(CsiCapture& capture) const {
    const auto warn = [&](const std::string& what) { capture.warnings.push_back(name_ + ": " + what); };
    if (others_ > 0) warn(std::to_string(others_) + " packets without CSI are skipped");
    if (unusable_.count() > 0) capture.warnings.push_back(unusable_.warning(name_, "record"));
    if (const std::size_t more = frames_.size() - capture.packets.size(); more > 0)
      warn(std::to_string(more) +
           " frames whose channel, cores or streams differ from most frames are left out");
    if (packets_.is_truncated())
      warn("at byte " + std::to_string(packets_.at()) + ": the last packet is truncated and left out");
  }

  const std::string& name_;
  PcapReader packets_;
  std::vector<NexmonFrame> frames_;
  std::size_t others_ = 0;
  SkippedRecords unusable_;
};

}  // namespace

CsiCapture read_nexmon_csi(const std::string& name, std::string_view bytes) {
  return NexmonReader(name, bytes).read();
}

}  // namespace radioslam
