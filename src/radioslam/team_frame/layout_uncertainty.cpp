#include "radioslam/team_frame/layout_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr int kReweightings = 20;
constexpr double kLeastSpread_m = 1;  // of the nodes that fit, below which all count alike

Eigen::Matrix2Xd nodes_of(const RigidBody& body, const Eigen::Matrix2Xd& positions) {
  return positions.middleCols(static_cast<Eigen::Index>(body.first_node), body.points.cols());
}

Eigen::Vector2d centre_of(const RigidBody& body) {
  return body.T_layout_body * Eigen::Vector2d(body.points.rowwise().mean());
}

/// Bodies of one group that have points.
struct Group {
  std::vector<std::size_t> bodies;
  std::vector<Eigen::Index> nodes;
  bool is_fixed = false;
};

std::vector<Group> groups_of(const std::vector<RigidBody>& layout, const std::vector<std::size_t>& group_of) {
  std::map<std::size_t, Group> groups;
  for (std::size_t b = 0; b < layout.size(); ++b) {
    if (layout[b].points.cols() == 0) continue;
    Group& group = groups[group_of[b]];
    group.bodies.push_back(b);
    group.is_fixed = group.is_fixed || layout[b].fixed;
    for (Eigen::Index i = 0; i < layout[b].points.cols(); ++i)
      group.nodes.push_back(static_cast<Eigen::Index>(layout[b].first_node) + i);
  }
  std::vector<Group> result;
  for (auto& [number, group] : groups) result.push_back(std::move(group));
  return result;
}

/// Rigid motion of `source` onto `target` by most of the points, whatever the others do.
SE2 align_most(const Eigen::Matrix2Xd& source, const Eigen::Matrix2Xd& target) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(source.cols());
  SE2 T;
  for (int k = 0; k < kReweightings; ++k) {
    T = align_points(source, target, weights);
    std::vector<double> squares;
    for (Eigen::Index i = 0; i < source.cols(); ++i)
      squares.push_back((T * Eigen::Vector2d(source.col(i)) - target.col(i)).squaredNorm());
    const double scale = std::max(kLeastSpread_m * kLeastSpread_m, upper_median(squares));
    for (Eigen::Index i = 0; i < source.cols(); ++i)
      weights[i] = 1 / (1 + squares[static_cast<std::size_t>(i)] / scale);
  }
  return T;
}

void add_moves(const Group& group, const std::vector<RigidBody>& layout, const std::vector<RigidBody>& other,
               std::vector<double>& moves_m) {
  SE2 T_layout_other;
  if (!group.is_fixed)
    T_layout_other = align_most(Eigen::Matrix2Xd(node_positions(other)(Eigen::all, group.nodes)),
                                Eigen::Matrix2Xd(node_positions(layout)(Eigen::all, group.nodes)));
  for (const std::size_t b : group.bodies)
    moves_m[b] = (T_layout_other * centre_of(other[b]) - centre_of(layout[b])).norm();
}

/// Mean of squared displacements over layouts by halves, of the two mirror images the one that fits better.
void add_mean_squares(const Group& group, const std::vector<RigidBody>& layout,
                      const std::vector<std::vector<Layout>>& by_halves, std::vector<double>& squares_m2) {
  for (const std::vector<Layout>& images : by_halves) {
    std::vector<double> nearest(layout.size(), 0);
    double least = std::numeric_limits<double>::infinity();
    for (const Layout& image : images) {
      std::vector<double> moves(layout.size(), 0), of_free;
      add_moves(group, layout, image.bodies, moves);
      for (const std::size_t b : group.bodies)
        if (!layout[b].fixed) of_free.push_back(moves[b]);
      if (of_free.empty()) continue;
      if (const double median = upper_median(of_free); median < least) {
        least = median;
        nearest = std::move(moves);
      }
    }
    for (const std::size_t b : group.bodies)
      squares_m2[b] += nearest[b] * nearest[b] / static_cast<double>(by_halves.size());
  }
}

/// By how much every body's centre lies further from the group's than the body reaches.
void add_beyond(const Group& group, const std::vector<RigidBody>& layout, std::vector<double>& beyond_m) {
  const Eigen::Matrix2Xd positions = node_positions(layout);
  const Eigen::Vector2d middle = positions(Eigen::all, group.nodes).rowwise().mean();
  for (const std::size_t b : group.bodies) {
    const Eigen::Vector2d centre = centre_of(layout[b]);
    const double reach = (nodes_of(layout[b], positions).colwise() - centre).colwise().norm().maxCoeff();
    beyond_m[b] = std::max(0.0, (centre - middle).norm() - reach);
  }
}

}  // namespace

std::vector<bool> second_half(const std::vector<std::string>& bssids) {
  std::vector<bool> second;
  std::string_view box;
  bool is_second = true;
  for (const std::string& bssid : bssids) {
    const std::string_view mine = std::string_view(bssid).substr(0, bssid.empty() ? 0 : bssid.size() - 1);
    if (second.empty() || mine != box) is_second = !is_second;
    box = mine;
    second.push_back(is_second);
  }
  return second;
}

std::vector<double> centre_moves_m(const std::vector<RigidBody>& layout, const std::vector<RigidBody>& other,
                                   const std::vector<std::size_t>& group_of) {
  RADIOSLAM_CHECK(other.size() == layout.size() && group_of.size() == layout.size(), "of the same bodies");
  std::vector<double> moves(layout.size(), 0);
  for (const Group& group : groups_of(layout, group_of)) add_moves(group, layout, other, moves);
  return moves;
}

std::vector<double> layout_sigmas_m(const std::vector<RigidBody>& layout,
                                    const std::vector<std::vector<Layout>>& by_halves,
                                    const std::vector<AlternativeLayout>& alternatives,
                                    const std::vector<std::size_t>& group_of, const LayoutParams& params) {
  std::vector<double> squares(layout.size(), 0), beyond(layout.size(), 0), alternative(layout.size(), 0);
  double weights = 1;
  for (const AlternativeLayout& other : alternatives) weights += other.weight;
  for (const AlternativeLayout& other : alternatives)
    for (std::size_t b = 0; b < layout.size(); ++b)
      alternative[b] += other.weight / weights * other.moves_m[b] * other.moves_m[b] / 2;
  const double held_m = 2 * params.sigma_m;
  std::vector<double> sigmas(layout.size(), 0);
  for (const Group& group : groups_of(layout, group_of)) {
    if (group.bodies.size() < 2) continue;
    add_mean_squares(group, layout, by_halves, squares);
    add_beyond(group, layout, beyond);
    for (const std::size_t b : group.bodies)
      if (!layout[b].fixed)
        sigmas[b] = std::sqrt(std::max(0.0, squares[b] - held_m * held_m) +
                              std::pow(params.sigma_size * beyond[b], 2) + alternative[b]);
  }
  return sigmas;
}

}  // namespace radioslam
