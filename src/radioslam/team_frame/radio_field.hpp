// How well places explain what was heard at them: a Gaussian process over the floor, shared by the team.
//
// Every access point is a draw of one random field over the plane, so the covariance of two scans over the
// access points is that of their places (Lawrence 2005, Gaussian process latent variable models; Ferris, Fox
// and Lawrence 2007, WiFi-SLAM). With S the scans' sample covariance and m independent access points,
//
//   cost(x) = m/2 (ln |K(x)| + tr K(x)^-1 S)
//   K_ij = far exp(-d_ij / far_length) + near exp(-d_ij^2 / 2 near_length^2) + everywhere
//          + [same robot] (robot + drift exp(-|t_i - t_j| / drift_time)) + [i = j] noise
//
// The scans of one robot share more than their place: entries that a phone repeats from earlier scans, the
// body that carries it, the network's momentary answers. Scans of one walk are alike at 0.94 where those of
// two walks at the same place are at 0.76 (ilc20, cosine); a model without the terms of the third line calls
// that distance, and pushes the walks apart.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/radio/fingerprint.hpp"

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

  /// Shares of the scans' variance, lengths of 40 and 15 m, 20 s.
  static FieldKernel usual();
  double operator[](Index i) const;
};

/// Who heard a scan, and when.
struct FieldNode {
  std::size_t robot = 0;
  Stamp stamp;
};

/// Cost of places and its slopes.
struct FieldCost {
  double value = 0;
  Eigen::Matrix2Xd by_position;  ///< 1/m, per node
  FieldKernel::Vector by_kernel;
};

class RadioField {
 public:
  /// `heard`: a row per node, each of unit length; `channels` is m.
  RadioField(std::vector<FieldNode> nodes, const Eigen::MatrixXd& heard, double channels);

  std::size_t size() const { return nodes_.size(); }
  /// Places in metres, 2 x nodes. Time grows with the cube of the nodes. The value is infinite where rounding
  /// leaves K without a Cholesky factor.
  FieldCost cost(const Eigen::Matrix2Xd& places, const FieldKernel& kernel) const;

 private:
  Eigen::MatrixXd covariance(const Eigen::Matrix2Xd& places, const FieldKernel& kernel) const;
  void add_slopes(const Eigen::Matrix2Xd& places, const FieldKernel& kernel,
                  const Eigen::MatrixXd& by_covariance, FieldCost& cost) const;

  std::vector<FieldNode> nodes_;
  Eigen::MatrixXd heard_;  ///< S = heard heard^T
  double channels_;
};

/// A row of unit length per fingerprint, a column per access point that at least three of them hold: (RSS +
/// 100)^e. Fingerprints that hold none have a row of zeros.
Eigen::MatrixXd heard_powers(const std::vector<const Fingerprint*>& fingerprints, double exponent);

}  // namespace radioslam
