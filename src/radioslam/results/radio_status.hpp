// What a run found out about a device's RSSI offset, and about an access point's position.
#pragma once

namespace radioslam {

/// Status of the RSSI offset of a robot's device from the team's mean.
enum class RssiOffsetStatus {
  kNotSought,       ///< disabled, or no fingerprints of this robot or of any other
  kNotObserved,     ///< too few pairs of fingerprints with every other robot
  kNotSignificant,  ///< estimated, but the team's offsets are within their errors
  kCorrected,
};

/// Status of an access point's position.
enum class AccessPointStatus {
  kFound,
  kAmbiguous,          ///< an alternative position fits nearly as well
  kPoorlyConstrained,  ///< its standard deviation is too large
};

}  // namespace radioslam
