// Ends the program cleanly when it is interrupted.
#pragma once

namespace radioslam::cli {

/// Call first, before any thread starts. SIGINT and SIGTERM then remove unfinished outputs and end the
/// program with kInterrupted; one that was ignored when the program started stays ignored. A closed pipe is
/// an error of the write instead of a signal, and a broken promise (RADIOSLAM_CHECK) ends with kOurFailure.
void install_signal_handling();

}  // namespace radioslam::cli
