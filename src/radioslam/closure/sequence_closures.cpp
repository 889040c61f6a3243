#include "radioslam/closure/sequence_closures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kPeakRatio =
    0.25;  // neighbourhood of a similarity peak on either side, as a fraction of the window length

/// Whether no fingerprint near `node` along its path is more similar to `other`; of equals the first is the
/// peak.
bool is_peak(const RadioMeasurements& radio, std::size_t node, std::size_t other, double within_m) {
  const double own = similarity_of(radio, node, other);
  for (std::size_t n = node; n-- > 0 && path_between_m(radio, n, node) <= within_m;)
    if (similarity_of(radio, n, other) >= own) return false;
  for (std::size_t n = node + 1; n < radio.nodes.size() && path_between_m(radio, n, node) <= within_m; ++n)
    if (similarity_of(radio, n, other) > own) return false;
  return true;
}

/// Cheap necessary condition that compares adjacent pairs of a row only; it excludes most pairs.
bool is_peak_of_row(const RadioMeasurements& radio, std::span<const SimilarPair> row, std::size_t k,
                    double within_m) {
  const auto beside = [&](std::size_t other) {
    return path_between_m(radio, row[other].j, row[k].j) <= within_m;
  };
  if (k > 0 && beside(k - 1) && row[k - 1].similarity >= row[k].similarity) return false;
  return k + 1 == row.size() || !beside(k + 1) || row[k + 1].similarity <= row[k].similarity;
}

/// Whether both windows of one closure overlap those of the other.
bool overlap(const RadioMeasurements& radio, const SequenceCandidate& a, const SequenceCandidate& b,
             double window_path_m) {
  const auto near = [&](std::size_t x, std::size_t y) { return path_between_m(radio, x, y) < window_path_m; };
  return (near(a.node_i, b.node_i) && near(a.node_j, b.node_j)) ||
         (near(a.node_i, b.node_j) && near(a.node_j, b.node_i));
}

bool accepted(const SequenceClosure& closure) { return closure.fit.status == SequenceStatus::kAccepted; }

/// Keeps only the most precise of accepted closures that overlap.
void keep_separate(const RadioMeasurements& radio, std::vector<SequenceClosure>& closures,
                   double window_path_m) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < closures.size(); ++k)
    if (accepted(closures[k])) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return closures[a].fit.covariance.determinant() < closures[b].fit.covariance.determinant();
  });
  std::vector<std::size_t> kept;
  for (const std::size_t k : order) {
    const bool beside = std::any_of(kept.begin(), kept.end(), [&](std::size_t other) {
      return overlap(radio, closures[k].candidate, closures[other].candidate, window_path_m);
    });
    if (beside)
      closures[k].fit.status = SequenceStatus::kSuppressed;
    else
      kept.push_back(k);
  }
}

bool is_certain(const Eigen::Matrix3d& covariance, const SequenceClosureParams& params) {
  const auto variances = symmetric_eigenvalues<Eigen::Matrix2d>(covariance.topLeftCorner<2, 2>());
  return std::sqrt(variances[1]) <= params.max_sigma_m &&
         std::sqrt(covariance(2, 2)) <= params.max_sigma_yaw_rad;
}

void drop_uncertain(std::vector<SequenceClosure>& closures, const SequenceClosureParams& params) {
  for (SequenceClosure& closure : closures)
    if (accepted(closure) && !is_certain(closure.fit.covariance, params))
      closure.fit.status = SequenceStatus::kUncertain;
}

/// What is known of windows from matches made earlier.
class EarlierMatches {
 public:
  EarlierMatches(const RadioMeasurements& radio, const EarlierSequences& earlier)
      : earlier_(earlier), number_(earlier_nodes(radio, earlier.radio)) {}

