#include "radioslam/io/csi/esp32_csi.hpp"

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/esp32_training.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

/// A packet and its training fields.
struct Esp32Measurement {
  Esp32Packet packet;
  std::vector<TrainingField> fields;
};

CsiPacket packet_of(const Esp32Packet& said, const std::vector<std::size_t>& places) {
  CsiPacket packet;
  packet.clock_us = said.clock_us;
  packet.stamp = said.host_stamp.value_or(Stamp{std::int64_t{said.clock_us} * kNanosecondsPerMicrosecond});
  packet.sender = said.sender;
  packet.counter = said.counter;
  packet.rssi[0] = said.rssi_dbm;
  packet.noise_dbm = said.noise_dbm;
  packet.antennas = packet.streams = 1;
  packet.channel.resize(1, static_cast<Eigen::Index>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k)
    packet.channel(0, static_cast<Eigen::Index>(k)) = {static_cast<float>(said.values[2 * places[k] + 1]),
                                                       static_cast<float>(said.values[2 * places[k]])};
  return packet;
}

class Esp32Reader {
 public:
  Esp32Reader(const std::string& name, std::string_view bytes) : text_{name, std::string(bytes)} {}

  CsiCapture read() {
    if (text_.content.empty()) text_.fail(0, "the file is empty");
    for (TextLines lines(text_); lines.next();) read_line(lines);
    if (measurements_.empty()) {
      torn_.throw_first();
      text_.fail(0, "contains no line with CSI_DATA");
    }
    CsiCapture capture = capture_of_most_measured();
    add_warnings(capture);
    return capture;
  }

 private:
  void read_line(const TextLines& at) {
    if (columns_.take_header(at.line()) || trim(at.line()).empty()) return;
    if (esp32_data_begin(at.line()) == std::string_view::npos) {
      ++others_;
      return;
    }
    try {
      Esp32Packet packet = read_esp32_line(at, columns_);
      std::vector<TrainingField> fields = training_fields(at, packet);
      measurements_.push_back({std::move(packet), std::move(fields)});
    } catch (const InputError& error) {
      torn_.add(error);
    }
  }

  CsiCapture capture_of_most_measured() const {
    MeasuredShapes<CapturedBand> bands;
    for (const Esp32Measurement& measurement : measurements_)
      for (const TrainingField& field : measurement.fields) bands.add(field.band, field.places.size());
    const CapturedBand& kept = bands.most_frequent();
    CsiCapture capture = capture_of(kept);
    for (const Esp32Measurement& measurement : measurements_)
      for (const TrainingField& field : measurement.fields)
        if (field.band == kept) {
          capture.packets.push_back(packet_of(measurement.packet, field.places));
          break;
        }
    return capture;
  }

  void add_warnings(CsiCapture& capture) const {
    const auto warn = [&](std::size_t count, const std::string& what) {
      if (count > 0) capture.warnings.push_back(text_.name + ": " + std::to_string(count) + what);
    };
    warn(others_, " lines without CSI are skipped");
    if (torn_.count() > 0) capture.warnings.push_back(torn_.warning(text_.name, "line"));
    warn(measurements_.size() - capture.packets.size(),
         " packets on another channel or without the most frequent training field are left out");
  }

  Text text_;
  Esp32Columns columns_;
  std::vector<Esp32Measurement> measurements_;
  std::size_t others_ = 0;
  SkippedRecords torn_;
};

}  // namespace

bool is_esp32_csi(std::string_view bytes) { return esp32_data_begin(bytes) != std::string_view::npos; }

CsiCapture read_esp32_csi(const std::string& name, std::string_view bytes) {
  return Esp32Reader(name, bytes).read();
}

}  // namespace radioslam
