// Objective of an access point's position and path loss: what RSS along known paths says of
// [x, y, P0, n], the model of access_points.hpp.
//
// Sites that detected the access point have noise whitened by its Cholesky factor, residuals under Huber's
// loss; sites without detection are censored readings (censored_loss.hpp). Everything depends on the position
// by decades, 10 log10 d, so that those of many positions are whitened at once, and P0 and n at a fixed
// position are optimized without computing them again. Cost: square of the number of sites per position.
#pragma once

#include <Eigen/Core>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/fingerprints/access_points.hpp"

namespace radioslam {

/// Sites by column, their mean RSS and number of readings.
struct HeardPlaces {
  Eigen::Matrix2Xd place_m;
  Eigen::VectorXd rss_dbm, readings;
};

/// In cells that grow until there are at most `max_places`.
HeardPlaces heard_places(const std::vector<PlacedReading>& readings, const AccessPointParams& params);

/// [x, y, P0, n].
using PathLossUnknowns = Eigen::Vector4d;

/// Cost (squared residuals under Huber's loss, those of censored readings, and the priors'), gradient and
/// information of all unknowns, or of P0 and n at a fixed position.
template <int kUnknowns>
struct PathLossCost {
  double cost = 0;
  double heard_cost = 0;  ///< contribution of the residuals
  Eigen::Matrix<double, kUnknowns, 1> gradient = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  Eigen::Matrix<double, kUnknowns, kUnknowns> information =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
};

class PathLossObjective {
 public:
  PathLossObjective(const HeardPlaces& places, const RssAlongPath& heard, const AccessPointParams& params);

  Eigen::Index places() const { return rss_.size(); }

  /// Whitened decades of the sites that detected it, a column per position of the access point.
  Eigen::MatrixXd heard_decades(const Eigen::Matrix2Xd& positions_m) const;
  /// Decades of the sites that did not.
  Eigen::VectorXd undetected_decades(const Eigen::Vector2d& position_m) const;

  /// P0 and n by linear least squares, from the sites that detected it and the priors.
  Eigen::Vector2d fitted_law(const Eigen::VectorXd& heard_decades) const;
  /// Cost of P0 and n at a fixed position, of the sites that detected it and the priors; and with the others.
  PathLossCost<2> heard_at(const Eigen::Vector2d& law, const Eigen::VectorXd& heard_decades) const;
  PathLossCost<2> at(const Eigen::Vector2d& law, const Eigen::VectorXd& heard_decades,
                     const Eigen::VectorXd& undetected_decades) const;
  PathLossCost<4> at(const PathLossUnknowns& unknowns) const;

 private:
  Eigen::VectorXd decades(const Eigen::Matrix2Xd& sites_m, const Eigen::Vector2d& position_m) const;
  Eigen::Matrix2Xd slopes(const Eigen::Matrix2Xd& sites_m, const Eigen::Vector2d& position_m) const;

  AccessPointParams params_;
  double floor_dbm_;
  Eigen::Matrix2Xd heard_m_, undetected_m_;
  Cholesky<Eigen::MatrixXd> noise_;
  Eigen::VectorXd ones_, rss_;  ///< whitened
};

}  // namespace radioslam
