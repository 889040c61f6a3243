// Who meets whom: which call a robot follows, and whose offer the caller takes. Source: Wang et al., section
// 5 and algorithm 1; by information: see expected_gain.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace radioslam {

/// What the link to a robot lacks: max(alpha (q - rho) / q, 0), rho = max(esnr_db, 0).
double service_discrepancy(double q_db, double esnr_db, double alpha);

/// A robot to meet, as it is heard here.
struct MeetingOption {
  std::string robot;
  double esnr_db = 0;
  double error = 0;  ///< that it states
};

/// The call that a robot follows: the one it hears best; of equals, that of the larger error.
std::optional<std::string> best_caller(const std::vector<MeetingOption>& callers);
/// The offer that a caller takes: that of the smallest service discrepancy; of equals, of the lower error.
std::optional<std::string> best_partner(const std::vector<MeetingOption>& offers, double q_db, double alpha);

/// By how much the expected squared errors of two robots' positions shrink together when they meet and learn
/// their difference (m^2). Each has drifted by itself since it last met the team, by e_i and e_j (m^2):
///   (e_i^2 + e_j^2) / (e_i + e_j).
double expected_gain(double error_i, double error_j);

}  // namespace radioslam
