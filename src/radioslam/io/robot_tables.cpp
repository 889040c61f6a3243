#include "radioslam/io/robot_tables.hpp"

#include <algorithm>
#include <optional>

#include "radioslam/io/csv.hpp"
#include "radioslam/io/numbers.hpp"

namespace radioslam {

void check_inertial(const Text& text) {
  constexpr std::size_t kColumns = 7;
  CsvReader csv(text, {{"t_s", "ax_mps2", "ay_mps2", "az_mps2", "wx_radps", "wy_radps", "wz_radps"}});
  std::optional<Stamp> last;
  while (csv.next()) {
    const Stamp stamp = csv.stamp(0);
    if (last && stamp <= *last) csv.fail("time does not run forward");
    for (std::size_t column = 1; column < kColumns; ++column) csv.number(column);
    last = stamp;
  }
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
