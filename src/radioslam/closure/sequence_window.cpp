#include "radioslam/closure/sequence_window.hpp"

#include <cmath>
#include <limits>

namespace radioslam {

SequenceWindow window_around(const RadioMeasurements& radio, std::size_t middle, double half_path_m) {
  const auto belongs = [&](std::size_t node) { return path_between_m(radio, node, middle) <= half_path_m; };
  std::size_t first = middle, last = middle;
  while (first > 0 && belongs(first - 1)) --first;
  while (last + 1 < radio.nodes.size() && belongs(last + 1)) ++last;
  SequenceWindow window{{}, Eigen::Matrix2Xd(2, static_cast<Eigen::Index>(last - first + 1))};
  const SE2 T_middle_start = flatten(radio.at(middle).T_start_body).inverse();
  for (std::size_t node = first; node <= last; ++node) {
    window.nodes.push_back(node);
    window.position_m.col(static_cast<Eigen::Index>(node - first)) =
        T_middle_start * flatten(radio.at(node).T_start_body).translation();
  }
  return window;
}

double path_between_m(const RadioMeasurements& radio, std::size_t a, std::size_t b) {
  if (radio.nodes[a].robot != radio.nodes[b].robot) return std::numeric_limits<double>::infinity();
  return std::abs(radio.at(a).travelled_m - radio.at(b).travelled_m);
}

double similarity_of(const RadioMeasurements& radio, std::size_t a, std::size_t b) {
  return static_cast<double>(radio.near_similarity.of(a, b));
}

}  // namespace radioslam
