radioslam_room(map
  SOURCES
    map_surfaces.cpp
    near_voxels.cpp
    occupancy.cpp
    placed_scan.cpp
    ray_view.cpp
    scanner_geometry.cpp
    team_map.cpp
    voxel_map.cpp
  ROOMS lidar results)
