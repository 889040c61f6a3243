// CSV table of similar fingerprint pairs (t_i_s,t_j_s,similarity), ordered by the two stamps. The table may
// exceed the available memory, so it is computed and written in blocks of rows.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"

namespace radioslam::cli {

/// Appends the table to `output` and returns its number of pairs. `first` are the join's rows, `second` its
/// columns. Uses all threads; the output does not depend on their number.
std::size_t write_similarity_table(const SimilarityJoin& join, const std::vector<Fingerprint>& first,
                                   const std::vector<Fingerprint>& second, OutputFile& output,
                                   const Progress& progress);

}  // namespace radioslam::cli
