radioslam_room(pipeline
  SOURCES
    collect_results.cpp
    occupancy_image.cpp
    pipeline.cpp
    run_results.cpp
  ROOMS joint odometry closure consistency records results)
