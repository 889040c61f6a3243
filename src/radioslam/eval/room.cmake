radioslam_room(eval
  SOURCES
    angle_truth.cpp
    association.cpp
    closures.cpp
    measurement_truth.cpp
    metrics.cpp
    mirror_image.cpp
    position_fit.cpp
    statistics.cpp
    team_estimate.cpp
  ROOMS results mission)
