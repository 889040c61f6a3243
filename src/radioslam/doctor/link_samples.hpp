// Links of one window with the poses of their ends, and how likely they are under an alignment of the two
// nodes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/doctor/team_links.hpp"

namespace radioslam {

/// A link with the poses of its ends, each in its node's frame.
struct LinkSample {
  Eigen::Vector3d p_i, p_j;
  Eigen::Matrix3d R_receiver;
  bool is_angle = false, is_fix = false, receiver_is_i = true;
  double range_m = 0, height_m = 0;
  double own_sigma = 1;  ///< as recorded
  double sigma = 1;      ///< with the error of dead reckoning
  std::vector<double> azimuths_rad;
};

/// Likelihood of a window's links: a normal distribution about the prediction with weight 0.8, else uniform.
class LinkLikelihood {
 public:
  /// x, y, z in metres and yaw of node j's frame in node i's.
  using Alignment = Eigen::Vector4d;
  /// An alignment with the cosine and sine of its yaw.
  struct Motion {
    explicit Motion(const Alignment& T);
    Eigen::Vector3d translation_m;
    double cosine, sine;
  };

  /// `alignment_sigma_m` is added to the sigmas of ranges.
  LinkLikelihood(const TeamLinks& team, const LinkWindow& window, double alignment_sigma_m);

  bool is_planar() const { return is_planar_; }
  const std::vector<LinkSample>& samples() const { return samples_; }

  /// In metres or radians; of an angle, that of the nearest path.
  double residual(const LinkSample& sample, const Motion& T) const;
  double inlier_density(const LinkSample& sample, double residual) const;
  double outlier_density(const LinkSample& sample) const;
  /// Of every `stride`th link.
  double log_likelihood(const Alignment& T, std::size_t stride = 1) const;
  /// Of the links whose ends have no odometry at their time.
  double log_likelihood_of_unplaced() const;

 private:
  void add(const TeamLinks& team, const LinkWindow& window, const TrackLink& link, double alignment_sigma_m);
  Eigen::Vector3d direction(const LinkSample& sample, const Motion& T) const;

  bool is_planar_;
  std::vector<LinkSample> samples_;
  std::size_t unplaced_ = 0;
  double range_span_m_;
};

}  // namespace radioslam
