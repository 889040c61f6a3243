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
void discount_uncertain_measurements(PoseGraph<Pose>& graph, std::size_t ranges) {
  for (std::size_t k = 0; k < std::min(ranges, graph.ranges.size()); ++k) discount(graph, graph.ranges[k]);
  for (auto& bearing : graph.bearings) discount(graph, bearing);
}

template void discount_uncertain_measurements(PoseGraph<SE2>&, std::size_t);
template void discount_uncertain_measurements(PoseGraph<SE3>&, std::size_t);

}  // namespace radioslam
