// The nearest of a fixed set of points: nanoflann's k-d tree.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nanoflann.hpp>
#include <vector>

namespace radioslam {

/// Looks at `points`, which must outlive it and stay as they are.
class PointTree {
 public:
  explicit PointTree(const std::vector<Eigen::Vector3f>& points)
      : points_{points}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
    tree_.buildIndex();
  }
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  /// The indices and squared distances of up to `count` points nearest to `at`, nearest first; returns how
  /// many there are.
  std::size_t nearest(const Eigen::Vector3f& at, std::size_t count, std::size_t* indices,
                      float* squared_distances) const {
    nanoflann::KNNResultSet<float, std::size_t> result(count);
    result.init(indices, squared_distances);
    tree_.findNeighbors(result, at.data(), nanoflann::SearchParams());
    return result.size();
  }

 private:
  static constexpr std::size_t kLeafSize = 16;

  struct Dataset {
    const std::vector<Eigen::Vector3f>& points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t k, std::size_t axis) const {
      return points[k][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };

  Dataset points_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Dataset>, Dataset, 3, std::size_t>
      tree_;
};

}  // namespace radioslam
