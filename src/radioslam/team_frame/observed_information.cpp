#include "radioslam/team_frame/observed_information.hpp"

#include <algorithm>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <class Pose>
void discount(const PoseGraph<Pose>& graph, auto& factor) {
  const double share = 1 - (1 - factor.weight) * squared_norm(graph, factor);
  factor.weight *= std::clamp(share, 0.0, 1.0);
}

}  // namespace

template <class Pose>
void discount_uncertain_measurements(PoseGraph<Pose>& graph, std::size_t ranges, double sigma_place_m) {
  for (std::size_t k = 0; k < std::min(ranges, graph.ranges.size()); ++k) discount(graph, graph.ranges[k]);
  for (auto& bearing : graph.bearings) {
    discount(graph, bearing);
    const double distance =
        (position(graph, bearing.j) - graph.poses[bearing.i.index()].translation()).norm();
    const double across = bearing.sigma_rad * distance;
    bearing.weight *= across * across / (across * across + sigma_place_m * sigma_place_m);
  }
}

template void discount_uncertain_measurements(PoseGraph<SE2>&, std::size_t, double);
template void discount_uncertain_measurements(PoseGraph<SE3>&, std::size_t, double);

}  // namespace radioslam
