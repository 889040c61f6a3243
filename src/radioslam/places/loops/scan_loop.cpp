#include "radioslam/places/loops/scan_loop.hpp"

namespace radioslam {

std::string_view reason(LoopStatus status) {
  switch (status) {
    case LoopStatus::kAccepted:
      return "";
    case LoopStatus::kLowOverlap:
      return "the scans do not fit";
    case LoopStatus::kTooLittleStructure:
      return "too little structure";
    case LoopStatus::kAmbiguous:
      return "another place fits as well";
    case LoopStatus::kUnmapped:
      return "a place not seen yet may fit as well";
    case LoopStatus::kAnotherStorey:
      return "it may be another storey";
    case LoopStatus::kRejectedByGraph:
      return "the other closures disagree";
  }
  return "";
}

}  // namespace radioslam
