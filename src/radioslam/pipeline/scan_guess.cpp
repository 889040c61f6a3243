#include "radioslam/pipeline/scan_guess.hpp"

#include <algorithm>

namespace radioslam {

double longest_between_rows_s(const Trajectory<SE3>& rows, Stamp begin, Stamp end) {
  double longest_s = 0;
  if (rows.size() < 2) return longest_s;
  for (std::size_t k = rows.segment(begin); k + 1 < rows.size() && rows[k].stamp < end; ++k)
    longest_s = std::max(longest_s, seconds_between(rows[k].stamp, rows[k + 1].stamp));
  return longest_s;
}

std::optional<ScanGuess> guess_by_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                           Stamp stamp, const SweptTime& time, double most_rows_s) {
  const auto at = [&](double after_s) { return Stamp{stamp.ns + Stamp::from_seconds(after_s).ns}; };
  const Stamp begin = std::min({stamp, previous.value_or(stamp), at(time.first_s)});
  const Stamp end = std::max(stamp, at(time.last_s));
  if (!odometry.covers(begin) || !odometry.covers(end)) return std::nullopt;
  if (longest_between_rows_s(odometry, begin, end) > most_rows_s) return std::nullopt;
  const SE3 T_body_any = odometry.at(stamp)->inverse();
  ScanGuess guess{{}, SweptWay::over(time)};
  for (std::size_t k = 0; k < guess.way.poses.size(); ++k)
    guess.way.poses[k] = T_body_any * *odometry.at(at(guess.way.time_of(k)));
  if (previous) guess.T_previous_body = (T_body_any * *odometry.at(*previous)).inverse();
  return guess;
}

}  // namespace radioslam
