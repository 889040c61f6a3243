// A small valid phone log, which tests damage.
#pragma once

#include <string>
#include <vector>

namespace radioslam {

/// The lines of a log, without line ends; line 1 is the start time.
inline std::vector<std::string> phone_log_lines() {
  return {"#\tstartTime:1574242584992",
          "#\tBrand:OPPO\tModel:PBCM10",
          "1574242584999\tTYPE_WAYPOINT\t204.25\t287.5",
          "1574242585000\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.75\t2",
          "1574242585000\tTYPE_MAGNETIC_FIELD\t-26.5\t3.75\t-42.25\t3",
          "1574242585000\tTYPE_GYROSCOPE\t0.25\t0.375\t0.125\t3",
          "1574242585000\tTYPE_ROTATION_VECTOR\t0.0\t0.0\t-0.6\t3",
          "1574242585020\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5\t2",
          "1574242585020\tTYPE_GYROSCOPE\t0.25\t0.375\t0.25\t3",
          "1574242586000\tTYPE_WIFI\tcafe\t0E:74:9C:A7:B2:E4\t-43\t5805\t1574242585900",
          "1574242586000\tTYPE_WIFI\tnet\twork\t0a:74:9c:a7:b2:e4\t-60\t2412\t1574242585000",
          "1574242586000\tTYPE_WIFI\t\t02:00:00:00:00:01\t-70\t2437\t1574242580000",
          "1574242586500\tTYPE_WAYPOINT\t205.5\t288",
          "#\tendTime:1574242588259"};
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

}  // namespace radioslam
