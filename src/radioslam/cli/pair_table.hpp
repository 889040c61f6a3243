// The table of similar pairs: t_i_s,t_j_s,similarity, ordered by the fingerprints' times. It may be far
// larger than the memory, so it is computed and written some rows at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity_join.hpp"

namespace radioslam::cli {

/// Appends the table to `output` and returns how many pairs it has. `first` are the join's rows and `second`
/// its columns. On all threads; the same bytes for any number of them.
std::size_t write_pair_table(const SimilarityJoin& join, const std::vector<Fingerprint>& first,
                             const std::vector<Fingerprint>& second, OutputFile& output,
                             const Progress& progress);

}  // namespace radioslam::cli
