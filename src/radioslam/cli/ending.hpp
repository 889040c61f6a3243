// How a program ends when a signal or a failed check ends it.
#pragma once

namespace radioslam::cli {

/// Call first, before any thread starts. SIGINT and SIGTERM then remove unfinished outputs and end the
/// program with kInterrupted; a signal that was ignored when the program started stays ignored. A closed pipe
/// becomes a write error instead of a signal, and a failed RADIOSLAM_CHECK ends the program with kOurFailure.
void end_cleanly();

/// From now on the first of these signals only asks the command to come to its end, with all outputs; the
/// second one ends the program as above.
void conclude_on_signal();
bool is_to_conclude();

}  // namespace radioslam::cli
