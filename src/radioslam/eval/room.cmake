radioslam_room(eval
  SOURCES
    association.cpp
    closures.cpp
    measurement_truth.cpp
    metrics.cpp
    statistics.cpp
    team_estimate.cpp
  ROOMS results mission)
