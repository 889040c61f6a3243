// Exit statuses of the program.
#pragma once

namespace radioslam::cli {

constexpr int kDone = 0;
constexpr int kOurFailure = 1;     ///< internal error, or a failure of the system
constexpr int kWrongInput = 2;     ///< invalid command line or input
constexpr int kInterrupted = 130;  ///< ended by a signal; outputs are unchanged

}  // namespace radioslam::cli
