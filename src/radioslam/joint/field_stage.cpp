#include "radioslam/joint/field_stage.hpp"

#include <algorithm>
#include <cstddef>

#include "radioslam/geometry/alignment.hpp"
#include "radioslam/team_frame/field_refinement.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"

namespace radioslam {
namespace {

template <class Pose>
typename Pose::Point place(const JointGraph<Pose>& joint, const RangeEnd<Pose>& end) {
  return joint.team.graph.poses[end.pose.index()] * end.lever_arm;
}

/// The component's fingerprints, thinned evenly, robot by robot.
std::vector<std::size_t> nodes_of(const RadioMeasurements& radio, const std::vector<int>& component, int of,
                                  int max_nodes) {
  std::vector<std::size_t> all, kept;
  for (std::size_t i = 0; i < radio.nodes.size(); ++i)
    if (component[radio.nodes[i].robot.index()] == of) all.push_back(i);
  for (const std::size_t k : thinned_nodes(all.size(), max_nodes)) kept.push_back(all[k]);
  return kept;
}

/// Every robot's odometry as a rigid body, aligned with its optimized trajectory.
template <class Pose>
std::vector<RigidBody> bodies_of(const JointGraph<Pose>& joint, const Mission& mission,
                                 const KnownStarts& starts, const RadioMeasurements& radio,
                                 const std::vector<std::size_t>& nodes) {
  std::vector<RigidBody> bodies = fingerprint_bodies(mission, starts, radio, nodes);
  for (RigidBody& body : bodies) {
    Eigen::Matrix2Xd optimized(2, body.points.cols());
    for (Eigen::Index k = 0; k < optimized.cols(); ++k) {
      const std::size_t node = nodes[body.first_node + static_cast<std::size_t>(k)];
      optimized.col(k) = place(joint, fingerprint_anchor(joint, radio, node)).template head<2>();
    }
    if (optimized.cols() == 1) body.T_layout_body = SE2(optimized.col(0) - body.points.col(0), 0);
    if (optimized.cols() > 1) body.T_layout_body = align_points(body.points, optimized);
  }
  return bodies;
}

/// Relocates layout outliers, then refines all bodies on their common radio field.
void refine(std::vector<RigidBody>& bodies, const RadioMeasurements& radio,
            const std::vector<std::size_t>& nodes, const FieldParams& params) {
  std::vector<FieldNode> field_nodes;
  std::vector<const Fingerprint*> fingerprints;
  for (const std::size_t node : nodes) {
    const Fingerprint& fingerprint = radio.at(node).fingerprint;
    field_nodes.push_back({radio.nodes[node].robot.index(), fingerprint.stamp});
    fingerprints.push_back(&fingerprint);
  }
  const Eigen::MatrixXd heard = fingerprint_powers(fingerprints, params.exponent);
  relocate_outliers(bodies, heard * heard.transpose());
  refine_by_field(bodies, RadioField(std::move(field_nodes), heard, params.channels), params);
}

template <class Pose>
void reset_layout_distances(JointGraph<Pose>& joint, const std::vector<FingerprintClosure>& closures) {
  for (std::size_t f = 0; f < joint.origins.ranges.size(); ++f) {
    const FactorOrigin& origin = joint.origins.ranges[f];
    if (origin.source != FactorSource::kFingerprint || !closures[origin.measurement].keeps_layout) continue;
    RangeFactor<Pose>& range = joint.team.graph.ranges[f];
    range.range_m = (place(joint, range.i) - place(joint, range.j)).norm();
  }
}

}  // namespace

template <class Pose>
bool refine_by_radio_field(JointGraph<Pose>& joint, const Mission& mission, const KnownStarts& starts,
                           const RadioMeasurements& radio, const TeamAlignment<Pose>& alignment,
                           const std::vector<FingerprintClosure>& closures, const FieldParams& params,
                           const Progress& progress) {
  if (!params.enabled ||
      std::none_of(closures.begin(), closures.end(), [](const auto& c) { return c.keeps_layout; }))
    return false;
  std::vector<SE2> moves(mission.robots.size());
  const int components = 1 + *std::max_element(alignment.component.begin(), alignment.component.end());
  for (int c = 0; c < components; ++c) {
    report_progress(progress, "radio field", static_cast<double>(c) / components);
    const auto nodes = nodes_of(radio, alignment.component, c, params.max_nodes);
    std::vector<RigidBody> bodies = bodies_of(joint, mission, starts, radio, nodes);
    const std::vector<RigidBody> before = bodies;
    refine(bodies, radio, nodes, params);
    for (std::size_t r = 0; r < bodies.size(); ++r)
      if (alignment.component[r] == c) moves[r] = bodies[r].T_layout_body * before[r].T_layout_body.inverse();
  }
  place_robots(joint, moves);
  reset_layout_distances(joint, closures);
  return true;
}

template bool refine_by_radio_field(JointGraph<SE2>&, const Mission&, const KnownStarts&,
                                    const RadioMeasurements&, const TeamAlignment<SE2>&,
                                    const std::vector<FingerprintClosure>&, const FieldParams&,
                                    const Progress&);
template bool refine_by_radio_field(JointGraph<SE3>&, const Mission&, const KnownStarts&,
                                    const RadioMeasurements&, const TeamAlignment<SE3>&,
                                    const std::vector<FingerprintClosure>&, const FieldParams&,
                                    const Progress&);

}  // namespace radioslam
