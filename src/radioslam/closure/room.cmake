radioslam_room(closure SOURCES fingerprint_closures.cpp sequence_window.cpp sequence_pairs.cpp sequence_match.cpp sequence_closures.cpp overlap_distance.cpp overlap_view.cpp
               overlap_link.cpp overlap_skeleton.cpp overlap_cross_covariance.cpp overlap_joint.cpp
               overlap_search.cpp overlap_exchange.cpp ROOMS team_frame graph)
