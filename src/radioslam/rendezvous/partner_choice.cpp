#include "radioslam/rendezvous/partner_choice.hpp"

#include <algorithm>
#include <tuple>

namespace radioslam {
namespace {

/// The option with the smallest key; the first of equals by name.
template <class Key>
std::optional<std::string> smallest(const std::vector<MeetingOption>& options, const Key& key) {
  if (options.empty()) return std::nullopt;
  const auto before = [&](const MeetingOption& a, const MeetingOption& b) {
    return std::tuple_cat(key(a), std::tie(a.robot)) < std::tuple_cat(key(b), std::tie(b.robot));
  };
  return std::min_element(options.begin(), options.end(), before)->robot;
}

}  // namespace

double service_discrepancy(double q_db, double esnr_db, double alpha) {
  return std::max(alpha * (q_db - std::max(esnr_db, 0.0)) / q_db, 0.0);
}

std::optional<std::string> best_caller(const std::vector<MeetingOption>& callers) {
  return smallest(callers, [](const MeetingOption& each) { return std::tuple(-each.esnr_db, -each.error); });
}

std::optional<std::string> best_partner(const std::vector<MeetingOption>& offers, double q_db, double alpha) {
  return smallest(offers, [&](const MeetingOption& each) {
    return std::tuple(service_discrepancy(q_db, each.esnr_db, alpha), each.error);
  });
}

double expected_gain(double error_i, double error_j) {
  const double sum = error_i + error_j;
  return sum > 0 ? (error_i * error_i + error_j * error_j) / sum : 0;
}

}  // namespace radioslam
