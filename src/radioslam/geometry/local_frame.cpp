#include "radioslam/geometry/local_frame.hpp"

#include <cmath>

namespace radioslam {
namespace {

constexpr double kEquatorRadius_m = 6378137, kFlattening = 1 / 298.257223563;
constexpr double kEccentricitySquared = kFlattening * (2 - kFlattening);

}  // namespace

Eigen::Vector3d earth_centred_m(const GeodeticPlace& place) {
  const double sine = std::sin(place.latitude_rad), cosine = std::cos(place.latitude_rad);
  const double normal_m = kEquatorRadius_m / std::sqrt(1 - kEccentricitySquared * sine * sine);
  const double axis_distance_m = (normal_m + place.height_m) * cosine;
  return {axis_distance_m * std::cos(place.longitude_rad), axis_distance_m * std::sin(place.longitude_rad),
          ((1 - kEccentricitySquared) * normal_m + place.height_m) * sine};
}

Eigen::Vector3d east_north_up_m(const GeodeticPlace& origin, const GeodeticPlace& place) {
  const double sin_p = std::sin(origin.latitude_rad), cos_p = std::cos(origin.latitude_rad);
  const double sin_l = std::sin(origin.longitude_rad), cos_l = std::cos(origin.longitude_rad);
  Eigen::Matrix3d R_local_earth;
  R_local_earth << -sin_l, cos_l, 0,          //
      -sin_p * cos_l, -sin_p * sin_l, cos_p,  //
      cos_p * cos_l, cos_p * sin_l, sin_p;
  return R_local_earth * (earth_centred_m(place) - earth_centred_m(origin));
}

}  // namespace radioslam
