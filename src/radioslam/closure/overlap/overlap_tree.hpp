// Binary tree of intervals over a robot's poses, with what the search needs to bound a whole interval by its
// middle pose: the bounding box of positions, their largest distance from the middle, their uncertainty
// relative to it, the range of headings and of path lengths. Up to kSummed poses, the spread of an interval
// is the maximum over its poses; above, it is bounded from its halves:
//   sigma(k | m) <= sigma(k | m_half) + sigma(m_half | m) + |p_k - p_m_half| sigma_rad(m_half | m).
// Cost: O(n log kSummed) spreads.
#pragma once

#include <cmath>
#include <cstdint>

#include "radioslam/closure/overlap/overlap_relative.hpp"

namespace radioslam {

template <class Pose>
struct OverlapNode {
  std::uint32_t begin = 0, end = 0, middle = 0;  ///< poses [begin, end) and the reference pose
  std::uint32_t right = 0;  ///< node of the second half; the first half's is the next one; 0: a leaf
  typename Pose::Point centre_m, half_extent_m;  ///< bounding box of the positions
  double radius_m = 0;                           ///< largest distance from the middle pose
  PoseSpread spread;                             ///< largest of any pose relative to the middle
  double heading_spread_rad = 0;                 ///< largest difference from the middle's heading
  double min_travelled_m = 0, max_travelled_m = 0;

  bool leaf() const { return right == 0; }
  std::uint32_t size() const { return end - begin; }
};

template <class Pose>
struct OverlapTree {
  struct Root {
    std::uint32_t node = 0;
    std::uint32_t component = 0;  ///< of its interval: OverlapPoses
  };
  std::vector<OverlapNode<Pose>> nodes;
  std::vector<Root> roots;
};

template <OverlapPoses Poses>
class OverlapTreeBuilder {
  using Pose = typename Poses::View::Pose;
  using Point = typename Pose::Point;
  using Node = OverlapNode<Pose>;

  /// Poses per leaf: small leaves give tighter bounds, large ones fewer nodes.
  static constexpr std::size_t kLeaf = 4;
  static constexpr std::size_t kSummed = 32;

 public:
  explicit OverlapTreeBuilder(const Poses& poses) : poses_(poses) {}

  OverlapTree<Pose> build() { return build({0, poses_.records().size()}); }
  /// Of these poses alone.
  OverlapTree<Pose> build(const PoseInterval& run) {
    tree_ = {};
    const auto& pieces = poses_.pieces();
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
      const PoseInterval poses = common(pieces[p], run);
      if (poses.size() > 0) tree_.roots.push_back({build_node(poses), poses_.component(p)});
    }
    return std::move(tree_);
  }

 private:
  std::uint32_t build_node(const PoseInterval& poses) {
    const auto at = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const std::size_t middle = poses.begin + poses.size() / 2;
    std::uint32_t right = 0;
    if (poses.size() > kLeaf) {
      build_node({poses.begin, middle});
      right = build_node({middle, poses.end});
    }
    Node node;
    node.begin = static_cast<std::uint32_t>(poses.begin);
    node.end = static_cast<std::uint32_t>(poses.end);
    node.middle = static_cast<std::uint32_t>(middle);
    node.right = right;
    if (poses.size() <= kSummed)
      sum_poses(node);
    else
      join_halves(node, tree_.nodes[at + 1], tree_.nodes[right]);
    tree_.nodes[at] = node;
    return at;
  }

  void sum_poses(Node& node) const {
    const auto& records = poses_.records();
    const auto& middle = records[node.middle];
    Point low = middle.position_m, high = low;
    node.min_travelled_m = node.max_travelled_m = middle.travelled_m;
    for (std::size_t k = node.begin; k < node.end; ++k) {
      const Point& p = records[k].position_m;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      node.min_travelled_m = std::min(node.min_travelled_m, records[k].travelled_m);
      node.max_travelled_m = std::max(node.max_travelled_m, records[k].travelled_m);
      node.radius_m = std::max(node.radius_m, (p - middle.position_m).norm());
      node.spread.widen(poses_.spread(k, node.middle));
      node.heading_spread_rad = std::max(node.heading_spread_rad,
                                         std::abs(wrap_angle(records[k].heading_rad - middle.heading_rad)));
    }
    set_box(node, low, high);
  }

  void join_halves(Node& node, const Node& first, const Node& second) const {
    const auto& records = poses_.records();
    const auto& middle = records[node.middle];
    node.min_travelled_m = std::min(first.min_travelled_m, second.min_travelled_m);
    node.max_travelled_m = std::max(first.max_travelled_m, second.max_travelled_m);
    for (const Node* half : {&first, &second}) {
      const auto& of_half = records[half->middle];
      const PoseSpread s = poses_.spread(half->middle, node.middle);
      node.spread.widen({half->spread.sigma_m + s.sigma_m + half->radius_m * s.sigma_rad,
                         half->spread.sigma_rad + s.sigma_rad});
      const double distance_m = (of_half.position_m - middle.position_m).norm();
      node.radius_m = std::max(node.radius_m, distance_m + half->radius_m);
      const double turn = std::abs(wrap_angle(of_half.heading_rad - middle.heading_rad));
      node.heading_spread_rad = std::max(node.heading_spread_rad, turn + half->heading_spread_rad);
    }
    set_box(node, (first.centre_m - first.half_extent_m).cwiseMin(second.centre_m - second.half_extent_m),
            (first.centre_m + first.half_extent_m).cwiseMax(second.centre_m + second.half_extent_m));
    const Point corner = (middle.position_m - node.centre_m).cwiseAbs() + node.half_extent_m;
    node.radius_m = std::min(node.radius_m, corner.norm());
  }

  static void set_box(Node& node, const Point& low, const Point& high) {
    node.centre_m = (low + high) / 2;
    node.half_extent_m = (high - low) / 2;
  }

  const Poses& poses_;
  OverlapTree<Pose> tree_;
};

}  // namespace radioslam
