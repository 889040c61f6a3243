#include "radioslam/cli/run_parameters.hpp"

namespace radioslam::cli {

template std::vector<ParameterRef> parameters_in<RunParams>(RunParams& params);

}  // namespace radioslam::cli
