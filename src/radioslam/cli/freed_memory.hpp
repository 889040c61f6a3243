// What the program does with memory that it has freed.
#pragma once

namespace radioslam::cli {

/// Graphs are solved and freed hundreds of times; giving the memory back each time took half of the time of
/// judging a team's loops. One arena for all threads: several would each keep what another could use.
/// To be called before there are threads.
void keep_freed_memory();

/// After a stage whose pieces the next one's large tables do not fit between.
void give_back_freed_memory();

}  // namespace radioslam::cli
