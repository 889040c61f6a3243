// How a program ends when a signal or a failed check ends it.
#pragma once

namespace radioslam::cli {

/// Call first, before any thread starts. SIGINT and SIGTERM then remove unfinished outputs and end the
/// program with kInterrupted; a signal that was ignored when the program started stays ignored. A closed pipe
/// becomes a write error instead of a signal, and a failed RADIOSLAM_CHECK ends the program with kOurFailure.
void end_cleanly();

}  // namespace radioslam::cli
