#include "radioslam/radio/captures/csi_captures.hpp"

#include <algorithm>

namespace radioslam {

CsiCapture merge_captures(const CsiRecording& csi, const std::string& robot,
                          std::vector<std::string>& notes) {
  CsiCapture all;
  std::size_t others = 0;
  for (const CsiCapture& capture : csi.captures) {
    for (const auto& warning : capture.warnings) notes.push_back(warning);
    if (all.packets.empty()) {
      all = capture;
      continue;
    }
    if (capture.subcarrier_hz != all.subcarrier_hz)
      ++others;
    else
      all.packets.insert(all.packets.end(), capture.packets.begin(), capture.packets.end());
  }
  if (others > 0)
    notes.push_back(std::to_string(others) + " captures of robot " + robot +
                    " were skipped: their subcarriers differ from those of the first capture");
  std::stable_sort(all.packets.begin(), all.packets.end(),
                   [](const CsiPacket& a, const CsiPacket& b) { return a.stamp < b.stamp; });
  return all;
}

CsiCapture captured_during(const CsiCapture& capture, Stamp begin, Stamp end) {
  CsiCapture part;
  part.subcarrier_hz = capture.subcarrier_hz;
  part.carrier_hz = capture.carrier_hz;
  const auto first = std::lower_bound(capture.packets.begin(), capture.packets.end(), begin,
                                      [](const CsiPacket& packet, Stamp s) { return packet.stamp < s; });
  const auto last = std::upper_bound(first, capture.packets.end(), end,
                                     [](Stamp s, const CsiPacket& packet) { return s < packet.stamp; });
  part.packets.assign(first, last);
  return part;
}

double carrier_hz_of(const CsiRecording& csi, const CsiCapture& capture) {
  return csi.carrier_hz > 0 ? csi.carrier_hz : capture.carrier_hz.value_or(0);
}

}  // namespace radioslam
