// Which proposals are verified, where not all can be.
//
// Of robots that something aligns, those of greatest worth (closure_worth.hpp). A closure holds with
//   p = P(|d| < r) (1 - D),   d: relative position in the plane, as predicted; D: distance of the
//   descriptors,
//                             r: distance at which two keyframes' views overlap
//                             (ScanLoopParams::radius_ratio).
// A choice counts as if it held: one that fails has no part in the predictions of the next round, where pairs
// like it are worth as much as before.
//
// Of robots that nothing aligns there is no prediction: each pair of robots has its turn with its most
// similar keyframes. A first closure there adds more information than any other, but there may be none: the
// two kinds alternate, so that neither waits for the other.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/places/closure_worth.hpp"
#include "radioslam/joint/places/proposal.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"
#include "radioslam/places/loops/scan_loop.hpp"

namespace radioslam {

/// Largest number of registrations between robots, and which come first.
struct VerificationBudget {
  enum class Order {
    kWorth,
    kSimilarity,  ///< of descriptors
    kRandom,
  };
  std::size_t registrations = 0;
  Order order = Order::kWorth;
  double least_worth = 0;  ///< nats that a registration is expected to add, of robots that something aligns
  bool takes_all_anywhere = false;  ///< proposals of robots that nothing aligns do not count
};

/// The proposals within the budget, as their indices, the best first. `predicted`: null if all are
/// `anywhere`.
template <class Pose>
std::vector<std::size_t> within_budget(const VerificationBudget& budget,
                                       const std::vector<Proposal>& proposals,
                                       const std::vector<ScannedRobot>& robots,
                                       const PredictedPoses<Pose>* predicted, const ScanLoopParams& loops);

}  // namespace radioslam
