#include "radioslam/sim/sensors/radio_channel.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
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

struct Pair {
  std::size_t i = 0;
  std::size_t j = 0;
};

/// A random one from each of `count` equal parts of the times.
std::vector<Stamp> spread(const std::vector<Stamp>& times, std::size_t count, Rng rng) {
  count = std::min(count, times.size());
  std::vector<Stamp> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = times.size() * k / count;
    const std::size_t end = times.size() * (k + 1) / count;
    chosen.push_back(times[begin + rng.below(end - begin)]);
  }
  return chosen;
}

LinkEnd robot_end(std::size_t robot) {
  LinkEnd end;
  end.robot = RobotIndex(robot);
  return end;
}

/// Draws the links of one pair of robots.
class PairLinks {
 public:
  PairLinks(const std::vector<Trajectory<SE3>>& truth, Pair pair, int dimension,
            const RadioChannelParams& params, const Rng& rng)
      : truth_(truth), pair_(pair), dimension_(dimension), params_(params), rng_(rng) {
    if (params.mirror) walls_.emplace(truth[pair.i], params, rng.split("walls"));
  }

  void append_to(RadioLinks& links) const {
    const auto times =
        times_in_range(truth_[pair_.i], truth_[pair_.j], params_.radio_range_m, params_.time_offset_s);
    const AngleEnds ends = angle_ends(params_);
    const auto chosen = spread(times, static_cast<std::size_t>(params_.links), rng_.split("times"));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const Rng own = rng_.split("links").split(k);
      if (params_.ranges) links.ranges.push_back(range_at(chosen[k], own.split("range")));
      const Stamp later{chosen[k].ns + Stamp::from_seconds(params_.time_offset_s).ns};
      if (ends != AngleEnds::kNone) measure_angle(pair_, later, own.split("first"), links);
      if (ends == AngleEnds::kBoth) measure_angle({pair_.j, pair_.i}, later, own.split("second"), links);
    }
  }

 private:
  RangeMeasurement range_at(Stamp stamp, Rng rng) const {
    const Eigen::Vector3d offset =
        truth_[pair_.j].at(stamp)->translation() - truth_[pair_.i].at(stamp)->translation();
    RangeMeasurement range;
    range.stamp = stamp;
    range.i = robot_end(pair_.i);
    range.j = robot_end(pair_.j);
    range.range_m = std::max(0.0, rng.normal(offset.norm(), params_.sigma_range_m));
    range.sigma_m = params_.sigma_range_m;
    return range;
  }

  /// Adds the angle measurement of robot `ends.i` to the transmissions of robot `ends.j`.
  void measure_angle(Pair ends, Stamp stamp, const Rng& rng, RadioLinks& links) const {
    std::optional<Wall> wall;
    if (walls_) wall = walls_->at(stamp);
    DrawnPaths drawn = draw_paths(*truth_[ends.i].at(stamp), truth_[ends.j].at(stamp)->translation(), wall,
                                  dimension_, params_, rng);
    if (drawn.paths.empty()) return;
    links.aoa_measurements.push_back({stamp, RobotIndex(ends.i), robot_end(ends.j), std::move(drawn.paths)});
    links.direct_paths.emplace_back(drawn.direct);
  }

  const std::vector<Trajectory<SE3>>& truth_;
  Pair pair_;
  int dimension_;
  const RadioChannelParams& params_;
  Rng rng_;
  std::optional<MirrorWalls> walls_;
};

void sort_by_time(RadioLinks& links) {
  std::stable_sort(links.ranges.begin(), links.ranges.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  std::vector<std::size_t> order(links.aoa_measurements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return links.aoa_measurements[a].stamp < links.aoa_measurements[b].stamp;
  });
  RadioLinks sorted;
  for (const std::size_t k : order) {
    sorted.aoa_measurements.push_back(std::move(links.aoa_measurements[k]));
    sorted.direct_paths.push_back(links.direct_paths[k]);
  }
  links.aoa_measurements = std::move(sorted.aoa_measurements);
  links.direct_paths = std::move(sorted.direct_paths);
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

std::vector<Stamp> times_in_range(const Trajectory<SE3>& a, const Trajectory<SE3>& b, double within_m,
                                  double offset_s) {
  if (a.empty() || b.empty()) return {};
  const std::int64_t begin = std::max(a.front().stamp, b.front().stamp).ns;
  const std::int64_t end = std::min(a.back().stamp, b.back().stamp).ns - Stamp::from_seconds(offset_s).ns;
  const std::int64_t step = Stamp::from_seconds(kTimeInRangeStep_s).ns;
  std::vector<Stamp> times;
  for (std::int64_t ns = begin; ns <= end; ns += step)
    if ((a.at({ns})->translation() - b.at({ns})->translation()).norm() <= within_m) times.push_back({ns});
  return times;
}

RadioLinks simulate_links(const std::vector<Trajectory<SE3>>& truth, int dimension,
                          const RadioChannelParams& params, const Rng& rng) {
  RadioLinks links;
  for (std::size_t j = 1; j < truth.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      PairLinks(truth, {i, j}, dimension, params, rng.split(j).split(i)).append_to(links);
  sort_by_time(links);
  return links;
}

}  // namespace radioslam
