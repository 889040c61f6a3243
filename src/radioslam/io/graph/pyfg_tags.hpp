// Tags at the beginning of the lines of a PyFG file.
#pragma once

#include <string_view>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

template <class Pose>
struct PyfgTags;

template <>
struct PyfgTags<SE2> {
  static constexpr std::string_view kPose = "VERTEX_SE2";
  static constexpr std::string_view kPoint = "VERTEX_XY";
  static constexpr std::string_view kPosePrior = "VERTEX_SE2:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XY:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE2";
  static constexpr std::string_view kSighting = "EDGE_SE2_XY";
};

template <>
struct PyfgTags<SE3> {
  static constexpr std::string_view kPose = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kPoint = "VERTEX_XYZ";
  static constexpr std::string_view kPosePrior = "VERTEX_SE3:QUAT:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XYZ:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE3:QUAT";
  static constexpr std::string_view kSighting = "EDGE_SE3_XYZ";
};

inline constexpr std::string_view kPyfgRange = "EDGE_RANGE";

/// Whether `tag` belongs to graphs of this dimension.
template <class Pose>
constexpr bool is_pyfg_tag(std::string_view tag) {
  using Tags = PyfgTags<Pose>;
  return tag == Tags::kPose || tag == Tags::kPoint || tag == Tags::kPosePrior || tag == Tags::kPointPrior ||
         tag == Tags::kRelativePose || tag == Tags::kSighting;
}

template <class Pose>
constexpr bool is_pyfg_vertex(std::string_view tag) {
  return tag == PyfgTags<Pose>::kPose || tag == PyfgTags<Pose>::kPoint;
}

}  // namespace radioslam
