// Synthetic lines of ESP32 captures.
#pragma once

#include <string>

namespace radioslam {

/// The two layouts that are recognised without a header.
enum class Esp32Layout { kTool, kEspressif };

/// The n-th complex value: all different, with both signs.
inline int esp32_real(int n) { return n % 120 - 50; }
inline int esp32_imaginary(int n) { return 40 - n % 100; }

struct Esp32Text {
  Esp32Layout layout = Esp32Layout::kTool;
  int mode = 1, bandwidth = 0, stbc = 0, channel = 6, secondary = 0;
  int stated = 256;  ///< number of values stated in the column `len`
  int values = 256;  ///< number of values in the list
  std::string clock_us = "80272146", host_time = "0,80.363225", id = "41", first_word = "1";

  std::string line() const {
    const bool is_tool = layout == Esp32Layout::kTool;
    const auto number = [](int value) { return "," + std::to_string(value); };
    std::string out = "CSI_DATA," + (is_tool ? std::string("AP") : id) + ",3C:71:BF:6D:2A:78,-73,11" +
                      number(mode) + ",0" + number(bandwidth) + ",1,1,0" + number(stbc) + ",0,0,-93,0" +
                      number(channel) + number(secondary) + "," + clock_us + ",0,101,0";
    out += is_tool ? "," + host_time + number(stated) + ",[" : number(stated) + "," + first_word + ",\"[";
    for (int n = 0; n < values; ++n) {
      if (n > 0 && !is_tool) out += ',';
      out += std::to_string(n % 2 == 0 ? esp32_imaginary(n / 2) : esp32_real(n / 2));
      if (is_tool) out += ' ';
    }
    return out + (is_tool ? "]\n" : "]\"\n");
  }
};

}  // namespace radioslam
