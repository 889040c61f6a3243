radioslam_room(lidar
  SOURCES
    candidate_map.cpp
    clouds/cloud_store.cpp
    clouds/packed_cloud.cpp
    deskew.cpp
    lidar_odometry.cpp
    local_map.cpp
    overlap_field.cpp
    pose_search.cpp
    prediction_error.cpp
    registration.cpp
    scan_matcher.cpp
    scan_points.cpp
    scan_structure.cpp
    structure_fit.cpp
    surfels/surfel.cpp
    surfels/surfel_columns.cpp
    surfels/surfel_map.cpp
    surfels/voxel_grid.cpp
  ROOMS mission
  PRIVATE_LIBRARIES $<BUILD_INTERFACE:nanoflann::nanoflann> Zstd::Zstd)
