// Clouds of keyframes, packed (packed_cloud.hpp): in memory up to a bound, in a temporary file beyond it.
//
// A cloud is quantised when it is added, so that nothing depends on where its bytes are or on the bound. The
// clouds read last are kept unpacked, up to a half of the bound; the other half is for packed ones.
// Thread-safe.
#pragma once

#include <cstddef>
#include <memory>

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/local_map.hpp"

namespace radioslam {

struct CloudStoreParams {
  int memory_mib = 16;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(memory_mib, "MiB", 0, 1e6,
                    "memory for the scans of keyframes; what does not fit is kept in a temporary file in "
                    "$TMPDIR, or /var/tmp, and read again. Results do not depend on it");
  }
};

/// A cloud in a store; copies are of the same one. By default an empty cloud, in none.
class StoredCloud {
 public:
  StoredCloud() = default;

  bool empty() const { return points_ == 0; }
  std::size_t points() const { return points_; }
  double median_range_m() const { return median_range_m_; }
  /// The quantised cloud, which is there as long as the pointer is held. Throws InputError where its
  /// temporary file cannot be read.
  std::shared_ptr<const ScanPyramid> read() const;

 private:
  friend class CloudStore;
  class Bytes;

  std::shared_ptr<const Bytes> bytes_;
  std::size_t points_ = 0;
  double median_range_m_ = 0;
};

/// Its clouds outlive it.
class CloudStore {
 public:
  explicit CloudStore(const CloudStoreParams& params = {});

  /// Throws InputError where the temporary file cannot be written.
  StoredCloud add(const ScanPyramid& cloud);

 private:
  friend class StoredCloud;
  class Shelf;

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace radioslam
