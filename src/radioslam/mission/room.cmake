radioslam_room(mission
  SOURCES
    continuous_trajectory.cpp
    dead_reckoning.cpp
    keyframe_choice.cpp
    keyframe_motion.cpp
    keyframes.cpp
    known_access_points.cpp
    odometry_edge.cpp
    sweep_slices.cpp
    wifi_channel.cpp
  ROOMS geometry)
