radioslam_room(pipeline
  SOURCES
    collect_results.cpp
    pipeline.cpp
    run_results.cpp
  ROOMS joint map odometry closure consistency records results)
