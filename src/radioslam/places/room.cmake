radioslam_room(places
  SOURCES
    context_keys.cpp
    scan_context.cpp
    scan_context_index.cpp
    sector_dft.cpp
  ROOMS lidar)
