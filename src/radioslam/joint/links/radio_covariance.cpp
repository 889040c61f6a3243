#include "radioslam/joint/links/radio_covariance.hpp"

#include <utility>

#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

namespace radioslam {

template <class Pose>
std::optional<RadioCovariance<Pose>> radio_covariance(const JointGraph<Pose>& joint,
                                                      const TeamAlignment<Pose>& alignment,
                                                      const RadioAlignmentParams& params) {
  if (alignment.segments.of_segment.empty()) return std::nullopt;
  auto marginals = Marginals<Pose>::compute(graph_for_covariances(joint, params.mixture).team.graph);
  if (!marginals) return std::nullopt;
  return RadioCovariance<Pose>{std::move(*marginals), params.beam.evidence_temperature};
}

#define RADIOSLAM_RADIO_COVARIANCE(Pose)                          \
  template std::optional<RadioCovariance<Pose>> radio_covariance( \
      const JointGraph<Pose>&, const TeamAlignment<Pose>&, const RadioAlignmentParams&);
RADIOSLAM_RADIO_COVARIANCE(SE2)
RADIOSLAM_RADIO_COVARIANCE(SE3)
#undef RADIOSLAM_RADIO_COVARIANCE

}  // namespace radioslam
