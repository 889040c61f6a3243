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

const RobotTruth& truth_of(const RadioMeasurements& radio, const Truth& truth, std::size_t node) {
  return truth.robots[radio.nodes[node].robot.index()];
}

/// Nothing where the truth does not cover it.
std::optional<SequenceError> error_of(const RadioMeasurements& radio, const Truth& truth,
                                      const SequenceClosure& closure) {
  const std::size_t i = closure.candidate.node_i, j = closure.candidate.node_j;
  const RobotTruth &of_i = truth_of(radio, truth, i), &of_j = truth_of(radio, truth, j);
  const auto at_i = of_i.poses.at(radio.at(i).fingerprint.stamp),
             at_j = of_j.poses.at(radio.at(j).fingerprint.stamp);
  if (!at_i || !at_j) return std::nullopt;
  const SE2 T_j_i = flatten(*at_j).inverse() * flatten(*at_i);
  const Eigen::Vector2d estimated = closure.fit.T_j_i.translation(), true_m = T_j_i.translation();
  if (!of_i.has_orientation || !of_j.has_orientation)
    return SequenceError{std::abs(estimated.norm() - true_m.norm()), {}, {}};
  const SE2::Tangent gap = (closure.fit.T_j_i.inverse() * T_j_i).log();
  return SequenceError{(estimated - true_m).norm(),
                       std::abs(wrap_angle(closure.fit.T_j_i.angle() - T_j_i.angle())),
                       gap.dot(ldlt_solve(closure.fit.covariance, gap))};
}

std::vector<SequenceCell> empty_sequence_cells(const std::string& measure) {
  std::vector<SequenceCell> cells;
  for (const double window_path_m : kWindows_m)
    for (int step = 1; step <= kSimilarities; ++step)
      cells.push_back({step * kSimilarityStep, window_path_m, 0, 0, {}, 0, measure});
  return cells;
}

void add_sequences(SequenceCell& cell, const RadioMeasurements& radio, const Truth& truth) {
  SequenceClosureParams params;
  params.min_similarity = cell.min_similarity;
  params.window_path_m = cell.window_path_m;
  const auto closures = propose_sequence_closures(radio, params);
  ++cell.missions;
  cell.candidates += closures.size();
  const auto errors = sequence_errors(radio, truth, closures);
  cell.accepted.insert(cell.accepted.end(), errors.begin(), errors.end());
  const auto accepted = std::count_if(closures.begin(), closures.end(), [](const SequenceClosure& closure) {
    return closure.fit.status == SequenceStatus::kAccepted;
  });
  cell.without_truth += static_cast<std::size_t>(accepted) - errors.size();
}

template <class Value>
std::optional<double> median_over(const SequenceCell& cell, Value&& value) {
  std::vector<double> values;
  for (const SequenceError& error : cell.accepted)
    if (const std::optional<double> known = value(error)) values.push_back(*known);
  return median_of(std::move(values));
}

std::optional<double> scaled(std::optional<double> value, double by) {
  return value ? std::optional(*value * by) : std::nullopt;
}

StudyRow sequence_row(const SequenceCell& cell) {
  const double missions = static_cast<double>(cell.missions);
  const double accepted = static_cast<double>(cell.accepted.size());
  const auto right = std::count_if(cell.accepted.begin(), cell.accepted.end(),
                                   [](const SequenceError& error) { return error.right(); });
  const auto ratio = accepted > 0 ? std::optional(static_cast<double>(right) / accepted) : std::nullopt;
  return {(cell.measure.empty() ? "" : cell.measure + ", ") + "window " + number_text(cell.window_path_m, 0) +
              " m, similarity " + number_text(cell.min_similarity, 1),
          {number_text(static_cast<double>(cell.candidates) / missions, 0),
           number_text(accepted / missions, 1), percent_text(ratio, 1),
           number_text(median_over(cell, [](const auto& e) { return std::optional(e.distance_m); }), 2),
           number_text(
               median_over(cell, [](const auto& e) { return scaled(e.angle_rad, kDegreesPerRadian); }), 1),
           number_text(
               median_over(cell, [](const auto& e) { return scaled(e.nees, 1.0 / kDegreesOfFreedom); }), 2)}};
}

}  // namespace

bool SequenceError::right() const {
  return distance_m <= kRight_m && (!angle_rad || *angle_rad <= kRight_rad);
}

std::vector<SequenceError> sequence_errors(const RadioMeasurements& radio, const Truth& truth,
                                           const std::vector<SequenceClosure>& closures) {
  std::vector<SequenceError> errors;
  for (const SequenceClosure& closure : closures)
    if (closure.fit.status == SequenceStatus::kAccepted)
      if (const auto error = error_of(radio, truth, closure)) errors.push_back(*error);
  return errors;
}

std::vector<SequenceCell> measure_sequence_closures(const std::vector<StudyMission>& missions,
                                                    const std::vector<std::string>& measures,
                                                    const Progress& progress) {
  std::vector<SequenceCell> all;
  const std::size_t runs = measures.size() * missions.size();
  std::size_t run = 0;
  for (const std::string& measure : measures) {
    std::vector<SequenceCell> cells = empty_sequence_cells(measure);
    RadioParams params;
    if (!measure.empty()) params.measure = measure;
    for (const StudyMission& of : missions) {
      const RadioMeasurements radio = measure_radio(of.mission, params, {});
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const double done = static_cast<double>(c) / static_cast<double>(cells.size());
        report_progress(progress, "missions", (static_cast<double>(run) + done) / static_cast<double>(runs));
        add_sequences(cells[c], radio, of.truth);
      }
      ++run;
    }
    all.insert(all.end(), cells.begin(), cells.end());
  }
  return all;
}

StudyTable sequence_table(const std::vector<SequenceCell>& cells, const std::string& missions) {
  StudyTable table{"Sequence closures",
                   missions +
                       ": relative poses of closures by similar sequences of fingerprints compared with the "
                       "truth, per mission.",
                   {"candidates", "accepted", "within 3 m and 20°", "median error, m", "median error, °",
                    "median of NEES / 3"},
                   {},
                   {}};
  for (const SequenceCell& cell : cells) table.rows.push_back(sequence_row(cell));
  table.notes = {
      "The window is the path length that is matched on either side.",
      "Accepted closures have no pair of fingerprints in common, so longer windows leave fewer of them.",
      "The median of NEES / 3 is 0.79 for a consistent covariance; lower values are conservative."};
  const auto any = [&](const auto& of_cell) { return std::any_of(cells.begin(), cells.end(), of_cell); };
  if (any([](const SequenceCell& cell) { return cell.without_truth > 0; }))
    table.notes.push_back("Closures at times that the truth does not cover are left out.");
  if (any([](const SequenceCell& cell) {
        return std::any_of(cell.accepted.begin(), cell.accepted.end(),
                           [](const SequenceError& error) { return !error.angle_rad; });
      }))
    table.notes.push_back(
        "Where the truth has no orientations, a closure's error is that of its distance, and it is right "
        "within 3 m.");
  return table;
}

}  // namespace radioslam
