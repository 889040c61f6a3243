radioslam_room(lidar SOURCES scan_points.cpp voxel_grid.cpp surfel.cpp surfel_map.cpp local_map.cpp scan_order.cpp registration.cpp pose_search.cpp scanner_traits.cpp scan_sweep.cpp scan_odometry.cpp scan_loops.cpp
               ROOMS graph mission PRIVATE_LIBRARIES $<BUILD_INTERFACE:nanoflann::nanoflann>)
