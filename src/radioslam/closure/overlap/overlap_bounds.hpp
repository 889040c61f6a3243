// Overlap tests for one pair of poses and for all pairs of two intervals of poses (boxes) at once.
//
// A pair (k, l) is kept if its distance (overlap_distance.hpp) over the nearest link is below D and, for
// sensors with a limited field of view, its views can overlap and share min_shared_view (overlap_view.hpp).
// The radius r of the distance is the sum of the ranges, or the distance beyond which the views share less.
//
// Box I of robot a against box J of robot b, with middle poses i and j and the covariance of j seen from i:
// for any unit vector u, every pair has
//   u^T dp >= s = u^T (c_J - c_I) - sum |u_n| (h_I + h_J)_n                                  (boxes: c +- h)
//   sqrt(u^T S_kl u) <= sqrt(u^T S_ij u) + R_J sigma_rot(ij) + sigma_J + sigma_I
//                       + (|dp_ij| + R_I + R_J) omega_I
// with R, sigma, omega the largest distance, position spread and rotation spread from the middle pose, by the
// triangle inequality for standard deviations on
//   eta_l - eta_k = (eta_j - eta_i) + (eta_l - eta_j) - (eta_k - eta_i)   seen at p_l.
// By duality d_min >= (s - r) / (the second bound), so the boxes are excluded if s - r > D times that bound.
// u is the normal that attains the middle pair's d_min: as boxes shrink the bound converges to the distance
// itself, also for elongated covariances. The gap between the boxes with the largest eigenvalue in place of
// u^T S u is tested too. Boxes whose farthest corners are within r are kept without evaluating covariances.
// (Wi-Closure (Wang et al.) eq. 4.13 omits the lever arms and is not conservative.)
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/closure/overlap/overlap_tree.hpp"
#include "radioslam/closure/overlap/overlap_view.hpp"

namespace radioslam {

/// Criterion for a pair: D, the two sensors, the kind of distance.
struct OverlapRule {
  double max_mahalanobis = 2;
  OverlapDistance distance = OverlapDistance::kMinimum;
  OverlapSensor a, b;
  double min_shared_view = 0;

  /// r; nothing if the views never share enough.
  std::optional<double> radius_m() const { return max_distance_of_shared_view(a, b, min_shared_view); }
  bool all_round() const { return std::min(a.view_rad, b.view_rad) >= 2 * std::numbers::pi; }
};

inline OverlapRule overlap_rule(const OverlapParams& params, const OverlapSensor& a, const OverlapSensor& b) {
  return {params.max_mahalanobis, overlap_distance(params), a, b, params.min_shared_view};
}

/// Bounds over one link for all pairs of two boxes.
template <class Pose>
struct LinkBound {
  enum class State : std::uint8_t {
    kOpen,     ///< some pair may pass
    kInside,   ///< every pair passes, at distance 0
    kOutside,  ///< no pair passes
  };
  std::uint32_t tie = 0;
  State state = State::kOpen;
  typename Pose::Point normal = Pose::Point::Zero();  ///< u; zero: no bound was computed
  double sigma_m = 0;  ///< upper bound of every pair's standard deviation along u
};

enum class BoxStatus { kOutside, kInside, kSplitA, kSplitB, kCompare };

template <OverlapView View>
class OverlapTest {
 public:
  using Pose = typename View::Pose;
  using Point = typename Pose::Point;
  using Record = typename View::Record;
  using Node = OverlapNode<Pose>;
  using Bound = LinkBound<Pose>;
  struct Box {
    const Node& node;
    const Record& middle;
  };
  struct Overlap {
    double distance_m = 0, mahalanobis = 0;
  };

  OverlapTest(const View& view, const OverlapRule& rule)
      : view_(view),
        rule_(rule),
        is_attainable_(rule.radius_m().has_value()),
        radius_m_(rule.radius_m().value_or(0)) {}

  const View& view() const { return view_; }

  /// Distances of a pair that is kept; nothing otherwise.
  std::optional<Overlap> pair(std::size_t tie, const Record& k, const Record& l) const {
    if (!is_attainable_) return std::nullopt;
    const double distance_m = difference(tie, k, l).norm();
    if (rule_.all_round() && distance_m <= radius_m_) return Overlap{distance_m, 0};
    const RelativePosition<Pose> place = view_.relative(tie, k, l);
    const double mahalanobis = distance(place);
    if (!(mahalanobis < rule_.max_mahalanobis)) return std::nullopt;
    if (!rule_.all_round() && !views_can_overlap(tie, k, l, place)) return std::nullopt;
    return Overlap{distance_m, mahalanobis};
  }

  /// Adds pair (k, l) to `out` if it is kept; `bounds` must include all links that can be nearest.
  void compare(OverlapCandidate pair_of, const Record& k, const Record& l, std::span<const Bound> bounds,
               OverlapCandidates& out) const {
    const Bound& tie = nearest(bounds, k, l);
    if (tie.state == Bound::State::kOutside || is_excluded(tie, difference(tie.tie, k, l))) return;
    ++out.counts.distances_evaluated;
    const auto overlap = pair(tie.tie, k, l);
    if (!overlap) return;
    pair_of.distance_m = overlap->distance_m;
    pair_of.mahalanobis = overlap->mahalanobis;
    out.candidates.push_back(pair_of);
    ++out.counts.kept;
  }

