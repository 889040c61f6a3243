radioslam_room(mission
  SOURCES
    compass.cpp
    continuous_trajectory.cpp
    dead_reckoning.cpp
    keyframes.cpp
    levelling.cpp
    odometry_between.cpp
    odometry_edge.cpp
    step_detection.cpp
    wifi_channel.cpp
  ROOMS geometry)
