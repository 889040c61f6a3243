#include "radioslam/lidar/loops/scan_loop.hpp"

namespace radioslam {

std::string_view reason(LoopStatus status) {
  switch (status) {
    case LoopStatus::kAccepted:
      return "";
    case LoopStatus::kLowOverlap:
      return "the scans do not fit";
    case LoopStatus::kAmbiguous:
      return "another place fits as well";
    case LoopStatus::kContradictsOdometry:
      return "the odometry disagrees";
    case LoopStatus::kRejectedByGraph:
      return "the other closures disagree";
  }
  return "";
}

}  // namespace radioslam
