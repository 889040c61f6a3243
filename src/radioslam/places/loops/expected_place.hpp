// Where a scan is expected among the keyframes of a robot.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/places/loops/kept_submaps.hpp"
#include "radioslam/places/loops/scan_loop.hpp"
#include "radioslam/places/scan_context_index.hpp"

namespace radioslam {

/// One robot's keyframes at the poses of an estimate, of which only those near one another matter.
struct PlacedKeyframes {
  const ScanKeyframes& keyframes;
  const std::vector<SE3>& poses;      ///< z is up
  const std::vector<double>& path_m;  ///< from the first keyframe to each
  const ScanContextIndex* index =
      nullptr;  ///< of the keyframes' contexts; null: none are searched that look alike
  /// Standard deviation of the relative position of two keyframes, metres; thread-safe, and cheap for one
  /// first keyframe with many others; needed with an index.
  std::function<double(std::size_t, std::size_t)> sigma_m = {};
  std::shared_ptr<KeptSubmaps> submaps = std::make_shared<KeptSubmaps>();

  bool has_cloud(std::size_t k) const { return !keyframes.clouds[k].empty(); }
};

/// Where keyframe j of one robot is expected from keyframe i of another.
struct ExpectedPlace {
  struct Alternative {
    SE3 T_i_j;  ///< as uncertain as the first
    double weight;
  };
  UncertainPose<SE3> T_i_j;                    ///< where it is searched
  double weight = 1;                           ///< of the alignment that predicts it
  std::vector<Alternative> alternatives = {};  ///< by other alignments of the robots
  bool anywhere = false;                       ///< nothing predicts it: this is but where it is searched

  /// Calls visit(T_i_j, share of all weights) for every prediction.
  template <class Visit>
  void for_each(const Visit& visit) const {
    double all = weight;
    for (const Alternative& other : alternatives) all += other.weight;
    visit(T_i_j.pose, weight / all);
    for (const Alternative& other : alternatives) visit(other.T_i_j, other.weight / all);
  }
};

/// Keyframe j of the source, which is compared with keyframe i of the target.
struct ComparedKeyframes {
  const PlacedKeyframes& target;
  std::size_t i;
  const PlacedKeyframes& source;
  std::size_t j;

  bool are_of_one_robot() const { return &target.keyframes == &source.keyframes; }
};

}  // namespace radioslam
