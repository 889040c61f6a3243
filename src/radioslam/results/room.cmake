radioslam_room(results
  SOURCES
    candidate_list.cpp
    note_groups.cpp
    result_notes.cpp
  ROOMS mission)
