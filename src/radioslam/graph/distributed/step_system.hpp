// A robot's rows of the team's Gauss-Newton system, H_rr x_r = -g_r - sum_s H_rs x_s, at fixed poses: its
// own steps x_r, given its neighbours' x_s. H_rr is factorised once per linearisation.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {

template <class Pose>
class StepSystem {
 public:
  using Steps = std::vector<typename Pose::Tangent>;  ///< per pose of the graph

  /// `graph`: fixed poses' steps are given, the others solved for. Only relative poses tie the two.
  explicit StepSystem(const PoseGraph<Pose>& graph);

  /// At the graph's poses, which has the structure of the constructor's; false when H_rr is singular.
  bool linearise(const PoseGraph<Pose>& graph);
  /// Of the graph's factors, where it was linearised.
  double cost() const { return cost_; }
  /// Moves the steps that are solved for the way to the solution, `relaxation` times as far; all are zero
  /// after a linearisation. Returns the decrease of the quadratic at a relaxation of one.
  double move(Steps& steps, double relaxation);

 private:
  /// H_rs of one factor.
  struct Coupling {
    Eigen::Index offset = 0;  ///< of the free pose
    std::size_t fixed = 0;    ///< the given pose
    typename Pose::Jacobian information;
  };
  void couple(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor);

  NormalEquations<Pose> equations_;
  std::vector<Coupling> couplings_;
  Eigen::VectorXd reached_;  ///< H_rr x_r
  double cost_ = 0;
};

}  // namespace radioslam
