#include "radioslam/sim/sensors/arrival_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {
namespace {

struct LabelledPath {
  AoaPath path;
  bool direct = false;
};

/// Direction of a point in the body frame, with noise.
AoaPath towards(const Eigen::Vector3d& point_in_body, int dimension, double sigma_rad, Rng& rng) {
  AoaPath path;
  const double level = std::max(point_in_body.head<2>().norm(), 1e-9);  // straight above: any azimuth
  const double elevation = std::atan2(point_in_body.z(), level);
  const double across = rng.normal(0, sigma_rad);
  const double up = rng.normal(0, sigma_rad);
  const double azimuth_scale = dimension == 2 ? 1 : point_in_body.norm() / level;  // 1 / cos(elevation)
  path.azimuth_rad = wrap_angle(std::atan2(point_in_body.y(), point_in_body.x()) + across * azimuth_scale);
  if (dimension == 3) path.elevation_rad = elevation + up;
  path.sigma_rad = sigma_rad;
  return path;
}

AoaPath from_anywhere(int dimension, const RadioChannelParams& params, Rng& rng) {
  AoaPath path;
  path.azimuth_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
  const double elevation = radians(params.false_elevation_deg) * rng.uniform(-1, 1);
  if (dimension == 3) path.elevation_rad = elevation;
  path.sigma_rad = radians(params.sigma_angle_deg);
  return path;
}

/// Uniform over the allowed numbers; a maximum below the minimum counts as the minimum.
int draw_count(const RadioChannelParams& params, Rng& rng) {
  const int most = std::max(params.min_false_paths, params.max_false_paths);
  return params.min_false_paths +
         static_cast<int>(rng.below(static_cast<std::uint64_t>(most - params.min_false_paths) + 1));
}

}  // namespace

MirrorWalls::MirrorWalls(const Trajectory<SE3>& truth, const RadioChannelParams& params, const Rng& rng) {
  std::size_t begin = 0;
  double path_m = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    path_m += (truth[i].pose.translation() - truth[i - 1].pose.translation()).norm();
    if (path_m < params.mirror_section_m && i + 1 < truth.size()) continue;
    Rng own = rng.split(walls_.size());
    const Eigen::Vector3d from = truth[begin].pose.translation();
    Eigen::Vector3d along = truth[i].pose.translation() - from;
    along.z() = 0;
    if (along.norm() < 1e-9) along = truth[begin].pose.rotate(Eigen::Vector3d::UnitX());
    along.normalize();
    const double side = own.uniform() < 0.5 ? -1 : 1;
    const Eigen::Vector3d normal(-side * along.y(), side * along.x(), 0);
    begins_.push_back(truth[begin].stamp);
    walls_.push_back({from + params.mirror_distance_m * normal, normal});
    begin = i;
    path_m = 0;
  }
  if (walls_.empty()) walls_.emplace_back();
}

const Wall& MirrorWalls::at(Stamp stamp) const {
  const auto after = std::upper_bound(begins_.begin(), begins_.end(), stamp);
  return walls_[after == begins_.begin() ? 0 : static_cast<std::size_t>(after - begins_.begin() - 1)];
}

DrawnPaths draw_paths(const SE3& T_common_receiver, const Eigen::Vector3d& transmitter,
                      const std::optional<Wall>& wall, int dimension, const RadioChannelParams& params,
                      const Rng& rng) {
  const SE3 T_receiver_common = T_common_receiver.inverse();
  const double sigma_rad = radians(params.sigma_angle_deg);
  std::vector<LabelledPath> drawn;
  const auto add = [&](const AoaPath& path, bool direct, double mean_power_db, Rng& own) {
    drawn.push_back({path, direct});
    drawn.back().path.power_db = own.normal(mean_power_db, params.sigma_power_db);
  };
  Rng direct = rng.split("direct");
  const bool missing = direct.uniform() < params.missing_direct_ratio;
  const AoaPath path = towards(T_receiver_common * transmitter, dimension, sigma_rad, direct);
  if (!missing) add(path, true, 0, direct);
  Rng image = rng.split("mirror");
  if (wall)
    add(towards(T_receiver_common * wall->image(transmitter), dimension, sigma_rad, image), false,
        params.mirror_power_db, image);
  Rng anywhere = rng.split("anywhere");
  for (int left = draw_count(params, anywhere); left > 0; --left) {
    const AoaPath false_path = from_anywhere(dimension, params, anywhere);
    add(false_path, false, params.false_power_db, anywhere);
  }

  std::stable_sort(drawn.begin(), drawn.end(), [](const LabelledPath& a, const LabelledPath& b) {
    return a.path.power_db > b.path.power_db;
  });
  DrawnPaths result;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    if (drawn[k].direct) result.direct = static_cast<int>(k);
    result.paths.push_back(drawn[k].path);
  }
  return result;
}

}  // namespace radioslam
