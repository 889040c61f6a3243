radioslam_room(front_end
  SOURCES
    front_end.cpp
    recorded_samples.cpp
    replay.cpp
  ROOMS odometry records)
