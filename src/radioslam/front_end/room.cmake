radioslam_room(front_end
  SOURCES
    front_end.cpp
    replay.cpp
  ROOMS odometry records)
