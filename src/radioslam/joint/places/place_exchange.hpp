// What robots send each other to recognise places: descriptors of the keyframes that may be registered, and
// the scans of those that are. Robot b of a pair sends, robot a compares and registers; each thing is sent
// once to every robot.
#pragma once

#include <array>
#include <cstddef>
#include <set>

#include "radioslam/joint/places/proposal.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"

namespace radioslam {

/// By kind.
struct PlaceBytes {
  std::size_t descriptors = 0;  ///< a byte per bin
  std::size_t scans = 0;        ///< 21 per surfel: position 6, covariance 12, tilt 2, shape 1
};

class PlaceExchange {
 public:
  bool has_descriptor(std::size_t a, std::size_t b, std::size_t j) const {
    return descriptors_.contains({a, b, j});
  }
  void send_descriptor(const std::vector<ScannedRobot>& robots, std::size_t a, std::size_t b, std::size_t j);
  /// Keyframe j's scan, and those within `source_m` of path to either side.
  void send_scans(const std::vector<ScannedRobot>& robots, const Proposal& pair, double source_m);

  const PlaceBytes& sent() const { return sent_; }

 private:
  std::set<std::array<std::size_t, 3>> descriptors_, scans_;  ///< a, b, keyframe of b
  PlaceBytes sent_;
};

/// What it takes to send a every descriptor of these keyframes of b, and all scans of b.
PlaceBytes bytes_of_all(const ScannedRobot& b, const std::vector<std::size_t>& described);

}  // namespace radioslam
