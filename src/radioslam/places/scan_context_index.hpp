// Search of the most similar Scan Contexts among many: by keys, then by coarse correlation, then exactly.
//
//   1. `nearest_keys` contexts with the nearest keys (context_keys.hpp), by a pass over all keys
//   2. if these are more than `shortlist`: those with the greatest correlation of their spectra, in up to 32
//      bands of rings, at 8 frequencies and over 32 shifts
//   3. compare() with each of the shortlist
//
// The result is that of comparing all, unless a good match is lost in 1 or 2. Measured among 10,000 contexts
// of a simulated town (bench/place_bench.cpp), other scanner, up to 3 m away: 0.8 ms per search with 20 rings
// and 1.3 ms with 64; the best of all was found in 99.7 % and 97 % of the searches, and in over 99.5 % of
// those in which it was the right place. Memory: up to 2.5 kB per context beside its own. With key = ring and
// 50 nearest keys the search is that of DiSCo-SLAM (Huang et al., RA-L 2022). Searches can run at the same
// time.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/places/scan_context.hpp"
#include "radioslam/places/sector_dft.hpp"

namespace radioslam {

struct ScanContextIndexParams {
  std::string key = "spectral";
  int nearest_keys = 2000;
  int shortlist = 200;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(key, "", 0, 0,
                    "key by which places are searched; ring: occupied bins per ring, as in Scan Context; "
                    "spectral: also for different scanners",
                    "spectral|ring");
    RADIOSLAM_FIELD(nearest_keys, "", 1, 1e9,
                    "number of places with the nearest keys that are considered; DiSCo-SLAM: 50");
    RADIOSLAM_FIELD(shortlist, "", 1, 1e9,
                    "number of places compared exactly, the best of those considered by a coarse comparison");
  }
};

/// Descriptors of places, and their search.
struct PlaceDescriptorParams {
  ScanContextParams context;
  ScanContextIndexParams index;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    ScanContextParams::visit_fields(self.context, visit);
    ScanContextIndexParams::visit_fields(self.index, visit);
  }
};

/// A context of the index and how it matches the query: compare(query, context).
struct Neighbour {
  std::size_t index = 0;
  ContextMatch match;
};

class ScanContextIndex {
 public:
  explicit ScanContextIndex(const ScanContextIndexParams& params);

  std::size_t size() const { return contexts_.size(); }
  const ScanContext& context(std::size_t index) const { return contexts_[index]; }

  /// Gets the index size(). All contexts must have the same rings and sectors.
  void add(ScanContext context);
  /// No more are added for now: keeps no more memory than it needs.
  void shrink_to_fit();

  using Allowed = std::function<bool(std::size_t index)>;

  /// The `count` nearest among those allowed (all by default), by distance, then by index; fewer only if
  /// fewer are allowed.
  std::vector<Neighbour> nearest(const ScanContext& query, std::size_t count,
                                 const Allowed& allowed = {}) const;

  /// The same by comparing all.
  std::vector<Neighbour> nearest_exhaustively(const ScanContext& query, std::size_t count,
                                              const Allowed& allowed = {}) const;

 private:
  void keep_nearest_keys(const ScanContext& query, std::size_t count,
                         std::vector<std::size_t>& indices) const;
  void keep_coarsely_best(const ScanContext& query, std::size_t count,
                          std::vector<std::size_t>& indices) const;
  std::vector<Neighbour> best_of(const ScanContext& query, const std::vector<std::size_t>& indices,
                                 std::size_t count) const;

  ScanContextIndexParams params_;
  std::vector<ScanContext> contexts_;
  std::vector<float> keys_;              ///< one after the other
  std::vector<float> half_squares_;      ///< of the keys' norms
  std::optional<SectorDft> coarse_dft_;  ///< once there is a context
  std::vector<float> coarse_;            ///< spectra, one context after the other
};

}  // namespace radioslam