  Point difference(std::size_t tie, const Record& k, const Record& l) const {
    return view_.in_a(tie, l.position_m) - k.position_m;
  }

  /// The link with the shortest path between two poses, the first among equals.
  const Bound& nearest(std::span<const Bound> bounds, const Record& k, const Record& l) const {
    const Bound* best = &bounds[0];
    if (bounds.size() == 1) return *best;
    double least = path_m(best->tie, k, l);
    for (const Bound& bound : bounds.subspan(1)) {
      const double length = path_m(bound.tie, k, l);
      if (length < least) least = length, best = &bound;
    }
    return *best;
  }

  /// Selects from `from` the links that can be nearest for some pair of the boxes, and appends their bounds
  /// to `to`.
  BoxStatus box(const Box& I, const Box& J, std::span<const Bound> from, std::vector<Bound>& to,
                OverlapCounts& counts) const {
    ++counts.boxes_visited;
    if (!is_attainable_) return BoxStatus::kOutside;
    const std::size_t first = to.size();
    keep_near(I.node, J.node, from, to);
    const bool at_leaves = I.node.leaf() && J.node.leaf();
    bool all_inside = true, all_outside = true;
    for (std::size_t t = first; t < to.size(); ++t) {
      if (to[t].state == Bound::State::kOpen) compute_bound(I, J, at_leaves, to[t], counts);
      all_inside = all_inside && to[t].state == Bound::State::kInside;
      all_outside = all_outside && to[t].state == Bound::State::kOutside;
    }
    if (all_outside) return BoxStatus::kOutside;
    if (all_inside) return BoxStatus::kInside;
    if (at_leaves) return BoxStatus::kCompare;
    if (J.node.leaf()) return BoxStatus::kSplitA;
    if (I.node.leaf()) return BoxStatus::kSplitB;
    return I.node.radius_m >= J.node.radius_m ? BoxStatus::kSplitA : BoxStatus::kSplitB;
  }

  /// Whether a box's bound alone excludes the pair.
  bool is_excluded(const Bound& bound, const Point& difference_m) const {
    return bound.normal.dot(difference_m) - radius_m_ > reach(bound.sigma_m);
  }

 private:
  /// Margin for rounding of positions: coordinates are below 1e6 m, with an ulp of 1e-10 m.
  static constexpr double kRounding_m = 1e-8;
  static constexpr double kRoundingRatio = 1e-9;

  double reach(double sigma_m) const {
    return rule_.max_mahalanobis * sigma_m * (1 + kRoundingRatio) + kRounding_m;
  }

  double path_m(std::size_t tie, const Record& k, const Record& l) const {
    return std::abs(k.travelled_m - view_.link_travelled_a(tie)) +
           std::abs(l.travelled_m - view_.link_travelled_b(tie));
  }

  double distance(const RelativePosition<Pose>& place) const {
    constexpr int kDim = Pose::kDim;
    const Eigen::Matrix<double, kDim, kDim> covariance = position_block<Pose>(place.covariance);
    if (rule_.distance == OverlapDistance::kLineOfSight)
      return line_of_sight_distance<kDim>(place.difference_m, covariance, radius_m_);
    return minimum_distance<kDim>(place.difference_m, covariance, radius_m_).mahalanobis;
  }

  ViewSector sector_a(const Record& k, double widening_rad) const {
    return {k.position_m.template head<2>(), k.heading_rad, rule_.a.view_rad / 2 + widening_rad,
            rule_.a.range_m};
  }
  ViewSector sector_b(std::size_t tie, const Record& l, double widening_rad) const {
    return {view_.in_a(tie, l.position_m).template head<2>(), view_.turn_in_a(tie) + l.heading_rad,
            rule_.b.view_rad / 2 + widening_rad, rule_.b.range_m};
  }

  /// Largest standard deviation in the horizontal plane.
  static double horizontal_sigma(const typename Pose::Jacobian& c) {
    const double half_trace = (c(0, 0) + c(1, 1)) / 2;
    return std::sqrt(std::max(0.0, half_trace + std::hypot((c(0, 0) - c(1, 1)) / 2, c(0, 1))));
  }

  bool views_can_overlap(std::size_t tie, const Record& k, const Record& l,
                         const RelativePosition<Pose>& place) const {
    const double D = rule_.max_mahalanobis;
    const double yaw_variance = place.covariance(Pose::kDof - 1, Pose::kDof - 1);
    const double turn_rad = D * std::sqrt(std::max(0.0, yaw_variance));
    const double offset_m = D * horizontal_sigma(place.covariance);
    const ViewSector of_k = sector_a(k, 0);
    const bool can_touch = sector_distance(of_k, sector_b(tie, l, turn_rad)) <= offset_m;
    if (!can_touch || rule_.min_shared_view <= 0) return can_touch;
    return can_share_view(of_k, sector_b(tie, l, 0), offset_m, turn_rad, rule_.min_shared_view);
  }

