#include "radioslam/doctor/link_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr double kInlierWeight = 0.8;
constexpr double kRangeFloor_m = 0.3;
constexpr double kAngleFloor_rad = 0.07;
constexpr double kDriftRatio = 0.01;  // of the window's path
constexpr double kMinRangeSpan_m = 50;

double normal_density(double residual, double sigma) {
  return std::exp(-0.5 * residual * residual / (sigma * sigma)) / (sigma * std::sqrt(2 * std::numbers::pi));
}

bool place(const TeamLinks& team, const TrackEnd& end, double t_s, Eigen::Vector3d& position,
           Eigen::Matrix3d& rotation) {
  rotation.setIdentity();
  position = end.point_m;
  if (end.node == team.world()) return true;
  const auto row = team.tracks[end.node].at(t_s);
  if (!row) return false;
  rotation = row->rotation.toRotationMatrix();
  position = row->position_m + rotation * end.point_m;
  return true;
}

}  // namespace

LinkLikelihood::LinkLikelihood(const TeamLinks& team, const LinkWindow& window, double alignment_sigma_m)
    : is_planar_(team.is_planar) {
  for (const std::size_t k : window.links) add(team, window, team.links[k], alignment_sigma_m);
  std::vector<double> ranges{kMinRangeSpan_m};
  for (const LinkSample& sample : samples_)
    if (!sample.is_angle) ranges.push_back(sample.range_m);
  std::sort(ranges.begin(), ranges.end());
  range_span_m_ = std::max(kMinRangeSpan_m, 1.5 * ranges[ranges.size() * 9 / 10]);
}

void LinkLikelihood::add(const TeamLinks& team, const LinkWindow& window, const TrackLink& link,
                         double alignment_sigma_m) {
  const bool a_is_i = link.a.node == window.i;
  const auto& [end_i, end_j] = a_is_i ? std::pair(link.a, link.b) : std::pair(link.b, link.a);
  LinkSample sample;
  Eigen::Matrix3d R_i, R_j;
  if (!place(team, end_i, link.t_s, sample.p_i, R_i) || !place(team, end_j, link.t_s, sample.p_j, R_j)) {
    ++unplaced_;
    return;
  }
  sample.is_angle = link.kind == TrackLink::Kind::kAngle;
  sample.is_fix = link.kind == TrackLink::Kind::kFix;
  sample.receiver_is_i = a_is_i;
  sample.R_receiver = a_is_i ? R_i : R_j;
  sample.range_m = link.range_m;
  sample.own_sigma = link.sigma;
  sample.height_m = link.height_m;
  const double floor = sample.is_angle
                           ? kAngleFloor_rad
                           : std::hypot(kRangeFloor_m, kDriftRatio * window.path_m / 2, alignment_sigma_m);
  sample.sigma = std::hypot(link.sigma, floor);
  for (const AoaPath& path : link.paths) sample.azimuths_rad.push_back(path.azimuth_rad);
  samples_.push_back(std::move(sample));
}

LinkLikelihood::Motion::Motion(const Alignment& T)
    : translation_m(T.head<3>()), cosine(std::cos(T(3))), sine(std::sin(T(3))) {}

/// From i's end to j's, in the frame of node i.
Eigen::Vector3d LinkLikelihood::direction(const LinkSample& sample, const Motion& T) const {
  const Eigen::Vector3d &p = sample.p_j, &t = T.translation_m;
  Eigen::Vector3d d(T.cosine * p.x() - T.sine * p.y() + t.x(), T.sine * p.x() + T.cosine * p.y() + t.y(),
                    p.z() + t.z());
  d -= sample.p_i;
  if (is_planar_) d.z() = sample.height_m;
  return d;
}

double LinkLikelihood::residual(const LinkSample& sample, const Motion& T) const {
  const Eigen::Vector3d d = direction(sample, T);
  if (!sample.is_angle) return d.norm() - sample.range_m;
  Eigen::Vector3d to = d;
  if (!sample.receiver_is_i)
    to = -Eigen::Vector3d(T.cosine * d.x() + T.sine * d.y(), -T.sine * d.x() + T.cosine * d.y(), d.z());
  const Eigen::Vector3d in_body = sample.R_receiver.transpose() * to;
  const double azimuth_rad = std::atan2(in_body.y(), in_body.x());
  double nearest = std::numbers::pi;
  for (const double path_rad : sample.azimuths_rad) {
    const double difference = wrap_angle(azimuth_rad - path_rad);
    if (std::abs(difference) < std::abs(nearest)) nearest = difference;
  }
  return nearest;
}

double LinkLikelihood::inlier_density(const LinkSample& sample, double residual) const {
  const double paths = sample.is_angle ? static_cast<double>(sample.azimuths_rad.size()) : 1;
  return kInlierWeight / paths * normal_density(residual, sample.sigma);
}
double LinkLikelihood::outlier_density(const LinkSample& sample) const {
  return (1 - kInlierWeight) / (sample.is_angle ? 2 * std::numbers::pi : range_span_m_);
}

double LinkLikelihood::log_likelihood(const Alignment& T, std::size_t stride) const {
  const Motion motion(T);
  double sum = 0;
  for (std::size_t k = 0; k < samples_.size(); k += stride) {
    const LinkSample& sample = samples_[k];
    sum += std::log(inlier_density(sample, residual(sample, motion)) + outlier_density(sample));
  }
  return sum;
}

double LinkLikelihood::log_likelihood_of_unplaced() const {
  return static_cast<double>(unplaced_) * std::log((1 - kInlierWeight) / range_span_m_);
}

}  // namespace radioslam
