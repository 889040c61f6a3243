#include "radioslam/team_frame/observed_information.hpp"

#include <algorithm>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <class Pose>
void discount(const PoseGraph<Pose>& graph, auto& factor) {
  const double ratio = 1 - (1 - factor.weight) * squared_norm(graph, factor);
  factor.weight *= std::clamp(ratio, 0.0, 1.0);
}

}  // namespace

template <class Pose>
void use_observed_information(PoseGraph<Pose>& graph, std::size_t ranges, double sigma_antenna_position_m) {
  for (std::size_t k = 0; k < std::min(ranges, graph.ranges.size()); ++k) discount(graph, graph.ranges[k]);
  for (auto& bearing : graph.bearings) {
    discount(graph, bearing);
    const double across = bearing.sigma_rad * seen_by_receiver(graph, bearing).norm();
    bearing.weight *=
        across * across / (across * across + sigma_antenna_position_m * sigma_antenna_position_m);
  }
}

template void use_observed_information(PoseGraph<SE2>&, std::size_t, double);
template void use_observed_information(PoseGraph<SE3>&, std::size_t, double);

}  // namespace radioslam
