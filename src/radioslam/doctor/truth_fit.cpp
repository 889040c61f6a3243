#include "radioslam/doctor/truth_fit.hpp"

#include <cmath>

#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinPlaces = 4;
constexpr double kStart_m = 25;  // short, since an error of the heading moves the start
constexpr double kMinExtent_m = 2, kMaxMisfitOfStart = 0.1;

/// Places by odometry and truth at the same times.
struct Stretch {
  std::vector<Eigen::Vector3d> odometry_m, truth_m;
};

std::vector<Stretch> stretches_of(const Track& track, const RobotTruth& truth,
                                  const TruthCorrection& correction, double length_m) {
  std::vector<Stretch> stretches(1);
  double end_m = length_m;
  for (const auto& row : truth.poses) {
    const auto at = track.at(row.stamp.seconds() + correction.shift_s);
    if (!at) continue;
    if (at->path_m > end_m) {
      stretches.emplace_back();
      end_m = at->path_m + length_m;
    }
    Eigen::Vector3d place = correction.factor * row.pose.translation();
    if (correction.mirrored) place.y() *= -1;
    stretches.back().odometry_m.push_back(at->position_m);
    stretches.back().truth_m.push_back(place);
  }
  std::erase_if(stretches, [](const Stretch& stretch) { return stretch.truth_m.size() < kMinPlaces; });
  return stretches;
}

template <int dimension>
Eigen::Matrix<double, dimension, Eigen::Dynamic> columns(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix<double, dimension, Eigen::Dynamic> matrix(dimension,
                                                          static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k)
    matrix.col(static_cast<Eigen::Index>(k)) = points[k].template head<dimension>();
  return matrix;
}

template <int dimension>
void add(const Stretch& stretch, TruthFit& fit) {
  const auto odometry = columns<dimension>(stretch.odometry_m), truth = columns<dimension>(stretch.truth_m);
  const auto T_truth_odometry = align_points(odometry, truth);
  const Eigen::Vector<double, dimension> mean = truth.rowwise().mean();
  for (Eigen::Index k = 0; k < truth.cols(); ++k) {
    const Eigen::Vector<double, dimension> place = odometry.col(k);
    fit.squared_misfit += (truth.col(k) - T_truth_odometry * place).squaredNorm();
    fit.squared_extent += (truth.col(k) - mean).squaredNorm();
  }
  fit.places += static_cast<double>(truth.cols());
}

}  // namespace

double TruthFit::rmse_m() const { return places > 0 ? std::sqrt(squared_misfit / places) : 0; }
double TruthFit::relative() const {
  return squared_extent > 0 ? std::sqrt(squared_misfit / squared_extent) : 0;
}

TruthFit fit_truth(const Track& odometry, const RobotTruth& truth, int dimension,
                   const TruthCorrection& correction) {
  TruthFit fit;
  for (const Stretch& stretch : stretches_of(odometry, truth, correction, kTruthStretch_m))
    dimension == 3 ? add<3>(stretch, fit) : add<2>(stretch, fit);
  return fit;
}

std::optional<SE3> start_in_truth(const Track& odometry, const RobotTruth& truth) {
  const auto stretches = stretches_of(odometry, truth, {}, kStart_m);
  if (stretches.empty()) return std::nullopt;
  TruthFit fit;
  add<2>(stretches.front(), fit);
  if (fit.squared_extent < kMinExtent_m * kMinExtent_m * fit.places || fit.relative() > kMaxMisfitOfStart)
    return std::nullopt;
  return lift(align_points(columns<2>(stretches.front().odometry_m), columns<2>(stretches.front().truth_m)));
}

}  // namespace radioslam
