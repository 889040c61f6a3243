// Notes of a run by kind: messages that differ in names of robots and in numbers alone are of one kind.
#pragma once

#include <string>
#include <vector>

namespace radioslam {

/// Notes of one kind, in their order; at least one.
struct NoteGroup {
  std::vector<std::string> notes;
  std::vector<std::string> robots;  ///< in which they differ, without repetitions
};

/// Groups in the order of their first notes. `robots`: all names that notes may contain.
std::vector<NoteGroup> grouped_notes(const std::vector<std::string>& notes,
                                     const std::vector<std::string>& robots);

/// One line: the first note of the group, with the number of notes and the robots concerned if there are
/// several.
std::string line_of(const NoteGroup& group);

}  // namespace radioslam
