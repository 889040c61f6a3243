// Gaussian process likelihood of fingerprint positions: a radio field over the floor, common to the team.
//
// Every access point is a draw of one random field over the plane, so the covariance of two fingerprints over
// the access points is a function of their positions (Lawrence 2005, Gaussian process latent variable models;
// Ferris, Fox and Lawrence 2007, WiFi-SLAM). With S the fingerprints' sample covariance and m independent
// access points,
//
//   cost(x) = m/2 (ln |K(x)| + tr K(x)^-1 S)
//   K_ij = c_ij (far exp(-d_ij / far_length) + near exp(-d_ij^2 / 2 near_length^2) + everywhere)
//          + [same robot] (robot + drift exp(-|t_i - t_j| / drift_time)) + [i = j] noise
//   c_ij = 1 within a robot, exp(-a_r - a_s) between robots r and s
//
// Phones differ in the channels they scan and the weakest signal they report: at one place, two of them agree
// less than one does with itself, one pair of phones much less than another. The losses a model that; without
// them the difference is explained by distance, and trajectories are pushed apart.
//
// The terms of the second line model what fingerprints of one robot have in common apart from position:
// readings repeated from earlier scans, shadowing by the body that carries the phone, the network's momentary
// state. On ilc20 the cosine similarity at one place is 0.94 within a recording and 0.76 between two.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"

namespace radioslam {

/// The covariance's parameters, as logarithms: all are positive.
struct FieldKernel {
  enum Index {
    kFar,
    kFarLength,
    kNear,
    kNearLength,
    kNoise,
    kRobot,
    kEverywhere,
    kDrift,
    kDriftTime,
    kCount
  };
  using Vector = Eigen::Matrix<double, kCount, 1>;
  Vector log;

  /// Typical values: fractions of the fingerprints' variance, lengths of 40 and 15 m, 20 s.
  static FieldKernel nominal();
  double operator[](Index i) const;
};

/// The covariance's parameters for a team.
struct FieldModel {
  FieldKernel kernel;
  Eigen::VectorXd log_losses;  ///< ln a, per robot

  static FieldModel nominal(std::size_t robots);
};

/// Robot and time of a fingerprint.
struct FieldNode {
  std::size_t robot = 0;
  Stamp stamp;
};

/// Cost of positions and its gradient.
struct FieldCost {
  double value = 0;
  Eigen::Matrix2Xd by_position;  ///< 1/m, per node
  FieldKernel::Vector by_kernel;
  Eigen::VectorXd by_loss;  ///< per robot
};

class RadioField {
 public:
  /// `heard`: a row of unit length per node; `channels` is m.
  RadioField(std::vector<FieldNode> nodes, const Eigen::MatrixXd& heard, double channels);

  std::size_t size() const { return nodes_.size(); }
  /// `places`: positions in metres, 2 x nodes. Time grows with the cube of the nodes. The value is infinite
  /// where rounding leaves K without a Cholesky factor.
  FieldCost cost(const Eigen::Matrix2Xd& places, const FieldModel& model) const;
  /// Cost of `nodes` at `moved` (2 x nodes) given `others` at their `places` (2 x all nodes).
  double conditional_cost(const std::vector<Eigen::Index>& nodes, const Eigen::Matrix2Xd& moved,
                          const std::vector<Eigen::Index>& others, const Eigen::Matrix2Xd& places,
                          const FieldModel& model) const;

 private:
  const FieldNode& node(Eigen::Index i) const { return nodes_[static_cast<std::size_t>(i)]; }
  Eigen::MatrixXd covariance(const Eigen::Matrix2Xd& places, const FieldModel& model) const;
  void add_slopes(const Eigen::Matrix2Xd& places, const FieldModel& model,
                  const Eigen::MatrixXd& by_covariance, FieldCost& cost) const;

  std::vector<FieldNode> nodes_;
  Eigen::MatrixXd heard_;  ///< S = heard heard^T
  double channels_;
};

/// Matrix with a row of unit length per fingerprint and a column per access point observed by at least three
/// of them: (RSS + 100)^e. Fingerprints without such access points have a row of zeros.
Eigen::MatrixXd fingerprint_powers(const std::vector<const Fingerprint*>& fingerprints, double exponent);

}  // namespace radioslam
