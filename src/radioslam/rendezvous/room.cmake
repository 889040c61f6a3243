radioslam_room(rendezvous
  SOURCES
    adaptive_walk.cpp
    anchored_exploration.cpp
    angle_evidence.cpp
    partner_choice.cpp
    published_error.cpp
    read_log.cpp
    rendezvous_robot.cpp
    robot_estimate.cpp
    robot_logs.cpp
  ROOMS graph records)
