// Proposals of robots that something aligns, of which the predicted relative pose decides: first by the
// predictions alone; then the descriptors of the most promising keyframes are sent and compared.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/joint/places/attempts.hpp"
#include "radioslam/joint/places/place_predictions.hpp"
#include "radioslam/joint/places/place_proposals.hpp"

namespace radioslam {

template <class Pose>
class PredictedPlaces {
 public:
  /// All must outlive it.
  PredictedPlaces(const PlaceInput<Pose>& input, const std::vector<ScannedRobot>& robots,
                  const PlaceParams& params, const ScanLoopParams& loops,
                  const RadioAlignmentParams& alignment)
      : input_(input), robots_(robots), params_(params), loops_(loops), predictions_(input.team, alignment) {}

  /// False where the graph leaves poses open.
  bool exist() const { return predictions_.exist(); }

  /// Notes, for every stride of b, the keyframes of a that pruning leaves it, in each likely alignment.
  /// Returns the number of pairs.
  std::size_t expect(std::size_t a, std::size_t b, const std::vector<std::size_t>& strides);

  /// Has the descriptors sent that may decide this round, and proposes their keyframes. Returns how many of
  /// those expected are left for later.
  std::size_t propose(const Attempts& tried, PlaceExchange& exchange, PlaceCounts& counts,
                      std::vector<Proposal>& proposals);

  std::vector<Proposal> within(const VerificationBudget& budget,
                               const std::vector<Proposal>& proposals) const;

 private:
  using Poses = std::vector<Pose>;

  /// A stride of b as if the descriptors were equal: with the keyframe of a that is predicted to be nearest.
  struct Expected {
    Proposal pair;
    std::vector<std::size_t> partners;  ///< keyframes of a that pruning leaves
    std::vector<double> distances_m;    ///< predicted, of each
  };

  const Poses& poses_of(const Proposal& pair) const;
  Expected nearest_of(Proposal pair, const std::vector<std::size_t>& partners) const;
  std::vector<bool> asked_for(const PlaceExchange& exchange) const;
  void choose_by_descriptors(Expected& expected, PlaceCounts& counts) const;
  std::vector<std::size_t> indices_within(const VerificationBudget& budget,
                                          const std::vector<Proposal>& proposals) const;

  const PlaceInput<Pose>& input_;
  const std::vector<ScannedRobot>& robots_;
  const PlaceParams& params_;
  const ScanLoopParams& loops_;
  PlacePredictions<Pose> predictions_;
  std::vector<Expected> expected_;
};

}  // namespace radioslam
