#include "radioslam/pipeline/scan_guess.hpp"

namespace radioslam {

std::optional<ScanGuess> guess_by_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                           Stamp stamp, const SweptTime& time) {
  const auto at_stamp = odometry.at(stamp);
  if (!at_stamp) return std::nullopt;
  ScanGuess guess{{}, SweptWay::over(time)};
  for (std::size_t k = 0; k < guess.way.poses.size(); ++k) {
    const auto pose = odometry.at({stamp.ns + Stamp::from_seconds(guess.way.time_of(k)).ns});
    if (!pose) return std::nullopt;
    guess.way.poses[k] = at_stamp->inverse() * *pose;
  }
  const auto before = previous ? odometry.at(*previous) : std::nullopt;
  if (before) guess.T_previous_body = before->inverse() * *at_stamp;
  return guess;
}

}  // namespace radioslam
