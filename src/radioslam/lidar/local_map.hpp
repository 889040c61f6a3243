// What a scan is laid onto: surfels close together, found nearby, and the same thinner, found from afar.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/surfel.hpp"
#include "radioslam/lidar/surfel_map.hpp"

namespace radioslam {

struct LocalMapParams {
  double source_spacings = 2;         ///< a scan is registered by points so far apart
  double reach_spacings = 3;          ///< no point meets a surface farther than this
  double coarse_spacings = 3;         ///< of a first alignment where the start may be far off
  double coarse_reach_spacings = 12;  ///< and its reach
  double memory_m = 30;
  double correlation_share = 0.12;  ///< of the median range: points closer together err together

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"source_spacings", "", 1, 10, "a scan is registered by points so many spacings apart"},
          self.source_spacings);
    visit(Field{"reach_spacings", "", 1, 10, "no point meets a surface farther than this"},
          self.reach_spacings);
    visit(Field{"coarse_spacings", "", 1, 100, "spacing of a first alignment where the start may be far off"},
          self.coarse_spacings);
    visit(Field{"coarse_reach_spacings", "", 1, 100, "and its reach"}, self.coarse_reach_spacings);
    visit(Field{"memory_m", "m", 1, 1e6, "what was out of sight for so long a way is forgotten"},
          self.memory_m);
    visit(
        Field{"correlation_share", "", 1e-3, 10, "of the median range: points closer together err together"},
        self.correlation_share);
  }
};

/// A scan's surfels in its body frame, ever fewer of them.
struct ScanCloud {
  std::vector<Surfel> all;  ///< at the map's spacing
  SurfelSource source;      ///< what is registered
  SurfelSource few;         ///< for a first alignment
  double median_range_m = 0;
};

ScanCloud scan_cloud(std::vector<Surfel> surfels, double spacing_m, ScannerKind kind,
                     const LocalMapParams& params);

/// The surfels in the frame that `T` takes them to.
std::vector<Surfel> transformed(const SE3& T, const std::vector<Surfel>& surfels);

class LocalMap {
 public:
  LocalMap(double spacing_m, const LocalMapParams& params);

  bool empty() const { return fine_.empty(); }
  const SurfelMap& fine() const { return fine_; }
  const SurfelMap& coarse() const { return coarse_; }

  /// A scan from this pose, `way_m` metres into the way; what lies too far back is forgotten. Returns
  /// which share of the scan is new.
  double add(const ScanCloud& cloud, const SE3& T_map_body, double way_m);

 private:
  double memory_m_;
  SurfelMap fine_, coarse_;
};

}  // namespace radioslam
