radioslam_room(results
  SOURCES
    candidate_list.cpp
  ROOMS mission)
