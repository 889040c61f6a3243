#include "radioslam/io/mission/robot_tables.hpp"

#include <algorithm>

#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {

std::vector<ImuSample> read_imu(const Text& text) {
  enum : std::size_t { kTime, kAx, kAy, kAz, kWx, kWy, kWz };
  CsvReader csv(text, {{"t_s", "ax_mps2", "ay_mps2", "az_mps2", "wx_radps", "wy_radps", "wz_radps"}});
  std::vector<ImuSample> samples;
  while (csv.next()) {
    const Stamp stamp = csv.stamp(kTime);
    if (!samples.empty() && stamp <= samples.back().stamp)
      csv.fail("the time does not increase", InputError::Kind::kClock);
    samples.push_back({stamp,
                       {csv.number(kAx), csv.number(kAy), csv.number(kAz)},
                       {csv.number(kWx), csv.number(kWy), csv.number(kWz)}});
  }
  return samples;
}

std::string format_imu(const std::vector<ImuSample>& samples) {
  std::string out = "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n";
  for (const ImuSample& sample : samples) {
    out += format_stamp(sample.stamp);
    for (const double force : sample.specific_force_mps2) append_number(out += ',', force);
    for (const double rate : sample.angular_rate_radps) append_number(out += ',', rate);
    out += '\n';
  }
  return out;
}

std::vector<PositionFix> read_fixes(const Text& text) {
  enum : std::size_t { kTime, kX, kY, kZ, kSigma };
  CsvReader csv(text, {{"t_s", "x_m", "y_m", "z_m", "sigma_m"}});
  std::vector<PositionFix> fixes;
  while (csv.next()) {
    fixes.push_back(
        {csv.stamp(kTime), {csv.coordinate(kX), csv.coordinate(kY), csv.coordinate(kZ)}, csv.sigma(kSigma)});
    if (fixes.back().sigma_m <= 0) csv.fail("a sigma is zero");
  }
  std::stable_sort(fixes.begin(), fixes.end(),
                   [](const PositionFix& a, const PositionFix& b) { return a.stamp < b.stamp; });
  return fixes;
}

std::string format_fixes(const std::vector<PositionFix>& fixes) {
  std::string out = "t_s,x_m,y_m,z_m,sigma_m\n";
  for (const PositionFix& fix : fixes) {
    out += format_stamp(fix.stamp);
    for (int axis = 0; axis < 3; ++axis) append_number(out += ',', fix.position_m(axis));
    append_number(out += ',', fix.sigma_m);
    out += '\n';
  }
  return out;
}

}  // namespace radioslam
