// Scan Context: polar grid of the heights around a robot, by which it recognises a place from any heading.
//
// Source: Kim, Kim, "Scan Context: Egocentric Spatial Descriptor for Place Recognition within 3D Point Cloud
// Map", IROS 2018. A grid has N columns (sectors) of azimuth, starting at body x, and rings of equal width up
// to a range in the body's horizontal plane. The distance of two grids a and b, with unit columns a_j, b_j:
//
//   d(s) = 1 - mean over j of a_(j+s) . b_j,   over the n(s) columns j with a_(j+s) and b_j not empty
//   d    = min over the shifts s with n(s) >= min_common_ratio N of d(s); 1 without such a shift
//
// All N shifts cost one pass over the spectra along the sectors (sector_dft.hpp), and the n(s) are population
// counts of rotated masks. The shift is the yaw of b in a: p_a = Rz(yaw) p_b, to within half a sector.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/places/sector_dft.hpp"

namespace radioslam {

struct ScanContextParams {
  int rings = 20;
  int sectors = 60;
  double max_range_m = 0;
  double min_common_ratio = 0.25;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(rings, "", 1, 256, "number of rings of a scan's polar grid");
    RADIOSLAM_FIELD(sectors, "", 1, kMaxSectors,
                    "number of sectors of a scan's polar grid; yaw is found to within half a sector");
    RADIOSLAM_FIELD(max_range_m, "m", 0, 1000, "range of a scan's polar grid; 0: chosen from the scans");
    RADIOSLAM_FIELD(min_common_ratio, "", 0, 1,
                    "smallest ratio of sectors with points in both scans at which a yaw is considered");
  }
};

enum class ScanContextKind {
  kHeight,     ///< greatest height above the ground in each bin, metres
  kOccupancy,  ///< 1 in each bin with a point: for planar scanners
};

/// A place's polar grid with its spectra, both with 16 bits a number: a long drive has thousands.
class ScanContext {
 public:
  /// `bins`: rings x sectors, zero where empty and positive elsewhere.
  ScanContext(const Eigen::MatrixXf& bins, double min_common_ratio);

  int rings() const { return static_cast<int>(bins_.steps.rows()); }
  int sectors() const { return static_cast<int>(bins_.steps.cols()); }
  Eigen::MatrixXf bins() const { return bins_.values(); }
  bool empty() const { return columns_ == 0; }

  /// Bit j: column j is not empty.
  std::uint64_t columns() const { return columns_; }
  /// Smallest number of common columns at which a shift is considered, at least 1.
  int min_common() const { return min_common_; }
  /// Of the unit columns along the sectors, a spectrum per ring (SectorDft).
  Eigen::MatrixXf spectra() const { return spectra_.values(); }

 private:
  /// In steps of a 32767th of the largest number; none but zeros become zero.
  struct Rounded {
    Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic> steps;
    float step = 0;

    explicit Rounded(const Eigen::MatrixXf& values);
    Eigen::MatrixXf values() const { return step * steps.cast<float>(); }
  };

  Rounded bins_;
  std::uint64_t columns_ = 0;
  int min_common_ = 1;
  Rounded spectra_;
};

/// Points in the body frame, x forward, z up, metres. Those that are not finite, on the z axis or at or
/// beyond `max_range_m` in the horizontal plane are ignored. Heights are above the 5th percentile of all
/// heights, so they do not depend on the scanner's mounting; lower ones count as zero. No points: an empty
/// grid.
ScanContext make_scan_context(const std::vector<Eigen::Vector3f>& points, double max_range_m,
                              ScanContextKind kind, const ScanContextParams& params);

struct ContextMatch {
  double distance = 1;  ///< 0 to 1
  double yaw_rad = 0;   ///< of b's body in a's frame, in (-pi, pi]
  int shift = 0;        ///< column j of b is column j + shift of a, modulo the sectors
};

/// Both must have the same rings and sectors, and should have the same range and kind. Symmetric in the
/// distance, up to rounding. The least shift among equally good ones.
ContextMatch compare(const ScanContext& a, const ScanContext& b);

/// Size of a message with a grid: one byte per bin, and its rings, sectors and height scale.
std::size_t wire_bytes(const ScanContext& context);

}  // namespace radioslam