  /// The match of the same two windows; null if there is none.
  const SequenceFit* of(const SequenceCandidate& candidate, const SequenceWindow& i, const SequenceWindow& j,
                        double half_path_m) const {
    const auto node_i = number_[candidate.node_i], node_j = number_[candidate.node_j];
    if (!node_i || !node_j) return nullptr;
    const auto known =
        std::lower_bound(earlier_.matched.begin(), earlier_.matched.end(), std::pair(*node_i, *node_j),
                         [](const SequenceClosure& closure, const auto& nodes) {
                           return std::pair(closure.candidate.node_i, closure.candidate.node_j) < nodes;
                         });
    const bool is_known = known != earlier_.matched.end() && known->candidate.node_i == *node_i &&
                          known->candidate.node_j == *node_j;
    if (!is_known || !is_same(i, *node_i, half_path_m) || !is_same(j, *node_j, half_path_m)) return nullptr;
    return &known->fit;
  }

 private:
  bool is_same(const SequenceWindow& window, std::size_t middle, double half_path_m) const {
    const SequenceWindow before = window_around(earlier_.radio, middle, half_path_m);
    return std::equal(window.nodes.begin(), window.nodes.end(), before.nodes.begin(), before.nodes.end(),
                      [&](std::size_t now, std::size_t then) { return number_[now] == then; }) &&
           window.position_m == before.position_m;
  }

  const EarlierSequences& earlier_;
  EarlierNumbers number_;
};

}  // namespace

std::string_view reason(SequenceStatus status) {
  switch (status) {
    case SequenceStatus::kAccepted:
      return "";
    case SequenceStatus::kTooFewMatches:
      return "too few nodes";
    case SequenceStatus::kNoDistances:
      return "no distances predicted";
    case SequenceStatus::kResidual:
      return "residual";
    case SequenceStatus::kAmbiguous:
      return "another pose fits as well";
    case SequenceStatus::kUncertain:
      return "too straight or too coarse";
    case SequenceStatus::kSuppressed:
      return "a more certain one beside it";
  }
  return "";
}

std::vector<SequenceCandidate> sequence_candidates(const RadioMeasurements& radio,
                                                   const SequenceClosureParams& params) {
  const double peak_m = kPeakRatio * params.window_path_m;
  std::vector<SequenceCandidate> candidates;
  const auto take = [&](std::span<const SimilarPair> row) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const auto [i, j, similarity] = row[k];
      if (path_between_m(radio, i, j) >= params.min_path_m && is_peak_of_row(radio, row, k, peak_m) &&
          is_peak(radio, i, j, peak_m) && is_peak(radio, j, i, peak_m))
        candidates.push_back({i, j, static_cast<double>(similarity)});
    }
  };
  radio.near_similarity.for_each_row(std::max(params.min_similarity, kAnySimilarity), take);
  return candidates;
}

std::vector<SequenceClosure> match_sequences(const RadioMeasurements& radio,
                                             const SequenceClosureParams& params,
                                             const EarlierSequences* earlier) {
  std::vector<SequenceClosure> matched;
  for (const SequenceCandidate& candidate : sequence_candidates(radio, params))
    matched.push_back({candidate, {}});
  std::optional<EarlierMatches> known;
  if (earlier) known.emplace(radio, *earlier);
  const double half_m = params.window_path_m / 2;
  parallel_for(matched.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      auto& [candidate, fit] = matched[k];
      const SequenceWindow i = window_around(radio, candidate.node_i, half_m);
      const SequenceWindow j = window_around(radio, candidate.node_j, half_m);
      const SequenceFit* before = known ? known->of(candidate, i, j, half_m) : nullptr;
      fit = before ? *before : match_windows(radio, i, j, params.match);
    }
  });
  return matched;
}

std::vector<SequenceClosure> choose_sequences(const RadioMeasurements& radio,
                                              std::vector<SequenceClosure> matched,
                                              const SequenceClosureParams& params) {
  drop_uncertain(matched, params);
  keep_separate(radio, matched, params.window_path_m);
  return matched;
}

std::vector<SequenceClosure> propose_sequence_closures(const RadioMeasurements& radio,
                                                       const SequenceClosureParams& params) {
  return choose_sequences(radio, match_sequences(radio, params), params);
}

}  // namespace radioslam
