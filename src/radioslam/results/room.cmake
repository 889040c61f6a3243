radioslam_room(results
  SOURCES
    candidate_list.cpp
    most_probable_candidates.cpp
  ROOMS mission)
