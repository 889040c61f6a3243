// Signal handling: removes unfinished outputs when the program is interrupted.
#pragma once

namespace radioslam::cli {

/// Call first, before any thread starts. SIGINT and SIGTERM then remove unfinished outputs and end the
/// program with kInterrupted; a signal that was ignored when the program started stays ignored. A closed pipe
/// becomes a write error instead of a signal, and a failed RADIOSLAM_CHECK ends the program with kOurFailure.
void install_signal_handling();

}  // namespace radioslam::cli
