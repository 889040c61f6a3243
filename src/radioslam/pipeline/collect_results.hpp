// Results of a run, collected from the optimized joint graph.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// The robots' trajectories, with the graph's variables at `poses`.
template <class Pose>
std::vector<RobotResult> collect_robots(const JointGraph<Pose>& joint, const std::vector<Pose>& poses,
                                        const TeamAlignment<Pose>& alignment);

/// Outcomes of the distances that fingerprints predict.
template <class Pose>
std::vector<ClosureResult> collect_fingerprint_closures(const JointGraph<Pose>& joint);

/// Outcomes of the ranges and angles between robots, by their weight in the alignment.
template <class Pose>
std::vector<ClosureResult> collect_radio_links(const JointGraph<Pose>& joint);

/// Transforms between every two placed robots of one component.
template <class Pose>
std::vector<TransformResult> collect_transforms(const JointGraph<Pose>& joint,
                                                const TeamAlignment<Pose>& alignment,
                                                const Marginals<Pose>& marginals);

/// Notes on constant odometry errors that exceed three times both their stated and their estimated sigma.
template <class Pose>
std::vector<std::string> odometry_notes(const Mission& mission, const JointGraph<Pose>& joint,
                                        const Marginals<Pose>& marginals);

/// Note on the stated start that everything else contradicts most, if significantly.
template <class Pose>
std::optional<std::string> start_note(const JointGraph<Pose>& joint, const Marginals<Pose>& marginals);

/// Fills RobotResult::rssi_offset_db and its sigma where they are observable.
void add_rssi_offsets(std::vector<RobotResult>& robots, const RssiOffsets& offsets);

/// Note on corrected RSSI offsets: the largest difference between two robots' devices.
std::string rssi_offset_note(const std::vector<RobotResult>& robots);

/// The fitted model, with at most a few thousand of its samples.
SimilarityModelResult collect_similarity_model(const RadioMeasurements& radio, const RadioParams& params);

/// Components in the order of their numbers.
template <class Pose>
std::vector<Component> collect_components(const JointGraph<Pose>& joint,
                                          const TeamAlignment<Pose>& alignment);

}  // namespace radioslam
