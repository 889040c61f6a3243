// Access by name to the parameters of a run. They are several hundred fields, compiled once for all commands.
#pragma once

#include "radioslam/cli/parameters.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam::cli {

extern template std::vector<ParameterRef> parameters_in<RunParams>(RunParams& params);

}  // namespace radioslam::cli
