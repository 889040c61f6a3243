// Check that a command's output does not replace one of its inputs.
#pragma once

#include <string>
#include <vector>

namespace radioslam::cli {

/// Refuses (InputError) an output that is one of the inputs, or a folder that contains one of them. Paths are
/// compared after normalisation and with symbolic links resolved; empty paths are ignored.
void refuse_replacing_inputs(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace radioslam::cli
