// Nearest neighbours in a fixed set of points (nanoflann's k-d tree).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nanoflann.hpp>
#include <vector>

namespace radioslam {

/// Refers to `points`, which must outlive it unchanged.
class PointTree {
 public:
  explicit PointTree(const std::vector<Eigen::Vector3f>& points)
      : points_{points}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
    tree_.buildIndex();
  }
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  /// Writes the indices and squared distances of the `count` points nearest to `at`, nearest first; returns
  /// how many were found.
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