  /// Drops links for which another one is nearer for every pair of the boxes.
  void keep_near(const Node& I, const Node& J, std::span<const Bound> from, std::vector<Bound>& to) const {
    double least_longest = std::numeric_limits<double>::infinity();
    const auto longest = [](double low, double high, double at) {
      return std::max(std::abs(low - at), std::abs(high - at));
    };
    const auto shortest = [](double low, double high, double at) {
      return at < low ? std::abs(low - at) : at > high ? std::abs(high - at) : 0.0;
    };
    if (from.size() > 1)
      for (const Bound& bound : from)
        least_longest =
            std::min(least_longest,
                     longest(I.min_travelled_m, I.max_travelled_m, view_.link_travelled_a(bound.tie)) +
                         longest(J.min_travelled_m, J.max_travelled_m, view_.link_travelled_b(bound.tie)));
    for (const Bound& bound : from) {
      if (from.size() > 1 &&
          shortest(I.min_travelled_m, I.max_travelled_m, view_.link_travelled_a(bound.tie)) +
                  shortest(J.min_travelled_m, J.max_travelled_m, view_.link_travelled_b(bound.tie)) >
              least_longest)
        continue;
      const bool is_outside = bound.state == Bound::State::kOutside;
      to.push_back({bound.tie, is_outside ? Bound::State::kOutside : Bound::State::kOpen, Point::Zero(), 0});
    }
  }

  void compute_bound(const Box& I, const Box& J, bool at_leaves, Bound& bound, OverlapCounts& counts) const {
    const Point between = view_.in_a(bound.tie, J.node.centre_m) - I.node.centre_m;
    const Point half = I.node.half_extent_m + view_.half_extent_in_a(bound.tie, J.node.half_extent_m);
    const double gap = (between.cwiseAbs() - half).cwiseMax(0.0).norm();
    if (rule_.all_round()) {
      if ((between.cwiseAbs() + half).norm() + kRounding_m <= radius_m_) {
        bound.state = Bound::State::kInside;
        return;
      }
      if (gap <= radius_m_ && !at_leaves) return;
    }
    ++counts.distances_evaluated;
    const RelativePosition<Pose> place = view_.relative(bound.tie, I.middle, J.middle);
    const double slack = spread_slack(I.node, J.node, place);
    set_normal(place, slack, bound);
    const double along = bound.normal.dot(between) - bound.normal.cwiseAbs().dot(half);
    const double sigma_m = sigma_bound(position_block<Pose>(place.covariance)) + slack;
    if (along - radius_m_ > reach(bound.sigma_m) || gap - radius_m_ > reach(sigma_m) ||
        (!rule_.all_round() && !box_views_can_overlap(I, J, bound.tie, place, sigma_m)))
      bound.state = Bound::State::kOutside;
  }

  /// Upper bound of how much a pair's standard deviation in any direction exceeds the middle pair's.
  static double spread_slack(const Node& I, const Node& J, const RelativePosition<Pose>& place) {
    const double lever = place.difference_m.norm() + I.radius_m + J.radius_m;
    return J.radius_m * sigma_bound(rotation_block<Pose>(place.covariance)) + J.spread.sigma_m +
           I.spread.sigma_m + lever * I.spread.sigma_rad;
  }

  void set_normal(const RelativePosition<Pose>& place, double slack, Bound& bound) const {
    constexpr int kDim = Pose::kDim;
    const Eigen::Matrix<double, kDim, kDim> covariance = position_block<Pose>(place.covariance);
    bound.normal = minimum_distance<kDim>(place.difference_m, covariance, radius_m_).normal;
    if (bound.normal.isZero(0)) bound.normal = place.difference_m.stableNormalized();
    bound.sigma_m = std::sqrt(std::max(0.0, bound.normal.dot(covariance * bound.normal))) + slack;
  }

  /// Whether views of the boxes can touch; how much they share is left to their pairs.
  bool box_views_can_overlap(const Box& I, const Box& J, std::size_t tie, const RelativePosition<Pose>& place,
                             double sigma_m) const {
    const double sigma_rad = sigma_bound(rotation_block<Pose>(place.covariance)) + I.node.spread.sigma_rad +
                             J.node.spread.sigma_rad;
    const ViewSector of_I = sector_a(I.middle, I.node.heading_spread_rad + kRoundingRatio);
    const ViewSector of_J =
        sector_b(tie, J.middle, J.node.heading_spread_rad + reach(sigma_rad) + kRoundingRatio);
    return sector_distance(of_I, of_J) <= I.node.radius_m + J.node.radius_m + reach(sigma_m);
  }

  const View& view_;
  OverlapRule rule_;
  bool is_attainable_;  ///< whether any two poses' views share enough
  double radius_m_;
};

}  // namespace radioslam
