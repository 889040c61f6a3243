radioslam_room(eval
  SOURCES
    access_point_errors.cpp
    association.cpp
    closures.cpp
    measurement_truth.cpp
    metrics.cpp
    mirror_image.cpp
    team_estimate.cpp
  ROOMS closure results mission)
