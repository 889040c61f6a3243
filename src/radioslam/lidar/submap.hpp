// A local map that no longer changes, laid out for many searches of scans on it.
#pragma once

#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/overlap_field.hpp"
#include "radioslam/lidar/surfels/surfel_columns.hpp"

namespace radioslam {

class Submap {
 public:
  explicit Submap(const LocalMap& map)
      : fine_(map.fine().surfels(), map.fine().max_distance_m()),
        coarse_(map.coarse().surfels(), map.coarse().max_distance_m()),
        overlap_(coarse_.surfels(), coarse_.max_distance_m()) {}

  const SurfelColumns& fine() const { return fine_; }
  const SurfelColumns& coarse() const { return coarse_; }
  const OverlapField& overlap() const { return overlap_; }
  std::size_t bytes() const { return sizeof(Submap) + fine_.bytes() + coarse_.bytes() + overlap_.bytes(); }

 private:
  SurfelColumns fine_, coarse_;
  OverlapField overlap_;
};

}  // namespace radioslam
