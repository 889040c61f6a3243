radioslam_room(places
  SOURCES
    context_keys.cpp
    keyframe_contexts.cpp
    loops/kept_submaps.cpp
    loops/loop_candidates.cpp
    loops/loop_verification.cpp
    loops/other_places.cpp
    loops/scan_loop.cpp
    loops/scan_loops.cpp
    loops/storey.cpp
    scan_context.cpp
    scan_context_index.cpp
    sector_dft.cpp
    seen_through.cpp
  ROOMS lidar graph)
