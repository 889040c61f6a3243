radioslam_room(rendezvous
  SOURCES
    adaptive_walk.cpp
    anchored_exploration.cpp
    angle_evidence.cpp
    partner_choice.cpp
    published_error.cpp
    rendezvous_robot.cpp
  ROOMS base graph)
