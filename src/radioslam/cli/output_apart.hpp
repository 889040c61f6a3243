// Outputs that would replace what a command reads.
#pragma once

#include <string>
#include <vector>

namespace radioslam::cli {

/// Refuses (InputError) an output that is one of the inputs, or a folder with one of them in it, however the
/// paths are written and through symbolic links. Empty paths are none.
void refuse_replacing_inputs(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace radioslam::cli
