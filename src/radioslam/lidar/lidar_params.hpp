// How scans are laid onto each other: what scan_odometry.hpp and scanner_traits.hpp need to know beforehand.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/scan_order.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfel.hpp"

namespace radioslam {

struct ScanOdometryParams {
  double spacing_m = 0;         ///< of the map's points; 0: by the scans
  double spacing_share = 0.05;  ///< of the median range, where the scans decide
  double least_spacing_m = 0.05;
  double most_spacing_m = 0.5;
  double first_sigma_m = 0.5;  ///< deviation of the predicted motion before any is known
  double first_sigma_rad = 0.2;
  double least_sigma_m = 0.02;
  double least_sigma_rad = 0.005;
  double level_sigma_m = 0.1;  ///< of a robot with a scanner in the plane, from its plane
  double level_sigma_rad = 0.05;
  double prior_factor = 10;           ///< the prior's sigma, in deviations
  double deviation_share = 0.05;      ///< weight of the newest deviation
  double enough_share = 0.9;          ///< of the usual fit; one worse than that is searched for from afar
  int most_aligned = 5;               ///< of 21 starts of that search, the most promising
  double insert_share = 0.8;          ///< of the usual fit; a scan below it does not enter the map
  double least_matched_share = 0.15;  ///< a scan less of which fits the map is left out
  double least_usual_share = 0.5;     ///< likewise, of the usual fit: noise reaches 0.4
  double least_first_share = 0.5;     ///< likewise, of the second scan, when nothing is usual yet
  int patience = 10;                  ///< after so many left out that fit each other, or times the usual
                                      ///< interval without any, a new map is begun

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"spacing_m", "m", 0, 10, "between points of the map; 0: by the scans"}, self.spacing_m);
    visit(Field{"spacing_share", "", 0.001, 1, "of the median range, where the scans decide"},
          self.spacing_share);
    visit(Field{"least_spacing_m", "m", 0.001, 10, "and not less than this"}, self.least_spacing_m);
    visit(Field{"most_spacing_m", "m", 0.001, 10, "nor more"}, self.most_spacing_m);
    visit(Field{"first_sigma_m", "m", 1e-3, 10, "error of the first predicted motion"}, self.first_sigma_m);
    visit(Field{"first_sigma_rad", "rad", 1e-3, 3, "likewise"}, self.first_sigma_rad);
    visit(Field{"least_sigma_m", "m", 1e-4, 10, "no predicted motion is trusted to be better"},
          self.least_sigma_m);
    visit(Field{"least_sigma_rad", "rad", 1e-5, 3, "likewise"}, self.least_sigma_rad);
    visit(Field{"level_sigma_m", "m", 1e-4, 100, "of a robot with a scanner in the plane, from its plane"},
          self.level_sigma_m);
    visit(Field{"level_sigma_rad", "rad", 1e-5, 3, "likewise"}, self.level_sigma_rad);
    visit(Field{"prior_factor", "", 1, 1000,
                "the prior's sigma in deviations: predictions err systematically, and count where scans tell "
                "nothing"},
          self.prior_factor);
    visit(Field{"deviation_share", "", 1e-3, 1, "weight of the newest in the mean deviation"},
          self.deviation_share);
    visit(Field{"enough_share", "", 0, 1,
                "of the usual fit; a worse one is searched for from afar, and must be so of what is found"},
          self.enough_share);
    visit(Field{"most_aligned", "", 1, 21, "of the 21 starts of that search, the most promising"},
          self.most_aligned);
    visit(Field{"insert_share", "", 0, 1, "of the usual fit; a scan below it does not enter the map"},
          self.insert_share);
    visit(Field{"least_matched_share", "", 0, 1, "a scan less of which fits the map is left out"},
          self.least_matched_share);
    visit(Field{"least_usual_share", "", 0, 1, "likewise, of the usual fit"}, self.least_usual_share);
    visit(Field{"least_first_share", "", 0, 1, "likewise, of the second scan, when nothing is usual yet"},
          self.least_first_share);
    visit(Field{"patience", "", 1, 1e6, "after so many left out that fit each other they are the map"},
          self.patience);
  }
};

struct LidarParams {
  ScanPointParams points;
  SurfelParams surfel;
  RegistrationParams registration;
  LocalMapParams map;
  ScanOrderParams order;
  ScanOdometryParams odometry;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("scan_points", self.points);
    visit("scan_surfels", self.surfel);
    visit("scan_registration", self.registration);
    visit("scan_map", self.map);
    visit("scan_order", self.order);
    visit("scan_odometry", self.odometry);
  }
};

}  // namespace radioslam
