radioslam_room(lidar
  SOURCES
    candidate_map.cpp
    deskew.cpp
    lidar_odometry.cpp
    local_map.cpp
    loops/loop_candidates.cpp
    loops/loop_verification.cpp
    loops/scan_loop.cpp
    loops/scan_loops.cpp
    pose_search.cpp
    prediction_error.cpp
    registration.cpp
    scan_matcher.cpp
    scan_points.cpp
    scan_structure.cpp
    surfels/surfel.cpp
    surfels/surfel_map.cpp
    surfels/voxel_grid.cpp
  ROOMS graph mission
  PRIVATE_LIBRARIES $<BUILD_INTERFACE:nanoflann::nanoflann>)
