radioslam_room(closure
  SOURCES
    fingerprint_closures.cpp
    overlap/chain_segments.cpp
    overlap/keyframe_skeleton.cpp
    overlap/overlap_cross_covariance.cpp
    overlap/overlap_distance.cpp
    overlap/overlap_exchange.cpp
    overlap/overlap_joint.cpp
    overlap/overlap_link.cpp
    overlap/overlap_search.cpp
    overlap/overlap_view.cpp
    sequence_closures.cpp
    sequence_match.cpp
    sequence_window.cpp
  ROOMS team_frame graph)
