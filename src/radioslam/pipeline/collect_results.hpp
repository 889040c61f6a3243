// From an optimised joint graph to what a run reports.
#pragma once

#include <string>
#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// A closure whose squared residual over its variance exceeds this has not taken part: chi-square, one
/// degree of freedom, 99 %.
inline constexpr double kAcceptedStatistic = 6.635;

/// The robots' trajectories at these poses of the graph.
template <class Pose>
std::vector<RobotResult> collect_robots(const JointGraph<Pose>& joint, const std::vector<Pose>& poses,
                                        const TeamPlacement<Pose>& placement);

template <class Pose>
std::vector<ClosureResult> collect_closures(const RadioMeasurements& radio, const JointGraph<Pose>& joint,
                                            const std::vector<FingerprintClosure>& closures);

/// What became of the ranges and angles between robots: by the weight the alignment gave them.
template <class Pose>
std::vector<ClosureResult> collect_radio_links(const JointGraph<Pose>& joint);

/// Fills RobotResult::sigma_position_m from the marginal covariances.
template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const Marginals<Pose>& marginals);

/// Between every two placed robots of one component.
template <class Pose>
std::vector<TransformResult> collect_transforms(const JointGraph<Pose>& joint,
                                                const TeamPlacement<Pose>& placement,
                                                const Marginals<Pose>& marginals);

/// What a user should know: constant odometry errors beyond three times what is stated and what is certain.
template <class Pose>
std::vector<std::string> odometry_notes(const Mission& mission, const JointGraph<Pose>& joint,
                                        const Marginals<Pose>& marginals);

/// Fills RobotResult::rssi_offset_db and its sigma where fingerprints told.
void add_device_offsets(std::vector<RobotResult>& robots, const DeviceOffsets& offsets);

/// What a user should know where offsets were taken off: how far apart the devices are.
std::string device_offset_note(const std::vector<RobotResult>& robots);

/// The fitted model and at most a few thousand of its samples.
SimilarityModelResult collect_similarity_model(const RadioMeasurements& radio, const RadioParams& params);

/// Components in the order of their numbers.
template <class Pose>
std::vector<Component> collect_components(const JointGraph<Pose>& joint,
                                          const TeamPlacement<Pose>& placement);

}  // namespace radioslam
