radioslam_room(lidar SOURCES scan_points.cpp voxel_grid.cpp surfel.cpp surfel_map.cpp registration.cpp scan_odometry.cpp
               ROOMS mission PRIVATE_LIBRARIES $<BUILD_INTERFACE:nanoflann::nanoflann>)
