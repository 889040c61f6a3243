// How the program ends, for scripts.
#pragma once

namespace radioslam::cli {

constexpr int kDone = 0;
constexpr int kOurFailure = 1;     ///< the program is wrong, or the machine failed it
constexpr int kWrongInput = 2;     ///< the call or an input is wrong
constexpr int kInterrupted = 130;  ///< ended from outside; no output was touched

}  // namespace radioslam::cli
