#include "radioslam/study/fingerprints/sequence_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kRight_m = 3;
constexpr double kRight_rad = 0.3490658503988659;  // 20 degrees
constexpr std::array kWindows_m{10.0, 20.0, 30.0, 40.0};
constexpr int kSimilarities = 9;
constexpr double kSimilarityStep = 0.1;
constexpr int kDegreesOfFreedom = 3;

SE2 true_pose(const RadioMeasurements& radio, const Truth& truth, std::size_t node) {
  const auto pose = truth.robots[radio.nodes[node].robot.index()].poses.at(radio.at(node).fingerprint.stamp);
  RADIOSLAM_CHECK(pose.has_value(), "the truth must cover the fingerprints");
  return flatten(*pose);
}

SequenceError error_of(const RadioMeasurements& radio, const Truth& truth, const SequenceClosure& closure) {
  const SE2 T_j_i = true_pose(radio, truth, closure.candidate.node_j).inverse() *
                    true_pose(radio, truth, closure.candidate.node_i);
  const SE2::Tangent gap = (closure.fit.T_j_i.inverse() * T_j_i).log();
  return {(closure.fit.T_j_i.translation() - T_j_i.translation()).norm(),
          std::abs(wrap_angle(closure.fit.T_j_i.angle() - T_j_i.angle())),
          gap.dot(ldlt_solve(closure.fit.covariance, gap))};
}

std::vector<SequenceCell> empty_sequence_cells() {
  std::vector<SequenceCell> cells;
  for (const double window_path_m : kWindows_m)
    for (int step = 1; step <= kSimilarities; ++step)
      cells.push_back({step * kSimilarityStep, window_path_m, 0, 0, {}});
  return cells;
}

void add_sequences(SequenceCell& cell, const RadioMeasurements& radio, const Truth& truth) {
  SequenceClosureParams params;
  params.min_similarity = cell.min_similarity;
  params.window_path_m = cell.window_path_m;
  const auto closures = propose_sequence_closures(radio, params);
  ++cell.missions;
  cell.candidates += closures.size();
  for (const SequenceError& error : sequence_errors(radio, truth, closures)) cell.accepted.push_back(error);
}

template <class Value>
std::optional<double> median_over(const SequenceCell& cell, Value&& value) {
  std::vector<double> values;
  for (const SequenceError& error : cell.accepted) values.push_back(value(error));
  return median_of(std::move(values));
}

StudyRow sequence_row(const SequenceCell& cell) {
  const double missions = static_cast<double>(cell.missions);
  const double accepted = static_cast<double>(cell.accepted.size());
  const auto right = std::count_if(cell.accepted.begin(), cell.accepted.end(),
                                   [](const SequenceError& error) { return error.right(); });
  const auto ratio = accepted > 0 ? std::optional(static_cast<double>(right) / accepted) : std::nullopt;
  return {
      "window " + number_text(cell.window_path_m, 0) + " m, similarity " +
          number_text(cell.min_similarity, 1),
      {number_text(static_cast<double>(cell.candidates) / missions, 0), number_text(accepted / missions, 1),
       percent_text(ratio, 1), number_text(median_over(cell, [](const auto& e) { return e.distance_m; }), 2),
       number_text(median_over(cell, [](const auto& e) { return e.angle_rad * kDegreesPerRadian; }), 1),
       number_text(median_over(cell, [](const auto& e) { return e.nees / kDegreesOfFreedom; }), 2)}};
}

}  // namespace

bool SequenceError::right() const { return distance_m <= kRight_m && angle_rad <= kRight_rad; }

std::vector<SequenceError> sequence_errors(const RadioMeasurements& radio, const Truth& truth,
                                           const std::vector<SequenceClosure>& closures) {
  std::vector<SequenceError> errors;
  for (const SequenceClosure& closure : closures)
    if (closure.fit.status == SequenceStatus::kAccepted) errors.push_back(error_of(radio, truth, closure));
  return errors;
}

std::vector<SequenceCell> measure_sequence_closures(const CarparkParams& carpark, std::uint64_t first_seed,
                                                    int seeds, const Progress& progress) {
  std::vector<SequenceCell> cells = empty_sequence_cells();
  for (int k = 0; k < seeds; ++k) {
    const auto [mission, truth] = simulate_carpark(carpark, first_seed + static_cast<std::uint64_t>(k));
    const RadioMeasurements radio = measure_radio(mission, RadioParams{}, {});
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double done = static_cast<double>(c) / static_cast<double>(cells.size());
      report_progress(progress, "car parks", (k + done) / seeds);
      add_sequences(cells[c], radio, truth);
    }
  }
  return cells;
}

StudyTable sequence_table(const std::vector<SequenceCell>& cells) {
  StudyTable table{"Sequence closures",
                   "Simulated car parks where fingerprints alone detect revisited places: relative poses of "
                   "sequence closures compared with the truth, per mission.",
                   {"candidates", "accepted", "within 3 m and 20°", "median error, m", "median error, °",
                    "median of NEES / 3"},
                   {},
                   {}};
  for (const SequenceCell& cell : cells) table.rows.push_back(sequence_row(cell));
  table.notes = {
      "The window is the path length that is matched on either side.",
      "Accepted closures have no pair of fingerprints in common, so longer windows leave fewer of them.",
      "The median of NEES / 3 is 0.79 for a consistent covariance; lower values are conservative."};
  return table;
}

}  // namespace radioslam
