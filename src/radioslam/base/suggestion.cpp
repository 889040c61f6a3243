#include "radioslam/base/suggestion.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

constexpr std::size_t kMaxSuggestions = 3;
constexpr std::size_t kLettersPerError = 3;  // one letter in three may differ

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

bool is_near(std::string_view name, std::string_view candidate, std::size_t distance) {
  const std::size_t allowed = std::max<std::size_t>(2, name.size() / kLettersPerError);
  return distance <= allowed && distance < std::max(name.size(), candidate.size());
}

std::size_t distance_between(std::string_view name, std::string_view candidate) {
  const bool same_ending = last_part(name) == last_part(candidate);
  return same_ending ? 1 : edit_distance(name, candidate);
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::vector<std::string> nearest_names(std::string_view name, const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const auto& candidate : names) {
    const std::size_t distance = distance_between(name, candidate);
    if (is_near(name, candidate, distance)) near.emplace_back(distance, candidate);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), kMaxSuggestions));
  std::vector<std::string> nearest;
  for (auto& [distance, candidate] : near) nearest.push_back(std::move(candidate));
  return nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names) {
  const auto nearest = nearest_names(name, names);
  if (nearest.empty()) return {};
  std::string text = "; did you mean " + nearest.front();
  for (std::size_t i = 1; i < nearest.size(); ++i) {
    text += (i + 1 == nearest.size() ? " or " : ", ") + nearest[i];
  }
  return text + "?";
}

}  // namespace radioslam
