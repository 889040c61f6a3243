// Words of findings: numbers and file names.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace radioslam {

/// Three significant digits, without an exponent below a million.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  if (std::string(text).find('e') != std::string::npos && value > -1e15 && value < 1e15 &&
      (value > 1 || value < -1))
    std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

/// A time in seconds, to a tenth: `number` would round Unix times to a thousand days.
inline std::string time_text(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", t_s);
  return text;
}

/// Units that files are written in by mistake, in metres and in seconds.
struct Unit {
  const char* name;
  double si;
};
inline constexpr std::array<Unit, 4> kLengthUnits = {
    {{"millimetres", 1e-3}, {"centimetres", 1e-2}, {"feet", 0.3048}, {"kilometres", 1e3}}};
inline constexpr std::array<Unit, 3> kTimeUnits = {
    {{"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};

inline constexpr const char* kRangesFile = "radio/ranges.csv";
inline constexpr const char* kAnglesFile = "radio/aoa.csv";

inline std::string robot_file(const std::string& robot, const char* name) {
  return "robots/" + robot + "/" + name;
}
inline std::string odometry_file(const std::string& robot) { return robot_file(robot, "odometry.tum"); }

}  // namespace radioslam
