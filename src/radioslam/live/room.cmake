radioslam_room(live
  SOURCES
    growing_estimate.cpp
    link_evidence.cpp
    published_frames.cpp
    scans_so_far.cpp
    stream_effort.cpp
    team_stream.cpp
  ROOMS front_end pipeline eval)
